//! The optimised sets of points in the repository: their measures are those of the documents, and programs of others agree.

use crate::certificate::check;
use crate::common::{cover, stderr, stdout, succeeds};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A row of the table in the documents.
struct Row {
    measure: &'static str,
    file: PathBuf,
    /// The value as the table has it, with five decimals.
    value: String,
    /// The dispersion of `greedy` for points of this number in this number of dimensions; empty for other measures.
    greedy: String,
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
        let [dims, points, value, greedy] = [2, 3, 5, 7].map(|cell| cells[cell].to_owned());
        Row { measure, file, value, greedy, size: [dims, points] }
    };
    rows.take_while(|line| line.starts_with('|')).map(row).collect()
}

#[test]
fn the_optimised_sets_have_the_measures_of_the_documents() {
    let dir = tempfile::tempdir().unwrap();
    let rows = table();
    let listed: BTreeSet<PathBuf> = rows.iter().map(|row| row.file.clone()).collect();
    let data = fs::read_dir(root().join("coverage/data")).unwrap().map(|entry| entry.unwrap().path());
    assert_eq!(listed, data.filter(|path| path.extension().is_some_and(|ending| ending == "csv")).collect());
    for Row { measure, file, value, greedy, size: [dims, points] } in rows {
        let name = file.to_str().unwrap();
        let arguments = ["estimate", name, "--measures", measure, "--format", "json", "--certificate", "c.json"];
        let printed = stdout(&succeeds(cover(dir.path(), &arguments[..if measure == "star" { 6 } else { 8 }])));
        let json: Value = serde_json::from_str(&printed).unwrap();
        let key = if measure == "star" { "star_discrepancy" } else { "dispersion" };
        let found = &json["continuous"][key];
        assert_eq!(found["lower"], found["upper"], "{name}");
        let found = found["upper"].as_f64().unwrap();
        assert_eq!(format!("{found:.5}"), value, "{name}");
        if measure == "star" {
            let judge = Command::new("python3").arg(root().join("tests/check_star.py")).arg(&file).output();
            let Ok(judge) = judge else { continue };
            let judged: f64 = stdout(&judge).trim().parse().unwrap_or_else(|_| panic!("{name}: {}", stderr(&judge)));
            assert!((judged - found).abs() < 1e-15, "{name}: {found}, and the judge says {judged}");
        } else {
            let certificate = serde_json::from_str(&fs::read_to_string(dir.path().join("c.json")).unwrap()).unwrap();
            let Some(judge) = check(dir.path(), &certificate) else { continue };
            let of_greedy = [
                "estimate",
                "--measures",
                "dispersion",
                "--strategy",
                "greedy",
                "--dims",
                &dims,
                "--budget",
                &points,
                "--format",
                "json",
            ];
            let json: Value = serde_json::from_str(&stdout(&succeeds(cover(dir.path(), &of_greedy)))).unwrap();
            let found_by_greedy = json["continuous"]["dispersion"]["upper"].as_f64().unwrap();
            assert_eq!(format!("{found_by_greedy:.5}"), greedy, "{name}");
            let said = stdout(&judge);
            let bound = said.split_whitespace().filter_map(|word| word.parse::<f64>().ok()).next().unwrap();
            assert!(
                judge.status.success() && said.contains(": proved") && bound < found * (1.0 + 1e-9),
                "{name}: {said}"
            );
        }
    }
}
