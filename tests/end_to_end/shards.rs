//! Campaigns in shards, and the campaign that they make together.

use crate::common::{files, fuzz, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Runs all shards of a campaign into the folders `s1`, `s2` and so on, and merges them into `all`; then runs the whole campaign into `one`.
fn in_shards(dir: &Path, campaign: &[&str], of: usize) {
    let mut merge = vec!["merge".to_owned(), "all".to_owned()];
    // Shards run in any order, with any number of jobs.
    for number in (1..=of).rev() {
        let (shard, out) = (format!("{number}/{of}"), format!("s{number}"));
        let jobs = if number % 2 == 0 { "1" } else { "2" };
        succeeds(fuzz(dir, &[campaign, &["--shard", &shard, "--out", &out, "--jobs", jobs, "-q"]].concat()));
        merge.push(out);
    }
    succeeds(fuzz(dir, &merge.iter().map(String::as_str).collect::<Vec<_>>()));
    succeeds(fuzz(dir, &[campaign, &["--out", "one", "-q"]].concat()));
}

#[test]
fn merged_shards_are_the_campaign_of_one_machine_byte_for_byte() {
    for (campaign, of) in [
        (&["--budget", "53"][..], 4),
        (&["cut-in", "--strategy", "random", "--budget", "30", "--open", "friction"], 3),
        (&["ncap-ccr", "--k", "2", "--budget", "40"], 5),
        // Less tests than shards, and a grid that ends before its budget.
        (&["--strategy", "sobol", "--budget", "3"], 5),
        (&["grid-traffic", "--set", "speed=9", "--budget", "40"], 3),
    ] {
        let dir = tempfile::tempdir().unwrap();
        in_shards(dir.path(), campaign, of);
        let [all, one] = ["all", "one"].map(|out| files(&dir.path().join(out)));
        assert_eq!(all.keys().collect::<Vec<_>>(), one.keys().collect::<Vec<_>>(), "{campaign:?}");
        for (name, contents) in &one {
            assert!(all[name] == *contents, "{campaign:?}: {name} differs");
        }
    }
}

#[test]
fn shards_of_the_tests_of_a_file_are_merged_byte_for_byte_and_so_are_tests_that_add_to_a_file() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    succeeds(fuzz(dir, &["--budget", "25", "--out", "base", "-q"]));
    for campaign in [&["--tests", "base/trials.csv"][..], &["--extend", "base/trials.csv", "--budget", "20"]] {
        in_shards(dir, campaign, 3);
        assert!(files(&dir.join("all")) == files(&dir.join("one")), "{campaign:?}");
        ["all", "one", "s1", "s2", "s3"].iter().for_each(|folder| fs::remove_dir_all(dir.join(folder)).unwrap());
    }
}

#[test]
fn a_shard_goes_on_after_an_interruption_and_other_commands_do_not_take_it_for_a_campaign() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let shard = |number: &str, more: &[&str]| {
        let options = ["--budget", "40", "--shard", number, "--out", "s2"];
        fuzz(dir, &[&options[..], more].concat())
    };
    succeeds(shard("2/4", &[]));
    let whole = fs::read_to_string(dir.join("s2/trials.jsonl")).unwrap();
    assert_eq!(whole.lines().count(), 10);
    // The process was killed within a line.
    fs::write(dir.join("s2/trials.jsonl"), &whole[..whole.len() / 2]).unwrap();
    fs::write(dir.join("s2/shard.json"), "{\"shard\":2,\"of\":4}\n").unwrap();
    refused(&fuzz(dir, &["merge", "all", "s2"]), &["s2 holds shard 2/4, which has not ended", "--resume"]);
    succeeds(shard("2/4", &["--resume"]));
    assert_eq!(fs::read_to_string(dir.join("s2/trials.jsonl")).unwrap(), whole);
    assert_eq!(fs::read_to_string(dir.join("s2/shard.json")).unwrap(), "{\"shard\":2,\"of\":4,\"tests\":10}\n");
    refused(&shard("2/4", &[]), &["holds a campaign already"]);
    refused(&shard("3/4", &["--resume"]), &["s2 holds shard 2/4, and this command runs shard 3/4"]);
    for command in [&["map", "s2"][..], &["replay", "s2", "11"], &["--budget", "40", "--out", "s2", "--resume"]] {
        refused(&fuzz(dir, command), &["s2 holds shard 2/4 of a campaign, and no whole campaign", "`merge`"]);
    }
}

