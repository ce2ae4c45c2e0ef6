//! Campaigns that count the tests of a file as done, or that run them.

use crate::common::{cover, fuzz, golden, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Parameters of which 16 tests have all pairs of values.
const OPEN: &[&str] = &["--open", "speed=1,3,5,7", "--open", "distance=10,20,30,40", "--open", "lanes=2,4,6"];

const OLD: &str = "speed,distance,lanes\n1,10,2\n3,10,6\n5,10,4\n1,20,6\n3,20,2\n7,20,4\n1,30,4\n";

fn extended(dir: &Path, more: &[&str]) -> std::process::Output {
    fuzz(dir, &[OPEN, &["--extend", "old.csv", "--out", "out"], more].concat())
}

fn read(dir: &Path, name: &str) -> String {
    fs::read_to_string(dir.join("out").join(name)).unwrap()
}

#[test]
fn a_campaign_runs_what_the_file_lacks_and_counts_both() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("old.csv"), OLD).unwrap();
    let output = succeeds(extended(dir.path(), &["--format", "json", "--jobs", "2"]));
    assert!(
        stderr(&output).contains("has only 9 tests for these parameters beside the 7 in old.csv"),
        "{}",
        stderr(&output)
    );
    let summary: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&summary["tests"], &summary["coverage"]["tests"]), (&Value::from(9), &Value::from(16)));
    assert_eq!(summary["coverage"]["discrete"]["ratio"], 1.0);
    for line in read(dir.path(), "trials.csv").lines().skip(1) {
        let test = line.split(',').skip(1).take(3).collect::<Vec<_>>().join(",");
        assert!(!OLD.lines().any(|old| old == test), "{test} is there already");
    }
    let study: Value = serde_json::from_str(&read(dir.path(), "campaign.json")).unwrap();
    assert_eq!((&study["extends"]["name"], &study["extends"]["tests"]), (&Value::from("old.csv"), &Value::from(7)));
    assert_eq!(study["extends"]["hash"].as_str().unwrap().len(), 32);

    // The folder stands on its own: the file may go.
    fs::remove_file(dir.path().join("old.csv")).unwrap();
    let estimate = ["estimate", "out", "--time-limit", "5", "--format", "json"];
    assert_eq!(stdout(&succeeds(cover(dir.path(), &estimate))), read(dir.path(), "coverage.json"));
    fs::remove_file(dir.path().join("out/extended.csv")).unwrap();
    succeeds(fuzz(dir.path(), &["replay", "out", "3"]));
    refused(&cover(dir.path(), &estimate), &["cannot read out/extended.csv"]);
    fs::write(dir.path().join("out/extended.csv"), OLD.replace("7,20,4\n", "")).unwrap();
    refused(&cover(dir.path(), &estimate), &["out/extended.csv", "found 6 tests", "the campaign extends 7 tests"]);
}

#[test]
fn the_table_says_what_was_counted() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("old.csv"), OLD).unwrap();
    let table = stdout(&succeeds(extended(dir.path(), &["--format", "table"])));
    let counted =
        table.lines().skip_while(|line| !line.contains("extends")).take_while(|line| !line.contains("written to"));
    let head: String = counted.map(|line| format!("{line}\n")).collect();
    golden("extended.txt", &head);
    fs::write(dir.path().join("all.csv"), OLD.to_owned() + &tests_of(dir.path())).unwrap();
    let nothing = fuzz(dir.path(), &[OPEN, &["--extend", "all.csv", "--out", "none", "--format", "table"]].concat());
    assert!(stderr(&succeeds(nothing)).contains("no test was run: nothing is missing beside the 16 in all.csv"));
}

/// The tests of the campaign, without a header.
fn tests_of(dir: &Path) -> String {
    let table = read(dir, "trials.csv");
    let test = |line: &str| line.split(',').skip(1).take(3).collect::<Vec<_>>().join(",") + "\n";
    table.lines().skip(1).map(test).collect()
}

