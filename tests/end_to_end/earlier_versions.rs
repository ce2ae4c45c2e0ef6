//! Folders that version 0.1.0 has written (commit 5e19f33, before the library came first) are replayed and mapped. They
//! are not continued, since the robustness of a collision is another.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;

/// A copy of one of these folders.
fn copy(name: &str, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/earlier").join(name)).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
}

/// The folders with the options that would continue them.
const FOLDERS: [(&str, &[&str]); 3] = [
    // The strategy was `halton-shifted`, which is `halton` with a seed.
    ("shifted", &["--strategy", "halton", "--seed", "3", "--budget", "12"]),
    // The search has learned the scale of the formula.
    ("learned", &["--strategy", "cmaes", "--seed", "3", "--budget", "24", "--spec", "always (car.acceleration > -8)"]),
    ("extended", &["--extend", "old.csv", "--budget", "12"]),
];

#[test]
fn folders_of_an_earlier_version_are_replayed_and_mapped_and_not_continued() {
    for (name, options) in FOLDERS {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join(name);
        copy(name, &folder);
        let log = fs::read_to_string(folder.join("trials.jsonl")).unwrap();
        let passing = log.lines().position(|line| line.contains("\"verdict\":\"pass\"")).unwrap();
        let replay = ["replay", name, &passing.to_string(), "--format", "json"];
        let replayed: serde_json::Value = serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &replay)))).unwrap();
        let logged: serde_json::Value = serde_json::from_str(log.lines().nth(passing).unwrap()).unwrap();
        assert_eq!(replayed["trace_hash"], logged["trace_hash"], "{name}: {replayed}");
        succeeds(fuzz(dir.path(), &["map", name, "--x", "speed", "--y", "distance", "--out", "map.svg"]));
        if name == "extended" {
            fs::copy(folder.join("extended.csv"), dir.path().join("old.csv")).unwrap();
        }
        let resumed = fuzz(dir.path(), &[options, &["--out", name, "--resume", "-q"]].concat());
        refused(&resumed, &["holds a different campaign: its `version` is \"0.1.0\""]);
        assert!(fs::read_to_string(folder.join("trials.jsonl")).unwrap() == log, "{name}: another log");
    }
}

#[test]
fn a_replay_of_a_collision_of_an_earlier_version_says_that_the_version_is_another() {
    let dir = tempfile::tempdir().unwrap();
    copy("early", &dir.path().join("early"));
    let says = stderr(&fuzz(dir.path(), &["replay", "early", "2"]));
    assert!(
        says.contains("test 2 differs from the log") && says.contains("another version of this software"),
        "{says}"
    );
}
