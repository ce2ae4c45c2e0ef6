//! Constraints that compute with continuous parameters, from the file of a space to the tests of a campaign.

use crate::common::{cover, fuzz, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

const SPACE: &str = "constraints = [\"gap >= 0.5 * speed\", \"weather == 'fog' implies speed < 0.1 * gap + 2\"]\n\
    parameter = [{ name = \"speed\", interval = [0, 10] }, { name = \"gap\", interval = [0, 20] },\n\
    { name = \"weather\", choice = [\"clear\", \"rain\", \"fog\"] }, { name = \"lanes\", choice = [2, 4] }]\n";

/// A system whose robustness is least at the edge of the valid part. It notes each test that it gets.
const SYSTEM: &str = r#"while read -r line; do
echo "$line" >> asked
i=${line#*:}; i=${i%%,*}; speed=${line#*'"speed":'}; speed=${speed%%,*}; gap=${line#*'"gap":'}; gap=${gap%%,*}
awk "BEGIN { printf \"{\\\"index\\\":$i,\\\"robustness\\\":{\\\"room\\\":%.9f}}\\n\", $gap - 0.5 * $speed - 1 }"
done
"#;

fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    fs::write(dir.path().join("system.sh"), SYSTEM).unwrap();
    dir
}

fn run(dir: &Path, out: &str, more: &[&str]) -> Output {
    let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "-q", "--out", out];
    fuzz(dir, &[&system[..], more].concat())
}

fn log(dir: &Path, out: &str) -> String {
    fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap()
}

/// Checks that a test with these values keeps the constraints of `SPACE`.
#[track_caller]
fn keeps(speed: f64, gap: f64, weather: &str) {
    assert!(gap >= 0.5 * speed && (weather != "fog" || speed < 0.1 * gap + 2.0), "{speed} {gap} {weather}");
}

/// Checks all tests that the system was asked about so far.
#[track_caller]
fn asked_for_valid_tests(dir: &Path) {
    for line in fs::read_to_string(dir.join("asked")).unwrap().lines() {
        let asked: Value = serde_json::from_str(line).unwrap();
        let test = &asked["test"];
        keeps(test["speed"].as_f64().unwrap(), test["gap"].as_f64().unwrap(), test["weather"].as_str().unwrap());
    }
}

fn strategies(dir: &Path) -> Vec<String> {
    let listed = succeeds(fuzz(dir, &["list", "strategies", "--format", "json"]));
    let listed: Value = serde_json::from_str(&stdout(&listed)).unwrap();
    let named = |strategy: &Value| strategy["name"].as_str().unwrap().to_owned();
    listed["strategies"].as_array().unwrap().iter().map(named).collect()
}

#[test]
fn every_strategy_runs_the_whole_budget_of_valid_tests_however_many_jobs_there_are() {
    let folder = folder();
    let dir = folder.path();
    for strategy in strategies(dir) {
        let options = ["--strategy", &strategy, "--budget", "23"];
        succeeds(run(dir, &strategy, &[&options[..], &["--jobs", "1"]].concat()));
        assert_eq!(log(dir, &strategy).lines().count(), 23, "{strategy}");
        let other = format!("{strategy}-2");
        succeeds(run(dir, &other, &[&options[..], &["--jobs", "2"]].concat()));
        assert_eq!(log(dir, &other), log(dir, &strategy), "{strategy}");
    }
    asked_for_valid_tests(dir);
}

#[test]
fn a_campaign_that_is_cut_short_goes_on_with_the_same_tests() {
    let folder = folder();
    let dir = folder.path();
    for strategy in ["halton", "lhs", "hammersley", "greedy", "cmaes", "bayes"] {
        let options = ["--strategy", strategy, "--budget", "24"];
        succeeds(run(dir, strategy, &options));
        let all = log(dir, strategy);
        let part: String = all.split_inclusive('\n').take(11).collect();
        fs::write(dir.join(strategy).join("trials.jsonl"), part).unwrap();
        succeeds(run(dir, strategy, &[&options[..], &["--resume"]].concat()));
        assert_eq!(log(dir, strategy), all, "{strategy}");
    }
}

#[test]
fn the_simplest_failing_test_keeps_the_constraints_and_a_regression_file_has_to() {
    let folder = folder();
    let dir = folder.path();
    succeeds(run(dir, "out", &["--strategy", "cmaes", "--budget", "60"]));
    let failing =
        log(dir, "out").lines().position(|line| line.contains("\"fail\"")).expect("a failing test").to_string();
    succeeds(fuzz(dir, &["replay", "out", &failing, "--trust"]));
    succeeds(fuzz(dir, &["shrink", "out", &failing, "--trust", "--save", "simple.json"]));
    asked_for_valid_tests(dir);
    succeeds(fuzz(dir, &["replay", "simple.json", "--trust"]));
    let mut file: Value = serde_json::from_str(&fs::read_to_string(dir.join("simple.json")).unwrap()).unwrap();
    (file["test"]["speed"], file["test"]["gap"]) = (8.into(), 1.into());
    fs::write(dir.join("broken.json"), file.to_string()).unwrap();
    let output = fuzz(dir, &["replay", "broken.json", "--trust"]);
    refused(&output, &["broken.json: `test`: the values break the constraint `gap >= 0.5 * speed`"]);
}

