//! Checks the page on audits: its tables say what the CSVs say. If a table is old, the test prints it.

use std::collections::BTreeMap;
use std::fmt::Write;

const STATED: &str = include_str!("../data/audit.csv");
const KINDS: &str = include_str!("../data/audit-kinds.csv");
const STATISTICS: &str = include_str!("../data/audit-statistics.csv");
const STRATEGIES: &str = include_str!("../data/audit-strategies.csv");
const PAGE: &str = include_str!("../audit.md");

type Row = BTreeMap<String, String>;

/// Returns the rows of a CSV, each as the cells by the names of their columns.
fn rows(csv: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

fn number(row: &Row, column: &str) -> Option<f64> {
    row[column].parse().ok()
}

fn percent(share: Option<f64>) -> String {
    share.map_or("-".to_owned(), |share| format!("{:.1} %", 100.0 * share))
}

fn table(header: &[&str], lines: impl Iterator<Item = Vec<String>>) -> String {
    let mut text = format!("| {} |\n|{}\n", header.join(" | "), " --- |".repeat(header.len()));
    lines.for_each(|cells| writeln!(text, "| {} |", cells.join(" | ")).unwrap());
    text
}

/// Returns the volume of the largest hole, as a number or as a bracket.
fn hole(row: &Row) -> String {
    let (lower, upper) = (number(row, "hole_lower").unwrap(), number(row, "hole_upper").unwrap());
    if format!("{lower:.3}") == format!("{upper:.3}") { format!("{lower:.3}") } else { format!("{lower:.3} to {upper:.3}") }
}

fn stated_table() -> String {
    let line = |row: &Row| {
        let witness = match row["witness_failing"].as_str() {
            "0" => "none".to_owned(),
            failing => format!("{failing} of {}", row["witness_tried"]),
        };
        let better = number(row, "better_hole_upper").map_or("-".to_owned(), |hole| format!("{hole:.3}"));
        let tests = if row["better_tests"].is_empty() { "-".to_owned() } else { row["better_tests"].clone() };
        let scores = ["score", "other_score", "better_other_score"].map(|column| percent(number(row, column)));
        let [score, other, better_other] = scores;
        vec![row["scenario"].clone(), row["tests"].clone(), hole(row), witness, score, tests, better, other, better_other]
    };
    table(
        &["scenario", "tests", "largest hole", "witness fails", "score", "better: tests", "hole", "others: stated", "better"],
        rows(STATED).iter().map(line),
    )
}

fn statistics_table(kind: &str) -> String {
    let of_kind = |row: &&Row| row["comparison"].contains(kind);
    let line = |row: &Row| {
        let [mean, lower, upper] = ["mean", "lower", "upper"].map(|column| number(row, column).unwrap());
        let value = format!("{mean:+.3} ({lower:+.3} to {upper:+.3})");
        let p = number(row, "p").unwrap();
        let p = if p < 0.001 { "< 0.001".to_owned() } else { format!("{p:.3}") };
        vec![row["comparison"].clone(), row["mutants"].clone(), row["scenarios"].clone(), value, p]
    };
    table(
        &["comparison", "mutants", "scenarios", "mean (95 %)", "p"],
        rows(STATISTICS).iter().filter(of_kind).map(line),
    )
}

/// Returns the kinds with the least share of killed mutants over all stated suites.
fn kinds_table() -> String {
    let mut sums: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for row in rows(KINDS) {
        let sum = sums.entry(row["kind"].clone()).or_default();
        sum.0 += row["killed"].parse::<usize>().unwrap();
        sum.1 += row["mutants"].parse::<usize>().unwrap();
    }
    let mut sums: Vec<_> = sums.into_iter().filter(|(_, (_, mutants))| *mutants >= 10).collect();
    let share = |(killed, mutants): (usize, usize)| killed as f64 / mutants as f64;
    sums.sort_by(|a, b| share(a.1).total_cmp(&share(b.1)));
    let line = |(kind, sum): &(String, (usize, usize))| {
        vec![format!("`{kind}`"), sum.1.to_string(), percent(Some(share(*sum)))]
    };
    table(&["kind of defect", "mutants", "killed"], sums.iter().take(10).map(line))
}

#[test]
fn the_tables_of_the_page_say_what_the_csvs_say() {
    for table in [stated_table(), kinds_table(), statistics_table("random"), statistics_table("score")] {
        assert!(PAGE.contains(&table), "the page has another table than this:\n{table}");
    }
}

#[test]
fn each_suite_has_as_many_mutants_and_tests_as_the_others_of_its_scenario() {
    let suites = rows(STRATEGIES);
    assert!(!suites.is_empty());
    for of in suites.chunk_by(|a, b| a["scenario"] == b["scenario"]) {
        for column in ["mutants", "conditional", "tests"] {
            assert!(of.iter().all(|row| row[column] == of[0][column]), "{}: {column}", of[0]["scenario"]);
        }
    }
}

#[test]
fn every_better_suite_has_fewer_tests_and_a_smaller_hole_than_the_stated_suite() {
    for row in rows(STATED) {
        let Some(tests) = number(&row, "better_tests") else { continue };
        assert!(tests < number(&row, "tests").unwrap(), "{row:?}");
        assert!(number(&row, "better_hole_upper") < number(&row, "hole_lower"), "{row:?}");
    }
}
