//! Says which open parameters changed nothing in a campaign.
//!
//! A driver that does not see fog passes every test in fog, and a report on these tests gives false assurance. Two methods find such a
//! parameter. If nothing in the worlds of the tests reads the parameter, it has no effect, for certain. Otherwise some tests run once
//! more with another value of this parameter alone. If no trace of n pairs changes, the parameter has an effect in at most
//! `1 - 0.05^(1/n)` of the space, with 95 % confidence (about 3/n: Hanley and Lippman-Hand, If nothing goes wrong, is everything all
//! right?, JAMA 249(13), 1983). The tests stand for the space as far as the strategy spreads them evenly.

#[cfg(test)]
mod tests;

use paracosm_campaign::{Error, JsonArtefact, Log, Study, Subject, Trial, Worker};
use paracosm_engine::{Declared, Reach, Test};
use paracosm_space::{Point, Space, SpaceError, Values, plural};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The number of tests of a campaign for each pair of a parameter.
const TESTS_PER_PAIR: usize = 10;
/// The least and the greatest number of pairs. Fewer pairs say too little.
const PAIRS: (usize, usize) = (10, 100);
/// The steps along an interval from the value of a test to the other value, as shares of the interval.
const STEPS: [f64; 3] = [0.5, 0.25, 0.75];
/// The confidence that a parameter without an effect in all pairs has an effect in no larger part of the space.
const CONFIDENCE: f64 = 0.95;

/// Returns the names of the open parameters that neither the driver nor the world reads in a test in the middle of the space. They
/// are known before a test has run.
///
/// # Errors
/// No worker can be made.
pub fn foreseen(study: &Study) -> Result<Vec<String>, Error> {
    let names: Vec<String> = study.space().parameters().iter().map(|parameter| parameter.name.clone()).collect();
    let unread = unread(study, names.iter().cloned(), [&middle(study)])?;
    Ok(names.into_iter().filter(|name| unread.contains(name)).collect())
}

/// Returns the names of the fixed parameters whose value is not the nominal value, and that neither the driver nor the world reads in a test
/// in the middle of the space: a test in fog says nothing about fog if nobody sees it.
///
/// # Errors
/// The scenario cannot declare its parameters, or no worker can be made.
pub fn foreseen_fixed(study: &Study) -> Result<Vec<String>, Error> {
    if study.subject().scenario().is_err() {
        return Ok(Vec::new());
    }
    let declared = study.program()?.declare()?.parameters;
    let fixed = study.fixed().iter().filter(|(name, value)| {
        let nominal = declared.iter().find(|declared| declared.parameter.name == *name).map(Declared::nominal);
        nominal.is_some_and(|nominal| nominal != **value)
    });
    let names: Vec<String> = fixed.map(|(name, _)| name.to_owned()).collect();
    if names.is_empty() {
        return Ok(names);
    }
    let unread = unread(study, names.iter().cloned(), [&middle(study)])?;
    Ok(names.into_iter().filter(|name| unread.contains(name)).collect())
}

/// Returns the test in the middle of the space of a study.
fn middle(study: &Study) -> Values {
    let space = study.space();
    let discrete = space.levels().iter().map(|levels| levels / 2).collect();
    space.decode(&Point { continuous: vec![0.5; space.dims()], discrete })
}

/// The effect of an open parameter on the traces of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "effect")]
pub enum Effect {
    /// Some pair of tests that differ in this parameter alone has different traces or results.
    Seen,
    /// Nothing in the worlds of the tests reads the parameter, so it has no effect for certain.
    Unread,
    /// No pair of tests that differ in this parameter alone has different traces or results.
    Unseen {
        /// The number of pairs.
        pairs: usize,
        /// The largest share of the space in which the parameter may have an effect, with 95 % confidence.
        at_most: f64,
    },
    /// The campaign has too few tests to say anything.
    Unknown,
}

/// An open parameter with its effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterEffect {
    /// The name of the parameter.
    pub parameter: String,
    /// The effect of the parameter.
    #[serde(flatten)]
    pub effect: Effect,
}

/// The effects of the open parameters of a campaign, in the order of the space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Form", from = "Form")]
pub struct Effects(pub Vec<ParameterEffect>);

/// The effects in a file.
#[derive(Serialize, Deserialize)]
struct Form {
    without_effect: Vec<String>,
    parameters: Vec<ParameterEffect>,
}

impl From<Effects> for Form {
    fn from(effects: Effects) -> Self {
        let without_effect = effects.without_effect().map(|(name, _)| name.to_owned()).collect();
        Self { without_effect, parameters: effects.0 }
    }
}

impl From<Form> for Effects {
    fn from(form: Form) -> Self {
        Self(form.parameters)
    }
}

impl Effects {
    /// Finds the effects of the open parameters of a campaign. `run` runs a test, whose number is given.
    ///
    /// # Errors
    /// `run` fails, or no worker can be made.
    pub fn of(log: &Log, mut run: impl FnMut(&Values, usize) -> Result<Trial, Error>) -> Result<Self, Error> {
        let study = log.study();
        let open = study.space().parameters().iter().map(|parameter| parameter.name.clone());
        let unread = unread(study, open, log.trials().iter().map(|trial| &trial.test))?;
        let mut effects = Vec::new();
        for parameter in study.space().parameters() {
            let name = &parameter.name;
            let effect = if unread.contains(name) { Effect::Unread } else { tried(log, name, &mut run)? };
            effects.push(ParameterEffect { parameter: name.clone(), effect });
        }
        Ok(Self(effects))
    }