#[test]
fn existing_tests_that_break_a_constraint_are_named_and_cover_nothing() {
    let folder = folder();
    let dir = folder.path();
    fs::write(dir.join("old.csv"), "speed,gap,weather,lanes\n1,5,clear,2\n8,1,rain,2\n9,20,fog,4\n").unwrap();
    let says = "2 tests of the 3 in old.csv cover nothing: test 2 breaks `gap >= 0.5 * speed`";
    let space = ["--space", "SPACE.toml"];
    let estimated = succeeds(cover(dir, &[&["estimate", "old.csv"], &space[..]].concat()));
    assert!(stderr(&estimated).contains(says), "{}", stderr(&estimated));
    let added = succeeds(cover(dir, &[&["generate", "--extend", "old.csv", "--budget", "9"], &space[..]].concat()));
    assert!(stderr(&added).contains(says), "{}", stderr(&added));
    // `rain` and `fog` are not covered yet, whatever the lanes are.
    for combination in ["clear,4", "rain,2", "rain,4", "fog,2", "fog,4"] {
        assert!(stdout(&added).contains(combination), "{combination}: {}", stdout(&added));
    }
    let system = ["--system", "sh system.sh", "--out", "out", "--extend", "old.csv", "--budget", "5"];
    let extended = succeeds(fuzz(dir, &[&system[..], &space].concat()));
    assert!(stderr(&extended).contains(says), "{}", stderr(&extended));
    asked_for_valid_tests(dir);
}

#[test]
fn each_family_gives_the_budget_and_a_strategy_without_a_valid_test_says_so() {
    let folder = folder();
    let dir = folder.path();
    for strategy in ["random", "halton", "hammersley", "fibonacci", "lhs", "lhs-centred", "greedy"] {
        for family in ["ipog", "random", "cross"] {
            for budget in [1, 20] {
                let number = budget.to_string();
                let arguments = ["generate", "--space", "SPACE.toml", "--strategy", strategy, "--discrete", family];
                let generated = stdout(&succeeds(cover(dir, &[&arguments[..], &["--budget", &number]].concat())));
                assert_eq!(generated.lines().count(), 1 + budget, "{strategy} {family}");
                for line in generated.lines().skip(1) {
                    let cells: Vec<&str> = line.split(',').collect();
                    keeps(cells[0].parse().unwrap(), cells[1].parse().unwrap(), cells[2]);
                }
            }
        }
    }
    let inside = "constraints = [\"speed > 1 and speed < 9\"]\nparameter = [{ name = \"speed\", interval = [0, 10] }, \
        { name = \"gap\", interval = [0, 20] }, { name = \"weather\", choice = [\"clear\", \"fog\"] }]\n";
    fs::write(dir.join("SPACE.toml"), inside).unwrap();
    let says = "random-corners found no test that keeps the constraints; use another strategy";
    let corners = ["--strategy", "random-corners", "--budget", "5"];
    refused(&cover(dir, &[&["generate", "--space", "SPACE.toml"], &corners[..]].concat()), &[says]);
    refused(&run(dir, "corners", &corners), &[says]);
}

#[test]
fn continuous_parameters_may_have_to_differ_but_not_to_be_equal() {
    let folder = folder();
    let dir = folder.path();
    let constrained = |constraint: &str| {
        let text = format!(
            "constraints = [\"{constraint}\"]\nparameter = [{{ name = \"speed\", interval = [0, 10] }}, \
             {{ name = \"gap\", interval = [0, 20] }}]\n"
        );
        fs::write(dir.join("SPACE.toml"), text).unwrap();
    };
    fs::write(dir.join("old.csv"), "speed,gap\n1,2\n3,3\n").unwrap();
    constrained("speed != gap");
    let estimate = ["estimate", "old.csv", "--space", "SPACE.toml", "--format", "table"];
    let estimated = stdout(&succeeds(cover(dir, &estimate)));
    for row in ["valid share           1 of the box", "dispersion            0.9\n", "violate constraints   1 test"] {
        assert!(estimated.contains(row), "{row}: {estimated}");
    }
    let generate = ["generate", "--space", "SPACE.toml", "--budget", "30"];
    assert_eq!(stdout(&succeeds(cover(dir, &generate))).lines().count(), 31);
    constrained("speed == gap");
    refused(
        &cover(dir, &generate),
        &["line 1: column 17: `speed` is continuous, so hardly any test keeps an equation"],
    );
    constrained("abs(speed - gap) <= 0");
    refused(&cover(dir, &generate), &["only 0 of 2048 tests keep the constraints", "`abs(speed - gap) <= 0`"]);
    let estimated = stdout(&succeeds(cover(dir, &estimate)));
    assert!(estimated.contains("valid share           0..0.00"), "{estimated}");
}
