//! `repeat` runs a whole campaign again.

use crate::common::{fuzz, stdout, succeeds};
use std::fs;

#[test]
fn a_campaign_repeats_to_the_byte_and_a_test_that_differs_is_named() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["cut-in", "--strategy", "auto", "--seed", "3", "--budget", "40", "--out", "out"]));
    let printed = stdout(&succeeds(fuzz(dir.path(), &["repeat", "out", "--out", "again"])));
    assert!(printed.contains("the same              40 of 40 tests"), "{printed}");
    let log = |folder: &str| fs::read_to_string(dir.path().join(folder).join("trials.jsonl")).unwrap();
    assert_eq!(log("out"), log("again"));
    // Somebody has another trace of the first test that has one, and stopped after 30 tests.
    let mark = "\"trace_hash\":\"";
    let (before, after) = log("out").split_once(mark).map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let index = before.lines().count() - 1;
    let other = format!("{before}{mark}{}{}", "0".repeat(16), &after[16..]);
    let cut: String = other.split_inclusive('\n').take(30).collect();
    fs::write(dir.path().join("out/trials.jsonl"), cut).unwrap();
    let output = fuzz(dir.path(), &["repeat", "out", "--out", "third"]);
    let printed = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{printed}");
    assert!(printed.contains("the same              29 of 30 tests"), "{printed}");
    assert!(printed.contains(&format!("{:<22}another trace: ", format!("test {index}"))), "{printed}");
    assert!(printed.contains("without a pair        10 tests in third"), "{printed}");
}
