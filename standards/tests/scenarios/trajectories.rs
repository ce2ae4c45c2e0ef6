//! Exported trajectories of scenarios of files: read back, all entities have the recorded signals.

use super::others::{files_of_others, with_ending};
use super::worlds::{file, led};
use paracosm_engine::driver::find;
use paracosm_engine::{Motion, Pose, Program, Run, Setup};
use paracosm_oracles::Trace;
use paracosm_space::Values;
use paracosm_standards::opendrive::Map;
use paracosm_standards::openscenario::{EgoAs, Export, Original, Xosc};
use std::fs;
use std::path::{Path, PathBuf};

/// The greatest differences of an entity at any sample: in metres, in radians, and in m/s.
#[derive(Debug, Default, Clone, Copy)]
struct Difference {
    metres: f64,
    heading: f64,
    speed: f64,
}

/// The greatest allowed differences.
const METRES: f64 = 0.005;
const HEADING: f64 = 0.01;
const SPEED: f64 = 0.02;
/// A car that brakes at 8 m/s² has a mean speed within a tick that differs by 0.04 m/s from its speed at the end of the tick. A
/// trajectory gives places, and so mean speeds.
const DRIVEN_SPEED: f64 = 0.041;
/// The driver that leaves the car to the scenario.
const LED: &str = "default";

/// Runs a test with a driver, and records the motion; `None` if the test does not run to its end.
fn recorded(program: &Program, test: &Values, driver: &str) -> Option<(Trace, Motion)> {
    let descriptor = find(driver).unwrap();
    let mut driver = (descriptor.make)(&descriptor.settings(&[]).unwrap());
    let setup = Setup { takes_over: driver.takes_over(), ..Setup::asking_every(driver.period()) };
    let mut run = Run::new(program, test, setup).ok()?;
    run.record_motion();
    let trace = run.drive(driver.as_mut()).trace?;
    Some((trace, run.motion()?.clone()))
}

/// Exports a test of a scenario as trajectories, reads it back, and compares the signals. `None` if the test does not run.
fn compared(path: &Path, driver: &str) -> Option<Difference> {
    let read = || Xosc::read(path).unwrap_or_else(|error| panic!("{error}"));
    let program = read().program();
    let test = program.declare().unwrap().nominal();
    let (before, motion) = recorded(&program, &test, driver)?;
    let roads = read().concrete(&test, "roads.xodr").unwrap().roads;
    let originals = read().originals(&test).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let [case, road] = ["case.xosc", "roads.xodr"].map(|name| folder.path().join(name));
    let map = Map::parse(&road, roads.to_string()).unwrap();
    let (about, date) = ("a test", "2026-01-01T00:00:00");
    let export = Export {
        about,
        date,
        roads: "roads.xodr",
        map: &map,
        motion: &motion,
        originals: &originals,
        ego: EgoAs::Trajectory,
    };
    fs::write(&road, &*roads).unwrap();
    let text = export.text();
    // Only the newest version knows vehicles without a front axle.
    let has_fronts = text.matches("<Axles>").count() == text.matches("<FrontAxle ").count();
    assert!(text.contains(if has_fronts { "revMinor=\"2\"" } else { "revMinor=\"3\"" }), "{}", path.display());
    fs::write(&case, text).unwrap();
    let program = Xosc::read(&case).unwrap_or_else(|error| panic!("{error}")).program();
    let after = led(&program).unwrap_or_else(|error| panic!("{error}")).trace.unwrap();
    let mut greatest = Difference::default();
    // An entity that is never in the world is left out.
    let there = |poses: &[Option<Pose>]| poses.iter().any(Option::is_some);
    let entities = originals.iter().map(Original::name).zip(&motion.tracks);
    for (name, track) in entities.filter(|(_, track)| there(&track.poses)) {
        let of = |trace: &Trace, signal: &str| -> Vec<f64> {
            let signal = format!("{name}.{signal}");
            trace.signal(&signal).unwrap_or_else(|| panic!("no {signal}")).collect()
        };
        let [one, other] =
            [&before, &after].map(|trace| ["x", "y", "heading", "speed"].map(|signal| of(trace, signal)));
        assert!(other[0].len() + 1 >= one[0].len(), "{name}: it ends early");
        let last = one[0].len().min(other[0].len());
        for tick in (0..last).filter(|tick| track.poses.get(*tick).is_some_and(Option::is_some)) {
            let apart = |signal: usize| one[signal][tick] - other[signal][tick];
            greatest.metres = greatest.metres.max(libm::hypot(apart(0), apart(1)));
            greatest.heading = greatest.heading.max(libm::sin(apart(2)).abs());
            greatest.speed = greatest.speed.max(apart(3).abs());
        }
    }
    Some(greatest)
}

/// Checks the exports of scenarios, each with a driver. Returns the number of scenarios whose tests run.
fn check(scenarios: impl IntoIterator<Item = PathBuf>, driver: &str) -> usize {
    let mut count = 0;
    for path in scenarios {
        // Catalogs are no scenarios, and some files of esmini have elements that are refused.
        if Xosc::read(&path).map_or(true, |scenario| scenario.program().declare().is_err()) {
            continue;
        }
        let Some(found) = compared(&path, driver) else { continue };
        let most = if driver == LED { SPEED } else { DRIVEN_SPEED };
        // In this file, a pedestrian turns round within a tick.
        let turns = path.ends_with("actions.xosc");
        let is_close = found.metres <= METRES && found.heading <= HEADING && (found.speed <= most || turns);
        assert!(is_close, "{} {driver}: {found:?}", path.display());
        count += 1;
    }
    count
}

#[test]
fn entities_of_our_files_have_the_recorded_signals_in_an_export() {
    let files = ["slow-leader.xosc", "actions.xosc", "everything.xosc", "routes.xosc", "weather.xosc"];
    for driver in [LED, "aeb", "cruise"] {
        assert_eq!(check(files.map(file), driver), files.len(), "{driver}");
    }
}

#[test]
fn entities_of_files_of_others_have_the_recorded_signals_in_an_export() {
    let Some(folder) = files_of_others() else { return };
    let [alks, ncap] = ["alks/logical_scenarios/concrete_scenarios", "ncap/OpenSCENARIO/NCAP"];
    for (suite, driver, least) in [(alks, LED, 8), (alks, "aeb", 8), (ncap, LED, 30)] {
        let count = check(with_ending(&folder.join(suite), "xosc"), driver);
        assert!(count >= least, "{suite} {driver}: {count} scenarios");
    }
}
