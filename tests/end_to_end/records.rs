//! The optimised sets of points in the repository: their measures are those of the documents, and programs of others agree.

use crate::certificate::check;
use crate::common::{cover, stderr, stdout, succeeds};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A row of the table in the documents.
struct Row {
    measure: &'static str,
    file: PathBuf,
    /// The value as the table has it, with five decimals.
    value: String,
    /// The strategy that has the same number of points, and its measure: `greedy` for the dispersion, and `sobol` for the star discrepancy from three dimensions on.
    other: Option<(&'static str, String)>,
    size: [String; 2],
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn table() -> Vec<Row> {
    let page = fs::read_to_string(root().join("docs/covering.md")).unwrap();
    let rows = page.lines().skip_while(|line| !line.starts_with("| measure | dimensions | points |")).skip(2);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let measure = if cells[1] == "star discrepancy" { "star" } else { "dispersion" };
        let file = root().join(format!("coverage/data/{measure}-{}d-{}.csv", cells[2], cells[3]));
        let [dims, points, value] = [2, 3, 5].map(|cell| cells[cell].to_owned());
        let other = [("greedy", cells[7]), ("sobol", cells[8])].into_iter().find(|(_, value)| !value.is_empty());
        let other = other.map(|(strategy, value)| (strategy, value.to_owned()));
        Row { measure, file, value, other, size: [dims, points] }
    };
    rows.take_while(|line| line.starts_with('|')).map(row).collect()
}

/// Returns true for a set of points that `optimise` has found.
fn is_optimised(path: &Path) -> bool {
    let is_csv = path.extension().is_some_and(|ending| ending == "csv");
    is_csv && !path.file_name().is_some_and(|name| name.to_str().unwrap().starts_with("least-"))
}

#[test]
fn the_optimised_sets_have_the_measures_of_the_documents() {
    let dir = tempfile::tempdir().unwrap();
    let rows = table();
    let listed: BTreeSet<PathBuf> = rows.iter().map(|row| row.file.clone()).collect();
    let data = fs::read_dir(root().join("coverage/data")).unwrap().map(|entry| entry.unwrap().path());
    assert_eq!(listed, data.filter(|path| is_optimised(path)).collect());
    for Row { measure, file, value, other, size: [dims, points] } in rows {
        let name = file.to_str().unwrap();
        let arguments = ["estimate", name, "--measures", measure, "--format", "json", "--certificate", "c.json"];
        let printed = stdout(&succeeds(cover(dir.path(), &arguments[..if measure == "star" { 6 } else { 8 }])));
        let json: Value = serde_json::from_str(&printed).unwrap();
        let key = if measure == "star" { "star_discrepancy" } else { "dispersion" };
        let found = &json["continuous"][key];
        assert_eq!(found["lower"], found["upper"], "{name}");
        let found = found["upper"].as_f64().unwrap();
        assert_eq!(format!("{found:.5}"), value, "{name}");
        if let Some((strategy, value)) = other {
            let size = ["--strategy", strategy, "--dims", &dims, "--budget", &points];
            let arguments = [&["estimate", "--measures", measure, "--format", "json"], &size[..]].concat();
            let json: Value = serde_json::from_str(&stdout(&succeeds(cover(dir.path(), &arguments)))).unwrap();
            let found = json["continuous"][key]["upper"].as_f64().unwrap();
            assert_eq!(format!("{found:.5}"), value, "{strategy} beside {name}");
        }
        if measure == "star" {
            let judge = Command::new("python3").arg(root().join("tests/check_star.py")).arg(&file).output();
            let Ok(judge) = judge else { continue };
            if stderr(&judge).contains("No module named 'numpy'") {
                eprintln!("SKIPPED: no numpy for the star discrepancy of {name}");
                continue;
            }
            let judged: f64 = stdout(&judge).trim().parse().unwrap_or_else(|_| panic!("{name}: {}", stderr(&judge)));
            assert!((judged - found).abs() < 1e-15, "{name}: {found}, and the judge says {judged}");
        } else {
            let certificate = serde_json::from_str(&fs::read_to_string(dir.path().join("c.json")).unwrap()).unwrap();
            let Some(judge) = check(dir.path(), &certificate) else { continue };
            let said = stdout(&judge);
            let bound = said.split_whitespace().filter_map(|word| word.parse::<f64>().ok()).next().unwrap();
            assert!(
                judge.status.success() && said.contains(": proved") && bound < found * (1.0 + 1e-9),
                "{name}: {said}"
            );
        }
    }
}

/// What the independent checker says of a table of least dispersions; none where there is no Python to run it.
fn check_least(table: &Path) -> Option<Output> {
    Command::new("python3").arg(root().join("tests/check_least.py")).arg(table).output().ok()
}

#[test]
fn the_least_dispersions_of_the_documents_are_proved_and_reached() {
    let page = fs::read_to_string(root().join("docs/covering.md")).unwrap();
    let rows = page.lines().skip_while(|line| !line.starts_with("| points | d = 2 | d = 3 | d = 4 |")).skip(2);
    let rows: Vec<Vec<&str>> =
        rows.take_while(|line| line.starts_with('|')).map(|line| line.split('|').map(str::trim).collect()).collect();
    for dims in [2, 3, 4] {
        let file = root().join(format!("coverage/data/least-{dims}d.json"));
        let table: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        let shown: Vec<&str> = rows.iter().map(|cells| cells[dims]).filter(|cell| !cell.is_empty()).collect();
        let known = table["rows"].as_array().unwrap();
        assert_eq!(shown.len(), known.len());
        for (shown, row) in shown.iter().zip(known) {
            let [level, dispersion] = ["level", "dispersion"].map(|key| row[key].as_f64().unwrap());
            assert!(level >= dispersion * (1.0 - 1e-6), "{shown}");
            assert_eq!(*shown, format!("{dispersion:.5}"));
            let points = row["points"].as_array().unwrap();
            let csv = root().join(format!("coverage/data/least-{dims}d-{}.csv", points.len()));
            // One point is in the middle.
            let Ok(csv) = fs::read_to_string(csv) else {
                assert_eq!(points.len(), 1);
                continue;
            };
            let read = |line: &str| line.split(',').map(|x| x.parse::<f64>().unwrap()).collect::<Vec<f64>>();
            assert_eq!(Value::from(csv.lines().skip(1).map(read).collect::<Vec<_>>()), row["points"]);
        }
        let Some(judge) = check_least(&file) else { continue };
        let judge = succeeds(judge);
        assert_eq!(stdout(&judge).lines().filter(|line| line.contains(": proved; ")).count(), known.len());
    }
}

#[test]
fn a_table_of_least_dispersions_that_claims_too_much_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let printed =
        stdout(&succeeds(cover(dir.path(), &["least", "--dims", "2", "--budget", "4", "--certificate", "c.json"])));
    assert!(printed.contains("4 points              0.25 (proved)"), "{printed}");
    let table: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("c.json")).unwrap()).unwrap();
    let row = |change: &dyn Fn(&mut Value)| {
        let mut changed = table.clone();
        change(&mut changed["rows"][3]);
        changed
    };
    for (changed, says) in [
        (table.clone(), None),
        (row(&|row| row["dispersion"] = 0.2499.into()), Some("not 0.2499")),
        (row(&|row| row["level"] = row["dispersion"].clone()), Some("do not rule out all points")),
        (row(&|row| row["steps"] = "x".into()), Some("do not rule out all points")),
        (
            row(&|row| row["steps"] = row["steps"].as_str().unwrap().trim_end_matches('x').into()),
            Some("the steps for 4 points are wrong"),
        ),
        (row(&|row| row["points"][0][0] = 0.9.into()), Some("the largest empty box between the points has the volume")),
    ] {
        let file = dir.path().join("changed.json");
        fs::write(&file, changed.to_string()).unwrap();
        let Some(judge) = check_least(&file) else { return };
        match says {
            None => drop(succeeds(judge)),
            Some(says) => {
                assert!(!judge.status.success() && stderr(&judge).contains(says), "{says}: {}", stderr(&judge));
            }
        }
    }
}

