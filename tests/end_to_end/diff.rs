//! `diff`: two campaigns with the same tests.

use crate::common::{fuzz, golden, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn campaign(dir: &Path, out: &str, more: &[&str]) {
    succeeds(fuzz(dir, &[&["cut-in", "--budget", "200", "--out", out, "-q"], more].concat()));
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    let log = fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn two_drivers_are_compared_test_by_test() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    campaign(dir, "before", &["--driver", "rss"]);
    campaign(dir, "after", &["--driver", "planner"]);
    let diff = |more: &[&str]| fuzz(dir, &[&["diff", "before", "after"], more].concat());
    golden("diff.txt", &stdout(&succeeds(diff(&[]))));
    let told: Value = serde_json::from_str(&stdout(&succeeds(diff(&["--format", "json"])))).unwrap();
    // Counted again from both logs, which have the same tests at the same places.
    let (before, after) = (trials(dir, "before"), trials(dir, "after"));
    let fails = |trial: &Value| trial["verdict"] == "fail";
    let indices = |from: &[Value], to: &[Value]| -> Vec<usize> {
        (0..200).filter(|index| !fails(&from[*index]) && fails(&to[*index])).collect()
    };
    let listed = |key: &str| -> Vec<usize> {
        told[key].as_array().unwrap().iter().map(|changed| changed["index"][0].as_u64().unwrap() as usize).collect()
    };
    assert_eq!(told["tests"], 200);
    assert_eq!(listed("new_failures"), indices(&before, &after));
    assert_eq!(listed("mended"), indices(&after, &before));
    assert!(!listed("mended").is_empty());
    // Every changed test is in one mode of its campaign.
    let in_modes = |key: &str| -> usize {
        told[key].as_array().unwrap().iter().map(|mode| mode["tests"].as_array().unwrap().len()).sum()
    };
    assert_eq!(in_modes("mended_modes"), listed("mended").len());
    assert_eq!(in_modes("new_modes"), listed("new_failures").len());
    let status = |order: [&str; 2]| fuzz(dir, &["diff", order[0], order[1], "--fail-on-new-failure"]).status.code();
    assert_eq!(status(["after", "before"]), Some(1));
    assert_eq!(status(["before", "before"]), Some(0));
}

#[test]
fn tests_of_one_campaign_alone_are_named_and_campaigns_without_a_pair_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    campaign(dir, "a", &[]);
    succeeds(fuzz(dir, &["cut-in", "--budget", "150", "--out", "b", "-q"]));
    let noted = stderr(&succeeds(fuzz(dir, &["diff", "a", "b"])));
    assert!(noted.contains("50 of the tests in a and 0 of the tests in b have no pair"), "{noted}");
    succeeds(fuzz(dir, &["cut-in", "--budget", "20", "--seed", "3", "--out", "c", "-q"]));
    refused(&fuzz(dir, &["diff", "a", "c"]), &["no test in common", "same strategy, seed and budget"]);
    succeeds(fuzz(dir, &["--budget", "20", "--out", "d", "-q"]));
    refused(&fuzz(dir, &["diff", "a", "d"]), &["first campaign is on `cut-in`, the second on `pedestrian-crossing`"]);
    succeeds(fuzz(dir, &["cut-in", "--set", "gap=20", "--budget", "20", "--out", "e", "-q"]));
    refused(&fuzz(dir, &["diff", "a", "e"]), &["`gap` is open in the first campaign"]);
    refused(&fuzz(dir, &["diff", "a", "nowhere"]), &["nowhere/campaign.json"]);
}
