//! Points of Euro NCAP: only for a whole grid of the protocol, and as many as the rating calculator of Euro NCAP gives.

use crate::common::{fuzz, stdout, succeeds};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

const SCENARIOS: [&str; 4] = ["ncap-ccr", "ncap-cpna", "ncap-cpfa", "ncap-cpnco"];

/// The options of a campaign on the whole grid of a scenario, as `describe` says them.
fn options(dir: &Path, scenario: &str) -> Vec<String> {
    let described = stdout(&succeeds(fuzz(dir, &["describe", scenario, "--format", "json"])));
    let described: Value = serde_json::from_str(&described).unwrap();
    described["points"]["options"].as_str().unwrap().split(' ').map(str::to_owned).collect()
}

/// What a campaign prints, as JSON.
fn campaign(dir: &Path, scenario: &str, driver: &str, options: &[&str]) -> Value {
    let out = format!("{scenario}-{driver}");
    let arguments = [&[scenario, "--driver", driver, "--out", &out, "-q", "--format", "json"], options].concat();
    serde_json::from_str(&stdout(&succeeds(fuzz(dir, &arguments)))).unwrap()
}

/// The impact speeds of a campaign in km/h, each with the speed of the car and the place of the impact on the car in percent.
fn impacts(folder: &Path) -> Value {
    let log = fs::read_to_string(folder.join("trials.jsonl")).unwrap();
    let trials = log
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|trial| trial["test"].is_object());
    let entry = |trial: Value| {
        let number = |name: &str| trial["test"][name].as_f64();
        // An overlap to the right is on the first half of the width. The middle of a wholly overlapped car is at the half.
        let of_overlap = |overlap: f64| if overlap < 0.0 { -50.0 - overlap } else { 150.0 - overlap };
        let place = number("impact").or_else(|| number("overlap").map(of_overlap)).unwrap_or(50.0);
        let impact = trial["metrics"]["impact_speed"].as_f64().unwrap() * 3.6;
        (format!("{} at {place}", number("ego_speed").unwrap()), json!(impact))
    };
    Value::Object(trials.map(entry).collect())
}

/// What the rating calculator of Euro NCAP says to each case: the number of tests of its standard range, and their points. `None` if it is not
/// installed.
fn judged(cases: &[Value]) -> Option<Vec<(u64, f64)>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let python = root.join("target/checker/bin/python3");
    let found = Command::new(&python).args(["-c", "import euroncap_rating_2026"]).stderr(Stdio::null()).status();
    if !found.is_ok_and(|status| status.success()) {
        eprintln!("SKIPPED: no rating calculator of Euro NCAP");
        return None;
    }
    let mut judge = Command::new(python);
    let judge = judge.arg(root.join("tests/end_to_end/ncap_judge.py")).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut judge = judge.spawn().unwrap();
    judge.stdin.take().unwrap().write_all(json!(cases).to_string().as_bytes()).unwrap();
    let output = judge.wait_with_output().unwrap();
    assert!(output.status.success());
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn the_rating_calculator_of_euro_ncap_gives_the_same_points() {
    let dir = tempfile::tempdir().unwrap();
    let (mut cases, mut ours) = (Vec::new(), Vec::new());
    for scenario in SCENARIOS {
        let options = options(dir.path(), scenario);
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        for driver in ["aeb", "cruise", "cc", "rss", "reg157", "planner"] {
            let points = campaign(dir.path(), scenario, driver, &options)["points"].take();
            if points["points"].is_null() {
                // The situation never came about in a test.
                assert!(points["without_situation"].as_u64().unwrap() > 0, "{scenario} {driver}: {points}");
                continue;
            }
            assert_eq!(points["ran"], points["cells"], "{scenario} {driver}: {points}");
            cases.push(
                json!({"grid": points["grid"], "impacts": impacts(&dir.path().join(format!("{scenario}-{driver}")))}),
            );
            ours.push(points);
        }
    }
    assert!(cases.len() >= 16, "{} campaigns", cases.len());
    let Some(theirs) = judged(&cases) else { return };
    for ((case, ours), (cells, points)) in cases.iter().zip(&ours).zip(theirs) {
        assert_eq!(ours["cells"], cells, "{case}");
        assert!((ours["points"].as_f64().unwrap() - points).abs() < 1e-12, "{case}: {ours}, calculator {points}");
    }
    let different: BTreeSet<String> = ours.iter().map(|points| points["points"].to_string()).collect();
    assert!(different.len() >= 8, "{different:?}");
}

#[test]
fn a_part_of_the_grid_or_another_world_gives_no_points() {
    let dir = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let part = ["--open", "ego_speed=10,20,30", "--discrete", "cross", "--budget", "3"];
    let printed = campaign(dir.path(), "ncap-cpfa", "aeb", &part);
    assert_eq!(printed["points"]["points"], Value::Null);
    assert_eq!([&printed["points"]["ran"], &printed["points"]["cells"]], [3, 6]);
    let table = stdout(&succeeds(fuzz(dir.path(), &[&["ncap-cpfa", "--out", "table"], &part[..]].concat())));
    assert!(table.contains("points on this grid   none: 3 of the 6 tests of CPFA day have run\n"), "{table}");
    let whole = options(dir.path(), "ncap-cpfa");
    let whole: Vec<&str> = whole.iter().map(String::as_str).collect();
    for (driver, other) in [("rss", "--set=friction=0.4"), ("cc", "--set=fog=0.5")] {
        let printed = campaign(dir.path(), "ncap-cpfa", driver, &[&whole[..], &[other]].concat());
        assert_eq!((&printed["points"]["ran"], &printed["points"]["points"]), (&json!(0), &Value::Null), "{other}");
    }
    // The points stand in a file, and a comparison has them if both campaigns ran the whole grid.
    for (driver, out) in [("cruise", "before"), ("planner", "after")] {
        succeeds(fuzz(dir.path(), &[&["ncap-cpfa", "--driver", driver, "--out", out], &whole[..]].concat()));
    }
    let compared = stdout(&succeeds(fuzz(dir.path(), &["diff", "before", "after", "--format", "json"])));
    let compared: Value = serde_json::from_str(&compared).unwrap();
    for (i, folder) in ["before", "after"].iter().enumerate() {
        let kept = fs::read_to_string(dir.path().join(folder).join("points.json")).unwrap();
        let kept: Value = serde_json::from_str(&kept).unwrap();
        assert_eq!(compared["points"][i], kept, "{folder}");
        assert!(kept["points"].is_number(), "{kept}");
    }
    let compared = stdout(&succeeds(fuzz(dir.path(), &["diff", "before", "after"])));
    assert!(compared.contains("points before") && compared.contains("0.500: CPFA day, 6 tests"), "{compared}");
    // A car that brakes before anything happens avoids nothing.
    let settings =
        ["ttc=10", "field_of_view=180", "clear_ttc=20", "margin=2"].map(|setting| format!("--set=driver.{setting}"));
    let timid: Vec<&str> = whole.iter().copied().chain(settings.iter().map(String::as_str)).collect();
    let printed = campaign(elsewhere.path(), "ncap-cpfa", "aeb", &timid);
    assert_eq!(printed["points"]["points"], Value::Null, "{}", printed["points"]);
    assert!(printed["points"]["without_situation"].as_u64().unwrap() > 0, "{}", printed["points"]);
    let printed = campaign(dir.path(), "pedestrian-crossing", "aeb", &["--budget", "3"]);
    assert_eq!(printed["points"], Value::Null);
}
