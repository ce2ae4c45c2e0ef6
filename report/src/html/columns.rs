//! The table of tests of a page: columns of numbers, one after the other.
//!
//! A column of a continuous coordinate or of a robustness has 32-bit floats: they show five digits. The log has the exact values, by the index
//! of the test. If not all tests fit, every k-th of the tests that do not fail is kept, and if that
//! is not enough, every k-th of the failing tests.

use super::Page;
use super::pack::{base64, gzip};
use paracosm_campaign::Trial;
use paracosm_oracles::Verdict;
use paracosm_space::{Coordinate, Value};
use serde::Serialize;

/// The description of the table.
#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct Tests {
    /// The number of tests of the campaign.
    pub all: usize,
    /// The number of tests in the table.
    pub rows: usize,
    /// The columns in their order. Each column has one number for each row.
    pub columns: Vec<Column>,
}

/// A column of the table.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Column {
    /// `index`, `verdict`, `mode`, `impact`, `coordinate` or `robustness`.
    pub of: &'static str,
    /// The name of the coordinate or the id of the requirement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The type of the numbers: `u8`, `u16`, `u32` or `f32`, the least significant byte first.
    pub kind: &'static str,
}

/// The table in the form of the page.
pub(super) struct Packed {
    pub described: Tests,
    pub text: String,
}

/// Packs the tests of a campaign into a text of at most `most` bytes.
pub(super) fn pack(page: &Page, most: usize) -> Packed {
    let trials = page.log.trials();
    // Every k-th of the tests that do not fail, and of the failing tests.
    let mut steps = [1, 1];
    loop {
        let mut counts = [0, 0];
        let rows: Vec<&Trial> = trials
            .iter()
            .filter(|trial| {
                let kind = usize::from(trial.is_failure());
                counts[kind] += 1;
                counts[kind] % steps[kind] == 0
            })
            .collect();
        let packed = packed(page, &rows);
        let Some(kind) = [0, 1].into_iter().find(|kind| steps[*kind] <= trials.len()) else { return packed };
        if packed.text.len() <= most {
            return packed;
        }
        steps[kind] = (2 * steps[kind]).max(steps[kind] * packed.text.len() / most.max(1));
    }
}

fn packed(page: &Page, rows: &[&Trial]) -> Packed {
    let mut bytes = Vec::new();
    let mut columns = Vec::new();
    let mut column = |of: &'static str, name: Option<String>, kind: &'static str, numbers: Vec<u8>| {
        columns.push(Column { of, name, kind });
        bytes.extend(numbers);
    };
    let integers = |of: &dyn Fn(&Trial) -> u32| rows.iter().flat_map(|trial| of(trial).to_le_bytes()).collect();
    let shorts = |of: &dyn Fn(&Trial) -> u16| rows.iter().flat_map(|trial| of(trial).to_le_bytes()).collect();
    let floats = |of: &dyn Fn(&Trial) -> Option<f64>| {
        rows.iter().flat_map(|trial| (of(trial).unwrap_or(f64::NAN) as f32).to_le_bytes()).collect()
    };
    let verdict = |trial: &Trial| Verdict::ALL.iter().position(|verdict| *verdict == trial.verdict).unwrap_or_default();
    let mut modes = vec![0; page.log.trials().len()];
    for (number, mode) in page.modes.modes.iter().enumerate() {
        let number = u16::try_from(number + 1).unwrap_or(u16::MAX);
        for index in &mode.trials {
            modes[*index] = number;
        }
    }
    column("index", None, "u32", integers(&|trial| u32::try_from(trial.index).unwrap_or(u32::MAX)));
    column("verdict", None, "u8", rows.iter().map(|trial| verdict(trial) as u8).collect());
    column("mode", None, "u16", shorts(&|trial| modes[trial.index]));
    column("impact", None, "f32", floats(&|trial| Some(trial.contact()?.speed)));
    for coordinate in page.log.study().space().coordinates() {
        let of = |trial: &Trial| place(trial, &coordinate);
        let name = Some(coordinate.name());
        match coordinate.parameter.levels() {
            None => column("coordinate", name, "f32", floats(&of)),
            Some(_) => {
                column("coordinate", name, "u16", shorts(&|trial| of(trial).map_or(u16::MAX, |level| level as u16)));
            }
        }
    }
    for judged in page.summary.requirements() {
        // A violation may have a robustness of 0: its sign says so.
        let signed = |trial: &Trial| {
            trial.robustness(&judged.id).map(|robustness| match robustness {
                0.0 if trial.violates(&judged.id) => -0.0,
                robustness => robustness,
            })
        };
        column("robustness", Some(judged.id.clone()), "f32", floats(&signed));
    }
    let described = Tests { all: page.log.trials().len(), rows: rows.len(), columns };
    Packed { described, text: base64(&gzip(&bytes)) }
}

/// Returns the value of a continuous coordinate, or the level of a discrete one.
fn place(trial: &Trial, coordinate: &Coordinate) -> Option<f64> {
    let value: &Value = coordinate.value(trial.test.get(&coordinate.parameter.name)?)?;
    match coordinate.parameter.levels() {
        None => value.number(),
        Some(_) => coordinate.parameter.level(value).map(|level| level as f64),
    }
}
