//! Computes the numbers of the page on UN R157.

use crate::page::Page;
use crate::rows::{Row, different, number, rows};
use std::fmt::Write;

const CSV: &[u8] = include_bytes!("../../data/alks.csv");

/// The number of valid combinations of the cut-in, which is known from the published files.
const VALID_CUT_INS: &str = "29750";

/// Returns a table with a row for each scenario: the given columns, which are the same for all drivers, and a cell for each driver.
fn table(all: &[Row], columns: &[(&str, &str)], cell: impl Fn(&Row) -> String) -> String {
    let (mut text, drivers) = (String::from("| scenario |"), different(all, "driver"));
    columns.iter().for_each(|(_, title)| write!(text, " {title} |").unwrap());
    drivers.iter().for_each(|driver| write!(text, " `{driver}` |").unwrap());
    writeln!(text, "\n|{}", " --- |".repeat(1 + columns.len() + drivers.len())).unwrap();
    for scenario in different(all, "scenario") {
        let of: Vec<&Row> = all.iter().filter(|row| row["scenario"] == scenario).collect();
        write!(text, "| {scenario} |").unwrap();
        columns.iter().for_each(|(column, _)| write!(text, " {} |", of[0][column]).unwrap());
        of.iter().for_each(|row| write!(text, " {} |", cell(row)).unwrap());
        text.push('\n');
    }
    text
}

#[test]
fn the_numbers_of_the_page_follow_from_its_tests() {
    let all = rows(CSV);
    let mut page = Page::open("alks.md");
    let failures = table(&all, &[("combinations", "combinations"), ("valid", "valid")], |row| {
        format!("{} ({})", row["fail"], row["unpreventable"])
    });
    page.table("failures", &failures);
    let arrays = table(&all, &[("valid", "all"), ("tests_2", "pairs"), ("tests_3", "triples")], |row| {
        format!("{} / {} / {}", row["fail"], row["fail_2"], row["fail_3"])
    });
    page.table("arrays", &arrays);
    let of = |scenario: &str, driver: &str| -> &Row {
        all.iter().find(|row| row["scenario"].starts_with(scenario) && row["driver"] == driver).unwrap()
    };
    let stuck = all
        .iter()
        .filter(|row| row["scenario"].starts_with("4_4_1"))
        .map(|row| row["inconclusive"].parse::<u32>().unwrap());
    let stuck = stuck.min().unwrap();
    page.says(format!("The {},{:03} tests with a headway of 0 m are inconclusive", stuck / 1000, stuck % 1000));
    page.says(format!("At 5 km/h nobody avoids this ({} tests)", of("4_3_1", "cc")["unpreventable"]));
    page.says(format!("The {} failures of `aeb` are at 5 km/h", of("4_2_3", "aeb")["fail"]));
    page.says(format!("at less than 0.4 m/s in {} tests at 60 km/h", of("4_2_1", "fsm")["fail"]));
    let (fsm, planner) = (of("4_4_1", "fsm"), of("4_4_1", "planner"));
    assert_eq!([fsm["fail_3"], planner["fail_3"]], ["0", "0"]);
    page.says(format!(
        "{} tests with all triples find none of the {} failures of `fsm`, and none of the {} failures of `planner`. One of {:.0} combinations fails for `fsm`",
        fsm["tests_3"],
        fsm["fail"],
        planner["fail"],
        number(fsm, "valid") / number(fsm, "fail")
    ));
    page.given(&[
        "**4.4_1 (cut-in).**",
        "`lessThan` 0 never comes",
        "in some tests with 10 and 20 m",
        "**4.3_1 (following).** All violations are at ego speeds of 5, 10 and 15 km/h",
        "slow down to 5 m/s *below*",
    ]);
    page.given(&[
        "**4.5_1 (cut-out).**",
        "with a standing vehicle 10 to 30 m in front",
        "**4.2_3 (crossing pedestrian).**",
        "`reg157` from 30 km/h on",
        "All failures are in lane -4. In lane 4 the",
        "**4.2_1 (blocking vehicle).**",
        "**4.1_1 (free driving).** All tests pass. The test at 5 km/h",
    ]);
    page.given(&[
        "UN Regulation No. 157 says",
        "A covering array of strength 2 has all valid pairs of values, and one of strength 3 has",
        "among the tests of strength 2, and among the tests of strength 3",
        "the arrays of seed 0;",
        "a 0 in this table",
    ]);
    page.close();
}

#[test]
fn every_valid_combination_has_a_verdict_and_none_is_an_error() {
    for row in rows(CSV) {
        let count = |name: &str| row[name].parse::<usize>().unwrap();
        let judged = ["fail", "unpreventable", "pass", "inconclusive", "invalid", "error"].map(count);
        assert_eq!(judged.iter().sum::<usize>(), count("valid"), "{row:?}");
        assert_eq!(count("error"), 0, "{row:?}");
        if row["scenario"].starts_with("4_4_1") {
            assert_eq!(row["valid"], VALID_CUT_INS);
        }
    }
}