#[test]
fn a_campaign_goes_on_with_the_same_tests_in_whatever_file_and_with_no_others() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("old.csv"), OLD).unwrap();
    succeeds(extended(dir.path(), &[]));
    let whole = read(dir.path(), "trials.jsonl");
    let log = dir.path().join("out/trials.jsonl");
    fs::write(&log, &whole[..whole.len() / 2]).unwrap();
    // Other columns, in another order, and what is no parameter.
    let columns = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        format!("{} , note,{},{}\n", cells[2], cells[0], cells[1])
    };
    fs::write(dir.path().join("moved.csv"), OLD.lines().map(columns).collect::<String>()).unwrap();
    let resume = |file: &str| fuzz(dir.path(), &[OPEN, &["--extend", file, "--out", "out", "--resume"]].concat());
    succeeds(resume("moved.csv"));
    assert_eq!(read(dir.path(), "trials.jsonl"), whole);

    fs::write(dir.path().join("old.csv"), OLD.to_owned() + "1,10,4\n").unwrap();
    refused(&resume("old.csv"), &["different campaign", "`extends`", "\"tests\":7", "\"tests\":8", "old.csv"]);
    let without = fuzz(dir.path(), &[OPEN, &["--strategy", "greedy", "--out", "out", "--resume"]].concat());
    refused(&without, &["different campaign", "`extends`", "that of this command is nothing"]);
    assert_eq!(read(dir.path(), "trials.jsonl"), whole);
}

#[test]
fn continuous_tests_are_extended_where_they_leave_the_largest_holes() {
    let dir = tempfile::tempdir().unwrap();
    let half: String = (0..200).map(|i| format!("{},{}\n", 0.6 + f64::from(i % 14) / 3.0, 6 + i / 4)).collect();
    fs::write(dir.path().join("old.csv"), format!("speed,distance\n{half}")).unwrap();
    let arguments = ["--extend", "old.csv", "--budget", "20", "--format", "json", "--out"];
    let summary = stdout(&succeeds(fuzz(dir.path(), &[&arguments[..], &["out"]].concat())));
    let coverage = &serde_json::from_str::<Value>(&summary).unwrap()["coverage"];
    assert_eq!(coverage["tests"], 220);
    let dispersion = coverage["continuous"]["dispersion"]["upper"].as_f64().unwrap();
    assert!(dispersion < 0.1, "{dispersion}: half of the space was empty");
    let speeds = tests_of(dir.path()).lines().filter(|line| line.split(',').next().unwrap() > "5").count();
    assert!(speeds > 10, "most go where nothing is, {speeds} did");
    refused(
        &fuzz(dir.path(), &[&arguments[..], &["no", "--strategy", "halton"]].concat()),
        &["`halton` does not look at existing tests", "use greedy"],
    );
}

#[test]
fn tests_of_other_parameters_are_refused_with_their_place() {
    let dir = tempfile::tempdir().unwrap();
    let cases: [(&str, &[&str]); 5] = [
        (&OLD.replace("distance", "distanc"), &["old.csv, line 1", "`distance`", "is it `distanc`?"]),
        (&OLD.replace("3,20,2", "3,25,2"), &["old.csv, line 6", "`distance`", "found 25", "10, 20, 30, 40"]),
        (&OLD.replace("3,20,2", "3,,2"), &["old.csv, line 6", "`distance`", "found an empty cell, expected a value"]),
        (
            "speed,distance,lanes,friction\n1,10,2,0.8\n3,10,2,0.5\n",
            &["old.csv, line 3", "found 0.5, but `friction` is fixed at 0.8", "--open friction"],
        ),
        ("", &["old.csv", "empty"]),
    ];
    for (text, says) in cases {
        fs::write(dir.path().join("old.csv"), text).unwrap();
        refused(&extended(dir.path(), &[]), says);
    }
    fs::write(dir.path().join("old.csv"), OLD).unwrap();
    let fixed = ["--open", "speed=1,3,5,7", "--open", "distance=10,20,30,40", "--extend", "old.csv", "--out", "out"];
    refused(&fuzz(dir.path(), &fixed), &["old.csv, line 3", "found 6, but `lanes` is fixed at 2", "--open lanes"]);
    fs::create_dir(dir.path().join("folder")).unwrap();
    refused(&fuzz(dir.path(), &["--extend", "folder"]), &["folder is a folder", "folder/trials.csv"]);
    assert!(!dir.path().join("out").exists() && !dir.path().join("paracosm-out").exists());
}

