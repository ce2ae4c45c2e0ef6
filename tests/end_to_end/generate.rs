//! `paracosm-cover generate` as a user gives it: tests as CSV, and those that a test set lacks.

use crate::common::{cover, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;

const SPACE: &str = "\
[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n\
[[parameter]]\nname = \"lanes\"\nchoice = [2, 4, 6]\n\
[[parameter]]\nname = \"sky, today\"\nchoice = [\"clear\", \"rain\"]\n";

fn generated(dir: &Path, arguments: &[&str]) -> String {
    stdout(&succeeds(cover(dir, &[&["generate"], arguments].concat())))
}

/// The value at a path of what `estimate` prints as JSON.
fn measured(dir: &Path, arguments: &[&str], path: &str) -> f64 {
    let printed = stdout(&succeeds(cover(dir, &[&["estimate", "--format", "json"], arguments].concat())));
    let json: serde_json::Value = serde_json::from_str(&printed).unwrap();
    json.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("no number {path} in {printed}"))
}

#[test]
fn the_tests_are_the_strategy_s_and_a_sequence_goes_on_where_it_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let four = generated(dir.path(), &["--dims", "2", "--budget", "4"]);
    let expected = "x1,x2\n0.5,0.3333333333333333\n0.25,0.6666666666666666\n0.75,0.1111111111111111\n\
                    0.125,0.4444444444444444\n";
    assert_eq!(four, expected);
    let later = generated(dir.path(), &["--dims", "2", "--budget", "2", "--skip", "3"]);
    assert_eq!(later.lines().skip(1).collect::<Vec<_>>(), expected.lines().skip(3).collect::<Vec<_>>());
}

#[test]
fn values_are_written_as_the_space_writes_them_and_read_back_as_the_same_tests() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let arguments = ["--space", "SPACE.toml", "--strategy", "greedy", "--budget", "30", "--seed", "5"];
    let csv = generated(dir.path(), &arguments);
    assert!(csv.starts_with("speed,lanes,\"sky, today\"\n"), "{csv}");
    assert_eq!(csv.lines().count(), 31);
    assert_eq!(generated(dir.path(), &arguments), csv, "the seed decides");
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let estimate = ["tests.csv", "--space", "SPACE.toml"];
    assert_eq!(measured(dir.path(), &estimate, "/discrete/ratio"), 1.0);
    assert!(measured(dir.path(), &estimate, "/k_wise_dispersion/upper") < 0.25);
}

#[test]
fn a_space_without_continuous_parameters_gives_the_rows_of_the_family_alone() {
    let dir = tempfile::tempdir().unwrap();
    let space = SPACE.split("[[parameter]]").skip(2).map(|rest| format!("[[parameter]]{rest}")).collect::<String>();
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let rows = generated(dir.path(), &["--space", "SPACE.toml", "--discrete", "cross"]);
    assert_eq!(rows, "lanes,\"sky, today\"\n2,clear\n2,rain\n4,clear\n4,rain\n6,clear\n6,rain\n");
}

#[test]
fn what_is_added_to_a_test_set_fills_its_holes() {
    let dir = tempfile::tempdir().unwrap();
    let old = generated(dir.path(), &["--dims", "2", "--budget", "100"]);
    let half: Vec<&str> = old.lines().filter(|line| line.starts_with("x1") || line.starts_with("0.0")).collect();
    fs::write(dir.path().join("old.csv"), half.join("\n") + "\n").unwrap();
    assert!(measured(dir.path(), &["old.csv"], "/continuous/dispersion/lower") > 0.9);
    let added = generated(dir.path(), &["--extend", "old.csv", "--budget", "20"]);
    assert_eq!(added.lines().count(), 21, "those to add, not those there are");
    let all = [&half[..], &added.lines().skip(1).collect::<Vec<_>>()].concat().join("\n");
    fs::write(dir.path().join("all.csv"), all + "\n").unwrap();
    assert!(measured(dir.path(), &["all.csv"], "/continuous/dispersion/upper") < 0.2);
}

