//! `paracosm-cover plan` as a user gives it.

use crate::common::{cover, golden, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::time::{Duration, Instant};

const SPACE: &str = "\
[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n\
[[parameter]]\nname = \"distance\"\ninterval = [5, 60]\n\
[[parameter]]\nname = \"lanes\"\nchoice = [2, 4]\n\
[[parameter]]\nname = \"lit\"\nchoice = [\"no\", \"yes\"]\n\
[[parameter]]\nname = \"wet\"\nchoice = [\"no\", \"yes\"]\n";

#[test]
fn a_plan_says_of_every_number_what_it_guarantees() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let plan = ["plan", "--space", "SPACE.toml", "--k", "2", "--epsilon", "0.1", "--delta", "0.05"];
    golden("plan.txt", &stdout(&succeeds(cover(dir.path(), &[&plan[..], &["--format", "table"]].concat()))));
    golden("plan.json", &stdout(&succeeds(cover(dir.path(), &[&plan[..], &["--format", "json"]].concat()))));
}

#[test]
fn under_constraints_random_rows_are_planned_with_the_probabilities_that_these_leave() {
    let dir = tempfile::tempdir().unwrap();
    let space = format!("constraints = [\"lanes == 2 implies lit == 'no'\"]\n{SPACE}");
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let plan = ["plan", "--space", "SPACE.toml", "--format", "table"];
    golden("plan-constraints.txt", &stdout(&succeeds(cover(dir.path(), &plan))));
}

#[test]
fn an_array_that_is_not_made_in_time_is_given_up_and_its_bounds_are_said() {
    let dir = tempfile::tempdir().unwrap();
    let parameter = |i| format!("[[parameter]]\nname = \"p{i}\"\nchoice = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n");
    fs::write(dir.path().join("SPACE.toml"), (0..16).map(parameter).collect::<String>()).unwrap();
    let plan = |more: &[&str]| {
        let plan = ["plan", "--space", "SPACE.toml", "--format", "table"];
        stdout(&succeeds(cover(dir.path(), &[&plan, more].concat())))
    };
    golden("plan-given-up.txt", &plan(&["--k", "5", "--time-limit", "0.1"]));
    // So many combinations are not even tried.
    let not_tried = plan(&["--k", "8"]);
    assert!(not_tried.contains("over 99999999  not made"), "{not_tried}");
}

#[test]
fn beyond_three_dimensions_one_is_told_to_rely_on_what_was_measured() {
    let dir = tempfile::tempdir().unwrap();
    let plan = |dims: &str| succeeds(cover(dir.path(), &["plan", "--dims", dims, "--epsilon", "0.2"]));
    assert_eq!(stderr(&plan("3")), "");
    assert!(stderr(&plan("4")).contains("rely on the measured numbers"));
}

#[test]
fn an_epsilon_far_too_small_to_measure_is_answered_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let started = Instant::now();
    let plan = ["plan", "--dims", "3", "--epsilon", "1e-300", "--format", "table"];
    let plan = stdout(&succeeds(cover(dir.path(), &plan)));
    assert!(plan.contains("over 10^19  needed by any set") && plan.contains("over 1048576  measured until"), "{plan}");
    assert!(started.elapsed() < Duration::from_secs(5), "{:?}", started.elapsed());
}

#[test]
fn a_plan_that_takes_long_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let plan = ["plan", "--dims", "3", "--epsilon", "1e-5", "--time-limit", "3"];
    let notes = stderr(&succeeds(cover(dir.path(), &plan)));
    assert!(notes.contains("measuring points, at most 3 s (--time-limit)"), "{notes}");
}

#[test]
fn rows_with_different_valid_parts_are_planned_by_making_their_tests() {
    let dir = tempfile::tempdir().unwrap();
    let parameters = "[{ name = \"a\", choice = [1, 2, 3] }, { name = \"b\", choice = [1, 2, 3] }, { name = \"x\", interval = [0, 1] }]";
    let space = format!("constraints = [\"a == 1 or x < 0.5\"]\nparameter = {parameters}\n");
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let demand = ["--space", "SPACE.toml", "--k", "2", "--epsilon", "0.1"];
    let plan = succeeds(cover(dir.path(), &[&["plan", "--format", "json"], &demand[..]].concat()));
    let plan: Value = serde_json::from_str(&stdout(&plan)).unwrap();
    let [need] = plan["tests"].as_array().unwrap().as_slice() else { panic!("{plan}") };
    assert_eq!(need["guarantee"], "proved for this set");
    // It is the number of tests that `generate` makes, and these do what is asked.
    let generate = [&["generate", "--strategy", "greedy", "-q"], &demand[..]].concat();
    let tests = stdout(&succeeds(cover(dir.path(), &generate)));
    assert_eq!(need["tests"], tests.lines().count() - 1);
    fs::write(dir.path().join("tests.csv"), tests).unwrap();
    let estimate = ["estimate", "tests.csv", "--space", "SPACE.toml", "--k", "2", "--format", "json"];
    let estimate: Value = serde_json::from_str(&stdout(&succeeds(cover(dir.path(), &estimate)))).unwrap();
    assert!(estimate["k_epsilon"]["epsilon"].as_f64().unwrap_or(1.0) <= 0.1, "{estimate}");
    // Points for all rows together would say nothing of a row.
    assert_eq!(plan["points"], Value::Null);
    // Without time there is no number, and the plan says so.
    let none = [&["plan", "--format", "table", "--time-limit", "0.000001"], &demand[..]].concat();
    let none = stdout(&succeeds(cover(dir.path(), &none)));
    assert!(none.contains("greedy, the tests of seed 0                over 8  not made: it takes too long"), "{none}");
}

#[test]
fn a_bracket_around_epsilon_is_no_limit_of_time() {
    let dir = tempfile::tempdir().unwrap();
    let parameters = "[{ name = \"speed\", interval = [0, 40] }, { name = \"gap\", interval = [0, 30] }]";
    let space = format!("constraints = [\"speed <= 2 * gap\", \"speed <= 20\"]\nparameter = {parameters}\n");
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    // At 16 points of halton the dispersion is 0.19994 to 0.20004.
    for epsilon in ["0.1999", "0.2", "0.2001", "0.3"] {
        let plan = ["plan", "--space", "SPACE.toml", "--epsilon", epsilon, "--format", "json"];
        let plan: Value = serde_json::from_str(&stdout(&succeeds(cover(dir.path(), &plan)))).unwrap();
        for need in plan["points"].as_array().unwrap() {
            assert!(need["tests"].as_u64().is_some_and(|tests| (4..40).contains(&tests)), "{epsilon}: {need}");
        }
    }
}

#[test]
fn what_cannot_be_planned_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let cases: [(&[&str], &[&str]); 6] = [
        (&[], &["--space <SPACE>|--dims <D>"]),
        (&["--dims", "0"], &["no parameters"]),
        (&["--dims", "2", "--k", "2"], &["--k is a number of discrete parameters"]),
        (&["--space", "SPACE.toml", "--k", "6"], &["k is 6", "has 5 parameters"]),
        (&["--dims", "2", "--epsilon", "1"], &["epsilon is 1", "above 0 and below 1"]),
        (&["--dims", "2", "--delta", "nan"], &["delta is NaN", "above 0 and below 1"]),
    ];
    for (arguments, says) in cases {
        refused(&cover(dir.path(), &[&["plan"], arguments].concat()), says);
    }
}
