//! The works whose instructions are counted: the key works of tests, strategies, measures, formulas and sensors.

use paracosm::Study;
use paracosm::coverage::dispersion::dispersion;
use paracosm::coverage::extreme::extreme_discrepancy;
use paracosm::coverage::star::star_discrepancy;
use paracosm::coverage::{Deadline, PointSet};
use paracosm::engine::sensor::{Chance, Lidar, LidarSettings, Radar, RadarSettings, Sensor};
use paracosm::engine::vehicle::VehicleModel;
use paracosm::engine::{AutonomousVehicle, Program, RoadSegment, Run, Scenario, Setup, Step, Stream, driver, simulate};
use paracosm::generators::covering::{CoveringRequest, covering_array};
use paracosm::generators::{Request, Strategy};
use paracosm::oracles::{Formula, Trace};
use paracosm::space::Space;
use paracosm::space::rules::Rules;
use std::hint::black_box;

/// A work that is ready to be done. Its instructions are counted; the instructions of its preparation are not.
pub type Ready = Box<dyn FnMut()>;

/// A work, as a name and a function that prepares the work.
pub type Work = (&'static str, fn() -> Ready);

/// All works.
pub const ALL: &[Work] = &[
    ("5 tests of pedestrian-crossing", || tests("pedestrian-crossing", 5)),
    ("2 tests of follow-leader", || tests("follow-leader", 2)),
    ("2 tests of cut-out", || tests("cut-out", 2)),
    ("2 tests of ncap-cpna", || tests("ncap-cpna", 2)),
    ("1 test of t-loop", || tests("t-loop", 1)),
    ("1 test of grid-traffic", || tests("grid-traffic", 1)),
    ("100 ticks of a graph of 1000 nodes", graph),
    ("1000 points of halton", || points(Strategy::HALTON)),
    ("1000 points of sobol", || points(Strategy::SOBOL)),
    ("1000 points of sobol-owen", || points(Strategy::SOBOL_OWEN)),
    ("1000 points of lhs", || points(Strategy::LHS)),
    ("1000 points of random", || points(Strategy::RANDOM)),
    ("dispersion of 1000 points in 3 dimensions", || {
        measured(3, 1_000, |p| dispersion(p, Deadline::never()).volume.lower)
    }),
    ("star discrepancy of 10000 points in the plane", || {
        measured(2, 10_000, |p| star_discrepancy(p, Deadline::never()).lower)
    }),
    ("extreme discrepancy of 1000 points in the plane", || {
        measured(2, 1_000, |p| extreme_discrepancy(p, Deadline::never()).lower)
    }),
    ("array of strength 3 for 10 parameters with 4 values", array),
    ("formula over 10000 samples", formula),
    ("scan of a lidar", || sensed(Lidar::new(LidarSettings::default()).expect("sound settings"))),
    ("scan of a radar", || sensed(Radar::new(RadarSettings::default()).expect("sound settings"))),
    #[cfg(feature = "camera")]
    ("100 scenes for frames of a camera", frames),
];

/// The first tests of a scenario, with `aeb`, by Halton points: building, running, judging and hashing.
fn tests(scenario: &str, count: usize) -> Ready {
    let study = Study::of(paracosm::catalogue().find(scenario).expect("a scenario")).build().expect("a study");
    let points = study.generator(&[]).expect("a strategy").ask(count);
    let tests: Vec<_> = points.iter().map(|point| study.complete(&study.space().decode(point))).collect();
    let mut driver = driver::find("aeb").expect("a driver").build(&[]).expect("a driver");
    Box::new(move || {
        let program = study.program().expect("a program");
        for test in &tests {
            let outcome = simulate(program, test, VehicleModel::SingleTrack, driver.as_mut());
            black_box(outcome.trace.map(|trace| trace.hash()));
        }
    })
}

/// A run of a hundred ticks with a thousand nodes: arithmetic, comparisons, closures and memory.
fn graph() -> Ready {
    fn build(s: &mut Scenario) {
        let road = s.place(RoadSegment::new(200.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)));
        s.duration(1.0);
        let mut chain: Stream<f64> = car.speed();
        for _ in 0..100 {
            let near = (&chain + car.travelled()).below(5.0);
            let held = chain.map(|x| 0.5 * x).when(&near).merge(&-&chain).hold(0.0);
            chain = held.pre().skip_until(&near).max(&held);
        }
        s.place(chain.for_each(|x| assert!(x.is_finite())));
    }
    let program = Program::new("streams", "many nodes", build);
    let test = program.declare().expect("a sound program").nominal();
    let mut driver = driver::find("cruise").expect("a driver").build(&[]).expect("a driver");
    let mut run = Run::new(&program, &test, Setup::asking_every(0.1)).expect("a sound test");
    Box::new(move || drop(black_box(run.drive(driver.as_mut()))))
}

