//! Suspect and located combinations in a campaign, and the paper's example of discrete parameters.

use crate::common::{fuzz, golden, refused, stdout, succeeds};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

#[allow(dead_code)]
#[path = "../../examples/lanes.rs"]
mod lanes;

/// Parameters with 48 combinations, of which 16 have all pairs of values.
const OPEN: &[&str] = &["--open", "speed=1,3,5,7", "--open", "distance=10,20,30,40", "--open", "lanes=2,4,6"];

/// A campaign; what it prints.
fn run(dir: &Path, more: &[&str]) -> Value {
    let printed = stdout(&succeeds(fuzz(dir, &[OPEN, &["--format", "json"], more].concat())));
    serde_json::from_str(&printed).unwrap()
}

/// A campaign over all 48 combinations; what it prints.
fn campaign(dir: &Path, more: &[&str]) -> Value {
    run(dir, &[&["--discrete", "cross", "--budget", "48"], more].concat())
}

/// What was found guilty, as text.
fn guilty(summary: &Value) -> BTreeSet<String> {
    let locations = summary["located"]["locations"].as_array().unwrap().iter();
    let guilty = locations.filter(|location| location["conclusion"] == "guilty");
    guilty.map(|location| location["values"].to_string()).collect()
}

fn trials(dir: &Path) -> Vec<Value> {
    let log = fs::read_to_string(dir.join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn has(test: &Value, values: &Value) -> bool {
    values.as_object().unwrap().iter().all(|(name, value)| test[name] == *value)
}

#[test]
fn located_combinations_explain_all_failures_of_all_combinations() {
    let dir = tempfile::tempdir().unwrap();
    let summary = campaign(dir.path(), &["--locate", "--out", "located"]);
    let file = fs::read_to_string(dir.path().join("located/located.json")).unwrap();
    let located: Value = serde_json::from_str(&file).unwrap();
    assert_eq!(summary["located"], located);
    let trials = trials(&dir.path().join("located"));
    let locations = located["locations"].as_array().unwrap();
    assert!(locations.len() > 1 && located["unexplained"] == serde_json::json!([]), "{file}");
    for trial in &trials {
        let guilty = locations.iter().any(|location| has(&trial["test"], &location["values"]));
        assert_eq!(trial["verdict"] == "fail", guilty, "{trial}");
    }
    assert_eq!(located["ran"], 0, "all tests are in the campaign");
    // Each suspect is in failing tests only.
    for suspect in summary["suspects"]["ranked"].as_array().unwrap() {
        let with = trials.iter().filter(|trial| has(&trial["test"], &suspect["values"]));
        let verdicts: Vec<&Value> = with.map(|trial| &trial["verdict"]).collect();
        assert!(verdicts.len() as u64 == suspect["failures"] && verdicts.iter().all(|verdict| *verdict == "fail"));
    }
}

#[test]
fn a_covering_array_and_a_few_more_tests_find_what_all_tests_find() {
    let dir = tempfile::tempdir().unwrap();
    let all = campaign(dir.path(), &["--locate", "--out", "all"]);
    let few = run(dir.path(), &["--locate", "--out", "few"]);
    assert_eq!(guilty(&all), guilty(&few));
    assert_eq!(few["located"]["unexplained"], serde_json::json!([]));
    let further: Vec<&Value> = few["located"]["locations"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|location| location["tests"].as_array().unwrap())
        .collect();
    assert!(few["tests"] == 16 && few["located"]["ran"] == further.len() && further.len() <= 12, "{few}");
    // The further tests went as those of the same values among all.
    let trials = trials(&dir.path().join("all"));
    for test in further {
        let same = trials.iter().find(|trial| trial["test"] == test["test"]).unwrap();
        assert_eq!(same["verdict"], test["verdict"]);
    }
}

#[test]
fn locating_leaves_the_log_of_the_campaign_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let plain = campaign(dir.path(), &["--out", "plain"]);
    assert!(plain.get("located").is_none() && !dir.path().join("plain/located.json").exists());
    campaign(dir.path(), &["--locate", "--out", "located"]);
    let read = |name: &str, file: &str| fs::read(dir.path().join(name).join(file)).unwrap();
    for file in ["campaign.json", "trials.jsonl", "trials.csv", "coverage.json"] {
        assert!(read("plain", file) == read("located", file), "{file}");
    }
    // A finished campaign can be located later.
    campaign(dir.path(), &["--locate", "--resume", "--out", "plain"]);
    assert_eq!(read("plain", "located.json"), read("located", "located.json"));
}

/// The part of the table that is about suspects and the guilty.
fn table(dir: &Path, arguments: &[&str]) -> String {
    let table = stdout(&succeeds(fuzz(dir, &[arguments, &["--format", "table"]].concat())));
    let about = table
        .lines()
        .skip_while(|line| !line.contains("suspects"))
        .take_while(|line| !line.contains("-wise coverage") && !line.starts_with("  dispersion"));
    about.map(|line| format!("{line}\n")).collect()
}

#[test]
fn the_table_names_suspects_and_the_guilty() {
    let dir = tempfile::tempdir().unwrap();
    golden("guilty.txt", &table(dir.path(), &[OPEN, &["--locate"]].concat()));
}

#[test]
fn the_table_says_which_failures_are_unexplained_and_why() {
    let dir = tempfile::tempdir().unwrap();
    // Any speed: how fast the pedestrian walks matters, and is no discrete value.
    let open = ["--open", "distance=10,20,30,40", "--open", "lanes", "--open", "friction=0.3,0.8", "--budget", "60"];
    golden("unexplained.txt", &table(dir.path(), &[&open[..], &["--locate=25"]].concat()));
    let none = stdout(&succeeds(fuzz(
        dir.path(),
        &["--open", "distance=10,20", "--set", "speed=0.5", "--locate", "--format", "table", "--out", "none"],
    )));
    assert!(none.contains("located               nothing: locating needs a failing test"), "{none}");
}

#[test]
fn locating_needs_a_discrete_parameter() {
    let dir = tempfile::tempdir().unwrap();
    refused(&fuzz(dir.path(), &["--locate"]), &["no discrete parameter is open", "--open NAME=A,B,C"]);
    assert!(!dir.path().join("paracosm-out").exists());
}

#[test]
fn the_paper_s_example_is_counted_out() {
    golden("lanes.txt", &lanes::report().unwrap());
}
