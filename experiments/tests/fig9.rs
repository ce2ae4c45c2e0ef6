//! Checks the tables of recalls on the pages of Figure 9: they say what the CSV of all sets says. If a table is old, the test prints it;
//! UPDATE_GOLDEN=1 writes it into the page.

mod page;

use page::assert_tables;
use paracosm::analysis::statistics::{bootstrap_interval, median_and_quartiles, vargha_delaney};
use std::collections::BTreeMap;
use std::fmt::Write;

const STRATEGIES: [&str; 5] = ["random", "halton", "sobol-owen", "lhs", "greedy"];

/// Returns the recalls of the sets by strategy and number of tests, in the order of their seeds.
fn recalls(csv: &'static str) -> BTreeMap<(&'static str, usize), Vec<f64>> {
    let mut recalls: BTreeMap<(&str, usize), Vec<f64>> = BTreeMap::new();
    for line in csv.lines().skip(1) {
        let [strategy, tests, seed, recall] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let sets = recalls.entry((strategy, tests.parse().unwrap())).or_default();
        assert_eq!(seed, sets.len().to_string());
        sets.push(recall.parse().unwrap());
    }
    recalls
}

/// The table of medians with quartiles, and of the probability that a set of the strategy has a larger recall than a random set, with its
/// 95 % bootstrap interval over the sets.
fn table(csv: &'static str, sizes: [usize; 3]) -> String {
    let recalls = recalls(csv);
    let mut text = String::from("| strategy |");
    sizes.iter().for_each(|size| write!(text, " {size} tests | P(better) |").unwrap());
    text += "\n| --- | --- | --- | --- | --- | --- | --- |\n";
    for strategy in STRATEGIES {
        write!(text, "| `{strategy}` |").unwrap();
        for size in sizes {
            let (own, random) = (&recalls[&(strategy, size)], &recalls[&("random", size)]);
            assert!(own.len() >= 200);
            let (median, [lower, upper]) = median_and_quartiles(own);
            let percent = |share: f64| format!("{:.0}", 100.0 * share);
            write!(text, " {} % ({} to {}) |", percent(median), percent(lower), percent(upper)).unwrap();
            if strategy == "random" {
                text += " |";
                continue;
            }
            let [low, high] = bootstrap_interval(own.len(), |drawn| {
                let of = |values: &[f64]| drawn.iter().map(|i| values[*i]).collect::<Vec<_>>();
                vargha_delaney(&of(own), &of(random))
            });
            write!(text, " {:.2} ({low:.2} to {high:.2}) |", vargha_delaney(own, random)).unwrap();
        }
        text.push('\n');
    }
    text
}

#[test]
fn the_tables_of_the_pages_say_what_the_csv_says() {
    let pages = [
        ("fig9.md", include_str!("../data/fig9-recalls.csv"), [25, 100, 500]),
        ("fig9-cnn.md", include_str!("../data/fig9-cnn-recalls.csv"), [25, 50, 100]),
    ];
    for (name, csv, sizes) in pages {
        assert_tables(name, &[("recalls", table(csv, sizes))]);
    }
}
