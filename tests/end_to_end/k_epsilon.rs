//! (k, epsilon)-covering sets as users ask for them and are told of them.

use crate::common::{cover, refused, stderr, stdout, succeeds};
use crate::mixed_space::{SPACE, discrete_space, generated, measured, rows};
use serde_json::Value;
use std::fs;

#[test]
fn every_row_gets_points_until_none_has_a_larger_hole_than_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    for strategy in ["halton", "greedy"] {
        let arguments = ["--space", "SPACE.toml", "--strategy", strategy, "--k", "2", "--epsilon", "0.2"];
        let (csv, notes) = generated(dir.path(), &arguments);
        assert!(notes.contains("-covering: measured"), "{notes}");
        fs::write(dir.path().join("tests.csv"), csv).unwrap();
        let reached = &measured(dir.path(), &["tests.csv", "--space", "SPACE.toml"])["k_epsilon"];
        assert_eq!(reached["complete"], true);
        assert!(reached["epsilon"].as_f64().unwrap() <= 0.2, "{reached}");
    }
    refused(
        &cover(dir.path(), &["generate", "--space", "SPACE.toml", "--strategy", "lhs", "--epsilon", "0.2"]),
        &["`lhs` must know the number of tests beforehand", "halton or greedy"],
    );
}

#[test]
fn tests_that_do_not_reach_epsilon_in_time_are_printed_with_what_they_reach() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let (csv, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--epsilon", "1e-9", "--time-limit", "0.2"]);
    assert!(
        notes.contains("the --time-limit of 0.2 s ended the search before epsilon 0.000000001 was reached"),
        "{notes}"
    );
    // What was reached stands in the notes, measured; it is not what was asked for.
    let reached = notes.split("(2, ").nth(1).and_then(|rest| rest.split(')').next()).expect("what was reached");
    assert!(reached.parse::<f64>().unwrap() > 1e-9, "{notes}");
    assert!(notes.contains(&format!("{} tests by halton", rows(&csv).len())), "{notes}");
    let (csv, _) = generated(dir.path(), &["--space", "SPACE.toml", "--epsilon", "0.1", "--time-limit", "0"]);
    assert_eq!(rows(&csv).len(), 0);
    let without = cover(dir.path(), &["generate", "--space", "SPACE.toml", "--time-limit", "1"]);
    refused(&without, &["--epsilon"]);
}

#[test]
fn a_budget_alone_says_the_k_and_epsilon_that_it_reached() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let (csv, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--budget", "60"]);
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let reached = &measured(dir.path(), &["tests.csv", "--space", "SPACE.toml"])["k_epsilon"];
    let epsilon: f64 = notes.split("(2, ").nth(1).and_then(|rest| rest.split(')').next()).unwrap().parse().unwrap();
    assert!((epsilon - reached["epsilon"].as_f64().unwrap()).abs() < 1e-4 * epsilon, "{notes}{reached}");
}

#[test]
fn a_time_limit_that_comes_after_epsilon_is_no_complaint() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let epsilon = ["--space", "SPACE.toml", "--strategy", "halton", "--epsilon", "0.3"];
    let (csv, _) = generated(dir.path(), &epsilon);
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let again = [&epsilon[..], &["--extend", "tests.csv", "--time-limit", "0"]].concat();
    let (csv, notes) = generated(dir.path(), &again);
    assert_eq!(rows(&csv).len(), 0);
    assert!(!notes.contains("time limit"), "{notes}");
    assert!(notes.contains("-covering: measured"), "{notes}");
}

#[test]
fn where_fewer_than_k_parameters_are_discrete_all_their_combinations_are_covered() {
    let dir = tempfile::tempdir().unwrap();
    let axis = |name| format!("[[parameter]]\nname = \"{name}\"\ninterval = [0, 1]\n");
    let space = axis("x") + &axis("y") + "[[parameter]]\nname = \"a\"\nchoice = [1, 2, 3]\n";
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let space = ["--space", "SPACE.toml"];
    let says = "k is 2, but only 1 parameter is discrete: k is 1 for discrete parameters\n";
    let (csv, notes) = generated(dir.path(), &[&space[..], &["--k", "2", "--epsilon", "0.2"]].concat());
    assert!(notes.contains(says) && notes.contains("(1, "), "{notes}");
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let estimate = succeeds(cover(dir.path(), &["estimate", "tests.csv", "--space", "SPACE.toml", "--k", "2"]));
    assert_eq!(stderr(&estimate), says);
    let plan = succeeds(cover(
        dir.path(),
        &["plan", "--space", "SPACE.toml", "--k", "2", "--epsilon", "0.2", "--format", "json"],
    ));
    assert_eq!(stderr(&plan), says);
    assert_eq!(serde_json::from_str::<Value>(&stdout(&plan)).unwrap()["k"], 1);
    // Without --k there is nothing to say, and beyond all parameters nothing to cover.
    for verb in ["generate", "plan"] {
        let quiet = succeeds(cover(dir.path(), &[&[verb][..], &space].concat()));
        assert!(!stderr(&quiet).contains("k is"), "{}", stderr(&quiet));
        refused(&cover(dir.path(), &[&[verb][..], &space, &["--k", "4"]].concat()), &["k is 4", "3 parameters"]);
    }
    refused(&cover(dir.path(), &["estimate", "tests.csv", "--space", "SPACE.toml", "--k", "4"]), &["k is 4", "1 to 3"]);
}

#[test]
fn k_wise_coverage_brings_k_and_epsilon_with_it_and_nothing_else_does() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    fs::write(dir.path().join("DISCRETE.toml"), discrete_space()).unwrap();
    let (csv, _) = generated(dir.path(), &["--space", "SPACE.toml", "--budget", "60"]);
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let of = |space: &str, measures: &[&str]| {
        let estimate = ["tests.csv", "--space", space];
        measured(dir.path(), &[&estimate[..], measures].concat())["k_epsilon"].clone()
    };
    let all = of("SPACE.toml", &[]);
    assert!(all["epsilon"].as_f64().unwrap() > 0.0, "{all}");
    assert_eq!(of("SPACE.toml", &["--measures", "k-wise"]), all);
    assert_eq!(of("SPACE.toml", &["--measures", "dispersion,k-wise-dispersion"]), Value::Null);
    // Without anything continuous a row leaves no hole.
    assert_eq!(of("DISCRETE.toml", &["--measures", "k-wise"])["epsilon"], 0.0);
}
