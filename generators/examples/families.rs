//! Measures how often strategies find the failure of random functions with decoys.
//! `cargo run --release -p paracosm-generators --example families [FIRST [COUNT [STRATEGY..]]]`
//!
//! A run ends after 300 tests in batches of 16. Prints how many of the runs found the failure, and the median of
//! their tests, where a run without a failure counts as 301.

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
    for name in named {
        let strategy = Strategy::all().find(|strategy| strategy.name() == name).expect("a strategy");
        let runs = (first..first + count).into_par_iter().map(|number| {
            let function = Function::random(number);
            (tests_to_failure(&function, strategy, number), function)
        });
        let runs: Vec<(usize, Function)> = runs.collect();
        let mut tests: Vec<usize> = runs.iter().map(|run| run.0).collect();
        tests.sort_unstable();
        let found = tests.iter().filter(|tests| **tests <= BUDGET).count();
        println!("{name:<12} {found} of {count}, median {}", tests[tests.len() / 2]);
        if std::env::var_os("EACH").is_some() {
            runs.iter().for_each(|(tests, function)| println!("  {tests:>4} {}: {}", function.name, function.about));
        }
    }
}
