//! Computes the numbers of the page on how much of a failure map a small campaign knows.

use crate::page::Page;
use crate::rows::{Row, number, numbers_of, range, rows};
use paracosm::analysis::statistics::quantile;
use std::fmt::Write;

/// The numbers of a column, in ascending order, of the campaigns of a strategy with a number of tests.
fn values(samples: &[Row], column: &str, strategy: &str, tests: u32) -> Vec<f64> {
    let mut values =
        numbers_of(samples, column, |row| row["strategy"] == strategy && row["tests"] == tests.to_string());
    values.sort_by(f64::total_cmp);
    values
}

fn median(samples: &[Row], column: &str, strategy: &str, tests: u32) -> f64 {
    quantile(&values(samples, column, strategy, tests), 0.5)
}

#[test]
fn the_numbers_of_the_page_follow_from_its_campaigns() {
    let samples = rows(include_bytes!("../../data/boundary.csv"));
    let mut page = Page::open("boundary.md");
    let mut table = String::from(
        "| strategy | tests | nearest test | model | where the model is 95 % sure | right where sure |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for strategy in ["boundary", "halton", "random"] {
        for tests in [50, 100, 200, 400] {
            let [nearest, sure, right] =
                ["nearest", "sure", "sure_right"].map(|column| median(&samples, column, strategy, tests));
            let model = values(&samples, "model", strategy, tests);
            let [least, most] = range(model.iter().copied());
            let middle = quantile(&model, 0.5);
            writeln!(table, "| `{strategy}` | {tests} | {nearest:.3} | {middle:.3} ({least:.3} to {most:.3}) | {sure:.3} | {right:.3} |").unwrap();
        }
    }
    page.table("campaigns", &table);

    let passing = number(samples.iter().find(|row| row["strategy"] == "none").unwrap(), "model");
    page.says(format!("is right at {passing:.3} of the places"));
    let model = |strategy: &str, tests: u32| median(&samples, "model", strategy, tests);
    assert!(model("halton", 200) < model("boundary", 100) && model("boundary", 100) < model("halton", 400));
    page.says(
        "With the model, 100 tests of `boundary` predict as much of the map right as 200 to 400 tests of `halton`",
    );
    let many = values(&samples, "model", "boundary", 200);
    page.says(format!(
        "200 tests reach 0.95 with {} of {} seeds",
        many.iter().filter(|share| **share >= 0.95).count(),
        many.len()
    ));
    let of_seed = |seed: &str, tests: u32, column: &str| {
        let is_it =
            |row: &&Row| row["strategy"] == "boundary" && row["seed"] == seed && row["tests"] == tests.to_string();
        number(samples.iter().find(is_it).unwrap(), column)
    };
    let seeds: Vec<String> = (0..10).map(|seed| seed.to_string()).collect();
    let worst = seeds.iter().min_by(|a, b| of_seed(a, 200, "model").total_cmp(&of_seed(b, 200, "model"))).unwrap();
    let [first, second, third] = [100, 200, 400].map(|tests| of_seed(worst, tests, "model"));
    let sure = of_seed(worst, 200, "sure");
    page.says(format!(
        "With one seed, the model is right at {first:.3} after 100 tests, at {second:.3} after 200 tests, where it is sure of {sure:.2} of the map, and at {third:.3} after 400 tests"
    ));
    for strategy in ["boundary", "halton", "random"] {
        for tests in [50, 100, 200, 400] {
            assert!(
                median(&samples, "sure_right", strategy, tests) >= 0.95,
                "the page says right at least as often as it says"
            );
        }
        assert!(values(&samples, "nearest", strategy, 400).len() == 10);
    }
    page.given(&[
        "After 50 to 400 tests",
        "and 10 seeds",
        "consists of 20,000 random tests",
        "is right at least as often as it says, from 50 tests on",
        "Between 200 and 400 tests",
    ]);
    page.given(&["100 tests of the strategy `boundary` tell as much as 200 to 400 tests of `halton`"]);
    page.close();
}