#[test]
fn the_tests_of_a_file_run_in_their_order_and_the_campaign_is_as_any_other() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("old.csv"), OLD).unwrap();
    let given =
        |out: &str, more: &[&str]| fuzz(dir.path(), &[OPEN, &["--tests", "old.csv", "--out", out], more].concat());
    let summary = succeeds(given("out", &["--format", "json"]));
    assert_eq!(stderr(&summary), "no failure map: a map needs two open continuous parameters\n");
    let summary: Value = serde_json::from_str(&stdout(&summary)).unwrap();
    assert_eq!((&summary["tests"], &summary["coverage"]["tests"]), (&Value::from(7), &Value::from(7)));
    let trials = read(dir.path(), "trials.csv");
    let tests = trials.lines().skip(1).map(|line| line.split(',').skip(1).take(3).collect::<Vec<_>>().join(","));
    assert_eq!(tests.collect::<Vec<_>>(), OLD.lines().skip(1).collect::<Vec<_>>());
    // It is continued and repeated without the file, and its coverage is that of the tests alone.
    let whole = read(dir.path(), "trials.jsonl");
    let cut: String = whole.split_inclusive('\n').take(3).collect();
    fs::write(dir.path().join("out/trials.jsonl"), cut).unwrap();
    succeeds(given("out", &["--resume", "--jobs", "1"]));
    assert_eq!(read(dir.path(), "trials.jsonl"), whole);
    fs::remove_file(dir.path().join("old.csv")).unwrap();
    let again = stdout(&succeeds(fuzz(dir.path(), &["repeat", "out", "--out", "again"])));
    assert!(again.contains("7 of 7 tests"), "{again}");
    let coverage = stdout(&succeeds(cover(dir.path(), &["estimate", "out", "--k", "2", "--format", "json"])));
    assert_eq!(serde_json::from_str::<Value>(&coverage).unwrap()["tests"], 7, "{coverage}");
}

#[test]
fn tests_that_cannot_run_are_refused_and_tests_that_break_a_constraint_are_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let given = |tests: &str, more: &[&str]| {
        fs::write(dir.path().join("t.csv"), tests).unwrap();
        fuzz(dir.path(), &[&["--tests", "t.csv"], more].concat())
    };
    refused(
        &given("speed,distance\n2,20\n2,200\n", &[]),
        &["t.csv, line 3", "`distance`: found 200, expected a number in [5, 60]"],
    );
    refused(&given("speed\n2\n", &[]), &["t.csv, line 1", "no column is called `distance`"]);
    refused(&given("speed,distance\n", &[]), &["no file has a test"]);
    refused(&fuzz(dir.path(), &["--strategy", "given"]), &["`given` runs the tests of a file", "--tests TESTS.csv"]);
    let output = given("speed,distance\n2,20\n", &["--seed", "1"]);
    assert!(stderr(&output).contains("'--tests <TESTS.csv>' cannot be used with '--seed <N>'"), "{}", stderr(&output));
    let space = "constraints = [\"x < 0.5\"]\nparameter = [{ name = \"x\", interval = [0, 1] }]\n";
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let answer = r#"while read -r line; do i=${line#*:}; echo "{\"index\":${i%%,*},\"robustness\":{\"r\":1}}"; done"#;
    fs::write(dir.path().join("system.sh"), answer).unwrap();
    let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "--out", "system"];
    let output = succeeds(given("x\n0.25\n0.75\n0.125\n", &system));
    let note = "1 test of the 3 in t.csv covers nothing: test 2 breaks `x < 0.5`; the campaign runs only tests that break none";
    assert!(stderr(&output).contains(note), "{}", stderr(&output));
    let trials = fs::read_to_string(dir.path().join("system/trials.csv")).unwrap();
    assert!(
        trials.lines().nth(1).unwrap().starts_with("0,0.25,pass")
            && trials.lines().nth(2).unwrap().starts_with("1,0.125,pass"),
        "{trials}"
    );
    assert_eq!(trials.lines().count(), 3);
}

