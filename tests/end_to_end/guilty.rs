//! Suspect and located combinations in a campaign, and the paper's example of discrete parameters.

use crate::common::{fuzz, golden, refused, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;

#[allow(dead_code)]
#[path = "../../examples/lanes.rs"]
mod lanes;

const ALL: &[&str] = &[
    "--open",
    "speed=1,3,5,7",
    "--open",
    "distance=10,20,30,40",
    "--open",
    "lanes=2,4,6",
    "--discrete",
    "cross",
    "--budget",
    "48",
];

/// A campaign over all 48 combinations; what it prints.
fn campaign(dir: &Path, more: &[&str]) -> Value {
    let printed = stdout(&succeeds(fuzz(dir, &[ALL, &["--format", "json"], more].concat())));
    serde_json::from_str(&printed).unwrap()
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
    // The tests on the way went as the campaign's tests of the same values.
    for test in locations.iter().flat_map(|location| location["tests"].as_array().unwrap()) {
        let same = trials.iter().find(|trial| trial["test"] == test["test"]).unwrap();
        assert_eq!(same["verdict"], test["verdict"]);
    }
    // Each suspect is in failing tests only.
    for suspect in summary["suspects"]["ranked"].as_array().unwrap() {
        let with = trials.iter().filter(|trial| has(&trial["test"], &suspect["values"]));
        let verdicts: Vec<&Value> = with.map(|trial| &trial["verdict"]).collect();
        assert!(verdicts.len() as u64 == suspect["failures"] && verdicts.iter().all(|verdict| *verdict == "fail"));
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

#[test]
fn the_table_names_suspects_and_the_guilty() {
    let dir = tempfile::tempdir().unwrap();
    let output = succeeds(fuzz(dir.path(), &[ALL, &["--locate", "--format", "table"]].concat()));
    let table = stdout(&output);
    let about =
        table.lines().skip_while(|line| !line.contains("suspects")).take_while(|line| !line.contains("written"));
    golden("guilty.txt", &about.map(|line| format!("{line}\n")).collect::<String>());
}

#[test]
fn locating_needs_a_discrete_parameter() {
    let dir = tempfile::tempdir().unwrap();
    refused(&fuzz(dir.path(), &["--locate"]), &["--locate", "discrete parameters", "--open NAME=A,B,C"]);
    assert!(!dir.path().join("paracosm-out").exists());
}

#[test]
fn the_paper_s_example_is_counted_out() {
    golden("lanes.txt", &lanes::report().unwrap());
}
