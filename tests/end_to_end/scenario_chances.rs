//! The probability of failure of scenarios of files, whose parameters have chances and constraints.

use crate::common::{fuzz, refused, stdout, succeeds};
use crate::scenario_files::folder;
use serde_json::{Value, json};

#[test]
fn the_values_of_a_distribution_that_remain_keep_their_chances() {
    let dir = folder();
    let chances = |file: &str, open: &[&str]| {
        let given = ["likelihood", file, "--driver", "aeb", "--budget", "3", "--format", "json", "--open"];
        let found = stdout(&succeeds(fuzz(dir.path(), &[&given, open].concat())));
        let found: Value = serde_json::from_str(&found).expect("it is JSON");
        found["parameters"].clone()
    };
    // The file has 20 with the weight 1, and 50 with the weight 3.
    let of = |open: &[&str], name: &str| chances("slow-leader-chances.xosc", open)[name].clone();
    assert_eq!(of(&["gap=50,20"], "gap"), json!({"weights": [3, 1]}));
    assert_eq!(of(&["gap=50"], "gap"), json!({"weights": [3]}));
    assert_eq!(of(&["speed=30..40"], "speed"), json!({"normal": [35, 5]}));
    assert_eq!(of(&["speed=30,40"], "speed"), "uniform");
    // A distribution that is given takes the place of the distribution of the file.
    assert_eq!(of(&["gap=50,20", "--distribution", "gap=weights:1,2"], "gap"), json!({"weights": [1, 2]}));
    let of = |open: &str, name: &str| chances("slow-leader-shapes.xosc", &[open])[name].clone();
    assert_eq!(of("speed=30,29", "speed")["weights"].as_array().map(Vec::len), Some(2));
    assert_eq!(of("start=46..49", "start"), "uniform");
}

#[test]
fn the_probability_of_failure_is_that_of_tests_that_keep_the_constraints() {
    let dir = folder();
    let given = ["likelihood", "slow-leader-variation.xosc", "--continuous", "--driver", "aeb", "--budget", "50"];
    // The speed is at most 50 m/s by a constraint.
    let narrow = [&given[..], &["--open", "speed=20..45", "--method", "qmc"]].concat();
    let whole = stdout(&succeeds(fuzz(dir.path(), &narrow)));
    assert!(!whole.contains("keep the constraints"), "{whole}");
    let part = stdout(&succeeds(fuzz(dir.path(), &given)));
    assert!(part.contains("the probability is that of tests that keep the constraints: 50 of "), "{part}");
    let qmc = [&given[..], &["--method", "qmc"]].concat();
    refused(&fuzz(dir.path(), &qmc), &["the method qmc needs the whole space"]);
}
