//! Recorded motions as scenarios, which are read back.

use super::worlds::file;
use nalgebra::Vector2;
use paracosm_engine::object::Body;
use paracosm_engine::{Control, Motion, Pose, Run, Setup, Step, Track};
use paracosm_standards::opendrive::Map;
use paracosm_standards::openscenario::{EgoAs, Export, Xosc};
use std::fs;

const DT: f64 = 0.02;
const TICKS: u32 = 400;

/// Returns the track of a body with its poses over time; `None` where the body is not in the world.
fn track(name: &str, body: Body, at: impl Fn(f64) -> Option<[f64; 3]>) -> Track {
    let pose = |[x, y, heading]: [f64; 3]| Pose { position: Vector2::new(x, y), heading };
    let poses = (0..=TICKS).map(|tick| at(f64::from(tick) * DT).map(pose)).collect();
    Track { name: name.to_owned(), body, poses }
}

/// Writes motions as a scenario, reads the scenario and plays it.
fn played(motion: &Motion) -> Motion {
    let (map, date) = (&Map::read(&file("straight.xodr")).unwrap(), "2026-01-01T00:00:00");
    let export =
        Export { about: "a test", date, roads: "straight.xodr", map, motion, originals: &[], ego: EgoAs::Trajectory };
    let folder = tempfile::tempdir().unwrap();
    fs::copy(file("straight.xodr"), folder.path().join("straight.xodr")).unwrap();
    let case = folder.path().join("case.xosc");
    fs::write(&case, export.text()).unwrap();
    let program = Xosc::read(&case).unwrap_or_else(|error| panic!("{error}")).program();
    let setup = Setup { takes_over: false, ..Setup::asking_every(0.1) };
    let mut run = Run::new(&program, &program.declare().unwrap().nominal(), setup).unwrap();
    run.record_motion();
    while let Step::Need(_) = run.advance() {
        run.supply(Control::default());
    }
    run.motion().unwrap().clone()
}

/// Returns the greatest distance in metres of the bodies at the ticks of the motion. Bodies must be there at the same ticks.
fn distance(motion: &Motion) -> f64 {
    let back = played(motion);
    assert_eq!((back.tracks.len(), back.dt), (motion.tracks.len(), 0.01));
    let mut greatest: f64 = 0.0;
    for (one, other) in motion.tracks.iter().zip(&back.tracks) {
        assert!(other.poses.len() > 2 * TICKS as usize, "{}: it ends early", one.name);
        for (tick, (a, b)) in one.poses.iter().zip(other.poses.iter().step_by(2)).enumerate() {
            assert_eq!(a.is_some(), b.is_some(), "{} at tick {tick}", one.name);
            let far = a.zip(*b).map(|(a, b)| (a.position - b.position).norm());
            greatest = far.map_or(greatest, |far| greatest.max(far));
        }
    }
    greatest
}

#[test]
fn bodies_enter_and_leave_at_their_ticks() {
    let car = |at: &dyn Fn(f64) -> Option<[f64; 3]>| track("other", Body::car(), at);
    let motion = Motion {
        dt: DT,
        tracks: vec![
            track("car", Body::car(), |time| Some([50.0 + 10.0 * time, -1.75, 0.0])),
            // It leaves, comes back elsewhere, and stands there.
            car(&|time| match time {
                ..2.0 => Some([100.0 + 8.0 * time + time * time, 1.75, 0.0]),
                ..3.01 => None,
                _ => Some([300.0, 1.75, 0.1]),
            }),
            // It enters at the first tick after the beginning, and leaves at the last tick.
            car(&|time| (0.01..7.99).contains(&time).then_some([200.0 - 5.0 * time, 5.25, 3.0])),
            // It is there at every other tick of a while.
            track("tree", Body::disc(paracosm_engine::object::Class::Tree, 0.3, 4.0), |time| {
                (((time / DT).round() as u32).is_multiple_of(2) && time < 0.2 || time > 4.0)
                    .then_some([20.0, 30.0, 0.0])
            }),
        ],
    };
    let far = distance(&motion);
    assert!(far <= 0.005, "{far} m");
}

#[test]
fn a_body_beyond_the_end_of_a_road_stays_there() {
    // The road begins at x = 0 m and ends at x = 1000 m.
    for x in [-0.09, -0.01, -1.0, 1000.01, 1000.09] {
        let stands = |x: f64, y: f64| move |_: f64| Some([x, y, 0.0]);
        let motion = Motion {
            dt: DT,
            tracks: vec![
                track("car", Body::car(), stands(500.0, -1.75)),
                track("person", Body::adult(), stands(x, 1.0)),
            ],
        };
        let far = distance(&motion);
        assert!(far <= 1e-5, "{far} m at x = {x} m");
    }
}
