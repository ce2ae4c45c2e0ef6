//! Measures whole tests per second on one core, points per second of each generator, samples per second of formulas,
//! and the roads and traffic of a city. Divan's items per second are the results. `baseline` is plain integer
//! arithmetic, to compare two machines, or one machine at two times.

mod baseline;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use nalgebra::Vector2;
use paracosm::Study;
use paracosm::engine::driver::reference;
use paracosm::engine::kinematic::CutIn;
use paracosm::engine::road::{RoadNetwork, RoutePosition, grid_city};
use paracosm::engine::sensor::{Chance, Lidar, LidarSettings, Scan, Sensor};
use paracosm::engine::traffic::{Traffic, TrafficCar};
use paracosm::engine::vehicle::{Pedals, Vehicle, VehicleModel};
use paracosm::engine::{
    AutonomousVehicle, DEFAULT_DT, Pose, Program, RoadSegment, Run, Scenario, Setup, Step, Stream, driver, simulate,
};
use paracosm::generators::{Request, Strategy};
use paracosm::oracles::{Formula, Monitor, Semantics, Trace};
use paracosm::space::Space;

fn main() {
    divan::main();
}

fn study(scenario: &str) -> Study {
    Study::of(paracosm::catalogue().find(scenario).unwrap()).build().unwrap()
}

/// Tests of `pedestrian-crossing`: 25 simulated seconds at 100 Hz, except tests that end with a contact.
#[divan::bench(args = ["aeb", "cruise"], sample_count = 20)]
fn tests(bencher: Bencher, driver: &str) {
    const TESTS: usize = 100;
    let study = study("pedestrian-crossing");
    let program = study.program().unwrap();
    let points = study.generator(&[]).unwrap().ask(TESTS);
    let tests: Vec<_> = points.iter().map(|point| study.complete(&study.space().decode(point))).collect();
    let mut driver = driver::find(driver).unwrap().build(&[]).unwrap();
    bencher.counter(ItemsCount::new(TESTS)).bench_local(|| {
        for test in &tests {
            black_box(
                simulate(program, test, VehicleModel::SingleTrack, driver.as_mut()).trace.map(|trace| trace.hash()),
            );
        }
    });
}

/// The same tests with the jointed car, which the physics engine moves.
#[divan::bench(sample_count = 20)]
fn jointed_tests(bencher: Bencher) {
    const TESTS: usize = 20;
    let study = study("pedestrian-crossing");
    let program = study.program().unwrap();
    let points = study.generator(&[]).unwrap().ask(TESTS);
    let tests: Vec<_> = points.iter().map(|point| study.complete(&study.space().decode(point))).collect();
    let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
    bencher.counter(ItemsCount::new(TESTS)).bench_local(|| {
        for test in &tests {
            black_box(simulate(program, test, VehicleModel::Jointed, driver.as_mut()).trace.map(|trace| trace.hash()));
        }
    });
}

/// Simulated seconds of `grid-traffic`: an ego vehicle on its way among a hundred cars.
#[divan::bench(sample_count = 20)]
fn grid_traffic(bencher: Bencher) {
    let study = study("grid-traffic");
    let program = study.program().unwrap();
    let test = program.declare().unwrap().nominal();
    let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
    let mut run =
        || simulate(program, &test, VehicleModel::SingleTrack, driver.as_mut()).trace.map(|trace| trace.len());
    let seconds = run().unwrap() as f64 * 0.02;
    bencher.counter(ItemsCount::new(seconds as usize)).bench_local(run);
}

/// Scans of a LiDAR with 32 channels and 1,800 columns, half a minute into `grid-traffic`, with noise and drop-off.
#[divan::bench(sample_count = 20)]
fn lidar_scans(bencher: Bencher) {
    const SCANS: usize = 10;
    let study = study("grid-traffic");
    let program = study.program().unwrap();
    let test = program.declare().unwrap().nominal();
    let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
    let mut run = Run::new(program, &test, Setup::asking_every(driver.period())).unwrap();
    driver.reset(&run.briefing()).unwrap();
    while run.time() < 30.0 {
        let Step::Need(observation) = run.advance() else { panic!("the car has come to its end") };
        let control = driver.step(observation).unwrap();
        run.supply(control);
    }
    let mut lidar = Lidar::new(LidarSettings::default()).unwrap();
    let (view, mut scan) = (run.view(), Scan::default());
    bencher.counter(ItemsCount::new(SCANS)).bench_local(|| {
        for number in 0..SCANS {
            lidar.sense(&view, &mut Chance::of(1, "lidar", number as u64), black_box(&mut scan));
        }
    });
}

