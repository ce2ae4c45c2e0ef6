//! Compares two campaigns test by test: the same tests under two drivers, or with two versions of the software.
//!
//! Tests are pairs if they have the same values. A *new failure* fails in the second campaign and does not fail in the first one; a
//! *mended* test is the other way round. McNemar's test says whether the two counts differ by more than chance. If both drivers were
//! equally good, a test that fails in one campaign alone would fail in either campaign with the same probability.

#[cfg(test)]
mod tests;

use crate::modes::Modes;
use crate::points::Points;
use crate::statistics::{mcnemar_p, quantile};
use paracosm_campaign::{Error, Log, Reason, StatedRequirement, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{Values, nearest};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use thiserror::Error;

/// Two campaigns, compared test by test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// The titles of both campaigns: the scenario and the driver.
    pub titles: [String; 2],
    /// The other differences of the campaigns in words: fixed parameters, and requirements that only one of them has.
    pub otherwise: Vec<String>,
    /// The requirements that only the first campaign has.
    #[serde(skip)]
    pub dropped: Vec<String>,
    /// The number of different tests of the first campaign that the second campaign does not have.
    #[serde(skip)]
    pub missing: usize,
    /// The number of pairs: tests that both campaigns have.
    pub tests: usize,
    /// The numbers of tests of each campaign that have no pair. A pair counts once, however often a campaign repeats its test.
    pub unpaired: [usize; 2],
    /// The points of Euro NCAP of both campaigns, if both have points on the same grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<[Points; 2]>,
    /// The numbers of failing tests among the pairs.
    pub failing: [usize; 2],
    /// The number of pairs in which both tests fail.
    pub still_failing: usize,
    /// The tests that fail in the second campaign and do not fail in the first one.
    pub new_failures: Vec<Changed>,
    /// The tests that fail in the first campaign and do not fail in the second one.
    pub mended: Vec<Changed>,
    /// The failure modes of the new failures in the second campaign, the most frequent mode first.
    pub new_modes: Vec<ModeCount>,
    /// The failure modes of the mended tests in the first campaign, the most frequent mode first.
    pub mended_modes: Vec<ModeCount>,
    /// The two-sided p-value of McNemar's exact test, over the pairs in which both tests passed or failed.
    pub mcnemar_p: f64,
    /// The changes of the margins, for each requirement that both campaigns have.
    pub margins: Vec<MarginChange>,
}

/// A test whose verdict has changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Changed {
    /// The index of the test in each campaign.
    pub index: [usize; 2],
    /// The values of the test.
    pub test: Values,
    /// The verdict in each campaign.
    #[serde(serialize_with = "in_words")]
    pub verdicts: [Verdict; 2],
    /// The requirements that the failing one of both tests violates.
    pub violates: Vec<String>,
}

/// A failure mode with the number of changed tests that have it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ModeCount {
    /// The name of the mode in the file `modes.json` of its campaign.
    pub name: String,
    /// The sentence that describes the mode.
    pub words: String,
    /// The indices of the changed tests in the campaign of the mode.
    pub tests: Vec<usize>,
    /// The number of all tests of the campaign with this mode, which the sentence describes.
    pub of: usize,
}

/// The changes of the robustness for one requirement, over the pairs in which both campaigns have a finite one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MarginChange {
    /// The id of the requirement.
    pub requirement: String,
    /// The unit of the changes; empty without a unit.
    pub unit: String,
    /// The number of pairs.
    pub pairs: usize,
    /// The number of pairs in which the margin is smaller in the second campaign.
    pub smaller: usize,
    /// The number of pairs in which the margin is the same.
    pub same: usize,
    /// The number of pairs in which the margin is larger in the second campaign.
    pub larger: usize,
    /// The median of the changes.
    pub median: f64,
    /// The greatest loss; `None` if no margin is smaller.
    pub worst: Option<Loss>,
}

/// The greatest loss of a margin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Loss {
    /// The index of the test in the second campaign.
    pub index: usize,
    /// The change of the margin, which is below 0.
    pub change: f64,
}

/// The reason why two campaigns cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum DifferenceFlaw {
    /// The campaigns are on scenarios with different parameters.
    #[error(
        "the first campaign is on `{first}`, the second on `{second}`: only campaigns over the same parameters of a scenario have the same tests"
    )]
    Scenarios {
        /// The scenario of the first campaign.
        first: String,
        /// The scenario of the second campaign.
        second: String,
    },
    /// A campaign has an open parameter that the other one does not have.
    #[error(
        "parameter `{name}` is open in the {has} campaign and not in the {lacks} one{}: only campaigns over the same parameters have the same tests",
        paracosm_space::did_you_mean(.nearest)
    )]
    Parameter {
        /// The name of the parameter.
        name: String,
        /// The campaign that has the parameter.
        has: Which,
        /// The campaign that does not.
        lacks: Which,
        /// The nearest name in the other campaign.
        nearest: Option<String>,
    },
    /// No test is in both campaigns.
    #[error(
        "the campaigns have no test in common: run the second one with the same strategy, seed and budget as the first one"
    )]
    NoPair,
}

