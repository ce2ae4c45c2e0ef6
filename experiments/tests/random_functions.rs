//! Checks the table of random functions with decoys on the page on strategies: it says what the CSV of all runs says. If it is old, the test
//! prints it; UPDATE_GOLDEN=1 writes it into the page.

mod page;

use page::assert_tables;
use std::fmt::Write;

const RUNS: &str = include_str!("../data/random-functions.csv");

/// The number of tests of a run without a failure.
const CENSORED: u32 = 301;

/// Returns the strategies in the order of the file, each with the tests to the failure of each function.
fn runs() -> Vec<(&'static str, Vec<(u32, u32)>)> {
    let mut strategies: Vec<(&str, Vec<(u32, u32)>)> = Vec::new();
    for line in RUNS.lines().skip(1) {
        let [strategy, function, tests] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let run = (function.parse().unwrap(), if tests.is_empty() { CENSORED } else { tests.parse().unwrap() });
        match strategies.last_mut().filter(|last| last.0 == strategy) {
            Some(last) => last.1.push(run),
            None => strategies.push((strategy, vec![run])),
        }
    }
    strategies
}

fn table() -> String {
    let mut text = String::from(
        "| strategy | functions 1000 to 1059 | functions 1000 to 1299 | median |\n| --- | --- | --- | --- |\n",
    );
    for (strategy, runs) in runs() {
        let found = |last: u32| {
            let among: Vec<_> = runs.iter().filter(|run| run.0 <= last).collect();
            format!("{} of {}", among.iter().filter(|run| run.1 < CENSORED).count(), among.len())
        };
        let mut tests: Vec<u32> = runs.iter().map(|run| run.1).collect();
        tests.sort_unstable();
        let median = f64::from(tests[(tests.len() - 1) / 2] + tests[tests.len() / 2]) / 2.0;
        writeln!(text, "| `{strategy}` | {} | {} | {median} |", found(1059), found(1299)).unwrap();
    }
    text
}

#[test]
fn the_table_of_the_page_says_what_the_csv_says() {
    assert_tables("strategies.md", &[("random-functions", table())]);
}

#[test]
fn each_strategy_has_a_run_of_each_function() {
    for (strategy, runs) in runs() {
        let functions: Vec<u32> = runs.iter().map(|run| run.0).collect();
        assert_eq!(functions, (1000..1300).collect::<Vec<_>>(), "{strategy}");
        assert!(runs.iter().all(|run| (1..=CENSORED).contains(&run.1)));
    }
}
