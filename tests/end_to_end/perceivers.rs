//! Perceivers in their own processes, by the command line.

use crate::cameras::can_draw;
use crate::common::{fuzz, refused, stdout, succeeds};
use crate::python::python;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

/// Runs a campaign with a blind detector; `false` without something to draw with, or without Python.
pub fn runs_blind(dir: &Path) -> bool {
    let command = perceiver(dir, "classes = ('car',)\ndef detect(self, image):\n    return []");
    command.is_some_and(|command| perceive(dir, &command, &["--budget", "1"]).status.success())
}

/// A camera that films a small image twice a second.
const CAMERAS: &str = r#"
look = "flat"

[camera.front]
resolution = [40, 24]
focal_mm = 24.0
sensor_mm = 36.0
position = [0.3, 0.0, 1.35]
yaw_pitch_roll = [0.0, 2.0, 0.0]
rate = 2.0
"#;

/// The command of a perceiver in Python whose class has this body.
fn perceiver(dir: &Path, body: &str) -> Option<String> {
    fs::write(dir.join("cameras.toml"), CAMERAS).unwrap();
    let script = dir.join("perceiver.py");
    let body = body.replace('\n', "\n    ");
    let text = format!(
        "import numpy as np\nfrom paracosm import Detection, Perceiver\n\n\nclass Mine(Perceiver):\n    {body}\n\n\nMine().serve()\n"
    );
    fs::write(&script, text).unwrap();
    can_draw().then(|| python(&script)).flatten()
}

fn perceive(dir: &Path, command: &str, options: &[&str]) -> Output {
    let usual = ["perceive", "follow-leader", "--perceiver-command", command, "--cameras", "cameras.toml"];
    fuzz(dir, &[&usual[..], &["--format", "json", "--out", "out"], options].concat())
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn trials(dir: &Path) -> Vec<Value> {
    let log = fs::read_to_string(dir.join("out/trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The sum of a metric over all trials.
fn sum(trials: &[Value], name: &str) -> f64 {
    trials.iter().filter_map(|trial| trial["metrics"][format!("perception.{name}")].as_f64()).sum()
}

#[test]
fn a_blind_detector_misses_every_encounter_and_a_stranger_must_give_its_command_to_replay_it() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let body = "classes = ('car',)\ndef detect(self, image):\n    print('nothing there')\n    return []";
    let Some(command) = perceiver(dir, body) else { return };
    let printed = succeeds(perceive(dir, &command, &["--budget", "4", "--jobs", "1"]));
    let trials = trials(dir);
    let results = json(&dir.join("out/perception.json"));
    let found = &results["detection"];
    assert!(found["encounters"].as_f64().unwrap() > 0.0, "{results}");
    assert_eq!(found["encounters"], found["missed_encounters"]);
    assert_eq!(found["encounters"].as_f64().unwrap(), sum(&trials, "encounters"));
    assert_eq!((found["risk"]["probability"].as_f64(), found["recall"].as_f64()), (Some(1.0), Some(0.0)));
    assert_eq!(results["images"].as_f64().unwrap(), sum(&trials, "images"));
    let summary: Value = serde_json::from_str(&stdout(&printed)).unwrap();
    assert_eq!(summary["perception"], results);
    assert!(trials.iter().any(|trial| trial["verdict"] == "fail"));
    // Road users in all ranges of a property are the road users.
    let counted = |axis: &str| {
        let ranges = found["ranges"].as_array().unwrap().iter();
        let of_axis = ranges.filter(|range| range["range"].as_str().unwrap().starts_with(axis));
        of_axis.map(|range| range["objects"].as_u64().unwrap()).sum::<u64>()
    };
    assert!(counted("visible-0.75") >= found["objects"].as_u64().unwrap());
    assert_eq!((counted("distance"), counted("height")), (counted("visible"), counted("visible")));

    refused(&fuzz(dir, &["replay", "out", "0"]), &["perceiver.py", "--perceiver-command", "--trust"]);
    let again =
        stdout(&succeeds(fuzz(dir, &["replay", "out", "0", "--perceiver-command", &command, "--format", "json"])));
    let again: Value = serde_json::from_str(&again).unwrap();
    assert_eq!(again["robustness"], trials[0]["robustness"]);
    refused(&fuzz(dir, &["blame", "out", "--trust"]), &["perceiver.py", "cannot replace"]);
    refused(&fuzz(dir, &["blame", "out"]), &["perceiver.py", "cannot replace"]);
}

#[test]
fn a_probability_of_false_alarms_in_the_dark_follows_the_distribution_of_the_light() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let body = "classes = ('car',)\ndef detect(self, image):\n    \
                return [Detection('car', 0.9, 0, 0, 5, 5)] if image.mean() < 60 else []";
    let Some(command) = perceiver(dir, body) else { return };
    let asked = |more: &[&str]| {
        let usual = ["likelihood", "follow-leader", "--perceiver-command", &command, "--cameras", "cameras.toml"];
        let question = ["--open", "light", "--set", "leader_speed=15", "--budget", "12", "--format", "json"];
        let formula = ["--spec", "always (perception.false_alarms < 1)"];
        fuzz(dir, &[&usual[..], &question, &formula, more].concat())
    };
    let probability = |distribution: &str| {
        let printed: Value =
            serde_json::from_str(&stdout(&succeeds(asked(&["--distribution", distribution])))).unwrap();
        printed["probability"].as_f64().unwrap()
    };
    let [any, bright] = ["light=uniform", "light=beta:20,1"].map(probability);
    assert!(bright < any && any < 1.0, "{bright} in bright light, {any} in any light");
    refused(&asked(&["--distribution", "lihgt=beta:20,1"]), &["lihgt", "light"]);
    refused(&fuzz(dir, &["likelihood", "--cameras", "cameras.toml"]), &["--cameras", "--perceiver"]);
    refused(&fuzz(dir, &["perceive", "follow-leader"]), &["--perceiver MODEL.onnx", "--perceiver-command"]);
}

#[test]
fn a_mask_of_the_lower_half_is_compared_with_the_road_pixel_by_pixel() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let body = "def segment(self, image):\n    mask = np.zeros(image.shape[:2])\n    mask[12:] = 1\n    return mask";
    let Some(command) = perceiver(dir, body) else { return };
    refused(&perceive(dir, &command, &[]), &["perception.overlap", "--spec"]);
    succeeds(perceive(dir, &command, &["--budget", "2", "--spec", "always (perception.overlap > 0.1)"]));
    let trials = trials(dir);
    let [both, answered, missed, neither] =
        ["true_positives", "false_positives", "false_negatives", "true_negatives"].map(|name| sum(&trials, name));
    let images = sum(&trials, "images");
    assert_eq!(both + answered + missed + neither, images * 40.0 * 24.0);
    // The mask is the half of each image.
    assert_eq!(both + answered, images * 20.0 * 24.0);
    let overlap = json(&dir.join("out/perception.json"))["segmentation"]["overlap"].as_f64().unwrap();
    assert!((overlap - both / (both + answered + missed)).abs() < 1e-12);
    assert!(overlap > 0.2, "{overlap}");
}

#[test]
fn a_perceiver_that_raises_dies_is_late_or_answers_wrongly_is_an_error_of_its_test() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    for (detect, says) in [
        ("raise ValueError('no lens')", "ValueError: no lens"),
        ("import os; os._exit(3)", "the perceiver ended without an answer"),
        ("import time; time.sleep(30)", "no answer within 4 s"),
        ("return [Detection('cra', 0.9, 1, 2, 3, 4)]", "did you mean `car`"),
        ("return [Detection('car', 1.5, 1, 2, 3, 4)]", "score 1.5"),
        ("return [Detection('car', 0.5, 1, 2, -3, 4)]", "no negative size"),
        ("return [Detection('car', float('nan'), 1, 2, 3, 4)]", "expected one line of JSON"),
    ] {
        let body = format!("classes = ('car', 'person')\ndef detect(self, image):\n    {detect}");
        let Some(command) = perceiver(dir, &body) else { return };
        let _ = fs::remove_dir_all(dir.join("out"));
        let output = perceive(dir, &command, &["--budget", "1", "--perceiver-timeout", "4"]);
        let trials = trials(dir);
        assert_eq!(trials[0]["verdict"], "error", "{output:?}");
        let error = trials[0]["error"].to_string();
        assert!(error.contains(says), "{error}");
        if detect.starts_with("raise") {
            let log = fs::read_to_string(dir.join("out/perceiver.log")).unwrap();
            assert!(log.contains("Traceback") && log.contains("ValueError: no lens"), "{log}");
        }
    }
}

