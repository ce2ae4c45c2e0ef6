//! Formulas that are asked of a scenario's runs beside its own requirements.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use paracosm::{Study, scenarios};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn run(dir: &Path, out: &str, more: &[&str]) -> Value {
    let summary = succeeds(fuzz(dir, &[&["--budget", "30", "--out", out, "-q", "--format", "json"], more].concat()));
    serde_json::from_str(&stdout(&summary)).unwrap()
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    let log = fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_formula_is_a_further_requirement_and_changes_no_run() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), "plain", &[]);
    let specs = ["--spec", "G (car.speed < 17)", "--spec", "always[0,1](car.speed<16.5 -> car.x > 1000)"];
    let summary = run(dir.path(), "asked", &specs);
    for (plain, asked) in trials(dir.path(), "plain").iter().zip(&trials(dir.path(), "asked")) {
        assert_eq!(plain["trace_hash"], asked["trace_hash"]);
        assert_eq!(plain["robustness"]["no-collision"], asked["robustness"]["no-collision"]);
        // A contact leaves open what would have come after it.
        let first = asked["robustness"]["spec-1"].as_f64();
        assert_eq!(first.is_none(), asked["robustness"]["progress"].is_null(), "{asked}");
        assert!(first.is_none_or(|robustness| (0.0..0.34).contains(&robustness)), "{asked}");
        let second = asked["robustness"]["spec-2"].as_f64().unwrap();
        assert_eq!(asked["verdict"] == "fail", plain["verdict"] == "fail" || second < 0.0, "{asked}");
    }
    let ids: Vec<&Value> = summary["requirements"].as_array().unwrap().iter().map(|judged| &judged["id"]).collect();
    assert_eq!(ids, ["no-collision", "progress", "spec-1", "spec-2"]);
    let study = fs::read_to_string(dir.path().join("asked/campaign.json")).unwrap();
    let study: Value = serde_json::from_str(&study).unwrap();
    let formula = "always[0,1] ((car.speed < 16.5) -> (car.x > 1000))";
    let expected =
        json!({"id": "spec-2", "text": formula, "formula": formula, "unit": "", "scale": null, "given": true});
    assert_eq!(study["requirements"][3], expected);
    let replay = succeeds(fuzz(dir.path(), &["replay", "asked", "3", "--format", "table"]));
    assert!(stdout(&replay).contains("spec-2"), "{}", stdout(&replay));
    // However it is written, it is the same formula.
    let resumed = ["--spec", "always (car.speed < 17)", "--spec", "G[0,1] (car.speed < 16.5 implies car.x > 1e3)"];
    run(dir.path(), "asked", &[&resumed[..], &["--resume"]].concat());
    let other = fuzz(dir.path(), &["--budget", "30", "--out", "asked", "--resume"]);
    refused(&other, &["different campaign", "`requirements`", "spec-1"]);
}

#[test]
fn in_dense_time_the_car_is_placed_between_samples_when_a_formula_is_violated() {
    let dir = tempfile::tempdir().unwrap();
    let dense = ["--spec", "always[0.125,0.125] (car.travelled < 0)", "--dense"];
    let summary = run(dir.path(), "dense", &dense);
    assert_eq!(summary["requirements"][2]["violated"], 30);
    for trial in trials(dir.path(), "dense") {
        let metric = |name: &str| trial["metrics"][format!("{name}.spec-1")].clone();
        assert_eq!((metric("critical_time"), metric("critical_part")), (json!(0.125), json!("(car.travelled < 0)")));
        let travelled = -trial["robustness"]["spec-1"].as_f64().unwrap();
        assert!((metric("critical_travelled").as_f64().unwrap() - travelled).abs() < 1e-12, "{trial}");
        assert!(metric("critical_speed").as_f64().unwrap() > 1.0);
    }
    refused(&fuzz(dir.path(), &["--dense", "--budget", "1"]), &["--spec"]);
    let square = ["--spec", "G (car.speed * car.speed < 400)", "--dense", "--budget", "1"];
    refused(&fuzz(dir.path(), &square), &["--spec G (car.speed * car.speed < 400)", "not a piecewise linear function"]);
}

#[test]
fn formulas_that_cannot_be_asked_are_refused_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    let cases: &[(&str, &[&str])] = &[
        (
            "always (car.sped < 20)",
            &["column 9", "`car.sped`", "did you mean `car.speed`?", "describe pedestrian-crossing"],
        ),
        ("always (zzz < 20)", &["`zzz`", "the signals of the trace are car.x, car.y"]),
        ("always[0,0.005] (car.speed < 20)", &["0.005 s is not a multiple", "0.01 s", "~[0,0.005]"]),
        ("always (car.speed < )", &["column 21", "found `)`"]),
        ("", &["column 1"]),
    ];
    for (formula, says) in cases {
        refused(&fuzz(dir.path(), &["--spec", formula]), &[&["--spec"], *says].concat());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "{formula} wrote something");
    }
}

#[test]
fn a_formula_that_looks_past_the_end_is_named_and_leaves_tests_inconclusive() {
    let dir = tempfile::tempdir().unwrap();
    let late = ["--budget", "12", "--out", "late", "--spec", "eventually[0,30] (car.speed > 30)"];
    let late = succeeds(fuzz(dir.path(), &late));
    assert!(stderr(&late).contains("`eventually[0,30] (car.speed > 30)` looks beyond the 25 s"), "{}", stderr(&late));
    for trial in trials(dir.path(), "late") {
        assert_eq!(trial["robustness"]["spec-1"], Value::Null);
        assert_ne!(trial["verdict"], "pass");
    }
    // The same without an end is violated.
    run(dir.path(), "never", &["--spec", "eventually (car.speed > 30)"]);
    for trial in trials(dir.path(), "never") {
        let robustness = trial["robustness"]["spec-1"].as_f64();
        assert_eq!(robustness.is_none(), trial["robustness"]["progress"].is_null(), "{trial}");
        assert!(trial["verdict"] == "fail" && robustness.is_none_or(|robustness| robustness < 0.0), "{trial}");
    }
}

#[test]
fn every_signal_that_is_shown_can_be_named() {
    for program in scenarios::ALL {
        let signals = Study::of((*program).clone()).build().unwrap().signals().unwrap().unwrap();
        assert!(signals.iter().any(|signal| signal == "car.speed"), "{}", program.name());
        for signal in signals {
            let formula = paracosm::oracles::signal(signal).at_most(1.0).always(..).to_string();
            let study = Study::of((*program).clone()).spec(&formula).build().unwrap();
            assert_eq!(study.requirements().last().unwrap().formula.as_ref().unwrap().to_string(), formula);
        }
    }
}

#[test]
fn adaptive_campaigns_with_formulas_are_resumed_to_the_same_log() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--strategy", "cmaes", "--spec", "always (car.acceleration > -8)", "--seed", "3"];
    run(dir.path(), "whole", &options);
    run(dir.path(), "cut", &options);
    let (whole, cut) = (dir.path().join("whole/trials.jsonl"), dir.path().join("cut/trials.jsonl"));
    let whole = fs::read(whole).unwrap();
    fs::write(&cut, &whole[..whole.len() * 2 / 3]).unwrap();
    run(dir.path(), "cut", &[&options[..], &["--resume"]].concat());
    assert!(fs::read(cut).unwrap() == whole);
}
