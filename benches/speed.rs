//! Whole tests per second on one core, points per second of each generator, and a city's roads. Divan's items per
//! second are the figures; `baseline` is plain integer arithmetic, by which two machines (or two moods of one) can be
//! compared.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use nalgebra::Vector2;
use paracosm::Study;
use paracosm::coverage::Space;
use paracosm::engine::road::{Network, Place, grid_city};
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

/// The city of the paper's Figure 3: 20 x 20 junctions, 5,848 lanes.
fn figure_3() -> std::sync::Arc<Network> {
    grid_city(20, 20, 80.0, 2).build().unwrap()
}

/// Connecting the city's elements, checking them and building the lane graph.
#[divan::bench(sample_count = 20)]
fn city(bencher: Bencher) {
    bencher.bench(figure_3);
}

/// Positions all over the city, most of them far from any street, projected onto the nearest lane.
#[divan::bench(sample_count = 20)]
fn projections(bencher: Bencher) {
    const POSITIONS: usize = 10_000;
    let city = figure_3();
    let (low, high) = (city.bounds().min, city.bounds().max);
    // The plastic number's Kronecker sequence.
    let share = |i: usize, step: f64| (i as f64 * step).fract();
    let position =
        |i| Vector2::new(share(i, 0.754_877_666), share(i, 0.569_840_291)).component_mul(&(high - low)) + low;
    let positions: Vec<Vector2<f64>> = (0..POSITIONS).map(position).collect();
    bencher
        .counter(ItemsCount::new(POSITIONS))
        .bench(|| positions.iter().map(|position| city.project(*position).distance).sum::<f64>());
}

/// Shortest ways between lanes all over the city.
#[divan::bench(sample_count = 20)]
fn routes(bencher: Bencher) {
    const ROUTES: usize = 50;
    let city = figure_3();
    let ids: Vec<_> = city.ids().collect();
    let place = |i: usize| Place { lane: ids[i % ids.len()], s: 1.0 };
    bencher.counter(ItemsCount::new(ROUTES)).bench(|| {
        (0..ROUTES)
            .map(|i| city.route(place(1009 * i), place(2503 * i + 1), 20.0).map_or(0, |way| way.lanes.len()))
            .sum::<usize>()
    });
}