#[test]
fn a_perceiver_that_fails_and_answers_when_it_sees_the_images_again_is_doubted() {
    let dir = tempfile::tempdir().unwrap();
    let body = "classes = ('car',)\nseen = 0\ndef detect(self, image):\n    self.seen += 1\n    \
                if self.seen == 60: raise ValueError('tired')\n    return []";
    let Some(command) = perceiver(dir.path(), body) else { return };
    let output = succeeds(perceive(dir.path(), &command, &["--budget", "3", "--jobs", "1"]));
    assert!(trials(dir.path()).iter().all(|trial| trial["error"].is_null()));
    let note = "the perceiver failed ";
    assert!(stdout(&output).contains(note) && stdout(&output).contains("ValueError: tired"), "{}", stdout(&output));
}

#[test]
fn a_program_that_is_no_perceiver_is_refused_before_the_first_test() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::write(dir.join("cameras.toml"), CAMERAS).unwrap();
    for (command, says) in [
        ("cat", "expected one line of JSON"),
        ("no-such-program", "cannot start the perceiver `no-such-program`"),
        ("sh -c 'echo hello >&2'", "its last words: hello"),
        ("sh -c 'echo {}; sleep 9'", "expected either `classes` or `segments`"),
        (r#"sh -c 'echo "{\"classes\":[\"cat\"]}"; sleep 9'"#, "no class of the detector means a road user"),
        (r#"sh -c 'echo "{\"segments\":[\"raod\"]}"; sleep 9'"#, "did you mean `road`"),
        (r#"sh -c 'echo "{\"error\":\"no GPU\"}"; sleep 9'"#, "the perceiver refuses: no GPU"),
        ("'", "a quote is not closed"),
    ] {
        refused(&perceive(dir, command, &[]), &[says]);
        assert!(!dir.join("out").exists(), "{command}");
    }
    let both = ["perceive", "follow-leader", "--perceiver-command", "cat", "--perceiver", "a.onnx"];
    refused(&fuzz(dir, &both), &["cannot be used with"]);
}
