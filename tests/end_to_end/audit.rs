//! `paracosm-fuzz audit`: a suite of tests on trial.

use crate::certificate::check;
use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const FILES: [&str; 5] =
    ["audit.json", "audit-settings.json", "mutants.jsonl", "certificate-1.json", "certificate-2.json"];

fn audit(dir: &Path, out: &str, more: &[&str]) -> Value {
    let given = [
        "audit",
        "--tests",
        "halton:20",
        "--tests",
        "grid:5x4",
        "--mutants",
        "30",
        "--screen",
        "16",
        "-q",
        "--format",
        "json",
        "--out",
        out,
    ];
    let printed = stdout(&succeeds(fuzz(dir, &[&given, more].concat())));
    serde_json::from_str(&printed).unwrap()
}

fn contents(dir: &Path, out: &str) -> Vec<Vec<u8>> {
    FILES.iter().map(|file| fs::read(dir.join(out).join(file)).unwrap()).collect()
}

#[test]
fn an_audit_is_the_same_with_any_number_of_jobs_and_after_a_cut() {
    let dir = tempfile::tempdir().unwrap();
    let report = audit(dir.path(), "one", &["--jobs", "1"]);
    audit(dir.path(), "two", &["--jobs", "2"]);
    let whole = contents(dir.path(), "one");
    assert_eq!(whole, contents(dir.path(), "two"));
    assert_eq!(report, serde_json::from_slice::<Value>(&whole[0]).unwrap());
    // A kill while a line was written.
    let tried = dir.path().join("two/mutants.jsonl");
    let text = fs::read_to_string(&tried).unwrap();
    for cut in [text.len() / 2, 1, 0] {
        fs::write(&tried, &text[..cut]).unwrap();
        fs::remove_file(dir.path().join("two/audit.json")).unwrap();
        audit(dir.path(), "two", &["--resume"]);
        assert_eq!(whole, contents(dir.path(), "two"), "cut at {cut}");
    }
}

#[test]
fn an_audit_that_goes_on_makes_no_run_again_whose_result_is_kept() {
    let dir = tempfile::tempdir().unwrap();
    audit(dir.path(), "out", &[]);
    let whole = contents(dir.path(), "out");
    let runs = dir.path().join("out/runs.jsonl");
    let kept = fs::read_to_string(&runs).unwrap();
    let goes_on = |text: &str| {
        fs::write(&runs, text).unwrap();
        fs::write(dir.path().join("out/mutants.jsonl"), "").unwrap();
        audit(dir.path(), "out", &["--resume"]);
        assert_eq!(whole, contents(dir.path(), "out"));
        fs::read_to_string(&runs).unwrap()
    };
    assert!(goes_on(&kept) == kept, "a run was made again");
    // A kill while a line was written, a line of another program, and nothing.
    let keys = |text: &str| {
        let key = |line: &str| serde_json::from_str::<Value>(line).unwrap()["key"].to_string();
        text.lines().map(key).collect::<std::collections::BTreeSet<_>>()
    };
    for left in [kept.len() / 2, 0] {
        assert!(keys(&goes_on(&kept[..left])) == keys(&kept), "the file has other runs than before");
    }
    // Lines that somebody has changed are refused, and so is a new audit in the folder.
    let resume =
        ["audit", "--tests", "halton:20", "--tests", "grid:5x4", "--mutants", "30", "--screen", "16", "--out", "out"];
    for wrong in [kept.replacen("pass", "fail", 1), format!("{kept}{{\"key\": 7}}\n"), "mine\n".to_owned()] {
        fs::write(&runs, &wrong).unwrap();
        let output = fuzz(dir.path(), &[&resume[..], &["--resume"]].concat());
        refused(&output, &["runs.jsonl", "the line is not what an audit has written"]);
        assert!(fs::read_to_string(&runs).unwrap() == wrong, "the file has changed");
    }
    fs::remove_file(dir.path().join("out/audit-settings.json")).unwrap();
    refused(&fuzz(dir.path(), &resume), &["out holds an audit already; --resume continues it"]);
    // Another audit that is to go on there changes nothing.
    audit(dir.path(), "two", &[]);
    let before = fs::read(dir.path().join("two/runs.jsonl")).unwrap();
    let other = ["audit", "--driver", "planner", "--tests", "halton:20", "--out", "two", "--resume"];
    refused(&fuzz(dir.path(), &other), &["two holds another audit: `study` differs"]);
    assert!(fs::read(dir.path().join("two/runs.jsonl")).unwrap() == before, "the file has changed");
    refused(
        &fuzz(dir.path(), &["audit", "--tests", "halton:20", "--screen", "0", "--out", "three"]),
        &["--screen is 0"],
    );
    assert!(!dir.path().join("three").exists());
}