impl Reason for DifferenceFlaw {}

/// One of two campaigns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The first campaign.
    First,
    /// The second campaign.
    Second,
}

impl fmt::Display for Which {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::First => "first",
            Self::Second => "second",
        })
    }
}

impl Difference {
    /// Compares two campaigns. If a campaign has a test several times, the first one counts.
    ///
    /// # Errors
    /// The campaigns have other open parameters, or no test in common.
    pub fn of(first: &Log, second: &Log) -> Result<Self, Error> {
        same_parameters(first, second)?;
        let place: BTreeMap<String, &Trial> = first.trials().iter().rev().map(|trial| (key(trial), trial)).collect();
        let mut seen = BTreeSet::new();
        let mut pairs: Vec<[&Trial; 2]> = Vec::new();
        for trial in second.trials() {
            let key = key(trial);
            if let Some(other) = place.get(&key)
                && seen.insert(key)
            {
                pairs.push([other, trial]);
            }
        }
        if pairs.is_empty() {
            return Err(DifferenceFlaw::NoPair.into());
        }
        let changed = |from: usize| -> Vec<Changed> {
            let turned = pairs.iter().filter(|pair| pair[from].is_failure() && !pair[1 - from].is_failure());
            turned.map(|pair| Changed::of(pair, pair[from])).collect()
        };
        let (new_failures, mended) = (changed(1), changed(0));
        let decided =
            |pair: &&[&Trial; 2], from: usize| pair[from].is_failure() && pair[1 - from].verdict == Verdict::Pass;
        let [new, gone] = [1, 0].map(|from| pairs.iter().filter(|pair| decided(pair, from)).count());
        Ok(Self {
            titles: [first, second].map(|log| log.study().title()),
            otherwise: otherwise(first.study(), second.study()),
            dropped: only(first.study(), second.study()),
            missing: place.keys().filter(|key| !seen.contains(*key)).count(),
            tests: pairs.len(),
            unpaired: [first, second].map(|log| log.trials().len() - pairs.len()),
            points: points(first, second),
            failing: [0, 1].map(|of| pairs.iter().filter(|pair| pair[of].is_failure()).count()),
            still_failing: pairs.iter().filter(|pair| pair.iter().all(|trial| trial.is_failure())).count(),
            new_modes: modes(second, new_failures.iter().map(|changed| changed.index[1])),
            mended_modes: modes(first, mended.iter().map(|changed| changed.index[0])),
            new_failures,
            mended,
            mcnemar_p: mcnemar_p(new, gone),
            margins: margins(first.study(), &pairs),
        })
    }
}

impl Changed {
    fn of(pair: &[&Trial; 2], failing: &Trial) -> Self {
        Self {
            index: pair.map(|trial| trial.index),
            test: failing.test.clone(),
            verdicts: pair.map(|trial| trial.verdict),
            violates: failing.violated().map(str::to_owned).collect(),
        }
    }
}

/// Returns the ids of the requirements that only the first study has, or has with another formula.
fn only(first: &Study, second: &Study) -> Vec<String> {
    let is_there =
        |one: &&StatedRequirement| second.requirement(&one.id).is_some_and(|other| other.formula == one.formula);
    first.requirements().iter().filter(|one| !is_there(one)).map(|one| one.id.clone()).collect()
}

/// Says how two studies differ beside their titles: a changed verdict may come from such a difference.
fn otherwise(first: &Study, second: &Study) -> Vec<String> {
    let word = |study: &Study, name: &str| study.fixed().get(name).map(ToString::to_string);
    let names: BTreeSet<&str> =
        [first, second].iter().flat_map(|study| study.fixed().iter().map(|(name, _)| name)).collect();
    let fixed = names.into_iter().filter_map(|name| match [first, second].map(|study| word(study, name)) {
        [before, after] if before == after => None,
        [Some(before), Some(after)] => Some(format!("{name} is {before} before and {after} after")),
        _ => None,
    });
    let one_sided = [(first, second, "before"), (second, first, "after")].into_iter().flat_map(|(one, other, when)| {
        only(one, other)
            .into_iter()
            .map(move |id| format!("the requirement {id} is only there {when}, or with another formula"))
    });
    fixed.chain(one_sided).collect()
}

