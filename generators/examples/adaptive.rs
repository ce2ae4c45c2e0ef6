//! How many tests it takes to the first failure: the table of adaptive strategies in BENCHMARKS.md.
//! `cargo run --release -p paracosm-generators --example adaptive [BATCH [SEEDS]]`, a minute; with SEEDS 0 the time that
//! proposals take.
//!
//! Functions with a known set of failures (values below 0), which another seed puts elsewhere; a run ends after 300 tests
//! and then counts as 300. Medians, and how many of the runs found a failure.

use paracosm_coverage::{Domain, Parameter, Point, Space, Value};
use paracosm_generators::{Request, Strategy};
use std::time::Instant;

const BUDGET: usize = 300;

/// A test function: its name, its space, and its robustness, given where the seed puts the failure.
struct Case {
    name: &'static str,
    dims: usize,
    /// Words of so many levels.
    words: &'static [usize],
    robustness: fn(&Point, &Point) -> Option<f64>,
}

const CASES: [Case; 10] = [
    // Within 0.05 of a corner on every axis: one corner of 32.
    Case {
        name: "corner5",
        dims: 5,
        words: &[],
        robustness: |x, hidden| {
            let corner = |(x, c): (&f64, &f64)| (x - c.round()).abs();
            Some(x.continuous.iter().zip(&hidden.continuous).map(corner).fold(0.0, f64::max) - 0.05)
        },
    },
    // A ball of volume 1e-3 in the interior.
    Case { name: "ball5", dims: 5, words: &[], robustness: |x, hidden| Some(distance(x, hidden) - 0.1801) },
    // The same, but the slope leads elsewhere from most places.
    Case {
        name: "decoy5",
        dims: 5,
        words: &[],
        robustness: |x, hidden| {
            let decoy = Point { continuous: hidden.continuous.iter().map(|c| 1.0 - c).collect(), ..Point::default() };
            Some((2.0 * (distance(x, hidden) - 0.1801)).min(0.05 + distance(x, &decoy)))
        },
    },
    // The same, next to a region where tests end in errors.
    Case {
        name: "errors5",
        dims: 5,
        words: &[],
        robustness: |x, hidden| {
            let away = if hidden.continuous[0] < 0.5 { x.continuous[0] > 0.55 } else { x.continuous[0] < 0.45 };
            (!away).then(|| distance(x, hidden) - 0.1801)
        },
    },
    // Rosenbrock's valley: the failure, about 1e-3 of the plane, lies at its end.
    Case {
        name: "valley2",
        dims: 2,
        words: &[],
        robustness: |x, _| {
            let (a, b) = (4.0 * x.continuous[0] - 2.0, 4.0 * x.continuous[1] - 1.0);
            let (bend, ahead) = (b - a * a, 1.0 - a);
            Some(100.0 * bend * bend + ahead * ahead - 0.04)
        },
    },
    // A shell of volume 2e-3 around a point.
    Case {
        name: "ring2",
        dims: 2,
        words: &[],
        robustness: |x, hidden| Some((distance(x, hidden) - 0.2).abs() - 0.0008),
    },
    // Many minima, the failure in one of them.
    Case {
        name: "rough3",
        dims: 3,
        words: &[],
        robustness: |x, hidden| {
            let wave = |(x, c): (&f64, &f64)| 0.05 * (1.0 - libm::cos(30.0 * (x - c)));
            let waves: f64 = x.continuous.iter().zip(&hidden.continuous).map(wave).sum();
            Some(distance(x, hidden) + waves - 0.08)
        },
    },
    // Twenty axes of which three matter.
    Case {
        name: "few20",
        dims: 20,
        words: &[],
        robustness: |x, hidden| {
            let part = |i: usize| (x.continuous[i] - hidden.continuous[i]) * (x.continuous[i] - hidden.continuous[i]);
            Some((part(2) + part(9) + part(16)).sqrt() - 0.062)
        },
    },
    // One combination of words out of 64, each of which helps by itself, and a disc.
    Case {
        name: "words2",
        dims: 2,
        words: &[4, 4, 4],
        robustness: |x, hidden| Some(0.2 * wrong(x, hidden) as f64 + distance(x, hidden) - 0.15),
    },
    // One combination out of 16, which alone helps.
    Case {
        name: "needle2",
        dims: 2,
        words: &[4, 4],
        robustness: |x, hidden| Some(if wrong(x, hidden) > 0 { 0.5 } else { 0.0 } + distance(x, hidden) - 0.15),
    },
];

fn distance(x: &Point, hidden: &Point) -> f64 {
    let part = |(a, b): (&f64, &f64)| (a - b) * (a - b);
    x.continuous.iter().zip(&hidden.continuous).map(part).sum::<f64>().sqrt()
}

