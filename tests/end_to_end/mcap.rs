//! Runs as MCAP files, and the packages of MCAP for Python as judges of them.

use crate::cameras::can_draw;
use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// What the judge says to a file, its trace and a recording; `None`, with a note, if its packages are not installed.
fn judged(dir: &Path, arguments: &[&str]) -> Option<Value> {
    let import = "import numpy, mcap, mcap_protobuf";
    let has_judge = Command::new("python3").args(["-c", import]).stderr(Stdio::null()).status();
    if !has_judge.is_ok_and(|status| status.success()) {
        eprintln!("SKIPPED: no numpy, mcap and mcap-protobuf-support");
        return None;
    }
    let judge = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/end_to_end/mcap_judge.py");
    // Nothing is written beside the script.
    let output = Command::new("python3").args(["-B", judge]).args(arguments).current_dir(dir).output().unwrap();
    Some(serde_json::from_str(&stdout(&succeeds(output))).unwrap())
}

/// Runs the test in which a fast pedestrian steps in front of the car.
fn crash(dir: &Path, command: &[&str]) {
    let values = ["pedestrian-crossing", "--set", "speed=7.625", "--set", "distance=11.11"];
    succeeds(fuzz(dir, &[&command[..1], &values, &command[1..]].concat()));
}

#[test]
fn the_python_package_reads_the_signals_the_frames_the_scene_and_the_points_of_a_run() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    crash(dir, &["run", "--out", "c"]);
    let replay = ["replay", "c", "0", "--lidar", "--trace", "run.csv", "--mcap"];
    let said = fuzz(dir, &[&replay[..], &["run.mcap"]].concat());
    assert!(stderr(&said).contains(" messages on 20 topics written to run.mcap"), "{}", stderr(&said));
    fuzz(dir, &[&replay[..], &["again.mcap"]].concat());
    let bytes = fs::read(dir.join("run.mcap")).unwrap();
    assert!(bytes == fs::read(dir.join("again.mcap")).unwrap(), "the same test gives the same bytes");
    let Some(judged) = judged(dir, &["run.mcap", "run.csv"]) else { return };
    assert!(judged["messages"].as_u64().unwrap() > 5000, "{judged}");
}

#[test]
fn the_images_in_a_file_are_the_images_of_a_recording_and_its_pinhole_shows_bodies_where_they_are() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let cameras = stdout(&succeeds(fuzz(dir, &["record", "--print-cameras"])));
    fs::write(dir.join("cameras.toml"), cameras).unwrap();
    crash(dir, &["record", "--cameras", "cameras.toml", "--budget", "1", "--out", "images"]);
    let replay = ["replay", "images", "0", "--lidar", "--trace", "run.csv", "--cameras", "cameras.toml"];
    fuzz(dir, &[&replay[..], &["--mcap", "run.mcap"]].concat());
    let Some(judged) = judged(dir, &["run.mcap", "run.csv", "images"]) else { return };
    assert!(judged["images"].as_u64().unwrap() > 20, "{judged}");
}

#[test]
fn a_system_has_its_signals_in_a_file() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let answer = r#"i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"trace\":{\"time\":[0,0.1,0.2],\"x\":[1,2,3]}}""#;
    fs::write(dir.join("system.sh"), format!("while read -r line; do {answer}; done\n")).unwrap();
    fs::write(dir.join("SPACE.toml"), "[[parameter]]\nname = \"a\"\ninterval = [0, 1]\n").unwrap();
    let system = ["--system", "sh system.sh"];
    let run = ["run", "--space", "SPACE.toml", "--spec", "always (x < 9)", "--budget", "1", "--out", "c"];
    succeeds(fuzz(dir, &[&run[..], &system].concat()));
    let replayed = fuzz(dir, &[&["replay", "c", "0", "--mcap", "run.mcap"][..], &system].concat());
    // A topic for the signal, for the requirement and for the events.
    assert!(stderr(&replayed).contains("messages on 3 topics written to run.mcap"), "{}", stderr(&replayed));
}

#[test]
fn options_of_a_file_need_the_file_and_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    crash(dir, &["run", "--out", "c"]);
    refused(&fuzz(dir, &["replay", "c", "0", "--lidar"]), &["--mcap"]);
    refused(&fuzz(dir, &["replay", "c", "0", "--mcap", "no/run.mcap"]), &["--mcap", "no"]);
    refused(&fuzz(dir, &["replay", "c", "0", "--mcap", "c/campaign.json"]), &["campaign.json"]);
    refused(&fuzz(dir, &["replay", "c", "0", "--mcap", "run.csv"]), &["--mcap run.csv: expected FILE.mcap"]);
    let same = ["replay", "c", "0", "--trace", "a.mcap", "--mcap", "a.mcap"];
    refused(&fuzz(dir, &same), &["--trace and --mcap are both a.mcap"]);
    refused(&fuzz(dir, &["replay", "c/campaign.json", "--mcap", "run.mcap"]), &["--mcap"]);
    let log = fs::read_to_string(dir.join("c/trials.jsonl")).unwrap();
    fs::write(dir.join("c/trials.jsonl"), log.replace("\"trace_hash\":\"6", "\"trace_hash\":\"7")).unwrap();
    refused(&fuzz(dir, &["replay", "c", "0", "--mcap", "run.mcap"]), &["differs from the log"]);
    assert!(!dir.join("run.mcap").exists(), "a file of another run would mislead");
}

#[test]
fn a_violation_with_a_robustness_of_0_is_an_event() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    crash(dir, &["run", "--out", "c", "--spec", "always (not (car.speed == car.speed))"]);
    fuzz(dir, &["replay", "c", "0", "--mcap", "run.mcap"]);
    let bytes = fs::read(dir.join("run.mcap")).unwrap();
    assert!(String::from_utf8_lossy(&bytes).contains("spec-1 is violated"));
}
