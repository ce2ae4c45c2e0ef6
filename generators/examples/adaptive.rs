//! Measures the tests to the first failure: the table of adaptive strategies in BENCHMARKS.md.
//! `cargo run --release -p paracosm-generators --example adaptive [BATCH [SEEDS [DIMS..]]]`, a minute; with SEEDS 0 the
//! time that proposals take in so many dimensions, 5 where nothing is said. That is the processor's time of the thread
//! where the system tells it (Linux), so that a busy machine does not matter.
//!
//! Functions with a known set of failures (values below 0), which another seed puts elsewhere; a run ends after 300
//! tests and then counts as 300. Medians, and how many of the runs found a failure.

use paracosm_generators::functions::Function;
use paracosm_generators::{Request, Strategy};
use paracosm_space::{Point, Space};
use std::time::Instant;

const BUDGET: usize = 300;

/// After how many tests the first one fails; None after the budget.
fn first_failure(function: &Function, strategy: Strategy, seed: u64, batch: usize) -> Option<usize> {
    let (space, placed) = (function.space(), function.placed(seed));
    let request = Request { seed: Some(seed), ..Request::new(&space, BUDGET) };
    // As in `paracosm-fuzz bench`, words are drawn for every test.
    let mut generator = strategy.build_independent(&request).expect("a generator");
    let mut done = 0;
    while done < BUDGET {
        let tests = generator.ask(batch.min(BUDGET - done));
        let robustness: Vec<_> = tests.iter().map(|test| placed.robustness(test)).collect();
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

/// Returns the processor time of this thread in milliseconds.
fn spent(since: Instant) -> f64 {
    let of_thread = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = of_thread.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64() * 1e3, |nanoseconds| nanoseconds * 1e-6)
}

/// Returns the robustness of a function without a failure: a bowl with waves.
fn bowl(test: &Point) -> f64 {
    const HIDDEN: [f64; 5] = [0.31, 0.64, 0.45, 0.58, 0.37];
    let wave = |(x, c): (&f64, &f64)| (x - c) * (x - c) + 0.05 * (1.0 - libm::cos(20.0 * (x - c)));
    test.continuous.iter().zip(HIDDEN.iter().cycle()).map(wave).sum()
}

/// The mean time of a batch of proposals after so many tests, in milliseconds, where nothing fails and where a fifth of
/// the space does.
fn print_times(batch: usize, dims: usize) {
    let space = Space::unit_cube(dims);
    let mut all: Vec<f64> =
        Strategy::RANDOM.build(&Request::new(&space, 1000)).expect("a generator").ask(1000).iter().map(bowl).collect();
    all.sort_by(f64::total_cmp);
    let begun = Instant::now();
    for strategy in Strategy::all().filter(|strategy| strategy.is_adaptive()) {
        for (failing, offset) in [("nothing", 0.1), ("a fifth", -all[200])] {
            let mut generator = strategy.build(&Request::new(&space, 1000)).expect("a generator");
            let (mut done, mut times) = (0, Vec::new());
            while done < 520 {
                let before = spent(begun);
                let tests = generator.ask(batch);
                times.push((done, spent(begun) - before));
                let told: Vec<_> = tests.iter().map(|test| Some(offset + bowl(test))).collect();
                generator.tell(&tests, &told);
                done += tests.len();
            }
            // The system's clock is coarse: a mean, not a median.
            let mean = |after: usize| {
                let near = times.iter().filter(|(done, _)| (after - 60..after + 20).contains(done));
                near.clone().map(|time| time.1).sum::<f64>() / near.count() as f64
            };
            let [early, middle, late] = [100, 200, 500].map(mean);
            let name = strategy.name();
            println!(
                "{name:<12} {dims} dimensions, {failing} fails, batch {batch}: {early:.2} ms after 100 tests, {middle:.2} after 200, {late:.2} after 500"
            );
        }
    }
}

fn main() {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse().expect("a number"));
    let (batch, seeds) = (numbers.next().unwrap_or(16), numbers.next().unwrap_or(30));
    if seeds == 0 {
        let dims: Vec<usize> = numbers.collect();
        let dims = if dims.is_empty() { vec![5] } else { dims };
        return dims.into_iter().for_each(|dims| print_times(batch, dims));
    }
    let strategies: Vec<Strategy> = [Strategy::RANDOM, Strategy::HALTON]
        .into_iter()
        .chain(Strategy::all().filter(|strategy| strategy.is_adaptive()))
        .collect();
    print!("| function |");
    strategies.iter().for_each(|strategy| print!(" `{strategy}` |"));
    println!("\n|{}", " --- |".repeat(1 + strategies.len()));
    for function in &Function::ALL {
        print!("| {} |", function.name);
        for &strategy in &strategies {
            let runs = (0..seeds as u64).map(|seed| first_failure(function, strategy, seed, batch));
            let runs: Vec<Option<usize>> = runs.collect();
            let found = runs.iter().flatten().count();
            let mut tests: Vec<usize> = runs.into_iter().map(|run| run.unwrap_or(BUDGET)).collect();
            tests.sort_unstable();
            print!(" {} ({found}) |", tests[tests.len() / 2]);
        }
        println!();
    }
}
