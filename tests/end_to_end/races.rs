//! Two campaigns in one folder: one of them is refused, and a mixture is recognised.

use crate::common::{cover, fuzz, refused, stderr, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// The number of pairs of campaigns that are started at once.
fn pairs() -> usize {
    std::env::var("PARACOSM_PAIRS").map_or(10, |pairs| pairs.parse().expect("a number of pairs"))
}

fn start(dir: &Path, arguments: &[&str]) -> Child {
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let program = program.args(["--strategy", "random", "--budget", "5", "--jobs", "1", "--out", "camp", "-q"]);
    let program = program.args(arguments).current_dir(dir).stdout(Stdio::null()).stderr(Stdio::piped());
    program.spawn().expect("the program starts")
}

/// The hashes of the studies in a log.
fn studies(log: &Path) -> Vec<String> {
    let text = fs::read_to_string(log).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.map(|line| line["study"].as_str().expect("each line has the hash of its study").to_owned()).collect()
}

#[test]
fn of_two_campaigns_that_are_started_at_once_in_one_folder_one_is_refused() {
    for turn in 0..pairs() {
        let dir = tempfile::tempdir().unwrap();
        // Some pairs continue a campaign, which begins one if there is none.
        let resume: &[&str] = if turn % 3 == 0 { &["--resume"] } else { &[] };
        let both = ["1", "2"].map(|seed| start(dir.path(), &[&["--seed", seed], resume].concat()));
        let outputs = both.map(|child| child.wait_with_output().unwrap());
        let mut refusals = 0;
        for output in &outputs {
            match output.status.code() {
                Some(0) => {}
                code => {
                    refusals += 1;
                    let message = stderr(output);
                    assert_eq!(code, Some(2), "{message}");
                    let says = ["is writing to camp", "holds a campaign already", "holds a different campaign"];
                    assert!(says.iter().any(|says| message.contains(says)), "{message}");
                }
            }
        }
        assert_eq!(refusals, 1, "turn {turn}");
        let winner = if outputs[0].status.success() { "1" } else { "2" };
        let study: Value = serde_json::from_slice(&fs::read(dir.path().join("camp/campaign.json")).unwrap()).unwrap();
        assert_eq!(study["seed"].to_string(), winner, "turn {turn}");
        let studies = studies(&dir.path().join("camp/trials.jsonl"));
        assert_eq!(studies.len(), 5, "turn {turn}");
        assert!(studies.iter().all(|study| *study == studies[0]), "turn {turn}");
        succeeds(fuzz(dir.path(), &["replay", "camp", "4", "-q"]));
    }
}

#[test]
fn a_campaign_that_is_refused_says_which_process_writes_to_the_folder() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("camp")).unwrap();
    let log = fs::File::create(dir.path().join("camp/trials.jsonl")).unwrap();
    log.lock().unwrap();
    let message = refusal(dir.path());
    assert!(message.contains("is writing to camp; wait until it ends"), "{message}");
    if cfg!(target_os = "linux") {
        let this = format!("process {} (`", std::process::id());
        assert!(message.contains(&this) || message.contains("another process"), "{message}");
    }
    drop(log);
    // A process that ended after it locked the folder has begun nothing.
    assert!(start(dir.path(), &[]).wait().unwrap().success());
}

fn refusal(dir: &Path) -> String {
    let output = start(dir, &[]).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(!dir.join("camp/campaign.json").exists(), "nothing is written");
    stderr(&output)
}

#[test]
fn the_trials_of_another_campaign_are_refused_by_every_command() {
    let dir = tempfile::tempdir().unwrap();
    for (seed, out) in [("1", "one"), ("2", "two")] {
        let arguments = ["--strategy", "random", "--budget", "20", "--seed", seed, "--out", out, "-q"];
        succeeds(fuzz(dir.path(), &arguments));
    }
    let path = |name: &str| dir.path().join(name);
    let hashes = [studies(&path("one/trials.jsonl")), studies(&path("two/trials.jsonl"))];
    assert_ne!(hashes[0][0], hashes[1][0]);
    let [one, two] = ["one", "two"].map(|out| fs::read_to_string(path(out).join("trials.jsonl")).unwrap());
    let mixed: String = one.lines().take(10).chain(two.lines().skip(10)).map(|line| format!("{line}\n")).collect();
    fs::write(path("one/trials.jsonl"), mixed).unwrap();
    let says = ["trials.jsonl, line 11", &hashes[1][0], &hashes[0][0], "two campaigns were mixed"];
    for command in [
        &["replay", "one", "3"] as &[&str],
        &["map", "one"],
        &["trace", "one"],
        &["blame", "one"],
        &["shrink", "one", "0"],
        &["--strategy", "random", "--budget", "20", "--seed", "1", "--out", "one", "--resume"],
    ] {
        refused(&fuzz(dir.path(), command), &says);
    }
    refused(&cover(dir.path(), &["estimate", "one"]), &says);
}

#[test]
fn the_hash_of_a_study_depends_on_the_study_alone() {
    let dir = tempfile::tempdir().unwrap();
    let mut found = Vec::new();
    for (out, options) in [
        ("a", ["--budget", "3", "--jobs", "1"]),
        ("b", ["--budget", "3", "--jobs", "2"]),
        ("c", ["--budget", "3", "--seed", "7"]),
        ("d", ["--budget", "4", "--jobs", "1"]),
    ] {
        succeeds(fuzz(dir.path(), &[&["--out", out, "-q"], &options[..]].concat()));
        found.push(studies(&dir.path().join(out).join("trials.jsonl"))[0].clone());
    }
    assert!(found.iter().all(|hash| hash.len() == 16 && hash.bytes().all(|byte| byte.is_ascii_hexdigit())));
    assert_eq!(found[0], found[1]);
    assert!(found[2] != found[0] && found[3] != found[0] && found[2] != found[3]);
}
