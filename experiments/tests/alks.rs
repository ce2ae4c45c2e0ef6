//! Checks the page on UN R157: its tables say what the CSV says. If a table is old, the test prints it.

use std::collections::BTreeMap;
use std::fmt::Write;

const CSV: &str = include_str!("../data/alks.csv");
const PAGE: &str = include_str!("../alks.md");

/// The number of valid combinations of the cut-in, which is known from the published files.
const VALID_CUT_INS: &str = "29750";

/// Returns the rows of the CSV, each as the cells by the names of their columns.
fn rows() -> Vec<BTreeMap<&'static str, &'static str>> {
    let names: Vec<&str> = CSV.lines().next().unwrap().split(',').collect();
    CSV.lines().skip(1).map(|line| names.iter().copied().zip(line.split(',')).collect()).collect()
}

/// Returns the different values of a column, in the order of the rows.
fn different(column: &str) -> Vec<&'static str> {
    let mut values = Vec::new();
    for row in rows() {
        if !values.contains(&row[column]) {
            values.push(row[column]);
        }
    }
    values
}

/// Returns a table with a row for each scenario: the given columns, which are the same for all drivers, and a cell for each driver.
fn table(columns: &[(&str, &str)], cell: impl Fn(&BTreeMap<&str, &str>) -> String) -> String {
    let (mut text, drivers) = (String::from("| scenario |"), different("driver"));
    columns.iter().for_each(|(_, title)| write!(text, " {title} |").unwrap());
    drivers.iter().for_each(|driver| write!(text, " `{driver}` |").unwrap());
    writeln!(text, "\n|{}", " --- |".repeat(1 + columns.len() + drivers.len())).unwrap();
    for scenario in different("scenario") {
        let of: Vec<_> = rows().into_iter().filter(|row| row["scenario"] == scenario).collect();
        write!(text, "| {scenario} |").unwrap();
        columns.iter().for_each(|(column, _)| write!(text, " {} |", of[0][column]).unwrap());
        of.iter().for_each(|row| write!(text, " {} |", cell(row)).unwrap());
        text.push('\n');
    }
    text
}

#[test]
fn the_tables_of_the_page_say_what_the_csv_says() {
    let failures = table(&[("combinations", "combinations"), ("valid", "valid")], |row| {
        format!("{} ({})", row["fail"], row["unpreventable"])
    });
    let arrays = table(&[("valid", "all"), ("tests_2", "pairs"), ("tests_3", "triples")], |row| {
        format!("{} / {} / {}", row["fail"], row["fail_2"], row["fail_3"])
    });
    for table in [failures, arrays] {
        assert!(PAGE.contains(&table), "the page has another table than this:\n{table}");
    }
}

#[test]
fn every_valid_combination_has_a_verdict_and_none_is_an_error() {
    for row in rows() {
        let count = |name: &str| row[name].parse::<usize>().unwrap();
        let judged = ["fail", "unpreventable", "pass", "inconclusive", "invalid", "error"].map(count);
        assert_eq!(judged.iter().sum::<usize>(), count("valid"), "{row:?}");
        assert_eq!(count("error"), 0, "{row:?}");
        if row["scenario"].starts_with("4_4_1") {
            assert_eq!(row["valid"], VALID_CUT_INS);
        }
    }
}