fn wrong(x: &Point, hidden: &Point) -> usize {
    x.discrete.iter().zip(&hidden.discrete).filter(|(a, b)| a != b).count()
}

impl Case {
    fn space(&self) -> Space {
        let word = |(i, &levels): (usize, &usize)| {
            let levels = (0..levels).map(|level| Value::Word(format!("w{level}"))).collect();
            Parameter::new(format!("word{i}"), Domain::Choice(levels))
        };
        let words = self.words.iter().enumerate().map(word);
        Space::new(Space::unit_cube(self.dims).parameters().iter().cloned().chain(words).collect()).expect("a space")
    }

    /// After how many tests the first one fails; None after the budget.
    fn first_failure(&self, strategy: Strategy, seed: u64, batch: usize) -> Option<usize> {
        let space = self.space();
        let request = |seed| Request { seed: Some(seed), ..Request::new(&space, BUDGET) };
        // The failure is another random test, away from the border so that its volume is what it is.
        let mut hidden = Strategy::Random.build(&request(1_000_000 + seed)).expect("a test").ask(1).remove(0);
        hidden.continuous.iter_mut().for_each(|u| *u = 0.19 + 0.62 * *u);
        hidden.discrete.iter_mut().zip(self.words).for_each(|(level, &levels)| {
            *level = (*level + seed as usize * 7 + seed as usize / levels) % levels;
        });
        let mut generator = strategy.build(&request(seed)).expect("a generator");
        let mut done = 0;
        while done < BUDGET {
            let tests = generator.ask(batch.min(BUDGET - done));
            let robustness: Vec<_> = tests.iter().map(|test| (self.robustness)(test, &hidden)).collect();
            if let Some(index) = robustness.iter().position(|r| r.is_some_and(|r| r < 0.0)) {
                return Some(done + index + 1);
            }
            if tests.is_empty() {
                return None;
            }
            generator.tell(&tests, &robustness);
            done += tests.len();
        }
        None
    }
}

/// The median time of a batch of proposals after so many tests, in milliseconds, where no failure can be found.
fn print_times(batch: usize) {
    let space = Space::unit_cube(5);
    let hidden = [0.31, 0.64, 0.45, 0.58, 0.37];
    for strategy in Strategy::ALL.into_iter().filter(|strategy| strategy.is_adaptive()) {
        let mut generator = strategy.build(&Request::new(&space, 1000)).expect("a generator");
        let (mut done, mut spent) = (0, Vec::new());
        while done < 520 {
            let begun = Instant::now();
            let tests = generator.ask(batch);
            spent.push((done, begun.elapsed().as_secs_f64() * 1e3));
            let wave = |(x, c): (&f64, &f64)| (x - c) * (x - c) + 0.05 * (1.0 - libm::cos(20.0 * (x - c)));
            let robustness = |test: &Point| Some(0.1 + test.continuous.iter().zip(&hidden).map(wave).sum::<f64>());
            let told: Vec<_> = tests.iter().map(robustness).collect();
            generator.tell(&tests, &told);
            done += tests.len();
        }
        for after in [100, 200, 500] {
            let near = spent.iter().filter(|(done, _)| (after - 60..after + 20).contains(done));
            let mut near: Vec<f64> = near.map(|spent| spent.1).collect();
            near.sort_by(f64::total_cmp);
            println!("{:<12} batch {batch} after {after} tests: {:.2} ms", strategy.name(), near[near.len() / 2]);
        }
    }
}

fn main() {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse().expect("a number"));
    let (batch, seeds) = (numbers.next().unwrap_or(16), numbers.next().unwrap_or(30));
    if seeds == 0 {
        return print_times(batch);
    }
    let strategies: Vec<Strategy> = [Strategy::Random, Strategy::Halton]
        .into_iter()
        .chain(Strategy::ALL.into_iter().filter(|strategy| strategy.is_adaptive()))
        .collect();
    print!("| function |");
    strategies.iter().for_each(|strategy| print!(" `{strategy}` |"));
    println!("\n|{}", " --- |".repeat(1 + strategies.len()));
    for case in &CASES {
        print!("| {} |", case.name);
        for &strategy in &strategies {
            let runs = (0..seeds as u64).map(|seed| case.first_failure(strategy, seed, batch));
            let runs: Vec<Option<usize>> = runs.collect();
            let found = runs.iter().flatten().count();
            let mut tests: Vec<usize> = runs.into_iter().map(|run| run.unwrap_or(BUDGET)).collect();
            tests.sort_unstable();
            print!(" {} ({found}) |", tests[tests.len() / 2]);
        }
        println!();
    }
}
