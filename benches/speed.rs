//! Whole tests per second on one core, and points per second of each generator. Divan's items per second are the
//! figures; `baseline` is plain integer arithmetic, by which two machines (or two moods of one) can be compared.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use paracosm::Study;
use paracosm::coverage::Space;
use paracosm::engine::{driver, simulate};
use paracosm::generators::{Request, Strategy};

fn main() {
    divan::main();
}

/// Steps of Marsaglia's xorshift (2003): three shifts each, one after the other.
#[divan::bench]
fn baseline(bencher: Bencher) {
    const STEPS: u64 = 1_000_000;
    let step = |x: u64, _| {
        let x = x ^ (x << 13);
        let x = x ^ (x >> 7);
        x ^ (x << 17)
    };
    bencher.counter(ItemsCount::new(STEPS)).bench(|| (0..black_box(STEPS)).fold(1, step));
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
