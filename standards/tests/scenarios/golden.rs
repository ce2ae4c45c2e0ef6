//! Positions, headings and speeds of all entities in concrete scenarios of others, against esmini's.

use super::others::{files_of_others, with_ending};
use paracosm_engine::{Control, Run, Setup, Step};
use paracosm_standards::openscenario::Xosc;
use std::path::{Path, PathBuf};

/// The greatest differences in a scenario.
#[derive(Debug, Default, Clone, Copy)]
struct Difference {
    metres: f64,
    at: f64,
    heading: f64,
    speed: f64,
    samples: usize,
}

/// Returns the file of a scenario with reference trajectories.
fn scenario(folder: &Path, name: &str) -> PathBuf {
    let (suite, path) = name.split_once("__").unwrap();
    let suite = match suite {
        "alks" => "alks/logical_scenarios/concrete_scenarios",
        "ncap" => "ncap/OpenSCENARIO/NCAP",
        _ => "esmini/resources/xosc",
    };
    folder.join(suite).join(format!("{}.xosc", path.replace("__", "/")))
}

/// Runs a scenario with its default controllers and compares it with its reference.
fn compared(folder: &Path, name: &str) -> Result<Difference, String> {
    let program = Xosc::read(&scenario(folder, name)).map_err(|error| error.to_string())?.program();
    let nominal = program.declare().map_err(|error| error.to_string())?.nominal();
    let setup = Setup { takes_over: false, ..Setup::asking_every(0.1) };
    let mut run = Run::new(&program, &nominal, setup).map_err(|error| error.to_string())?;
    let outcome = loop {
        match run.advance() {
            Step::Need(_) => run.supply(Control::default()),
            Step::Done(outcome) => break outcome,
        }
    };
    let Some(trace) = outcome.trace else { return Err(format!("{:?}", outcome.ending)) };
    let text = std::fs::read_to_string(folder.join("golden").join(format!("{name}.csv"))).unwrap();
    let mut greatest = Difference::default();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |index: usize| cells[index].parse::<f64>().unwrap();
        let tick = (number(0) / 0.01).round() as usize;
        let of = |signal: &str| trace.signal(&format!("{}.{signal}", cells[1]))?.nth(tick);
        let [Some(x), Some(y), Some(heading), Some(speed)] = ["x", "y", "heading", "speed"].map(of) else { continue };
        let metres = (x - number(2)).hypot(y - number(3));
        if metres > greatest.metres {
            (greatest.metres, greatest.at) = (metres, number(0));
        }
        greatest.heading = greatest.heading.max((heading - number(4)).sin().abs());
        greatest.speed = greatest.speed.max((speed - number(5)).abs());
        greatest.samples += 1;
    }
    Ok(greatest)
}

#[test]
fn entities_move_as_in_esmini() {
    let Some(folder) = files_of_others() else { return };
    let files = with_ending(&folder.join("golden"), "csv");
    let names = files.iter().map(|file| file.file_stem().unwrap().to_string_lossy().into_owned());
    for name in names {
        match compared(&folder, &name) {
            Ok(found) => println!(
                "{name}: {:.4} m at {:.1} s, {:.4} rad, {:.4} m/s, {} samples",
                found.metres, found.at, found.heading, found.speed, found.samples
            ),
            Err(error) => println!("{name}: {error}"),
        }
    }
}
