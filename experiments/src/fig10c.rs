//! The paper's Figure 10c: what networks that were taught to follow a red leader follow.
//!
//! Each network drives in three cases: behind a red leader alone, behind a red leader while another red car comes the
//! other way, and behind a white leader. The paper's network braked for the oncoming car, and ran into the white
//! leader.

use crate::cloning::{FOLLOW, driven};
use crate::{Done, print, write};
use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::campaign::Worker;
use paracosm::engine::object::{Body, Colour};
use paracosm::engine::{AutonomousVehicle, Environment, Monitor, Mover, Program, RoadSegment, Scenario};
use paracosm::oracles::Trace;
use paracosm::space::{Value, Values};
use std::path::Path;

const PROGRAM: Program = Program::new("fig10c", "a leader of either colour, with or without a car that comes", build);

const RED: Colour = [190, 25, 30];
const WHITE: Colour = [235, 235, 235];

/// The initial distance between the bumpers, in metres.
const GAP: f64 = 25.0;

fn build(s: &mut Scenario) {
    let leader_speed = s.interval("leader_speed", 2.0..=12.0).unit("m/s").default(8.0);
    let colour = s.choice("leader", ["red", "white"]);
    let oncoming = s.choice("oncoming", ["nobody", "red car"]);

    let road = s.place(RoadSegment::new(500.0));
    s.place(Environment::new());
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(15.0));
    let colour = if colour.value() == "white" { WHITE } else { RED };
    let leader = Mover::new("leader", Body::car().coloured(colour), road.path(1));
    s.place(leader.starting(10.0 + GAP + 4.5).speed(leader_speed.value()));
    if oncoming.value() == "red car" {
        let other = Mover::new("oncoming", Body::car().coloured(RED), road.path(-1));
        s.place(other.starting(500.0 - 10.0 - 160.0).speed(10.0));
    }

    s.duration(15.0);
    s.monitor(Monitor::no_collision(&car));
}

/// The cases in the figure: the name, the leader's colour, and the oncoming car.
const CASES: [(&str, &str, &str); 3] = [
    ("red leader", "red", "nobody"),
    ("red leader and a red car coming", "red", "red car"),
    ("white leader", "white", "nobody"),
];

/// The speeds of the leader in m/s.
const SPEEDS: [f64; 5] = [4.0, 6.0, 8.0, 10.0, 12.0];

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, _: &ProgressBar) -> Done {
    let header = "seed,case,leader_speed,verdict,clearance_or_missing_braking_m,least_speed_m_per_s";
    let mut table = vec![header.to_owned()];
    let mut over_time = vec!["seed,case,leader_speed,time,speed,throttle,oncoming_gap".to_owned()];
    for (seed, network) in FOLLOW.networks() {
        let study = driven(Study::of(PROGRAM), network).build()?;
        let mut worker = Worker::new(&study)?;
        for (name, leader, oncoming) in CASES {
            for speed in SPEEDS {
                let words = [("leader", leader), ("oncoming", oncoming)];
                let test = words.map(|(name, word)| (name.to_owned(), Value::Word(word.to_owned())));
                let test: Values =
                    [("leader_speed".to_owned(), Value::Number(speed))].into_iter().chain(test).collect();
                let (trial, trace) = worker.run(0, &test);
                let trace = trace.ok_or_else(|| trial.error().unwrap_or_default().to_owned())?;
                let case = format!("{seed},{name},{speed}");
                over_time.extend(told(&trace).iter().map(|row| format!("{case},{row}")));
                let least = signal(&trace, "car.speed").into_iter().fold(f64::INFINITY, f64::min);
                let clearance = trial.robustness("no-collision").unwrap_or(f64::NAN);
                table.push(format!("{case},{},{clearance:.3},{least:.3}", trial.verdict));
            }
        }
    }
    write(&out.join("fig10c.csv"), table.join("\n") + "\n")?;
    write(&out.join("fig10c-speeds.csv"), over_time.join("\n") + "\n")?;
    print(&(table.join("\n") + "\n"))
}

/// Returns a signal at every fifth tick.
fn signal(trace: &Trace, name: &str) -> Vec<f64> {
    trace.signal(name).into_iter().flatten().step_by(5).collect()
}

/// Returns the times of a test, with the speed, the throttle, and the distance along the straight road to the car that
/// comes, if there is one.
fn told(trace: &Trace) -> Vec<String> {
    let [speeds, throttles, own, others] =
        ["car.speed", "car.throttle", "car.x", "oncoming.x"].map(|name| signal(trace, name));
    let row = |(i, (speed, throttle)): (usize, (f64, f64))| {
        let gap = others.get(i).map_or(String::new(), |other| format!("{:.2}", other - own[i]));
        format!("{:.2},{speed:.3},{throttle:.3},{gap}", 5.0 * i as f64 * trace.dt())
    };
    speeds.into_iter().zip(throttles).enumerate().map(row).collect()
}
