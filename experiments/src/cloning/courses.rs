//! What networks are taught, in which tests, and how long.

use crate::scenario;
use paracosm::engine::Program;
use paracosm::space::Domain;
use paracosm::{Error, Study, StudyBuilder, scenarios};
use paracosm_neural::learn::Recipe;
use paracosm_neural::{CLONED, Model, Pilot};

/// A round: tests in which lessons are given, then how often all lessons so far are gone through.
pub struct Round {
    pub tests: usize,
    pub epochs: usize,
}

/// How a network comes to drive.
pub struct Course {
    /// The name of the network.
    pub name: &'static str,
    /// Pixels across and down of what it sees.
    pub resolution: [u32; 2],
    /// The standard deviation of what pushes steering and throttle while the expert drives.
    pub disturbance: [f64; 2],
    /// How much an error of the steering and one of the throttle count, squared.
    pub weights: [f32; 2],
    /// Every so-many-th run nothing is learnt from, if there is one to be spared.
    pub held_out: Option<usize>,
    /// In the first one the expert drives, then the network.
    pub rounds: &'static [Round],
    /// The conditions that it is trained in.
    conditions: fn() -> Result<StudyBuilder, Error>,
}

/// Figures 10a and 10c: behind a slow leader in broad daylight.
pub const FOLLOW: Course = Course {
    name: "follow",
    resolution: [100, 33],
    disturbance: [0.01, 0.15],
    weights: [10.0, 1.0],
    held_out: Some(8),
    rounds: &[
        Round { tests: 16, epochs: 8 },
        Round { tests: 12, epochs: 4 },
        Round { tests: 16, epochs: 4 },
        Round { tests: 16, epochs: 6 },
    ],
    conditions: || {
        let range = |lo, hi| Domain::Interval { lo, hi };
        Ok(scenario("follow-leader")?.open_over("leader_speed", range(2.0, 12.0)).open_over("gap", range(18.0, 40.0)))
    },
};

/// Figure 9: on a straight road that a pedestrian crosses at 1 m/s, who sets out at any of the study's distances.
pub const STOP: Course = Course {
    name: "stop",
    resolution: [120, 40],
    disturbance: [0.01, 0.15],
    weights: [10.0, 1.0],
    held_out: Some(8),
    rounds: &[
        Round { tests: 20, epochs: 4 },
        Round { tests: 14, epochs: 3 },
        Round { tests: 14, epochs: 3 },
        Round { tests: 14, epochs: 3 },
        Round { tests: 14, epochs: 8 },
    ],
    conditions: || Ok(Study::of(crate::crossing::PROGRAM).fix("speed", 1.0)),
};

/// Figure 10b: round the loop, always right, without fog.
pub const LOOP: Course = Course {
    name: "loop",
    resolution: [100, 33],
    disturbance: [0.08, 0.1],
    weights: [4.0, 1.0],
    // Of so few runs none can be spared.
    held_out: None,
    rounds: &[
        Round { tests: 1, epochs: 24 },
        Round { tests: 1, epochs: 12 },
        Round { tests: 1, epochs: 12 },
        Round { tests: 1, epochs: 24 },
    ],
    conditions: || {
        let speeds = Domain::Interval { lo: 7.5, hi: 8.5 };
        Ok(Study::of(LESSON).open_over("speed", speeds).fix("friction", 0.8))
    },
};

/// Once round the loop: every corner has another light.
const LESSON: Program = Program::new("t-loop-lesson", "once round the loop", |s| {
    scenarios::find("t-loop").expect("it comes with the software").build(s);
    s.duration(52.0);
});

impl Course {
    /// So many tests of the conditions that it is trained in.
    pub fn study(&self, seed: u64, tests: usize) -> Result<StudyBuilder, Error> {
        Ok((self.conditions)()?.seed(seed).budget(tests))
    }

    /// A study that the network drives which came of the course, as it comes with the software.
    pub fn drives(&self, study: StudyBuilder) -> StudyBuilder {
        let pilot = Pilot::new(self.network());
        study.own_driver("cnn", move || Box::new(pilot.clone()))
    }

    /// The network that came of the course, as it comes with the software.
    pub fn network(&self) -> Model {
        let network = CLONED.iter().find(|network| network.name == self.name).expect("every course has been held");
        Model::read(network.contents).expect("it was written as a driver")
    }

    /// How it learns.
    pub fn recipe(&self) -> Recipe {
        Recipe {
            resolution: self.resolution,
            seed: 1,
            batch: 32,
            rates: [1e-3, 1e-4],
            weights: self.weights,
            held_out: self.held_out,
        }
    }

    /// Where it comes from.
    pub fn story(&self) -> String {
        let name = self.name;
        format!("made by: cargo run --release -p paracosm-experiments --features neural -- train-{name}")
    }
}