    /// Returns a line for each reason, with the names of the parameters that changed no trace for this reason.
    pub fn in_words(&self) -> Vec<String> {
        let mut reasons: Vec<(String, Vec<&str>)> = Vec::new();
        for (name, why) in self.without_effect() {
            match reasons.iter_mut().find(|(known, _)| *known == why) {
                Some((_, names)) => names.push(name),
                None => reasons.push((why, vec![name])),
            }
        }
        reasons.into_iter().map(|(why, names)| format!("{}: {why}", names.join(", "))).collect()
    }

    /// Returns the names of the parameters that changed no trace, each with the reason for this statement in words.
    pub fn without_effect(&self) -> impl Iterator<Item = (&str, String)> {
        self.0.iter().filter_map(|one| Some((one.parameter.as_str(), one.effect.in_words()?)))
    }
}

impl Effect {
    /// Describes in words why a parameter counts as a parameter without effect; `None` if it has an effect, or if nothing is known.
    pub fn in_words(&self) -> Option<String> {
        match self {
            Self::Unread => Some("read by neither the world nor the driver".to_owned()),
            Self::Unseen { pairs, at_most } => Some(format!(
                "in {pairs} of {} of tests (an effect in at most {:.1} % of the space, 95 %)",
                plural(*pairs, "pair"),
                100.0 * at_most
            )),
            Self::Seen | Self::Unknown => None,
        }
    }

    fn unseen(pairs: usize) -> Self {
        Self::Unseen { pairs, at_most: 1.0 - libm::pow(1.0 - CONFIDENCE, 1.0 / pairs as f64) }
    }
}

impl JsonArtefact for Effects {
    const FILE: &'static str = "effects.json";
}

/// Returns the names of the open parameters that neither the driver nor anything in the world of any test reads.
fn unread<'t>(
    study: &Study,
    of: impl IntoIterator<Item = String>,
    tests: impl IntoIterator<Item = &'t Values>,
) -> Result<BTreeSet<String>, Error> {
    let mut names = BTreeSet::new();
    let Subject::Scenario(simulation) = study.subject() else { return Ok(names) };
    // The images of a perceiver show the air. A driver in another process is not looked into.
    if study.perceiver().is_some() || simulation.driver().is_external() {
        return Ok(names);
    }
    let mut tests = tests.into_iter().peekable();
    let Some(first) = tests.peek().copied() else { return Ok(names) };
    names.extend(of);
    for test in tests {
        let reached = reached(study, test);
        names.retain(|name| reached.get(name).is_some_and(|reach| *reach < Reach::World));
        if names.is_empty() {
            return Ok(names);
        }
    }
    let mut has_senses = false;
    Worker::new(study)?.watch(0, first, |run| has_senses |= run.has_senses());
    if has_senses {
        names.clear();
    }
    Ok(names)
}

/// Returns how far each parameter of the world of a test reaches; nothing for a test whose world cannot be built.
fn reached(study: &Study, test: &Values) -> paracosm_space::Record<Reach> {
    let Subject::Scenario(simulation) = study.subject() else { return Default::default() };
    let values = study.complete(test);
    let reaches = simulation.program().ok().and_then(|program| program.reaches(Test::new(&values, study.space())).ok());
    reaches.unwrap_or_default().into_iter().collect()
}

/// Runs tests once more with another value of one parameter, until one has another result.
fn tried(
    log: &Log,
    parameter: &str,
    run: &mut impl FnMut(&Values, usize) -> Result<Trial, Error>,
) -> Result<Effect, Error> {
    let space = log.study().space();
    let tests: Vec<&Trial> = log.trials().iter().filter(|trial| trial.covers()).collect();
    let (least, most) = PAIRS;
    let wanted = (tests.len() / TESTS_PER_PAIR).min(most);
    if wanted < least {
        return Ok(Effect::Unknown);
    }
    let mut pairs = 0;
    for place in 0..wanted {
        let trial = tests[place * tests.len() / wanted];
        let Some(test) = other(space, &trial.test, parameter)? else { continue };
        pairs += 1;
        if !is_same(trial, &run(&test, log.trials().len())?) {
            return Ok(Effect::Seen);
        }
    }
    Ok(if pairs < least { Effect::Unknown } else { Effect::unseen(pairs) })
}

/// Returns a valid test that differs in one parameter alone; `None` if none of the tried values is valid.
fn other(space: &Space, test: &Values, parameter: &str) -> Result<Option<Values>, SpaceError> {
    let point = space.encode(test)?;
    for step in STEPS {
        let continuous = space
            .continuous()
            .zip(&point.continuous)
            .map(|(coordinate, at)| if coordinate.parameter.name == parameter { (at + step).fract() } else { *at });
        let discrete = space.discrete().zip(&point.discrete).map(|(coordinate, at)| {
            let levels = coordinate.parameter.levels().map_or(1, <[_]>::len);
            let further = ((step * levels as f64) as usize).max(1);
            if coordinate.parameter.name == parameter { (at + further) % levels } else { *at }
        });
        let moved = Point { continuous: continuous.collect(), discrete: discrete.collect() };
        let values = space.decode(&moved);
        // A list of whole numbers may round to the same value.
        if values.get(parameter) != test.get(parameter) && space.allows(&space.encode(&values)?) {
            return Ok(Some(values));
        }
    }
    Ok(None)
}

/// Returns `true` if two trials have the same trace and the same results.
fn is_same(a: &Trial, b: &Trial) -> bool {
    (a.verdict, &a.trace_hash, &a.judgements) == (b.verdict, &b.trace_hash, &b.judgements)
}