/// Returns the points of two campaigns that ran the same grid of Euro NCAP.
fn points(first: &Log, second: &Log) -> Option<[Points; 2]> {
    let both = [Points::of(first)?, Points::of(second)?];
    (both[0].grid == both[1].grid && both.iter().all(|points| points.points.is_some())).then_some(both)
}

fn in_words<S: serde::Serializer>(verdicts: &[Verdict; 2], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(verdicts.iter().map(ToString::to_string))
}

/// Returns a text that is the same for tests with the same values.
fn key(trial: &Trial) -> String {
    let values: BTreeMap<&str, String> = trial.test.iter().map(|(name, value)| (name, value.to_string())).collect();
    format!("{values:?}")
}

fn same_parameters(first: &Log, second: &Log) -> Result<(), DifferenceFlaw> {
    let names = |log: &Log| -> Vec<String> {
        log.study().space().parameters().iter().map(|parameter| parameter.name.clone()).collect()
    };
    let [ours, theirs] = [first, second].map(names);
    for (has, lacks, these, others) in
        [(Which::First, Which::Second, &ours, &theirs), (Which::Second, Which::First, &theirs, &ours)]
    {
        if let Some(name) = these.iter().find(|name| !others.contains(name)) {
            let scenario = |log: &Log| log.study().subject().scenario().ok().map(|found| found.scenario().to_owned());
            if let (Some(first), Some(second)) = (scenario(first), scenario(second))
                && first != second
            {
                return Err(DifferenceFlaw::Scenarios { first, second });
            }
            let nearest = nearest(name, others.iter().map(String::as_str)).map(str::to_owned);
            return Err(DifferenceFlaw::Parameter { name: name.clone(), has, lacks, nearest });
        }
    }
    Ok(())
}

/// Counts the failure modes of some failing tests of a campaign.
fn modes(log: &Log, tests: impl Iterator<Item = usize>) -> Vec<ModeCount> {
    let tests: Vec<usize> = tests.collect();
    let all = Modes::of(log).modes.into_iter();
    let counts = all.map(|mode| {
        let tests = tests.iter().copied().filter(|index| mode.trials.contains(index)).collect();
        ModeCount { name: mode.name, words: mode.words, tests, of: mode.trials.len() }
    });
    let mut counts: Vec<ModeCount> = counts.filter(|mode| !mode.tests.is_empty()).collect();
    // A stable sort: modes with as many tests keep their order.
    counts.sort_by_key(|mode| std::cmp::Reverse(mode.tests.len()));
    counts
}

/// The share of a margin up to which a change is rounding.
const ROUNDING: f64 = 1e-9;

/// Returns the change of a margin; 0 if the change is rounding.
fn change(before: f64, after: f64) -> f64 {
    let change = after - before;
    if change.abs() <= ROUNDING * before.abs().max(after.abs()).max(1.0) { 0.0 } else { change }
}

/// Returns the changes of the margins for each requirement that both campaigns judge.
fn margins(study: &Study, pairs: &[[&Trial; 2]]) -> Vec<MarginChange> {
    let unit = |id: &str| study.requirement(id).map(|requirement| requirement.unit.clone()).unwrap_or_default();
    let mut ids: Vec<&str> = Vec::new();
    for id in pairs.iter().flat_map(|[trial, _]| trial.requirements()) {
        if !ids.contains(&id) {
            ids.push(id);
        }
    }
    let of = |id: &str| {
        let finite = |trial: &Trial| trial.robustness(id).filter(|margin| margin.is_finite());
        let changes = pairs.iter().filter_map(|[a, b]| Some((change(finite(a)?, finite(b)?), b.index)));
        let mut changes: Vec<(f64, usize)> = changes.collect();
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sorted: Vec<f64> = changes.iter().map(|(change, _)| *change).collect();
        let count = |is: fn(f64) -> bool| sorted.iter().filter(|change| is(**change)).count();
        (!sorted.is_empty()).then(|| MarginChange {
            requirement: id.to_owned(),
            unit: unit(id),
            pairs: sorted.len(),
            smaller: count(|change| change < 0.0),
            same: count(|change| change == 0.0),
            larger: count(|change| change > 0.0),
            median: quantile(&sorted, 0.5),
            worst: changes
                .first()
                .map(|(change, index)| Loss { index: *index, change: *change })
                .filter(|loss| loss.change < 0.0),
        })
    };
    ids.into_iter().filter_map(of).collect()
}
