//! Folders that an earlier version has written (commit 5e19f33, before the library came first) are replayed, mapped and
//! continued.

use crate::common::{fuzz, stdout, succeeds};
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

/// The folders with the options that continue them.
const FOLDERS: [(&str, &[&str]); 3] = [
    // The strategy was `halton-shifted`, which is `halton` with a seed.
    ("shifted", &["--strategy", "halton", "--seed", "3", "--budget", "12"]),
    // The search has learned the scale of the formula.
    ("learned", &["--strategy", "cmaes", "--seed", "3", "--budget", "24", "--spec", "always (car.acceleration > -8)"]),
    ("extended", &["--extend", "old.csv", "--budget", "12"]),
];

#[test]
fn folders_of_an_earlier_version_are_replayed_mapped_and_continued_to_the_same_log() {
    for (name, options) in FOLDERS {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join(name);
        copy(name, &folder);
        let log = fs::read_to_string(folder.join("trials.jsonl")).unwrap();
        let replayed = stdout(&succeeds(fuzz(dir.path(), &["replay", name, "5", "--format", "json"])));
        let replayed: serde_json::Value = serde_json::from_str(&replayed).unwrap();
        let logged: serde_json::Value = serde_json::from_str(log.lines().nth(5).unwrap()).unwrap();
        assert_eq!(replayed["trace_hash"], logged["trace_hash"], "{name}: {replayed}");
        succeeds(fuzz(dir.path(), &["map", name, "--x", "speed", "--y", "distance", "--out", "map.svg"]));
        let half: String = log.lines().take(7).map(|line| format!("{line}\n")).collect();
        fs::write(folder.join("trials.jsonl"), half).unwrap();
        if name == "extended" {
            fs::copy(folder.join("extended.csv"), dir.path().join("old.csv")).unwrap();
        }
        succeeds(fuzz(dir.path(), &[options, &["--out", name, "--resume", "-q"]].concat()));
        assert!(fs::read_to_string(folder.join("trials.jsonl")).unwrap() == log, "{name}: another log");
    }
}

#[test]
fn a_folder_whose_runs_might_have_ended_early_is_replayed() {
    let dir = tempfile::tempdir().unwrap();
    copy("early", &dir.path().join("early"));
    succeeds(fuzz(dir.path(), &["replay", "early", "2"]));
}