/// Points in five dimensions, including the construction of the generator.
fn points(strategy: Strategy) -> Ready {
    let space = Space::unit_cube(5);
    Box::new(move || {
        let request = Request { seed: Some(1), ..Request::new(&space, 1_000) };
        black_box(strategy.build(&request).expect("a strategy").ask(1_000));
    })
}

/// A measure of Halton points.
fn measured(dims: usize, n: usize, measure: fn(&PointSet) -> f64) -> Ready {
    let points = Strategy::HALTON.build(&Request::new(&Space::unit_cube(dims), n)).expect("a strategy").ask(n);
    let points = PointSet::new(dims, points.iter().map(|point| &point.continuous)).expect("points of the cube");
    Box::new(move || {
        black_box(measure(&points));
    })
}

fn array() -> Ready {
    let rules = Rules::free(&[4; 10]);
    Box::new(move || drop(black_box(covering_array(&CoveringRequest::new(&rules, 3)))))
}

fn formula() -> Ready {
    let mut trace = Trace::new(0.01, vec!["a".into(), "b".into()]);
    for i in 0..10_000 {
        let x = f64::from(i);
        trace.record(&[(x * 0.618_034).fract() - 0.2, (x * 0.414_214).fract() - 0.5]);
    }
    trace.finish();
    let formula: Formula = "always (a > 0 -> b < 3 until[0,5] b > 0)".parse().expect("a formula");
    Box::new(move || drop(black_box(formula.evaluate(&trace))))
}

/// A test of `grid-traffic` after two seconds, among a hundred cars.
fn in_the_city() -> Run {
    let program = paracosm::scenarios::find("grid-traffic").expect("a scenario");
    let test = program.declare().expect("a sound program").nominal();
    let mut driver = driver::find("aeb").expect("a driver").build(&[]).expect("a driver");
    let mut run = Run::new(program, &test, Setup::asking_every(driver.period())).expect("a sound test");
    driver.reset(&run.briefing()).expect("a driver");
    while run.time() < 2.0 {
        let Step::Need(observation) = run.advance() else { panic!("the run has ended") };
        let control = driver.step(observation).expect("a driver");
        run.supply(control);
    }
    run
}

fn sensed<S: Sensor + 'static>(mut sensor: S) -> Ready {
    let run = in_the_city();
    let mut reading = S::Reading::default();
    Box::new(move || sensor.sense(&run.view(), &mut Chance::of(1, "sensor", 1), black_box(&mut reading)))
}

/// The meshes and instances that a renderer gets for a frame; drawing is the work of the adapter.
#[cfg(feature = "camera")]
fn frames() -> Ready {
    let run = in_the_city();
    let stage = paracosm::render::Stages::default().of(run.network(), paracosm::render::Look::Flat);
    // The first scene makes the meshes of all scenes.
    drop(stage.scene(&run));
    Box::new(move || (0..100).for_each(|_| drop(black_box(stage.scene(&run)))))
}
