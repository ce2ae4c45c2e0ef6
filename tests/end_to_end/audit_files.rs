//! Suites of tests as files of OpenSCENARIO: concrete scenarios are audited, and better tests are written as a file.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use crate::exports::{judge, report};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Returns a folder with a scenario, its distribution, and the folder `suite` with three tests of the scenario.
fn folder() -> TempDir {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("standards/tests/scenarios/files");
    let dir = tempfile::tempdir().expect("a folder");
    for name in ["catalogs", "suite", "empty"] {
        fs::create_dir(dir.path().join(name)).expect("it is writable");
    }
    for name in ["straight.xodr", "slow-leader.xosc", "slow-leader-variation.xosc", "catalogs/entities.xosc"] {
        fs::copy(from.join(name), dir.path().join(name)).expect("it is there");
    }
    for (name, speed, gap) in [("b.xosc", "20", "50"), ("a.XOSC", "30.0", "20"), ("c.xosc", "40", "50")] {
        write_test(dir.path(), name, speed, gap);
    }
    fs::write(dir.path().join("suite/notes.txt"), "no scenario").expect("it is writable");
    dir
}

/// Writes a test of the scenario.
fn write_test(dir: &Path, name: &str, speed: &str, gap: &str) {
    let text = fs::read_to_string(dir.join("slow-leader.xosc")).expect("it is there");
    let text =
        text.replace("parameterType=\"double\" value=\"30\"", &format!("parameterType=\"double\" value=\"{speed}\""));
    let text =
        text.replace("parameterType=\"double\" value=\"50\"", &format!("parameterType=\"double\" value=\"{gap}\""));
    fs::write(dir.join("suite").join(name), text).expect("it is writable");
}

const AUDIT: [&str; 4] = ["--mutants", "0", "-q", "--format"];

#[test]
fn a_folder_of_concrete_scenarios_is_a_suite() {
    let dir = folder();
    let files = ["audit", "slow-leader-variation.xosc", "--tests", "suite", "--out", "one"];
    let audited: Value =
        serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &[&files[..], &AUDIT, &["json"]].concat()))))
            .expect("JSON");
    assert_eq!((&audited["suite"], &audited["tests"]), (&"suite".into(), &3.into()));
    // The same tests as a table, and in the scenario itself with its parameters opened.
    fs::write(dir.path().join("tests.csv"), "speed,gap\n30,20\n20,50\n40,50\n").expect("it is writable");
    let opened = ["--open", "speed=20..60", "--open", "gap=10..60"];
    for (scenario, open, out) in [("slow-leader-variation.xosc", &[][..], "v"), ("slow-leader.xosc", &opened[..], "s")]
    {
        let coverages = ["suite", "tests.csv"].map(|tests| {
            let out = format!("{out}-{tests}");
            let given = ["audit", scenario, "--tests", tests, "--out", &out];
            let output = succeeds(fuzz(dir.path(), &[&given[..], open, &AUDIT, &["json"]].concat()));
            let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
            report["coverage"].clone()
        });
        assert_eq!(coverages[0], coverages[1], "{scenario}");
    }
}

#[test]
fn a_folder_that_is_no_suite_of_the_scenario_is_refused() {
    let dir = folder();
    let audit = |scenario: &str, tests: &str| {
        fuzz(dir.path(), &["audit", scenario, "--tests", tests, "--mutants", "0", "--out", "out"])
    };
    let variation = "slow-leader-variation.xosc";
    refused(&audit(variation, "empty"), &["empty is a folder", "no file that ends with .xosc", "folder of a campaign"]);
    refused(
        &audit("pedestrian-crossing", "suite"),
        &["suite is a folder", "`pedestrian-crossing` is not the scenario of a file"],
    );
    write_test(dir.path(), "d.xosc", "35", "50");
    refused(
        &audit(variation, "suite"),
        &["suite/d.xosc, line 5: parameter `speed`: found 35, expected one of 20, 30, 40"],
    );
    write_test(dir.path(), "d.xosc", "fast", "50");
    refused(&audit(variation, "suite"), &["suite/d.xosc:5: ", "`value=\"fast\"`", "expected a finite number"]);
    let scenario = ["audit", "slow-leader.xosc", "--open", "speed=20..60", "--tests", "suite", "--out", "out"];
    write_test(dir.path(), "d.xosc", "35", "50");
    refused(&fuzz(dir.path(), &scenario), &["suite/a.XOSC, line 11: found 20, but `gap` is fixed at 50; --open gap"]);
    fs::write(dir.path().join("suite/d.xosc"), "<OpenSCENARIO><FileHeader/></OpenSCENARIO>").expect("it is writable");
    refused(&audit(variation, "suite"), &["suite/d.xosc:1: ", "found the end of <OpenSCENARIO>", "slow-leader.xosc:4"]);
    assert!(!dir.path().join("out").exists());
}

#[test]
fn better_tests_are_written_as_a_distribution_with_exactly_these_tests() {
    let dir = folder();
    let given = [
        "audit",
        "slow-leader-variation.xosc",
        "--continuous",
        "--tests",
        "suite",
        "--driver",
        "planner",
        "--mutants",
        "12",
        "--screen",
        "12",
        "--out",
        "out/audit",
    ];
    let noted = stderr(&succeeds(fuzz(dir.path(), &given)));
    assert!(!noted.contains("not written"), "{noted}");
    let table = fs::read_to_string(dir.path().join("out/audit/additions-1.csv")).expect("the suite misses mutants");
    let tests: Vec<String> = table.lines().skip(1).map(|line| line.replace(',', "|")).collect();
    assert!(!tests.is_empty(), "{table}");
    let listed = "out/audit/additions-1.xosc";
    let output = succeeds(fuzz(dir.path(), &["describe", listed, "--format", "json"]));
    let described: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let open: Vec<&Value> =
        described["parameters"].as_array().expect("a list").iter().filter(|one| one["open"] == true).collect();
    assert_eq!(open.len(), 1, "{described}");
    let parameter = &open[0]["parameter"];
    let levels = parameter["choice"].as_array().unwrap_or_else(|| panic!("{parameter}"));
    assert_eq!(levels.iter().map(|level| level.as_str().expect("a tuple")).collect::<Vec<_>>(), tests);
    let Some(python) = judge() else { return };
    let checked = report(&python, &dir.path().join(listed), ["qc_openscenario", "xoscBundle"]);
    assert!(checked.matches("status=\"completed\"").count() >= 2 && !checked.contains("<Issue"), "{checked}");
}
