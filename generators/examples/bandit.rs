//! Measures the tests to the first failure of one of two requirements, driven by the worse requirement or by a bandit
//! over both. `cargo run --release -p paracosm-generators --example bandit [BATCH [SEEDS]]`, some minutes.
//!
//! Medians over seeds, each of which puts the failure elsewhere; a run ends after 300 tests and then counts as 300.

use paracosm_generators::{Bandit, Generator, Request, Strategy};
use paracosm_space::{Point, Space};

const BUDGET: usize = 300;

/// Two requirements: what their robustness is where the seed puts the failure.
type Requirements = fn(&Point, &Point) -> [f64; 2];

/// The robustness of a ball of failures around a place, a thousandth of five dimensions.
fn ball(x: &Point, hidden: &Point) -> f64 {
    distance(x, hidden) - 0.1801
}

fn distance(x: &Point, y: &Point) -> f64 {
    x.continuous.iter().zip(&y.continuous).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

fn opposite(x: &Point) -> Point {
    Point { continuous: x.continuous.iter().map(|u| 1.0 - u).collect(), ..Point::default() }
}

const CASES: [(&str, Requirements); 5] = [
    // The first is never violated, but always the worse until the second is nearly violated.
    ("masked", |x, hidden| [0.05 + 0.02 * distance(x, &opposite(hidden)), ball(x, hidden)]),
    ("masked, flat", |x, hidden| [0.02, ball(x, hidden)]),
    // The first never matters.
    ("clear", |x, hidden| [5.0 + distance(x, &opposite(hidden)), ball(x, hidden)]),
    // Both lead to the same failure.
    ("alike", |x, hidden| [ball(x, hidden), 2.0 * ball(x, hidden)]),
    // Each has its own failure.
    ("two", |x, hidden| [ball(x, &opposite(hidden)), ball(x, hidden)]),
];

fn main() {
    let mut arguments = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let (batch, seeds) = (arguments.next().unwrap_or(16), arguments.next().unwrap_or(20));
    let strategies = [Strategy::ANNEAL, Strategy::PSO, Strategy::NELDER_MEAD, Strategy::CMAES, Strategy::BAYES];
    println!("{:<14}{:<14}{:>8}{:>8}", "case", "strategy", "worst", "bandit");
    for (name, requirements) in CASES {
        for strategy in strategies {
            let median = |arms: usize| {
                let mut counts: Vec<usize> =
                    (1..=seeds as u64).map(|seed| first_failure(strategy, requirements, seed, batch, arms)).collect();
                counts.sort_unstable();
                counts[counts.len() / 2]
            };
            println!("{name:<14}{:<14}{:>8}{:>8}", strategy.name(), median(1), median(2));
        }
    }
}

/// Returns the number of tests with one search for the worse requirement, or with a search for each.
fn first_failure(strategy: Strategy, requirements: Requirements, seed: u64, batch: usize, arms: usize) -> usize {
    let space = Space::unit_cube(5);
    let hidden =
        Strategy::RANDOM.build(&Request { seed: Some(seed + 1000), ..Request::new(&space, 1) }).unwrap().ask(1);
    let hidden = Point { continuous: hidden[0].continuous.iter().map(|u| 0.2 + 0.6 * u).collect(), ..Point::default() };
    let request = Request { seed: Some(seed), ..Request::new(&space, BUDGET) };
    let searches: Vec<Box<dyn Generator>> = (0..arms).map(|_| strategy.build(&request).unwrap()).collect();
    let mut bandit = Bandit::new(searches);
    let mut done = 0;
    while done < BUDGET {
        let tests = bandit.ask(batch.min(BUDGET - done));
        let told: Vec<[f64; 2]> = tests.iter().map(|test| requirements(test, &hidden)).collect();
        if let Some(at) = told.iter().position(|robustness| robustness.iter().any(|robustness| *robustness < 0.0)) {
            return done + at + 1;
        }
        let told = told.iter().map(|both| match arms {
            1 => vec![Some(both[0].min(both[1]))],
            _ => both.map(Some).to_vec(),
        });
        bandit.tell(&tests, &told.collect::<Vec<_>>());
        done += tests.len();
    }
    BUDGET
}
