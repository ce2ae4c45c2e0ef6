//! Whole tests per second on one core, and points per second of each generator. Divan's items per second are the
//! figures; `baseline` is plain integer arithmetic, by which two machines (or two moods of one) can be compared.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use paracosm::Study;
use paracosm::coverage::Space;
use paracosm::engine::{AutonomousVehicle, DEFAULT_DT, Program, RoadSegment, Run, Scenario, Stream, driver, simulate};
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

/// Nodes of streams evaluated in each tick of a run of 1,000 ticks: arithmetic, a comparison, a closure, and what
/// remembers something. The run around them takes the time of some thirty nodes.
#[divan::bench(sample_count = 20)]
fn stream_nodes(bencher: Bencher) {
    const CHAINS: usize = 100;
    const NODES: usize = 10;
    fn build(s: &mut Scenario) {
        let road = s.place(RoadSegment::new(200.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)));
        s.duration(10.0);
        let mut chain: Stream<f64> = car.speed();
        for _ in 0..CHAINS {
            let near = (&chain + car.travelled()).below(5.0);
            let held = chain.map(|x| 0.5 * x).when(&near).merge(&-&chain).hold(0.0);
            chain = held.pre().skip_until(&near).max(&held);
        }
        s.place(chain.for_each(|x| assert!(x.is_finite())));
    }
    let program = Program { name: "streams", about: "many nodes", build };
    let test = program.declare().unwrap().nominal();
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    bencher
        .counter(ItemsCount::new(CHAINS * NODES * 1000))
        .with_inputs(|| Run::new(&program, &test, DEFAULT_DT, 0.1).unwrap())
        .bench_local_values(|mut run| black_box(run.drive(driver.as_mut())));
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