/// Cut-ins of UN R157 in the plain kinematic world, with each reference driver.
#[divan::bench(args = reference::ALL.map(|(name, _)| name), sample_count = 20)]
fn cut_ins(bencher: Bencher, driver: &str) {
    const CUT_INS: usize = 30_000;
    let (_, drive) = reference::ALL.into_iter().find(|(name, _)| *name == driver).unwrap();
    let points = Strategy::HALTON.build(&Request::new(&Space::unit_cube(4), 3 * CUT_INS)).unwrap().ask(3 * CUT_INS);
    let valid = points.into_iter().filter_map(|point| CutIn::from_unit(point.continuous.try_into().unwrap()));
    let encounters: Vec<_> = valid.map(|cut_in| cut_in.encounter()).take(CUT_INS).collect();
    assert_eq!(encounters.len(), CUT_INS);
    bencher
        .counter(ItemsCount::new(CUT_INS))
        .bench_local(|| encounters.iter().filter(|encounter| drive(encounter).collision.is_some()).count());
}

/// Drives of a car over 10 seconds at 100 Hz, with throttle, brakes and steering.
#[divan::bench(args = VehicleModel::ALL, sample_count = 20)]
fn ways(bencher: Bencher, model: VehicleModel) {
    const WAYS: usize = 10;
    let start = Pose { position: Vector2::zeros(), heading: 0.0 };
    bencher.counter(ItemsCount::new(WAYS)).bench(|| {
        for _ in 0..WAYS {
            let mut car = model.build(&Vehicle::BMW_320I, start, 15.0);
            for tick in 0..1000 {
                let throttle = if tick % 200 < 120 { 0.3 } else { -0.4 };
                let steering = if tick % 300 < 150 { 0.02 } else { -0.02 };
                car.step(Pedals { throttle, steering }, 0.8, DEFAULT_DT);
            }
            black_box(car.state().travelled);
        }
    });
}

/// Nodes of streams, evaluated in each tick of a run of 1,000 ticks: arithmetic, a comparison, a closure, and a node
/// with memory. The rest of the run takes the time of about thirty nodes.
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
    let program = Program::new("streams", "many nodes", build);
    let test = program.declare().unwrap().nominal();
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    bencher
        .counter(ItemsCount::new(CHAINS * NODES * 1000))
        .with_inputs(|| Run::new(&program, &test, Setup::asking_every(0.1)).unwrap())
        .bench_local_values(|mut run| black_box(run.drive(driver.as_mut())));
}

/// Points in five dimensions, including the construction of the generator. Strategies that fill holes take milliseconds for each point,
/// so they are asked for fewer points.
#[divan::bench(args = Strategy::all().filter(|s| s.dims().contains(&5) && !s.is_adaptive()), sample_count = 20)]
fn points(bencher: Bencher, strategy: Strategy) {
    let points = if strategy.fills_holes() { 100 } else { 10_000 };
    let space = Space::unit_cube(5);
    bencher.counter(ItemsCount::new(points)).bench(|| {
        let request = Request { seed: Some(1), ..Request::new(&space, points) };
        strategy.build(&request).unwrap().ask(points)
    });
}

/// The window of 0.1 s and the window of 100 s should take the same time.
const FORMULAS: [&str; 4] = [
    "always always[0,0.1] (a > 0)",
    "always always[0,100] (a > 0)",
    "always (a > 0 -> eventually[0,5] b > 0)",
    "always (a > 0 -> b < 3 until[0,5] b > 0)",
];

/// Returns two signals of a thousand seconds at 100 Hz, each a slowly decaying sum of xorshift's numbers.
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

