//! Looks at the failures of Figure 9 with a network that a driver who never brakes would not have had: one by one, when the walker comes into
//! the way, and when each car is there.

use crate::cloning::{STOP, driven};
use crate::figures::table::Table;
use crate::sampling::write_csv;
use crate::{Done, crossing, print};
use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::campaign::Worker;
use paracosm::oracles::Trace;
use paracosm::space::{Value, Values};
use std::path::Path;

const MAP: &[u8] = include_bytes!("../data/fig9-cnn-reference.csv");
const OTHERS: &[u8] = include_bytes!("../data/fig9-cnn-drivers.csv");

/// The walker is in the way of a car whose middle is not further away than this to the side, in metres.
const BESIDE: f64 = 1.2;
/// A car has passed the walker when its middle is this far beyond the walker, in metres.
const PASSED: f64 = 2.5;
/// A car that has lost this much speed brakes, in m/s.
const LOST: f64 = 0.5;

/// The test, times with `cruise`, and times and the speed at the end with the network.
const COLUMNS: [&str; 9] = [
    "speed",
    "distance",
    "cruise_passes_s",
    "cruise_walker_in_the_way_s",
    "network_brakes_s",
    "network_walker_sets_out_s",
    "network_walker_in_the_way_s",
    "collision_s",
    "collision_m_per_s",
];

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let network = driven(Study::of(crossing::PROGRAM), STOP.network()).build()?;
    let cruise = Study::of(crossing::PROGRAM).driver("cruise").build()?;
    let (mut network, mut cruise) = (Worker::new(&network)?, Worker::new(&cruise)?);
    let tests = tests()?;
    bar.set_length(tests.len() as u64);
    let mut rows = vec![COLUMNS.map(str::to_owned).to_vec()];
    for [speed, distance] in tests {
        let value = |name: &str, value: f64| (name.to_owned(), Value::Number(value));
        let test: Values = [value("speed", speed), value("distance", distance)].into_iter().collect();
        let (_, going_on) = cruise.run(0, &test);
        let (trial, braking) = network.run(0, &test);
        let [going_on, braking] = [going_on, braking].map(|trace| trace.ok_or("a test without a trace"));
        let (going_on, braking) = (going_on?, braking?);
        let own = signal(&braking, "car.speed");
        let begun = own.first().copied().unwrap_or_default();
        let walking = signal(&braking, "pedestrian.speed");
        let times = [
            first(&going_on, |tick| apart(&going_on, "x", tick) < -PASSED),
            first(&going_on, |tick| apart(&going_on, "y", tick).abs() < BESIDE),
            first(&braking, |tick| own[tick] < begun - LOST),
            first(&braking, |tick| walking[tick] > 0.0),
            first(&braking, |tick| apart(&braking, "y", tick).abs() < BESIDE),
            trial.ticks as f64 * braking.dt(),
        ];
        let numbers = [speed, distance].into_iter().chain(times).chain(own.last().copied());
        rows.push(numbers.map(|number| format!("{number:.2}")).collect());
        bar.inc(1);
    }
    bar.finish_and_clear();
    write_csv(&out.join("fig9-cnn-braked.csv"), &rows)?;
    print(&rows.iter().map(|row| row.join(",") + "\n").collect::<String>())
}

/// Returns the speed and the distance of the tests that fail with the network and not with `cruise`.
fn tests() -> Result<Vec<[f64; 2]>, csv::Error> {
    let (own, others) = (Table::read(MAP)?, Table::read(OTHERS)?);
    let both = own.rows().zip(others.rows());
    let only_braking = both.filter(|(own, other)| own.word("verdict") == "fail" && other.word("cruise") == "false");
    Ok(only_braking.map(|(own, _)| ["speed", "distance"].map(|column| own.number(column))).collect())
}

fn signal(trace: &Trace, name: &str) -> Vec<f64> {
    trace.signal(name).into_iter().flatten().collect()
}

/// The distance from the car to the walker along an axis.
fn apart(trace: &Trace, axis: &str, tick: usize) -> f64 {
    let at =
        |who: &str| trace.signal(&format!("{who}.{axis}")).and_then(|mut values| values.nth(tick)).unwrap_or(f64::NAN);
    at("pedestrian") - at("car")
}

/// Returns the first time at which a condition holds, in seconds; NaN if it never holds.
fn first(trace: &Trace, holds: impl Fn(usize) -> bool) -> f64 {
    let ticks = trace.signal("car.x").map_or(0, Iterator::count);
    (0..ticks).find(|tick| holds(*tick)).map_or(f64::NAN, |tick| tick as f64 * trace.dt())
}
