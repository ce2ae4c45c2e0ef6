//! Measures how often strategies find the failure of random functions with decoys.
//! `cargo run --release -p paracosm-generators --example families [FIRST [COUNT [STRATEGY..]]]`
//!
//! A run ends after 300 tests in batches of 16. Prints a row of CSV for each run, with the number of tests to the failure, which is empty if
//! there is none. Says on standard error how many of the runs found the failure, and the median of their tests, where a run
//! without a failure counts as 301.

use paracosm_generators::functions::Function;
use paracosm_generators::{Request, Strategy};
use rayon::prelude::*;

const BUDGET: usize = 300;
const BATCH: usize = 16;

/// The number of tests to the first failure; one more than the budget if there is none.
fn tests_to_failure(function: &Function, strategy: Strategy, seed: u64) -> usize {
    let (space, placed) = (function.space(), function.placed(seed));
    let request = Request { seed: Some(seed), ..Request::new(&space, BUDGET) };
    let mut generator = strategy.build_independent(&request).expect("a generator");
    let mut done = 0;
    while done < BUDGET {
        let tests = generator.ask(BATCH.min(BUDGET - done));
        let robustness: Vec<_> = tests.iter().map(|test| placed.robustness(test)).collect();
        if let Some(index) = robustness.iter().position(|r| r.is_some_and(|r| r < 0.0)) {
            return done + index + 1;
        }
        if tests.is_empty() {
            break;
        }
        generator.tell(&tests, &robustness);
        done += tests.len();
    }
    BUDGET + 1
}

fn main() {
    let mut words = std::env::args().skip(1);
    let mut number = |or| words.next().map_or(or, |text| text.parse().expect("a number"));
    let (first, count): (u64, u64) = (number(0), number(60).max(1));
    let named: Vec<String> = words.collect();
    let named =
        if named.is_empty() { vec!["random".into(), "gp-cmaes".into(), "bayes".into(), "auto".into()] } else { named };
    println!("strategy,function,tests");
    for name in named {
        let strategy = Strategy::all().find(|strategy| strategy.name() == name).expect("a strategy");
        let runs = (first..first + count).into_par_iter();
        let runs: Vec<usize> =
            runs.map(|number| tests_to_failure(&Function::random(number), strategy, number)).collect();
        for (number, tests) in (first..).zip(&runs) {
            println!("{name},{number},{}", if *tests <= BUDGET { tests.to_string() } else { String::new() });
        }
        let mut sorted = runs;
        sorted.sort_unstable();
        let found = sorted.iter().filter(|tests| **tests <= BUDGET).count();
        eprintln!("{name:<16} {found} of {count}, median {}", sorted[sorted.len() / 2]);
    }
}