#[test]
fn least_dispersions_that_cannot_be_proved_are_refused_or_lie_between_bounds() {
    let dir = tempfile::tempdir().unwrap();
    for (arguments, says) in [
        (["--dims", "0", "--budget", "3"], "--dims is 0, expected a number from 1 to"),
        (["--dims", "2", "--budget", "0"], "--budget is 0, expected a number from 1 to"),
        (["--dims", "3", "--budget", "90"], "--budget is 90, expected a number from 1 to"),
    ] {
        let refused = cover(dir.path(), &[&["least"], &arguments[..]].concat());
        assert!(refused.status.code() == Some(2) && stderr(&refused).contains(says), "{}", stderr(&refused));
    }
    let printed = stdout(&succeeds(cover(dir.path(), &["least", "--dims", "3", "--budget", "9", "--time", "0"])));
    assert!(
        printed.contains("9 points              between 0.1 and ") && !printed.contains("A proved value"),
        "{printed}"
    );
    // More points are never worse.
    let reached = printed.lines().filter_map(|line| line.split(" and ").nth(1)?.trim().parse::<f64>().ok());
    let reached = reached.collect::<Vec<f64>>();
    assert!(reached.len() >= 7 && reached.is_sorted_by(|a, b| a >= b), "{printed}");
}

#[test]
fn a_certificate_that_cannot_be_written_is_refused_before_the_work() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("points.csv"), "x,y\n0.25,0.5\n").unwrap();
    fs::create_dir(dir.path().join("folder")).unwrap();
    let least = ["least", "--dims", "3", "--budget", "9", "--time", "3600", "--certificate"];
    for (file, says) in [("nowhere/least.json", "the folder nowhere does not exist"), ("folder", "folder")] {
        let refused = cover(dir.path(), &[&least[..], &[file]].concat());
        assert!(refused.status.code() == Some(2) && stderr(&refused).contains(says), "{}", stderr(&refused));
    }
    let refused = cover(dir.path(), &["estimate", "points.csv", "--certificate", "nowhere/proof.json"]);
    assert!(stderr(&refused).contains("the folder nowhere does not exist"), "{}", stderr(&refused));
}
