//! Whole tests per second on one core, points per second of each generator, and samples per second of formulas. Divan's items per second are the
//! figures; `baseline` is plain integer arithmetic, by which two machines (or two moods of one) can be compared.

mod baseline;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use paracosm::Study;
use paracosm::coverage::Space;
use paracosm::engine::{driver, simulate};
use paracosm::generators::{Request, Strategy};
use paracosm::oracles::{Formula, Monitor, Semantics, Trace};

fn main() {
    divan::main();
}

/// Tests of `pedestrian-crossing`: 25 simulated seconds at 100 Hz, but for those that a contact ends.
#[divan::bench(args = ["aeb", "cruise"], sample_count = 20)]
fn tests(bencher: Bencher, driver: &str) {
    const TESTS: usize = 100;
    let study = Study::of("pedestrian-crossing").unwrap();
    let program = study.program().unwrap();
    let points = study.generator().unwrap().ask(TESTS);
    let tests: Vec<_> = points.iter().map(|point| study.complete(&study.space.decode(point))).collect();
    let mut driver = driver::find(driver).unwrap().build(&[]).unwrap();
    bencher.counter(ItemsCount::new(TESTS)).bench_local(|| {
        for test in &tests {
            black_box(simulate(&program, test, driver.as_mut()).trace.map(|trace| trace.hash()));
        }
    });
}

/// Points in five dimensions, the building of the generator included. `greedy`, which thinks for milliseconds about
/// each, is asked for fewer.
#[divan::bench(args = Strategy::ALL.into_iter().filter(|s| s.dims().contains(&5)), sample_count = 20)]
fn points(bencher: Bencher, strategy: Strategy) {
    let points = if strategy == Strategy::Greedy { 100 } else { 10_000 };
    let space = Space::unit_cube(5);
    bencher.counter(ItemsCount::new(points)).bench(|| {
        let request = Request { seed: Some(1), ..Request::new(&space, points) };
        strategy.build(&request).unwrap().ask(points)
    });
}

/// One window of 0.1 s and one of 100 s should take the same time.
const FORMULAS: [&str; 4] = [
    "always always[0,0.1] (a > 0)",
    "always always[0,100] (a > 0)",
    "always (a > 0 -> eventually[0,5] b > 0)",
    "always (a > 0 -> b < 3 until[0,5] b > 0)",
];

/// Two signals of a thousand seconds at 100 Hz, each the sum of what xorshift says, slowly forgotten.
fn wandering() -> Trace {
    let mut trace = Trace::new(0.01, vec!["a".into(), "b".into()]);
    let mut x: u64 = 1;
    let mut row = [0.0; 2];
    for _ in 0..100_000 {
        for signal in &mut row {
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            *signal = 0.99 * *signal + (x >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        }
        trace.record(&row);
    }
    trace.finish();
    trace
}

/// Samples of a recorded trace.
#[divan::bench(args = FORMULAS)]
fn offline(bencher: Bencher, formula: &str) {
    let trace = wandering();
    let formula: Formula = formula.parse().unwrap();
    bencher.counter(ItemsCount::new(trace.len())).bench(|| formula.evaluate(black_box(&trace)).unwrap());
}

/// Samples of a recorded trace, and the time between them.
#[divan::bench(args = &FORMULAS[1..])]
fn dense(bencher: Bencher, formula: &str) {
    let trace = wandering();
    let formula: Formula = formula.parse().unwrap();
    bencher.counter(ItemsCount::new(trace.len())).bench(|| formula.evaluate_in(Semantics::Dense, &trace).unwrap());
}

/// Samples told one by one.
#[divan::bench(args = FORMULAS)]
fn online(bencher: Bencher, formula: &str) {
    let trace = wandering();
    let formula: Formula = formula.parse().unwrap();
    bencher.counter(ItemsCount::new(trace.len())).bench(|| {
        let mut monitor = Monitor::new(&formula, trace.signals(), trace.dt()).unwrap();
        trace.rows().for_each(|row| drop(black_box(monitor.step(row))));
        monitor.finish(true)
    });
}

/// Formulas read.
#[divan::bench]
fn parse(bencher: Bencher) {
    let text = FORMULAS[2];
    bencher.counter(ItemsCount::new(1_usize)).bench(|| black_box(text).parse::<Formula>().unwrap());
}
