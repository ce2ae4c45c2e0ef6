//! Finds the failure modes of a campaign: groups failing tests by what went wrong, not by their place in the space.
//!
//! Two failures are of the same mode if they violate the same requirements by the same part of their formulas, and
//! the car touched the same object with the same side during the same motion (driving, braking or standing). Figures
//! distinguish failures further: the critical time, the distance that the car had travelled by then, and its speed.
//! If a figure leaves a gap, the mode is divided into two.

mod gap;
#[cfg(test)]
mod tests;
mod words;

use gap::{Figure, Group};
use paracosm_campaign::{JsonArtefact, Log, Trial};
use paracosm_engine::object::Class;
use paracosm_engine::{Contact, ContactMotion, Face, Violation};
use paracosm_space::{Record, Value};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt::Display;

/// A number that describes a violation; a gap between its values divides a failure mode into two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum CriticalFigure {
    /// The time of the violation, in seconds.
    #[serde(rename = "critical_time")]
    Time,
    /// The distance that the car had travelled at the time of the violation, in metres.
    #[serde(rename = "critical_travelled")]
    Travelled,
    /// The speed of the car at the time of the violation, in m/s.
    #[serde(rename = "critical_speed")]
    Speed,
}

impl CriticalFigure {
    const ALL: [Self; 3] = [Self::Time, Self::Travelled, Self::Speed];

    fn of(self, violation: &Violation) -> Option<f64> {
        match self {
            Self::Time => Some(violation.time),
            Self::Travelled => violation.travelled,
            Self::Speed => violation.speed,
        }
    }

    /// Returns the difference up to which two values of the figure count as equal.
    const fn resolution(self) -> f64 {
        match self {
            Self::Time => 0.5,
            Self::Travelled => 2.0,
            Self::Speed => 1.0,
        }
    }
}

/// The failure modes of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Modes {
    /// The number of failing tests of the campaign.
    pub failures: usize,
    /// The failure modes of the campaign, the most frequent mode first.
    pub modes: Vec<Mode>,
}

/// A failure mode, which is a group of failing tests with the same kind of failure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mode {
    /// The name of the mode in a few words, such as `no-collision/pedestrian/left/braking`. It ends in `#1`, `#2` …
    /// if parts of formulas or figures divide the mode further.
    pub name: String,
    /// A sentence that describes the failures of the mode.
    pub words: String,
    /// The number of failing tests of this mode.
    pub count: usize,
    /// The index of a typical test, whose figures are nearest to the medians of the mode.
    pub representative: usize,
    /// The index of the test with the worst robustness in the mode.
    pub worst: usize,
    /// The ids of the requirements that the tests of the mode violate.
    pub violates: Vec<String>,
    /// The part of each violated formula on which the robustness depends, if the part is known, by the requirement's
    /// id.
    pub parts: Record<String>,
    /// The contact of the car with an object; `None` if the car touched no object.
    pub contact: Option<Touch>,
    /// The least and the greatest speed of the ego vehicle at the contact, in m/s; `None` if the car touched no object.
    pub impact_speed: Option<[f64; 2]>,
    /// The least and the greatest value of each figure that all tests of the mode have.
    pub figures: BTreeMap<CriticalFigure, [f64; 2]>,
    /// The values of each parameter among the tests of the mode, as the least and the greatest value or as a list of
    /// levels.
    pub parameters: Record<ValueRange>,
    /// The indices of the failing tests of the mode.
    pub trials: Vec<usize>,
}

/// A contact of the ego vehicle with an object.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Touch {
    /// The name of the object that the car touched.
    pub with: String,
    /// The class of the object that the car touched.
    #[serde(serialize_with = "in_a_word")]
    pub class: Class,
    /// The side of the car that touched the object.
    #[serde(serialize_with = "in_a_word")]
    pub face: Face,
    /// The motion of the car at the contact (driving, braking or standing).
    #[serde(serialize_with = "in_a_word")]
    pub motion: ContactMotion,
}

