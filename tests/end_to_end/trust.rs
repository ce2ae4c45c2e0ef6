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
        let output = fuzz(dir.path(), again);
        refused(&output, &["the command `sh system.sh`", "add --system 'sh system.sh', or --trust"]);
        assert!(!has_run(dir.path()), "{again:?}");
    }
    let output = fuzz(dir.path(), &["replay", "one.json", "--system", "sh other.sh"]);
    refused(&output, &["add --system 'sh system.sh', or --trust", "exactly the same, but you gave `sh other.sh`"]);
    assert!(!has_run(dir.path()));
}

#[test]
fn another_command_of_the_user_takes_the_place_of_the_command_of_a_folder() {
    let dir = campaign();
    // The system has moved, and no longer fails.
    let mended =
        r#"while read -r line; do i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"a\":2}}"; done"#;
    fs::write(dir.path().join("other.sh"), mended).unwrap();
    let replayed = succeeds(fuzz(dir.path(), &["replay", "camp", "1", "--system", "sh other.sh"]));
    let note = stderr(&replayed);
    assert!(note.contains("the campaign ran `sh system.sh`; now `sh other.sh` runs in its place"), "{note}");
    let shown = stdout(&replayed);
    assert!(shown.contains("test 1: pass, logged fail") && shown.contains("2, logged -1"), "{shown}");
    assert!(!has_run(dir.path()));
    // The same command with changed contents.
    fs::rename(dir.path().join("other.sh"), dir.path().join("system.sh")).unwrap();
    let same = ["replay", "camp", "1", "--system", "sh system.sh"];
    let says = [
        "test 1 differs from the log",
        "verdict: pass, logged fail",
        "a: 2, logged -1",
        "`sh system.sh` runs",
        "--changed",
    ];
    refused(&fuzz(dir.path(), &same), &says);
    let changed = stdout(&succeeds(fuzz(dir.path(), &[&same[..], &["--changed"]].concat())));
    assert!(changed.contains("test 1: pass, logged fail"), "{changed}");
    let printed = stdout(&succeeds(fuzz(dir.path(), &[&same[..], &["--changed", "--format", "json"]].concat())));
    let printed: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(printed["robustness"]["a"], 2.0);
    assert_eq!(
        (&printed["logged"]["verdict"], &printed["logged"]["robustness"]["a"]),
        (&"fail".into(), &(-1.0).into())
    );
    // A mended failure is no broken test.
    let regression = fuzz(dir.path(), &["replay", "one.json", "--system", "sh system.sh", "--fail-on-unexpected"]);
    assert_eq!(regression.status.code(), Some(1), "{}", stderr(&regression));
}

#[test]
fn a_command_for_which_the_campaign_has_no_place_is_refused() {
    let dir = campaign();
    let output = fuzz(dir.path(), &["replay", "camp", "1", "--driver-command", "sh system.sh"]);
    refused(&output, &["--driver-command 'sh system.sh'", "tests system sh system.sh", "leave --driver-command out"]);
    assert!(!has_run(dir.path()));
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
