//! The paper's Figure 9: a network that was taught to stop for pedestrians of 1 m/s meets faster and slower
//! pedestrians.
//!
//! This is the study of [`fig9`](crate::fig9) with the network as the driver, at 30 km/h and with shorter tests
//! ([`crossing`](crate::crossing)). Its reference map still takes long, so that another command makes the map, which
//! comes with the software. That command also makes the maps of drivers without cameras, which show what no driver can
//! do.

use crate::cloning::{STOP, driven};
use crate::recovery::Mark;
use crate::sampling::{Comparison, grid, reference_map};
use crate::{Done, crossing, print, write};
use indicatif::ProgressBar;
use paracosm::space::{Value, Values};
use paracosm::{Study, Trial};
use std::path::Path;

const SIZES: [usize; 3] = [25, 50, 100];
const SEEDS: u64 = 8;
/// The number of tests on each side of the map.
const SIDE: usize = 50;
/// The other drivers with maps: the expert who taught the network, an emergency brake, and a driver that never brakes.
const OTHERS: [&str; 3] = ["expert", "aeb", "cruise"];
const MAP: &str = include_str!("../data/fig9-cnn-reference.csv");

fn study() -> Result<Study, paracosm::Error> {
    driven(Study::of(crossing::PROGRAM), STOP.network()).build()
}

/// Makes the reference map and the maps of the other drivers, and writes them to a folder.
pub fn reference(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length((SIDE * SIDE * (1 + OTHERS.len())) as u64);
    let map = reference_map(&study()?, SIDE, out, "fig9-cnn", bar)?;
    let failing = |trials: &[Trial]| trials.iter().map(Trial::is_failure).collect::<Vec<bool>>();
    let network = failing(&map);
    let total = |fails: &[bool]| fails.iter().filter(|fails| **fails).count();
    let mut text = format!("of {} tests fail\n  {:<10}{:>6}\n", map.len(), "the network", total(&network));
    let mut columns = Vec::new();
    for name in OTHERS {
        let other = failing(&grid(&Study::of(crossing::PROGRAM).driver(name).build()?, SIDE, bar)?);
        let both: Vec<bool> = other.iter().zip(&network).map(|(one, other)| *one && *other).collect();
        text += &format!("  {name:<10}{:>6}, and both {:>5}\n", total(&other), total(&both));
        columns.push(other);
    }
    bar.finish_and_clear();
    let mut rows = vec![format!("speed,distance,{}", OTHERS.join(","))];
    rows.extend(map.iter().enumerate().map(|(i, trial)| {
        let values = trial.test.iter().map(|(_, value)| value.to_string());
        values.chain(columns.iter().map(|fails| fails[i].to_string())).collect::<Vec<_>>().join(",")
    }));
    write(&out.join("fig9-cnn-drivers.csv"), rows.join("\n") + "\n")?;
    print(&text)
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let study = study()?;
    let map = shipped(&study)?;
    let comparison = Comparison { study: &study, sizes: &SIZES, seeds: SEEDS, map: &map };
    bar.set_length(comparison.tests() as u64);
    bar.set_position(0);
    comparison.run(out, "fig9-cnn", bar)
}

/// Returns the reference map that comes with the software, in the unit square.
fn shipped(study: &Study) -> Result<Vec<Mark>, Box<dyn std::error::Error + Send + Sync>> {
    let mut csv = csv::Reader::from_reader(MAP.as_bytes());
    let names = csv.headers()?.clone();
    let mark = |row: csv::StringRecord| {
        let cell = |name: &str| names.iter().position(|other| other == name).and_then(|column| row.get(column));
        let number = |name: &str| Some(Value::Number(cell(name)?.parse().ok()?));
        let test: Option<Values> =
            ["speed", "distance"].into_iter().map(|name| Some((name.to_owned(), number(name)?))).collect();
        let test = test.ok_or("the reference map has a row without a test")?;
        let point = study.space().encode(&test)?.continuous;
        Ok(([point[0], point[1]], cell("verdict") == Some("fail")))
    };
    csv.records().map(|row| mark(row?)).collect()
}