#[test]
fn shards_that_are_no_whole_campaign_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let shard = |number: &str, out: &str, more: &[&str]| {
        let options = ["--shard", number, "--out", out, "-q"];
        succeeds(fuzz(dir, &[&options[..], more].concat()))
    };
    for number in ["1", "2", "3"] {
        shard(&format!("{number}/3"), &format!("s{number}"), &["--budget", "20"]);
    }
    shard("3/3", "other", &["--budget", "21"]);
    shard("3/4", "of-four", &["--budget", "20"]);
    succeeds(fuzz(dir, &["--budget", "5", "--out", "whole", "-q"]));
    let merge = |shards: &[&str]| fuzz(dir, &[&["merge", "all"], shards].concat());
    refused(&merge(&["s1", "s3"]), &["1 of 3 shards are missing: 2"]);
    refused(&merge(&["s1", "s2", "s3", "s1"]), &["s1 and s1 both hold shard 1/3: give each shard once"]);
    refused(&merge(&["s1", "s2", "other"]), &["s1 and other hold shards of different campaigns", "hashes"]);
    refused(&merge(&["s1", "s2", "of-four"]), &["one is of 3, the other of 4"]);
    refused(&merge(&["s1", "s2", "whole"]), &["whole holds no shard of a campaign"]);
    refused(&merge(&["s1", "s2", "nowhere"]), &["nowhere holds no shard of a campaign"]);
    assert!(!dir.join("all").exists());
    let log = dir.join("s2/trials.jsonl");
    let lines = fs::read_to_string(&log).unwrap();
    fs::write(&log, lines.lines().skip(1).map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    refused(&merge(&["s1", "s2", "s3"]), &["s2/trials.jsonl, line 1: found trial 7, expected trial 6"]);
    for (options, says) in [
        (&["--strategy", "auto"][..], "the strategy auto learns from the outcomes"),
        (&["--stop-at-first", "--strategy", "halton"], "stops at its first failing test"),
        (&["--junit"], "--junit is for a whole campaign"),
    ] {
        refused(&fuzz(dir, &[&["--shard", "1/2", "--out", "x"], options].concat()), &[says]);
        assert!(!dir.join("x").exists(), "{options:?}");
    }
}

#[test]
fn shards_of_a_command_are_merged_by_who_trusts_it_and_their_doubts_stay() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    // Each process answers one test, and breaks at the second.
    let system = r#"while read -r line; do n=$((n+1)); [ $n -gt 1 ] && exit 1
i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"a\":$((i % 5 - 1))}}"; done"#;
    fs::write(dir.join("system.sh"), system).unwrap();
    fs::write(dir.join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [0, 1] }]\n").unwrap();
    let campaign = ["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "12", "-q"];
    for number in ["1", "2"] {
        let (shard, out) = (format!("{number}/2"), format!("s{number}"));
        succeeds(fuzz(dir, &[&campaign[..], &["--shard", &shard, "--out", &out]].concat()));
    }
    refused(&fuzz(dir, &["merge", "all", "s1", "s2"]), &["sh system.sh", "--trust"]);
    assert!(!dir.join("all").exists());
    let merged = fuzz(dir, &["merge", "all", "s1", "s2", "--trust", "--fail-on-violation", "--format", "json"]);
    assert_eq!(merged.status.code(), Some(1), "{}", stderr(&merged));
    let printed: Value = serde_json::from_str(&stdout(&merged)).unwrap();
    assert_eq!(printed["verdicts"]["fail"], 3, "{printed}");
    assert!(printed["doubts"][0].to_string().contains("had a result when"), "{printed}");
    succeeds(fuzz(dir, &[&campaign[..], &["--out", "one"]].concat()));
    assert!(fs::read(dir.join("all/trials.jsonl")).unwrap() == fs::read(dir.join("one/trials.jsonl")).unwrap());
}
