//! Checks the page on stated suites: its tables say what the CSV files say. If a table is old, the test prints it.

use std::collections::BTreeMap;
use std::fmt::Write;

const SUITES: &str = include_str!("../data/audit.csv");
const KINDS: &str = include_str!("../data/audit-kinds.csv");
const PAGE: &str = include_str!("../audit.md");

type Row = BTreeMap<&'static str, &'static str>;

/// Returns the rows of a CSV, each as the cells by the names of their columns.
fn rows(csv: &'static str) -> Vec<Row> {
    let names: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    csv.lines().skip(1).map(|line| names.iter().copied().zip(line.split(',')).collect()).collect()
}

fn number(row: &Row, name: &str) -> Option<f64> {
    row[name].parse().ok()
}

fn percent(share: Option<f64>) -> String {
    share.map_or("–".to_owned(), |share| format!("{:.0} %", 100.0 * share))
}

/// The volume of a hole, as a certified bracket if it is not exact; a dash if nothing is continuous.
fn hole(lower: Option<f64>, upper: Option<f64>) -> String {
    match (lower, upper) {
        (Some(lower), Some(upper)) if upper > 0.0 && upper - lower > 5e-4 => {
            let digits = if format!("{lower:.3}") == format!("{upper:.3}") { 4 } else { 3 };
            format!("{lower:.digits$} to {upper:.digits$}")
        }
        (Some(_), Some(upper)) | (None, Some(upper)) if upper > 0.0 => format!("{upper:.3}"),
        _ => "–".to_owned(),
    }
}

/// Returns the table of suites.
fn suites() -> String {
    let mut text = String::from(
        "| scenario | tests | rows | largest hole | witness | mutants | killed | better suite: tests | its hole | \
         killed by stated / better |\n|",
    );
    text.push_str(&" --- |".repeat(10));
    text.push('\n');
    for row in rows(SUITES) {
        let witness = match number(&row, "witness_tried") {
            Some(tried) if tried > 0.0 => format!("fails in {} of {}", row["witness_failing"], row["witness_tried"]),
            _ => "–".to_owned(),
        };
        let better = if row["better_tests"].is_empty() { "–" } else { row["better_tests"] };
        let both =
            format!("{} / {}", percent(number(&row, "other_score")), percent(number(&row, "better_other_score")));
        writeln!(
            text,
            "| {} | {} | {} | {} | {witness} | {} | {} | {better} | {} | {both} |",
            row["scenario"],
            row["tests"],
            row["rows"],
            hole(number(&row, "hole_lower"), number(&row, "hole_upper")),
            row["mutants"],
            percent(number(&row, "score")),
            hole(None, number(&row, "better_hole_upper")),
        )
        .unwrap();
    }
    text
}

/// Returns the table of the kinds of defects that a suite misses, over all scenarios, from the kind that is missed most often.
fn kinds() -> String {
    let mut sums: BTreeMap<&str, [u32; 2]> = BTreeMap::new();
    for row in rows(KINDS) {
        let sum = sums.entry(row["kind"]).or_default();
        sum[0] += row["mutants"].parse::<u32>().unwrap();
        sum[1] += row["killed"].parse::<u32>().unwrap();
    }
    let (mut missed, all): (Vec<_>, Vec<_>) = sums.into_iter().partition(|(_, [mutants, killed])| killed < mutants);
    missed.sort_by_key(|(_, [mutants, killed])| (1_000_000 * killed / mutants, std::cmp::Reverse(*mutants)));
    let mut text = String::from("| kind | mutants | killed |\n| --- | --- | --- |\n");
    for (kind, [mutants, killed]) in missed {
        writeln!(text, "| `{kind}` | {mutants} | {killed} |").unwrap();
    }
    let mutants: u32 = all.iter().map(|(_, [mutants, _])| mutants).sum();
    writeln!(text, "| the {} other kinds | {mutants} | {mutants} |", all.len()).unwrap();
    text
}

#[test]
fn the_tables_of_the_page_say_what_the_csv_says() {
    for table in [suites(), kinds()] {
        assert!(PAGE.contains(&table), "the page has another table than this:\n{table}");
    }
}

#[test]
fn no_kind_has_more_killed_mutants_than_mutants_and_holes_are_brackets() {
    for row in rows(KINDS) {
        assert!(row["killed"].parse::<u32>().unwrap() <= row["mutants"].parse().unwrap(), "{row:?}");
    }
    for row in rows(SUITES) {
        let bounds = ["hole_lower", "hole_upper"].map(|name| number(&row, name).unwrap());
        assert!(0.0 <= bounds[0] && bounds[0] <= bounds[1] && bounds[1] <= 1.0, "{row:?}");
        // The witness is in the largest hole, or in a smaller one.
        assert!(number(&row, "witness_volume").is_none_or(|volume| volume <= bounds[1] + 1e-9), "{row:?}");
        // A better suite has fewer tests and a smaller hole.
        if let Some(tests) = number(&row, "better_tests") {
            assert!(tests < number(&row, "tests").unwrap(), "{row:?}");
            assert!(number(&row, "better_hole_upper").unwrap() < bounds[0], "{row:?}");
        }
    }
}
