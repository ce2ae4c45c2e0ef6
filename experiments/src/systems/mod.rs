//! Benchmarks of falsification tools, as systems that `paracosm-fuzz --system` and the study of searches test.
//!
//! The falsification category of ARCH-COMP, a yearly comparison of tools, has these benchmarks. Each model is written from the published equations
//! and tables. Its module says how it differs from the published model. The file `systems/requirements.toml` has the requirements.

pub mod serve;

mod aircraft;
mod cars;
mod fuel;
mod transmission;

use paracosm::oracles::Trace;
use paracosm::space::{Value, Values};
use thiserror::Error;

/// A system under test.
pub struct System {
    pub name: &'static str,
    pub inputs: &'static [&'static str],
    pub signals: &'static [&'static str],
    /// The sample period of the signals in seconds.
    period: f64,
    run: fn(&[Input], &mut Recorder),
}

/// Takes the signals of each sample in turn, in the order of their names.
type Recorder<'r> = dyn FnMut(&[f64]) + 'r;

/// All systems.
pub const SYSTEMS: &[System] = &[
    System {
        name: "aircraft",
        inputs: &["roll", "pitch", "yaw"],
        signals: &["altitude", "roll", "pitch", "mode"],
        period: aircraft::PERIOD,
        run: aircraft::run,
    },
    System {
        name: "automatic-transmission",
        inputs: &["throttle", "brake"],
        signals: &["speed", "rpm", "gear"],
        period: transmission::PERIOD,
        run: transmission::run,
    },
    System {
        name: "chasing-cars",
        inputs: &["throttle", "brake"],
        signals: &["y1", "y2", "y3", "y4", "y5"],
        period: cars::PERIOD,
        run: cars::run,
    },
    System {
        name: "fuel-control",
        inputs: &["pedal", "engine_speed"],
        signals: &["pedal", "mu", "normal"],
        period: fuel::PERIOD,
        run: fuel::run,
    },
];

impl System {
    /// Runs a test, and returns the trace of its signals.
    ///
    /// # Errors
    /// Returns an error if an input is missing, is empty, or has a value that is not a finite number.
    pub fn trace(&self, test: &Values) -> Result<Trace, InputFlaw> {
        let inputs: Result<Vec<Input>, _> = self.inputs.iter().map(|name| input(test, name)).collect();
        let mut trace = Trace::new(self.period, self.signals.iter().map(|&name| name.to_owned()).collect());
        (self.run)(&inputs?, &mut |row| trace.record(row));
        trace.finish();
        Ok(trace)
    }
}

/// The reason why a system cannot run a test.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InputFlaw {
    /// The test lacks an input.
    #[error("the test has no value for the input `{name}`")]
    Missing { name: &'static str },
    /// An input is neither a number nor a list of numbers.
    #[error("`{name}` is {value}, expected a number or a list of numbers")]
    NoNumbers { name: &'static str, value: Value },
}

fn input(test: &Values, name: &'static str) -> Result<Input, InputFlaw> {
    let value = test.get(name).ok_or(InputFlaw::Missing { name })?;
    let numbers: Option<Vec<f64>> = value.scalars().iter().map(Value::number).collect();
    let numbers = numbers.filter(|numbers| !numbers.is_empty() && numbers.iter().all(|number| number.is_finite()));
    numbers.map(Input::new).ok_or_else(|| InputFlaw::NoNumbers { name, value: value.clone() })
}

/// A signal that is constant over equal parts of a run.
pub struct Input(Vec<f64>);

impl Input {
    /// Makes the signal that has the given values, at least one, in equal parts of a run.
    pub fn new(values: Vec<f64>) -> Self {
        Self(values)
    }

    /// Returns the value at step `step` of `steps`.
    fn at(&self, step: usize, steps: usize) -> f64 {
        self.0[(step * self.0.len() / steps).min(self.0.len() - 1)]
    }
}

/// Advances a state by a step of the classical Runge-Kutta method. `slope` gets the share of the step that has passed, and the state.
fn advance<const N: usize>(from: [f64; N], step: f64, mut slope: impl FnMut(f64, [f64; N]) -> [f64; N]) -> [f64; N] {
    let after = |slope: &[f64; N], time: f64| std::array::from_fn(|i| from[i] + slope[i] * time);
    let a = slope(0.0, from);
    let b = slope(0.5, after(&a, step / 2.0));
    let c = slope(0.5, after(&b, step / 2.0));
    let d = slope(1.0, after(&c, step));
    std::array::from_fn(|i| from[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
}

/// Interpolates a table by straight lines, which go on beyond its ends. `at` ascends.
fn table(at: &[f64], values: &[f64], x: f64) -> f64 {
    let (before, share) = place(at, x);
    values[before] + (values[before + 1] - values[before]) * share
}

/// Interpolates a table of two variables by straight lines. `rows` and `columns` ascend.
fn table2(rows: &[f64], columns: &[f64], value: impl Fn(usize, usize) -> f64, row: f64, column: f64) -> f64 {
    let ((i, down), (j, right)) = (place(rows, row), place(columns, column));
    let along = |i: usize| value(i, j) + (value(i, j + 1) - value(i, j)) * right;
    along(i) + (along(i + 1) - along(i)) * down
}

/// Returns the entry before a value, and the share of the way to the next entry.
fn place(at: &[f64], x: f64) -> (usize, f64) {
    let before = at[1..at.len() - 1].partition_point(|entry| *entry <= x);
    (before, (x - at[before]) / (at[before + 1] - at[before]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm::oracles::Formula;
    use paracosm::space::{Point, Space};
    use serde::Deserialize;

    #[derive(Deserialize)]
    struct Requirements {
        requirement: Vec<Requirement>,
    }

    #[derive(Deserialize)]
    struct Requirement {
        name: String,
        system: String,
        space: String,
        formula: String,
    }

    #[test]
    fn every_requirement_can_be_judged_on_the_trace_of_its_system() {
        let text = include_str!("../../systems/requirements.toml");
        let requirements: Requirements = toml::from_str(text).unwrap();
        assert!(requirements.requirement.len() > 15);
        for Requirement { name, system, space, formula } in requirements.requirement {
            let system = SYSTEMS.iter().find(|known| known.name == system).unwrap();
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("systems");
            let space = Space::from_toml(&std::fs::read_to_string(folder.join(space)).unwrap()).unwrap();
            let point = Point { continuous: vec![0.0; space.dims()], discrete: Vec::new() };
            let trace = system.trace(&space.decode(&point)).unwrap();
            let evaluation = formula.parse::<Formula>().unwrap().evaluate(&trace).unwrap();
            assert!(evaluation.robustness.is_finite(), "{name}: {evaluation:?}");
        }
    }
}
