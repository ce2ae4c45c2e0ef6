//! Positions, headings and speeds of all entities in concrete scenarios of others, against esmini's.

use super::others::{files_of_others, with_ending};
use super::worlds::led;
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
    let outcome = led(&program).map_err(|error| error.to_string())?;
    let Some(trace) = outcome.trace else { return Err(format!("{:?}", outcome.ending)) };
    let text = std::fs::read_to_string(folder.join("golden").join(format!("{name}.csv"))).unwrap();
    let mut greatest = Difference::default();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |index: usize| cells[index].parse::<f64>().unwrap();
        let tick = (number(0) / 0.01).round() as usize;
        let of = |signal: &str| trace.signal(&format!("{}.{signal}", cells[1]))?.nth(tick);
        let [Some(x), Some(y), Some(heading), Some(speed)] = ["x", "y", "heading", "speed"].map(of) else { continue };
        let metres = libm::hypot(x - number(2), y - number(3));
        if metres > greatest.metres {
            (greatest.metres, greatest.at) = (metres, number(0));
        }
        greatest.heading = greatest.heading.max(libm::sin(heading - number(4)).abs());
        greatest.speed = greatest.speed.max((speed - number(5)).abs());
        greatest.samples += 1;
    }
    Ok(greatest)
}

/// The greatest differences in heading (rad) and in speed (m/s).
const HEADING: f64 = 0.01;
const SPEED: f64 = 0.02;

/// The greatest distances in metres, by the beginnings of names. In 4.4_1 a trigger comes one tick later than in esmini, because
/// esmini rounds the values of expressions: 2 m/s to the side are 0.02 m.
const DISTANCES: [(&str, f64); 15] = [
    ("alks__alks_scenario_4_1_1", 0.02),
    ("alks__alks_scenario_4_1_2", 0.02),
    ("alks__alks_scenario_4_2_1", 0.02),
    ("alks__alks_scenario_4_2_3", 0.02),
    ("alks__alks_scenario_4_3_1", 0.02),
    ("alks__alks_scenario_4_4_1", 0.0201),
    ("alks__alks_scenario_4_5_1", 0.02),
    ("alks__alks_scenario_4_6_1", 0.02),
    ("ncap__AEB_C2C_2023__NCAP_AEB_C2C_CCFhos", 0.05),
    ("ncap__AEB_C2C_2023__NCAP_AEB_C2C_CCR_", 0.05),
    ("ncap__AEB_VRU_2023__NCAP_AEB_VRU_CBLA", 0.05),
    ("ncap__AEB_VRU_2023__NCAP_AEB_VRU_CPN", 0.1),
    ("esmini__slow-lead-vehicle", 0.1),
    ("esmini__straight_500m", 0.1),
    ("esmini__left-hand-traffic", 0.1),
];

/// The scenarios that are refused, or differ by more than 0.1 m, as docs/openscenario.md says.
const MISSES: [&str; 15] = [
    "esmini__cut-in",
    "esmini__cut-in_simple",
    "esmini__distance_test",
    "esmini__highway_merge",
    "esmini__lane_change",
    "esmini__lane_change_simple",
    "esmini__ltap-od",
    "esmini__pedestrian",
    "esmini__speed-profile",
    "esmini__synchronize",
    "esmini__trajectory-test",
    "esmini__two_plus_one_road",
    "ncap__AEB_C2C_2023__NCAP_AEB_C2C_CCFhol_2023",
    "ncap__AEB_C2C_2023__NCAP_AEB_C2C_CCFtap_2023",
    "ncap__AEB_VRU_2023__NCAP_AEB_VRU_CBNA_2023",
];

#[test]
fn entities_move_as_in_esmini() {
    let Some(folder) = files_of_others() else { return };
    for file in with_ending(&folder.join("golden"), "csv") {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let found = compared(&folder, &name);
        let Some((_, most)) = DISTANCES.iter().find(|(beginning, _)| name.starts_with(beginning)) else {
            assert!(MISSES.contains(&name.as_str()), "{name}: {found:?} is not in a list");
            assert!(found.is_err() || found.is_ok_and(|found| found.metres > 0.1), "{name} misses no longer");
            continue;
        };
        let found = found.unwrap_or_else(|error| panic!("{name}: {error}"));
        // The standard leaves the speed of a synchronized entity open on its way.
        let speed = if name.contains("CPN") { 0.05 } else { SPEED };
        assert!(found.metres <= *most, "{name}: {found:?}");
        assert!(found.heading <= HEADING && found.speed <= speed, "{name}: {found:?}");
        assert!(found.samples >= 100, "{name}: {found:?}");
    }
}
