//! `paracosm-fuzz likelihood` as a user gives it.

use crate::common::{fuzz, golden, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;

const DISTRIBUTED: [&str; 8] = [
    "--open",
    "lanes",
    "--distribution",
    "speed=normal:5,2",
    "--distribution",
    "distance=beta:5,2",
    "--distribution",
    "lanes=weights:3,1,1",
];

fn likelihood(more: &[&str]) -> std::process::Output {
    let dir = tempfile::tempdir().unwrap();
    let output = fuzz(dir.path(), &[&["likelihood"], &DISTRIBUTED[..], more].concat());
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0, "it writes nothing");
    output
}

#[test]
fn a_probability_comes_with_its_interval_and_what_it_was_taken_under() {
    let output = succeeds(likelihood(&["--budget", "400", "--format", "table"]));
    golden("likelihood.txt", &stdout(&output));
    assert!(!stdout(&output).contains("safe") && stderr(&output).is_empty());
    golden("likelihood.json", &stdout(&succeeds(likelihood(&["--budget", "400", "--format", "json"]))));
}

#[test]
fn the_methods_agree_whatever_the_number_of_jobs() {
    let mut highest_lower: f64 = 0.0;
    let mut least_upper: f64 = 1.0;
    for (method, budget) in [("monte-carlo", 800), ("qmc", 800), ("subset", 2000)] {
        let tests = budget.to_string();
        let run = |jobs| {
            stdout(&succeeds(likelihood(&["--method", method, "--budget", &tests, "--jobs", jobs, "--format", "json"])))
        };
        let found = run("1");
        assert_eq!(found, run("3"), "{method}");
        let found: Value = serde_json::from_str(&found).unwrap();
        let number = |name: &str| found[name].as_f64().unwrap();
        assert!(number("lower") <= number("probability") && number("probability") <= number("upper"));
        assert!(number("evaluations") <= f64::from(budget));
        highest_lower = highest_lower.max(number("lower"));
        least_upper = least_upper.min(number("upper"));
    }
    assert!(highest_lower < least_upper, "the intervals of the methods have nothing in common");
}

#[test]
fn what_cannot_be_asked_is_refused_in_words() {
    let dir = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &[&str]); 11] = [
        (&["pedestrian-crosing"], &["`pedestrian-crossing`"]),
        (&["--distribution", "speed=beat:1,2"], &["`beat`", "`beta`"]),
        (&["--distribution", "speed"], &["NAME=DISTRIBUTION"]),
        (&["--distribution", "spede=beta:1,2"], &["`spede`", "`speed`"]),
        (&["--distribution", "friction=beta:1,2"], &["`friction`", "--open friction"]),
        (&["--distribution", "speed=weights:1,2"], &["`speed`", "choice"]),
        (&["--distribution", "speed=uniform", "--distribution", "speed=beta:1,2"], &["`speed`", "twice"]),
        (&["--method", "subsett"], &["`subsett`", "`subset`"]),
        (&["--method", "subset", "--budget", "100"], &["100", "at least 2000"]),
        (&["--confidence", "95"], &["confidence is 95", "below 1"]),
        (&["--budget", "0"], &["budget is 0"]),
    ];
    for (arguments, says) in cases {
        refused(&fuzz(dir.path(), &[&["likelihood"], arguments].concat()), says);
    }
}

#[test]
fn a_system_of_ones_own_has_the_distributions_of_its_space() {
    let dir = tempfile::tempdir().unwrap();
    // A test fails where x is below 0.
    let read = "i=${line#*:}; i=${i%%,*}; x=${line#*'\"x\":'}; x=${x%%\\}*}";
    let answer = r#"echo "{\"index\":$i,\"robustness\":{\"above\":$x}}""#;
    fs::write(dir.path().join("system.sh"), format!("while read -r line; do {read}\n{answer}\ndone\n")).unwrap();
    let space = |distribution: &str| {
        let text = format!("[[parameter]]\nname = \"x\"\ninterval = [-1, 1]\n{distribution}\n");
        fs::write(dir.path().join("SPACE.toml"), text).unwrap();
    };
    let system = [
        "likelihood",
        "--system",
        "sh system.sh",
        "--space",
        "SPACE.toml",
        "--budget",
        "600",
        "--confidence",
        "0.999",
        "--format",
        "json",
    ];
    let ask = || -> Value { serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &system)))).unwrap() };
    // (1 + x)^2 / 2.4 of the triangle with the mode 0.2 lies below x.
    for (distribution, truth) in [("", 0.5), ("distribution = { triangular = 0.2 }", 1.0 / 2.4)] {
        space(distribution);
        let found = ask();
        let number = |name: &str| found[name].as_f64().unwrap();
        assert!(number("lower") < truth && truth < number("upper"), "{found}");
    }
    space("distribution = { beat = [2, 5] }");
    refused(&fuzz(dir.path(), &system), &["SPACE.toml", "`beat`", "`beta`"]);
}
