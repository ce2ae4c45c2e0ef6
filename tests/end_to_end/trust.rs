//! Commands that stand in files of strangers: none is run without the user's word.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A system that leaves a trace of each start: the file `ran`.
const SYSTEM: &str = r#"touch ran; while read -r line; do i=${line#*:}; i=${i%%,*}
echo "{\"index\":$i,\"robustness\":{\"a\":-1}}"; done"#;

/// A folder with the campaign `camp` of a system, and the regression file `one.json` of one of its tests.
fn campaign() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("system.sh"), SYSTEM).unwrap();
    fs::write(dir.path().join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [-1, 1] }]\n").unwrap();
    let arguments = ["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "3", "--out", "camp", "-q"];
    succeeds(fuzz(dir.path(), &arguments));
    succeeds(fuzz(dir.path(), &["shrink", "camp", "1", "--trust", "--save", "one.json", "-q"]));
    fs::remove_file(dir.path().join("ran")).unwrap();
    dir
}

/// The commands that run tests of files again.
const AGAIN: [&[&str]; 3] = [&["replay", "camp", "1"], &["shrink", "camp", "1"], &["replay", "one.json"]];

fn has_run(dir: &Path) -> bool {
    fs::remove_file(dir.join("ran")).is_ok()
}

#[test]
fn a_command_in_a_file_is_shown_and_not_run() {
    let dir = campaign();
    for again in AGAIN {
        for other in [&[] as &[&str], &["--system", "sh other.sh"], &["--driver-command", "sh system.sh ."]] {
            let output = fuzz(dir.path(), &[again, other].concat());
            refused(&output, &["the command `sh system.sh`", "add --system 'sh system.sh', or --trust"]);
            assert!(!has_run(dir.path()), "{again:?}");
        }
    }
}

#[test]
fn a_command_is_run_if_the_user_gives_the_same_command_or_trusts_the_file() {
    let dir = campaign();
    for again in AGAIN {
        for word in [&["--system", "sh system.sh"] as &[&str], &["--trust"]] {
            succeeds(fuzz(dir.path(), &[again, word].concat()));
            assert!(has_run(dir.path()), "{again:?} {word:?}");
        }
    }
}

#[test]
fn nothing_else_runs_the_command() {
    let dir = campaign();
    for reads in [&["map", "camp"] as &[&str], &["trace", "camp"]] {
        fuzz(dir.path(), reads);
        assert!(!has_run(dir.path()), "{reads:?}");
    }
    // To continue a campaign, the user gives its command.
    let other = ["--system", "sh other.sh", "--space", "SPACE.toml", "--budget", "3", "--out", "camp", "--resume"];
    refused(&fuzz(dir.path(), &other), &["holds a different campaign"]);
    assert!(!has_run(dir.path()));
}

#[test]
fn the_commands_that_are_printed_can_be_copied() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("my system.sh"), SYSTEM).unwrap();
    fs::write(dir.path().join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [-1, 1] }]\n").unwrap();
    let system = ["--system", "sh 'my system.sh'", "--space", "SPACE.toml", "--budget", "3", "--junit"];
    let summary = succeeds(fuzz(dir.path(), &[&system[..], &["--out", "camp", "--format", "json", "-q"]].concat()));
    let summary: Value = serde_json::from_str(&stdout(&summary)).unwrap();
    let replay = summary["worst"]["replay"].as_str().expect("the summary has a command");
    assert!(replay.contains("--system"), "{replay}");
    let junit = fs::read_to_string(dir.path().join("camp/junit.xml")).unwrap();
    assert!(junit.contains("--system"), "{junit}");
    fs::remove_file(dir.path().join("ran")).unwrap();
    let output = Command::new("sh").args(["-c", replay]).current_dir(dir.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{replay}: {}", stderr(&output));
    assert!(has_run(dir.path()));
}

#[test]
fn the_command_of_a_driver_is_not_run_either() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "40", "--out", "camp", "-q"]));
    let file = dir.path().join("camp/campaign.json");
    let mut study: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    study["driver"] = serde_json::json!({"name": "touch ran", "settings": {},
        "external": {"by": "command", "timeout": 5.0}});
    fs::write(&file, study.to_string()).unwrap();
    // An older log names no study.
    let log = dir.path().join("camp/trials.jsonl");
    let lines = fs::read_to_string(&log).unwrap();
    let without = |line: &str| {
        let mut line: Value = serde_json::from_str(line).unwrap();
        line.as_object_mut().unwrap().remove("study");
        format!("{line}\n")
    };
    let failing = lines.lines().position(|line| line.contains("\"verdict\":\"fail\"")).expect("a test fails");
    fs::write(&log, lines.lines().map(without).collect::<String>()).unwrap();
    let failing = failing.to_string();
    for again in [&["replay", "camp", "0"] as &[&str], &["shrink", "camp", &failing]] {
        refused(&fuzz(dir.path(), again), &["the command `touch ran`", "add --driver-command 'touch ran', or --trust"]);
        assert!(!has_run(dir.path()), "{again:?}");
    }
    fuzz(dir.path(), &["blame", "camp"]);
    assert!(!has_run(dir.path()), "blame runs the reference drivers alone");
}

#[test]
fn nothing_is_sent_to_the_address_of_a_driver_without_trust() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "1", "--out", "camp", "-q"]));
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    listener.set_nonblocking(true).unwrap();
    let address = format!("grpc://{}", listener.local_addr().unwrap());
    let file = dir.path().join("camp/campaign.json");
    let mut study: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    study["driver"] =
        serde_json::json!({ "name": address, "settings": {}, "external": { "by": "address", "timeout": 1.0 } });
    fs::write(&file, study.to_string()).unwrap();
    let log = dir.path().join("camp/trials.jsonl");
    fs::write(&log, crate::common::without_study(&fs::read_to_string(&log).unwrap())).unwrap();
    let output = fuzz(dir.path(), &["replay", "camp", "0"]);
    refused(&output, &[&format!("names a driver at {address}"), "add --trust"]);
    assert!(listener.accept().is_err(), "somebody has connected");
}