#[test]
fn what_cannot_be_generated_is_refused_with_the_reason() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    fs::write(dir.path().join("tests.csv"), "x1,x2\n0.5,1.5\n").unwrap();
    let cases: [(&[&str], &str); 7] = [
        (&["--dims", "0"], "error: the space has no parameters; a generator needs at least one\n"),
        (&["--dims", "2", "--strategy", "haltom"], "error: no strategy is called `haltom` (did you mean `halton`?)\n"),
        (&["--dims", "2", "--budget", "0"], "error: the budget is 0 tests; a budget must be at least 1\n"),
        (
            &["--extend", "tests.csv"],
            "error: tests.csv, line 2: parameter `x2`: found 1.5, expected a number in [0, 1]; name the space of the \
             tests with --space SPACE.toml\n",
        ),
        (
            &["--dims", "3", "--extend", "tests.csv"],
            "error: tests.csv, line 1: no column is called `x3` (is it `x2`?); the columns are x1, x2\n",
        ),
        (
            &["--space", "SPACE.toml", "--measure", "kwise-dispersion"],
            "error: greedy cannot aim at `kwise-dispersion` (did you mean `k-wise-dispersion`?); it can aim at dispersion \
             and k-wise-dispersion\n",
        ),
        (
            &["--space", "SPACE.toml", "--measure", "dispersion"],
            "error: `halton` cannot aim at a measure; use greedy, or give no measure to aim at\n",
        ),
    ];
    for (arguments, message) in cases {
        let output = cover(dir.path(), &[&["generate"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(stderr(&output), message);
        assert_eq!(stdout(&output), "", "no test is written");
    }
}

#[test]
fn what_is_written_is_read_back_whatever_the_words_look_like() {
    let dir = tempfile::tempdir().unwrap();
    let choices = "[[parameter]]\nname = \"a\"\nchoice = [\" x\", \"x\"]\n\
        [[parameter]]\nname = \"b\"\nchoice = [\"1\", \"02\", \"3 \"]\n";
    fs::write(dir.path().join("space.toml"), choices).unwrap();
    let tests = generated(dir.path(), &["--space", "space.toml"]);
    fs::write(dir.path().join("tests.csv"), tests).unwrap();
    let covered = |what| measured(dir.path(), &["tests.csv", "--space", "space.toml"], what);
    assert_eq!((covered("/discrete/covered"), covered("/discrete/valid")), (6.0, 6.0));
}

#[test]
fn tests_that_came_to_nothing_are_not_counted_as_done() {
    let dir = tempfile::tempdir().unwrap();
    let choices = "[[parameter]]\nname = \"a\"\nchoice = [1, 2]\n[[parameter]]\nname = \"b\"\nchoice = [1, 2]\n";
    fs::write(dir.path().join("space.toml"), choices).unwrap();
    let trials = "index,a,b,verdict,error\n0,1,1,pass,\n1,1,2,error,it broke\n2,2,1,invalid,no world\n3,2,2,fail,\n";
    fs::write(dir.path().join("trials.csv"), trials).unwrap();
    let counted = |what| measured(dir.path(), &["trials.csv", "--space", "space.toml"], what);
    assert_eq!((counted("/tests"), counted("/discrete/covered")), (2.0, 2.0));
    let added = generated(dir.path(), &["--space", "space.toml", "--extend", "trials.csv"]);
    assert_eq!(added, "a,b\n2,1\n1,2\n");
}

#[test]
fn numbers_are_written_and_read_as_the_space_writes_them() {
    let dir = tempfile::tempdir().unwrap();
    let files = [
        ("m.pict", "V: 1.1, 1.10, 007\nW: 2.50, 1e3\nIF [V] = 1.1 THEN [W] < 9;\n"),
        (
            "space.toml",
            "constraints = [\"V < 7 implies W < 9\"]\n[[parameter]]\nname = \"V\"\nchoice = [1.10, 1.2, +7]\n\
             [[parameter]]\nname = \"W\"\nchoice = [2.50, 1e3]\n",
        ),
    ];
    let expected = [["1.1,2.50", "1.10,2.50", "007,2.50", "007,1e3"], ["1.10,2.50", "1.2,2.50", "+7,2.50", "+7,1e3"]];
    for ((name, text), expected) in files.into_iter().zip(expected) {
        fs::write(dir.path().join(name), text).unwrap();
        let tests = generated(dir.path(), &["--space", name]);
        let mut rows: Vec<&str> = tests.lines().skip(1).collect();
        rows.sort_by_key(|row| expected.iter().position(|expected| expected == row));
        assert_eq!(rows, expected);
        fs::write(dir.path().join("tests.csv"), &tests).unwrap();
        assert_eq!(measured(dir.path(), &["tests.csv", "--space", name], "/discrete/ratio"), 1.0);
        let added = generated(dir.path(), &["--space", name, "--extend", "tests.csv"]);
        assert_eq!(added, "V,W\n", "all are there");
    }
}

#[test]
fn the_notes_name_the_strategy_that_made_the_tests() {
    let dir = tempfile::tempdir().unwrap();
    let parameter = |name: &str| format!("[[parameter]]\nname = \"{name}\"\ninterval = [0.0, 1.0]\n");
    let parameters = parameter("x") + &parameter("y");
    fs::write(dir.path().join("whole.toml"), &parameters).unwrap();
    fs::write(dir.path().join("part.toml"), format!("constraints = [\"x + y < 1\"]\n{parameters}")).unwrap();
    for (space, strategy, says) in [
        ("whole.toml", "best", "5 tests by best\n"),
        ("part.toml", "best", "5 tests by greedy, which takes the place of best under constraints"),
        ("part.toml", "lhs-maximin", "5 tests by lhs, which takes the place of lhs-maximin under constraints"),
        ("part.toml", "halton", "5 tests by halton\n"),
    ] {
        let arguments = ["generate", "--space", space, "--strategy", strategy, "--budget", "5"];
        let notes = stderr(&succeeds(cover(dir.path(), &arguments)));
        assert!(notes.contains(says), "{space} {strategy}: {notes}");
    }
}
