//! Finds what tests have left untried of each parameter: single levels, and tenths of intervals.

use super::Gap;
use paracosm_campaign::{Error, Study, Trial};
use paracosm_space::{Coordinate, Value};
use serde::Serialize;

/// The number of equal parts of an interval, to see which parts have no test.
const PARTS: usize = 10;

/// The untried values of a parameter, or of a coordinate of a signal.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// The name of the parameter, or of the coordinate of a signal.
    pub name: String,
    /// The unit of the parameter's values.
    pub unit: Option<String>,
    /// The parts of a continuous parameter's interval without a test, in whole tenths of the interval.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gaps: Vec<[f64; 2]>,
    /// The levels of a discrete parameter that no test has.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<Value>,
}

impl Tried {
    /// Finds what these trials have left untried of the study's parameters.
    pub(super) fn of(study: &Study, trials: &[&Trial]) -> Result<Vec<Self>, Error> {
        let points = trials.iter().map(|trial| study.space().encode(&trial.test)).collect::<Result<Vec<_>, _>>()?;
        let (mut continuous, mut discrete) = (0, 0);
        let tried = study.space().coordinates().map(|coordinate| {
            let (mut gaps, mut levels) = (Vec::new(), Vec::new());
            match coordinate.parameter.levels() {
                None => {
                    let mut parts = [false; PARTS];
                    for point in &points {
                        parts[((point.continuous[continuous] * PARTS as f64) as usize).min(PARTS - 1)] = true;
                    }
                    gaps = untouched(&coordinate, &parts);
                    continuous += 1;
                }
                Some(all) => {
                    let tried = |level: &usize| points.iter().any(|point| point.discrete[discrete] == *level);
                    levels = (0..all.len()).filter(|level| !tried(level)).map(|level| all[level].clone()).collect();
                    discrete += 1;
                }
            }
            Self { name: coordinate.name(), unit: coordinate.parameter.unit.clone(), gaps, levels }
        });
        Ok(tried.collect())
    }

    /// Returns the untried values in words.
    pub(super) fn untried(&self) -> Vec<Gap> {
        let unit = self.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
        let gaps = self.gaps.iter().map(|[from, to]| format!("no test from {} to {}{unit}", short(*from), short(*to)));
        let levels = self.levels.iter().map(|level| format!("no test with {level}{unit}"));
        gaps.chain(levels).map(|why| Gap { what: self.name.clone(), why }).collect()
    }
}

/// Returns the runs of neighbouring parts without a test, as intervals of the coordinate's values.
fn untouched(coordinate: &Coordinate, parts: &[bool; PARTS]) -> Vec<[f64; 2]> {
    let at = |part: usize| coordinate.parameter.value_at(part as f64 / PARTS as f64);
    let mut gaps = Vec::new();
    let mut from = None;
    for part in 0..=PARTS {
        let free = parts.get(part).is_some_and(|touched| !touched);
        match (free, from) {
            (true, None) => from = Some(part),
            (false, Some(begin)) => {
                gaps.push([at(begin), at(part)]);
                from = None;
            }
            _ => {}
        }
    }
    gaps
}

/// Returns a value in words.
pub(super) fn words(value: &Value) -> String {
    value.number().map_or_else(|| value.to_string(), short)
}

/// Returns a number with at most six decimal places.
fn short(number: f64) -> String {
    let text = format!("{number:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