/// Evaluation of a recorded trace, in samples.
#[divan::bench(args = FORMULAS)]
fn offline(bencher: Bencher, formula: &str) {
    let trace = wandering();
    let formula: Formula = formula.parse().unwrap();
    bencher.counter(ItemsCount::new(trace.len())).bench(|| formula.evaluate(black_box(&trace)).unwrap());
}

/// Evaluation of a recorded trace, including the time between the samples.
#[divan::bench(args = &FORMULAS[1..])]
fn dense(bencher: Bencher, formula: &str) {
    let trace = wandering();
    let formula: Formula = formula.parse().unwrap();
    bencher.counter(ItemsCount::new(trace.len())).bench(|| formula.evaluate_in(Semantics::Dense, &trace).unwrap());
}

/// The same evaluation, with the part of the formula and the time that decide the robustness.
#[divan::bench(args = &FORMULAS[1..])]
fn dense_cause(bencher: Bencher, formula: &str) {
    let trace = wandering();
    let formula: Formula = formula.parse().unwrap();
    bencher
        .counter(ItemsCount::new(trace.len()))
        .bench(|| formula.explain_in(Semantics::Dense, &trace).unwrap().is_some());
}

/// Online monitoring of samples, one by one.
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

/// Parsing of formulas.
#[divan::bench]
fn parse(bencher: Bencher) {
    let text = FORMULAS[2];
    bencher.counter(ItemsCount::new(1_usize)).bench(|| black_box(text).parse::<Formula>().unwrap());
}

/// The city of the paper's Figure 3: 20 x 20 junctions, 5,848 lanes.
fn figure_3() -> std::sync::Arc<RoadNetwork> {
    grid_city(20, 20, 80.0, 2).build().unwrap()
}

/// Connecting the city's elements, checking them and building the lane graph.
#[divan::bench(sample_count = 20)]
fn city(bencher: Bencher) {
    bencher.bench(figure_3);
}

/// Projections of positions all over the city, most of them far from any street, onto the nearest lane.
#[divan::bench(sample_count = 20)]
fn projections(bencher: Bencher) {
    const POSITIONS: usize = 10_000;
    let city = figure_3();
    let (low, high) = (city.bounds().min, city.bounds().max);
    // The positions follow the plastic number's Kronecker sequence.
    let share = |i: usize, step: f64| (i as f64 * step).fract();
    let position =
        |i| Vector2::new(share(i, 0.754_877_666), share(i, 0.569_840_291)).component_mul(&(high - low)) + low;
    let positions: Vec<Vector2<f64>> = (0..POSITIONS).map(position).collect();
    bencher
        .counter(ItemsCount::new(POSITIONS))
        .bench(|| positions.iter().map(|position| city.project(*position).distance).sum::<f64>());
}

/// Shortest routes between lanes all over the city.
#[divan::bench(sample_count = 20)]
fn routes(bencher: Bencher) {
    const ROUTES: usize = 50;
    let city = figure_3();
    let ids: Vec<_> = city.ids().collect();
    let place = |i: usize| RoutePosition { lane: ids[i % ids.len()], s: 1.0 };
    bencher.counter(ItemsCount::new(ROUTES)).bench(|| {
        (0..ROUTES)
            .map(|i| city.route(place(1009 * i), place(2503 * i + 1), 20.0).map_or(0, |way| way.lanes.len()))
            .sum::<usize>()
    });
}

/// Steps of traffic all over the city, each a fiftieth of a second. Half of the cars change lanes if it saves them
/// time; the streets have two lanes for each direction.
#[divan::bench(args = [10, 100, 1000], sample_count = 20)]
fn traffic(bencher: Bencher, cars: usize) {
    const STEPS: usize = 500;
    const DT: f64 = 0.02;
    let city = grid_city(20, 20, 80.0, 4).build().unwrap();
    let scattered = TrafficCar::scattered(&city, cars, 1).into_iter().enumerate();
    let scattered = scattered.map(|(i, car)| if i.is_multiple_of(2) { car.changing_lanes() } else { car }).collect();
    let mut traffic = Traffic::new(city, scattered, 1).unwrap();
    // The traffic first runs from standstill to its usual state.
    (0..STEPS).for_each(|_| traffic.step(DT, &[]));
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| (0..STEPS).for_each(|_| traffic.step(DT, &[])));
}