fn in_a_word<S: Serializer>(value: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

/// The range of the values that a parameter has in a group of tests.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ValueRange {
    /// The least and the greatest value of a continuous parameter.
    Interval([f64; 2]),
    /// All values of a discrete parameter that occur, in the order of the parameter's levels.
    Values(Vec<Value>),
}

impl JsonArtefact for Modes {
    const FILE: &'static str = "modes.json";
}

impl Modes {
    /// Groups the failing trials of a campaign by failure modes.
    pub fn of(log: &Log) -> Self {
        let failing: Vec<&Trial> = log.trials().iter().filter(|trial| trial.is_failure()).collect();
        let mut kinds: BTreeMap<Kind, Vec<&Trial>> = BTreeMap::new();
        for trial in &failing {
            let violates = trial.violated().map(str::to_owned).collect();
            kinds.entry((violates, Touch::of(trial))).or_default().push(trial);
        }
        let mut modes: Vec<Mode> = kinds.iter().flat_map(|(kind, trials)| divided(log, kind, trials)).collect();
        modes.sort_by_key(|mode| (std::cmp::Reverse(mode.count), mode.trials[0]));
        words::tell_apart(&mut modes);
        Self { failures: failing.len(), modes }
    }
}

impl Touch {
    /// Returns the contact with which a trial ended; `None` if the car touched no object.
    pub fn of(trial: &Trial) -> Option<Self> {
        let Contact { with, class, face, motion, .. } = trial.contact()?.clone();
        Some(Self { with, class, face, motion })
    }
}

/// The properties that the failures of a kind share: the violated requirements, and the contact.
type Kind = (Vec<String>, Option<Touch>);

/// Divides the trials of one kind into modes.
fn divided(log: &Log, kind: &Kind, trials: &[&Trial]) -> Vec<Mode> {
    let mut by_parts: BTreeMap<Vec<Option<&str>>, Vec<&Trial>> = BTreeMap::new();
    for trial in trials {
        let parts = kind.0.iter().map(|id| Some(trial.violation(id)?.part.as_str())).collect();
        by_parts.entry(parts).or_default().push(trial);
    }
    let is_told_by_part = by_parts.len() > 1;
    let modes = by_parts.iter().flat_map(|(parts, trials)| of_parts(log, kind, parts, is_told_by_part, trials));
    let mut modes: Vec<Mode> = modes.collect();
    modes.sort_by_key(|mode| mode.trials[0]);
    if modes.len() > 1 {
        modes.iter_mut().enumerate().for_each(|(i, mode)| mode.name.push_str(&format!("#{}", i + 1)));
    }
    modes
}

/// Divides trials with the same requirements, contact and parts of formulas into modes by their figures.
fn of_parts(
    log: &Log,
    (violates, contact): &Kind,
    parts: &[Option<&str>],
    is_told_by_part: bool,
    trials: &[&Trial],
) -> Vec<Mode> {
    let figures = figures(violates, trials);
    let known: Vec<Figure> =
        figures.iter().map(|(figure, values)| Figure { values, resolution: figure.resolution() }).collect();
    let name = [Some(violates.join("+")), contact.as_ref().map(Touch::name)];
    let name = name.into_iter().flatten().collect::<Vec<_>>().join("/");
    let parts: Vec<(&str, &str)> =
        violates.iter().zip(parts).filter_map(|(id, part)| Some((id.as_str(), (*part)?))).collect();
    let mode = |Group { members, set_apart_by }: Group| {
        let all: Vec<&Trial> = members.iter().map(|member| trials[*member]).collect();
        let ranges: BTreeMap<CriticalFigure, [f64; 2]> = figures
            .iter()
            .map(|(figure, values)| (*figure, range(members.iter().map(|member| values[*member]))))
            .collect();
        let typical = typical(log, trials, &members, &known);
        let apart: Vec<CriticalFigure> = set_apart_by.iter().map(|figure| figures[*figure].0).collect();
        let story = words::Story { violates, parts: &parts, is_told_by_part, ranges: &ranges, apart: &apart };
        Mode {
            name: name.clone(),
            words: story.words(contact.as_ref(), trials[typical]),
            count: members.len(),
            representative: trials[typical].index,
            worst: all.iter().min_by(|a, b| severity(log, a).total_cmp(&severity(log, b))).map_or(0, |t| t.index),
            violates: violates.clone(),
            parts: parts.iter().map(|(id, part)| ((*id).to_owned(), (*part).to_owned())).collect(),
            contact: contact.clone(),
            impact_speed: contact.as_ref().map(|_| range(all.iter().filter_map(|t| Some(t.contact()?.speed)))),
            figures: ranges,
            parameters: extents(log, &all),
            trials: all.iter().map(|trial| trial.index).collect(),
        }
    };
    gap::groups(trials.len(), &known).into_iter().map(mode).collect()
}

