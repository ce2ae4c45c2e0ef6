//! The paper's Figure 9: a network that was taught to stop for pedestrians who walk at 1 m/s meets faster and slower ones.
//!
//! It is the study of [`fig9`](crate::fig9) with the network at the wheel, and with what comes before and after cut off, since
//! every image costs time: a test begins a little before the first of the walkers sets out, and ends when the walker has
//! crossed. Its reference map takes long all the same, is made by a command of its own, and comes with the
//! software. In the conditions of its training the network is held against the expert who taught it: where one of them stops,
//! the other should.

use crate::cloning::{STOP, trials};
use crate::recovery::Mark;
use crate::sampling::{Comparison, reference_map};
use crate::{Done, print, write};
use indicatif::ProgressBar;
use paracosm::coverage::{Value, Values};
use paracosm::engine::{
    AutonomousVehicle, Environment, Metric, Pedestrian, Program, RoadSegment, Scenario, Side, eventually, never,
};
use paracosm::oracles::Verdict;
use paracosm::{Study, Trial};
use std::path::Path;

const SIZES: [usize; 3] = [25, 50, 100];
const SEEDS: u64 = 8;
/// The map has this many tests on each side.
const SIDE: usize = 50;
const MAP: &str = include_str!("../data/fig9-cnn-reference.csv");
/// How many tests of its training conditions.
const TRAINING: usize = 100;
/// Whoever gets fewer metres far in the 25 s of a test has stopped on the way: at its speed it would be 417.
const STOPPED: f64 = 350.0;

const PROGRAM: Program = Program { name: "fig9-cnn", about: "a pedestrian crosses the road, and the test ends", build };

/// The scenario `pedestrian-crossing`, shortened.
fn build(s: &mut Scenario) {
    let speed = s.interval("speed", 0.5..=10.0).unit("m/s").default(1.0);
    let distance = s.interval("distance", 5.0..=60.0).unit("m").default(30.0);

    s.place(Environment::new());
    let road = s.place(RoadSegment::new(800.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, CROSSING - AHEAD)).speed(60.0 / 3.6));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, CROSSING)));

    let near = car.gap_along(&road.crossing(CROSSING)).below(distance);
    let walk = walker.walk(road.on_sidewalk(Side::Right, CROSSING), &speed);
    walk.skip_until(&near).take_until(&walker.arrived());

    s.duration((PASSED + CROSSED / speed.value()).min(LONGEST));
    s.premise(&near);
    s.require("no-collision", never(car.collides())).unit("m").scale(5.0);
    s.require("progress", eventually(car.travelled().at_least(MOVED))).unit("m").scale(50.0);
}

/// Where the walker crosses, and how far before it the car begins: metres.
const CROSSING: f64 = 100.0;
const AHEAD: f64 = 70.0;
/// Metres without which it has not come near the walker at all.
const MOVED: f64 = 40.0;
/// How long a test lasts: seconds until all that do not stop are past, and metres of a walker's way; 25 s at most.
const PASSED: f64 = 5.0;
const CROSSED: f64 = 8.5;
const LONGEST: f64 = 25.0;

fn study() -> Result<Study, paracosm::Error> {
    STOP.drives(Study::new(PROGRAM)?)
}

/// Makes the reference map and writes it to a folder.
pub fn reference(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length((SIDE * SIDE) as u64);
    let map = reference_map(&study()?, SIDE, out, bar)?;
    bar.finish_and_clear();
    let failing = map.iter().filter(|trial| trial.is_failure()).count();
    print(&format!("{failing} of {} tests fail\n", map.len()))
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    training(out, bar)?;
    let study = study()?;
    let map = shipped(&study)?;
    let comparison = Comparison { study: &study, sizes: &SIZES, seeds: SEEDS, map: &map };
    bar.set_length(comparison.tests() as u64);
    bar.set_position(0);
    comparison.run(out, "fig9-cnn", bar)
}

/// Drives in the conditions of its training, beside the expert.
fn training(out: &Path, bar: &ProgressBar) -> Done {
    // The tests that no lesson was from: those of the examination at the end of its training.
    let tests = STOP.study(1000, TRAINING)?;
    let expert = trials(&tests.clone().driver("expert", &[])?, bar)?;
    let network = trials(&STOP.drives(tests)?, bar)?;
    let mut rows = vec!["distance,verdict,violated,travelled,expert_verdict,expert_travelled".to_owned()];
    rows.extend(network.iter().zip(&expert).map(|(trial, shown)| {
        let distance = trial.test.get("distance").and_then(Value::number).unwrap_or(f64::NAN);
        let violated: Vec<&str> = trial.violated().collect();
        let (verdict, violated) = (trial.verdict, violated.join(" "));
        format!("{distance},{verdict},{violated},{},{},{}", travelled(trial), shown.verdict, travelled(shown))
    }));
    write(&out.join("training.csv"), rows.join("\n") + "\n")?;
    let passing = |trials: &[Trial]| trials.iter().filter(|trial| trial.verdict == Verdict::Pass).count();
    let stops = |trial: &Trial| travelled(trial) < STOPPED;
    let (of_expert, agreeing) = (
        expert.iter().filter(|trial| stops(trial)).count(),
        network.iter().zip(&expert).filter(|(trial, shown)| stops(trial) == stops(shown)).count(),
    );
    print(&format!(
        "training conditions: {} of {TRAINING} pass (expert {}); the expert stops in {of_expert}, and the network stops or goes on as it does in {agreeing}\n",
        passing(&network),
        passing(&expert)
    ))
}

/// Metres.
fn travelled(trial: &Trial) -> f64 {
    match trial.metric("travelled") {
        Some(Metric::Number(metres)) => *metres,
        _ => f64::NAN,
    }
}

/// The reference map that comes with the software, in the unit square.
fn shipped(study: &Study) -> Result<Vec<Mark>, Box<dyn std::error::Error + Send + Sync>> {
    let mut csv = csv::Reader::from_reader(MAP.as_bytes());
    let names = csv.headers()?.clone();
    let mark = |row: csv::StringRecord| {
        let cell = |name: &str| names.iter().position(|other| other == name).and_then(|column| row.get(column));
        let number = |name: &str| Some(Value::Number(cell(name)?.parse().ok()?));
        let test: Option<Values> =
            ["speed", "distance"].into_iter().map(|name| Some((name.to_owned(), number(name)?))).collect();
        let test = test.ok_or("the reference map has a row without a test")?;
        let point = study.space.encode(&test)?.continuous;
        Ok(([point[0], point[1]], cell("verdict") == Some("fail")))
    };
    csv.records().map(|row| mark(row?)).collect()
}