#[test]
fn a_campaign_runs_the_numbers_of_a_file_to_the_last_digit() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    // Through the unit cube, 1.3 of 0.5..10 would become 1.3000000000000003, and 6.9 would become 6.900000000000001.
    fs::write(dir.join("t.csv"), "speed,distance\n1.3,57.7\n6.9,50.7\n").unwrap();
    let given = ["--tests", "t.csv"];
    succeeds(fuzz(dir, &[&given[..], &["--out", "a"]].concat()));
    let log = fs::read_to_string(dir.join("a/trials.jsonl")).unwrap();
    let line = |at: usize| serde_json::from_str::<serde_json::Value>(log.lines().nth(at).unwrap()).unwrap();
    assert_eq!(log.lines().count(), 2);
    assert_eq!(line(0)["test"], serde_json::json!({"speed": 1.3, "distance": 57.7}));
    assert_eq!(line(1)["test"], serde_json::json!({"speed": 6.9, "distance": 50.7}));
    succeeds(fuzz(dir, &["--set", "speed=1.3", "--set", "distance=57.7", "--out", "one"]));
    let one = fs::read_to_string(dir.join("one/trials.jsonl")).unwrap();
    let one: serde_json::Value = serde_json::from_str(one.lines().next().unwrap()).unwrap();
    assert_eq!(one["trace_hash"], line(0)["trace_hash"], "--set runs the same test");
    // A campaign that is cut off and continued has the same bytes, and can be repeated.
    let first = log.lines().next().unwrap();
    fs::write(dir.join("a/trials.jsonl"), format!("{first}\n")).unwrap();
    succeeds(fuzz(dir, &[&given[..], &["--out", "a", "--resume"]].concat()));
    assert_eq!(fs::read_to_string(dir.join("a/trials.jsonl")).unwrap(), log);
    succeeds(fuzz(dir, &["repeat", "a", "--out", "again"]));
}

#[test]
fn a_constraint_judges_the_numbers_of_a_file_as_they_are_written() {
    let dir = tempfile::tempdir().unwrap();
    let answer = r#"i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"above\":1}}""#;
    fs::write(dir.path().join("system.sh"), format!("while read -r line; do {answer}; done\n")).unwrap();
    let speed = "[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10]\n";
    fs::write(dir.path().join("SPACE.toml"), format!("constraints = [\"speed <= 6.9\"]\n{speed}")).unwrap();
    fs::write(dir.path().join("t.csv"), "speed\n6.9\n7\n1.3\n").unwrap();
    let run = ["run", "--system", "sh system.sh", "--space", "SPACE.toml", "--tests", "t.csv"];
    let output = succeeds(fuzz(dir.path(), &run));
    assert!(stderr(&output).contains("1 test of the 3 in t.csv covers nothing: test 2 breaks"), "{}", stderr(&output));
    let log = fs::read_to_string(dir.path().join("paracosm-out/trials.jsonl")).unwrap();
    let tests: Vec<serde_json::Value> = log
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["test"]["speed"].clone())
        .collect();
    assert_eq!(tests, [6.9, 1.3]);
}

#[test]
fn the_strategy_of_a_file_needs_the_file_also_with_extend() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("t.csv"), "speed,distance\n2,20\n").unwrap();
    refused(&fuzz(dir.path(), &["--strategy", "given", "--extend", "t.csv"]), &["--tests TESTS.csv"]);
}