impl Touch {
    fn name(&self) -> String {
        format!("{}/{}/{}", self.with, self.face, self.motion)
    }
}

/// Returns the figures that all trials have, for each trial at the requirement that it violated first.
fn figures(violates: &[String], trials: &[&Trial]) -> Vec<(CriticalFigure, Vec<f64>)> {
    let time = |trial: &Trial, id: &str| trial.violation(id).map_or(f64::INFINITY, |violation| violation.time);
    let first = |trial: &Trial| violates.iter().min_by(|a, b| time(trial, a).total_cmp(&time(trial, b)));
    let all = CriticalFigure::ALL.into_iter().filter_map(|figure| {
        let value = |trial: &&Trial| figure.of(trial.violation(first(trial)?)?).filter(|value| value.is_finite());
        Some((figure, trials.iter().map(value).collect::<Option<Vec<f64>>>()?))
    });
    all.collect()
}

/// Returns the trial that is nearest to the medians of the figures. The distance is that of the figure with the
/// greatest difference, in shares of its range. Of equally near trials, the worst is chosen.
fn typical(log: &Log, trials: &[&Trial], members: &[usize], figures: &[Figure]) -> usize {
    let scales: Vec<(f64, f64)> = figures
        .iter()
        .map(|figure| {
            let mut values: Vec<f64> = members.iter().map(|member| figure.values[*member]).collect();
            values.sort_by(f64::total_cmp);
            (values[values.len() / 2], (values[values.len() - 1] - values[0]).max(figure.resolution))
        })
        .collect();
    let off = |member: usize| {
        let off =
            figures.iter().zip(&scales).map(|(figure, (median, range))| (figure.values[member] - median).abs() / range);
        off.fold(0.0, f64::max)
    };
    let rank = |a: &usize, b: &usize| {
        off(*a).total_cmp(&off(*b)).then(severity(log, trials[*a]).total_cmp(&severity(log, trials[*b])))
    };
    members.iter().copied().min_by(rank).expect("a mode has a test")
}

/// Returns the worst robustness of a trial in multiples of its scale. A lower value is worse.
fn severity(log: &Log, trial: &Trial) -> f64 {
    log.scales().worst(trial).map_or(0.0, |(_, robustness)| robustness)
}

/// Returns the least and the greatest value.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
}

/// Returns the place of some trials in the space.
fn extents(log: &Log, trials: &[&Trial]) -> Record<ValueRange> {
    let extent = |name: &str, levels: Option<&[Value]>| {
        let scalars = trials.iter().filter_map(|trial| trial.test.get(name)).flat_map(Value::scalars);
        match levels {
            None => ValueRange::Interval(range(scalars.filter_map(Value::number))),
            Some(levels) => {
                let there: Vec<&Value> = scalars.collect();
                ValueRange::Values(levels.iter().filter(|level| there.contains(level)).cloned().collect())
            }
        }
    };
    let parameters = log.study().space().parameters().iter();
    parameters.map(|parameter| (parameter.name.clone(), extent(&parameter.name, parameter.levels()))).collect()
}
