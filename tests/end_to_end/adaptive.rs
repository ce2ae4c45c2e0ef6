//! Campaigns of strategies that learn: repeated, split and resumed they are the same, whatever the number of jobs.

use crate::common::{cover, fuzz, refused, succeeds};
use std::fs;
use std::path::Path;

const STRATEGIES: [&str; 7] = ["anneal", "pso", "nelder-mead", "cmaes", "bayes", "boundary", "auto"];

/// A mixed space: two numbers, one choice.
fn run(dir: &Path, name: &str, strategy: &str, more: &[&str]) -> Vec<u8> {
    let options = ["--budget", "70", "--seed", "1", "--open", "lanes", "-q", "--strategy", strategy, "--out", name];
    succeeds(fuzz(dir, &[&options[..], more].concat()));
    fs::read(dir.join(name).join("trials.jsonl")).unwrap()
}

#[test]
fn trials_do_not_depend_on_the_number_of_jobs_but_on_the_batch() {
    let dir = tempfile::tempdir().unwrap();
    for strategy in STRATEGIES {
        let name = |what: &str| format!("{strategy}-{what}");
        let one = run(dir.path(), &name("one"), strategy, &["--jobs", "1"]);
        assert!(one == run(dir.path(), &name("four"), strategy, &["--jobs", "4", "--batch", "16"]), "{strategy}");
        let other = run(dir.path(), &name("batch"), strategy, &["--batch", "3"]);
        // After every batch another requirement may have its turn.
        assert!(one != other, "{strategy}");
        let study = fs::read_to_string(dir.path().join(name("batch")).join("campaign.json")).unwrap();
        assert!(study.contains("\"batch\": 3"), "{study}");
    }
}

#[test]
fn a_log_cut_anywhere_is_completed_to_the_same_log() {
    let dir = tempfile::tempdir().unwrap();
    for strategy in STRATEGIES {
        let whole = run(dir.path(), strategy, strategy, &[]);
        let path = dir.path().join(strategy).join("trials.jsonl");
        // Within the opening, within a batch, and just before the end.
        for cut in [whole.len() / 10, whole.len() / 2, whole.len() - 2] {
            fs::write(&path, &whole[..cut]).unwrap();
            assert!(run(dir.path(), strategy, strategy, &["--resume"]) == whole, "{strategy}, cut at byte {cut}");
        }
    }
}

#[test]
fn a_resumed_campaign_has_the_batch_it_began_with() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), "out", "cmaes", &["--batch", "5"]);
    let other = ["--budget", "70", "--seed", "1", "--open", "lanes", "--strategy", "cmaes", "--out", "out", "--resume"];
    refused(&fuzz(dir.path(), &other), &["different campaign", "batch", "5", "16"]);
    let none = ["--strategy", "cmaes", "--batch", "0", "--out", "none"];
    refused(&fuzz(dir.path(), &none), &["the batch is 0, expected at least 1 test"]);
}

#[test]
fn where_no_test_is_run_there_is_nothing_to_learn_from() {
    let dir = tempfile::tempdir().unwrap();
    for options in [
        &["estimate", "--strategy", "bayes", "--dims", "2", "--budget", "9"][..],
        &["generate", "--strategy", "bayes", "--dims", "2", "--budget", "9"],
        &["compare", "--strategies", "halton,bayes", "--out", "compared"],
    ] {
        refused(&cover(dir.path(), options), &["`bayes` is adaptive", "paracosm-fuzz run"]);
    }
}