#[test]
fn an_audit_shows_holes_a_witness_and_scores() {
    let dir = tempfile::tempdir().unwrap();
    let report = audit(dir.path(), "out", &["--driver", "planner"]);
    for suite in [&report, &report["others"][0]] {
        assert_eq!(suite["tests"], 20);
        assert_eq!(suite["witness"]["agrees_on_suite"], true);
        assert!(suite["witness"]["failing"].as_u64().unwrap() > 0);
        assert_eq!(suite["mutants"]["counted"], 30);
        let mutants = &suite["mutants"];
        assert_eq!(mutants["made"].as_u64().unwrap() - mutants["equivalent_so_far"].as_u64().unwrap(), 30);
        let score = mutants["mutation_score"]["value"].as_f64().unwrap();
        assert_eq!(score, mutants["killed"].as_f64().unwrap() / 30.0);
        assert!(suite["witness"]["fails_at"]["speed"].is_number() && suite["hole"]["box"]["speed"].is_array());
        assert!(suite["witness"]["probability"]["lower"].as_f64() < suite["witness"]["probability"]["upper"].as_f64());
    }
    assert!(report["hole"]["lower"].as_f64() < report["others"][0]["hole"]["lower"].as_f64());
    let given = ["audit", "--tests", "halton:20", "--mutants", "0", "--format", "table", "--out", "table"];
    let table = stdout(&succeeds(fuzz(dir.path(), &given)));
    assert!(fs::read(dir.path().join("table/witness-1.gif")).unwrap().starts_with(b"GIF89a"));
    assert!(fs::read(dir.path().join("table/hole-1.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(table.contains("witness") && table.contains("fails in the box"), "{table}");
}

#[test]
fn the_additions_to_a_suite_kill_the_mutants_that_it_misses() {
    let dir = tempfile::tempdir().unwrap();
    let run = |suite: &str, out: &str| {
        let given = ["audit", "--tests", suite, "--mutants", "60", "--screen", "16", "-q", "--out", out];
        succeeds(fuzz(dir.path(), &given));
        let text = fs::read_to_string(dir.path().join(out).join("mutants.jsonl")).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect::<Vec<Value>>()
    };
    let few = run("halton:4", "few");
    let more = run("few/additions-1.csv", "more");
    let missed: Vec<_> = few.iter().zip(&more).filter(|(few, _)| few["kills"][0].is_null()).collect();
    assert!(missed.len() > 5, "{}", missed.len());
    assert!(missed.iter().all(|(few, more)| few["mutant"] == more["mutant"] && !more["kills"][0].is_null()));
    // The last test kills the witness.
    let tests = fs::read_to_string(dir.path().join("few/additions-1.csv")).unwrap().lines().count() - 2;
    assert!(tests < missed.len(), "{tests} tests for {} mutants", missed.len());
}

/// The certificate of the first suite of an audit of `scenario`.
fn certified(dir: &Path, scenario: &str, more: &[&str]) -> (Value, String) {
    let given = ["audit", scenario, "--mutants", "0", "--format", "table", "--out", "out"];
    let table = stdout(&succeeds(fuzz(dir, &[&given, more].concat())));
    (serde_json::from_slice(&fs::read(dir.join("out/certificate-1.json")).unwrap()).unwrap(), table)
}

#[test]
fn the_certificate_of_an_audit_is_accepted_and_one_about_other_rows_is_not() {
    let dir = tempfile::tempdir().unwrap();
    let given = ["--driver", "fsm", "--open", "vehicle", "--tests", "grid:3x4x3x3"];
    let (certificate, table) = certified(dir.path(), "cut-in", &given);
    assert!(table.contains("certificate-1.json proves that no hole of a row is larger than 0.5"), "{table}");
    let claims = certificate["claims"].as_array().unwrap();
    assert!(claims.len() > 2 && claims[1]["like"] == 0, "{claims:?}");
    let Some(checked) = check(dir.path(), &certificate) else { return };
    let says = stdout(&succeeds(checked));
    assert!(says.matches("has been hit: proved").count() == claims.len(), "{says}");
    assert!(says.contains("in the row vehicle car has been hit: proved (1 projections"), "{says}");
    assert!(says.contains("has been hit: proved (as another row with the same points)"), "{says}");
    let refuses = |says: &str, tamper: &dyn Fn(&mut Value)| {
        let mut changed = certificate.clone();
        tamper(&mut changed);
        let message = stderr(&check(dir.path(), &changed).unwrap());
        assert!(message.starts_with("refused: ") && message.contains(says), "`{says}` is missing in: {message}");
    };
    refuses("no earlier claim is like this one", &|changed| changed["claims"][1]["like"] = json!(1));
    refuses("has a weaker bound", &|changed| changed["claims"][1]["upper"] = json!(0.500_000_000_000_1));
    refuses("is no row of discrete values", &|changed| changed["claims"][1]["row"] = json!([99]));
    refuses("the witness is of another projection", &|changed| changed["claims"][1]["row"] = json!([0]));
    refuses("the row has other points", &|changed| {
        let of_row = changed["levels"].as_array().unwrap().iter().position(|levels| levels == &json!([1])).unwrap();
        changed["coordinates"][of_row][1] = json!(0.3);
    });
}

#[test]
fn the_grid_that_a_regulation_lists_is_certified_within_its_constraints() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/standards/alks/logical_scenarios/alks_scenario_4_4_1_cut_in_no_collision_variation.xosc");
    if !file.exists() {
        eprintln!("{} was not found: its grid is not certified", file.display());
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let (certificate, _) = certified(dir.path(), file.to_str().unwrap(), &["--driver", "fsm"]);
    assert_eq!((certificate["format"].as_u64(), certificate["parts"].as_array().unwrap().len()), (Some(2), 1));
    let claims = certificate["claims"].as_array().unwrap();
    assert!(
        claims.len() == 10 && claims.iter().all(|claim| claim["note"].is_null() && claim["upper"].as_f64() < Some(0.5))
    );
    if let Some(checked) = check(dir.path(), &certificate) {
        let says = stdout(&succeeds(checked));
        assert_eq!(says.matches("has been hit: proved").count(), 10, "{says}");
    }
}

#[test]
fn a_folder_with_another_audit_and_wrong_suites_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    audit(dir.path(), "out", &[]);
    let run = |more: &[&str]| {
        fuzz(dir.path(), &[&["audit", "--mutants", "5", "--screen", "8", "-q", "--out", "out"], more].concat())
    };
    refused(&run(&["--tests", "halton:20"]), &["out holds an audit already; --resume continues it"]);
    refused(&run(&["--tests", "halton:20", "--resume"]), &["out holds another audit", "differs"]);
    let new = |more: &[&str]| fuzz(dir.path(), &[&["audit", "-q", "--out", "new"], more].concat());
    refused(&new(&[]), &["name a suite: --tests FILE.csv"]);
    refused(&new(&["--tests", "halton:none"]), &["found `none` after `halton:`, expected a number of tests"]);
    refused(&new(&["--tests", "grid:3"]), &["the grid has 1 size, expected 2", "speed, distance"]);
    refused(&new(&["--tests", "absent.csv"]), &["absent.csv"]);
    refused(&new(&["--tests", "halton:5", "--time-limit=-1"]), &["--time-limit -1: expected a number of seconds"]);
    refused(&new(&["--tests", "cmaes:40"]), &["audit the folder of a campaign"]);
    refused(&new(&["--tests", "halton:5", "--open", "friction:per-tick"]), &["`friction` is a signal"]);
    assert!(!dir.path().join("new").exists());
}

#[test]
fn a_better_suite_is_graded_with_other_mutants() {
    let dir = tempfile::tempdir().unwrap();
    let given = ["--driver", "planner", "--mutants", "30", "--screen", "16", "-q"];
    let run = |more: &[&str]| stdout(&succeeds(fuzz(dir.path(), &[&["audit"], &given[..], more].concat())));
    run(&["--tests", "grid:9x9", "--out", "first"]);
    let both =
        ["--tests", "first/better-1.csv", "--tests", "grid:9x9", "--seed", "1", "--out", "second", "--format", "json"];
    let report: Value = serde_json::from_str(&run(&both)).unwrap();
    let (better, grid) = (&report, &report["others"][0]);
    assert!(better["tests"].as_u64() < grid["tests"].as_u64());
    let hole = |suite: &Value| suite["hole"]["lower"].as_f64().unwrap();
    assert!(hole(better) < hole(grid), "{report}");
    let first: Value = serde_json::from_slice(&fs::read(dir.path().join("first/audit.json")).unwrap()).unwrap();
    let found = &first["better"];
    assert_eq!((&found["tests"], &found["file"]), (&better["tests"], &"better-1.csv".into()));
    assert_eq!(found["hole"]["upper"], better["hole"]["upper"]);
}

#[test]
fn a_suite_is_compared_with_suites_of_its_size_by_other_strategies() {
    let dir = tempfile::tempdir().unwrap();
    let given =
        ["audit", "--tests", "grid:3x3", "--compare", "--mutants", "10", "--screen", "8", "-q", "--format", "json"];
    let report: Value = serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &given)))).unwrap();
    let suites: Vec<&Value> = [&report].into_iter().chain(report["others"].as_array().unwrap()).collect();
    let names: Vec<&str> = suites.iter().map(|suite| suite["suite"].as_str().unwrap()).collect();
    assert!(names[0] == "grid:3x3" && names.contains(&"halton:9") && names.contains(&"greedy:9"), "{names:?}");
    assert!(suites.iter().all(|suite| suite["tests"] == 9));
}
