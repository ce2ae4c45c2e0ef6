//! The courses: what each network learns, in which tests, and for how long.

use crate::scenario;
use paracosm::engine::Program;
use paracosm::engine::sensor::Look;
use paracosm::space::Domain;
use paracosm::{Error, Study, StudyBuilder, scenarios};
use paracosm_neural::learn::Recipe;
use paracosm_neural::{CLONED, Model, Pilot};

/// The seeds of the networks of each course.
pub const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];

/// The look of the images of all courses.
pub const LOOK: Look = Look::Textured;

/// A round of training, in which tests record lessons, and the network then learns from all lessons so far.
pub struct Round {
    pub tests: usize,
    pub epochs: usize,
}

/// The plan by which networks learn to drive. They differ in the seed of their first weights, their tests and the order of
/// their lessons.
pub struct Course {
    /// The name of the networks.
    pub name: &'static str,
    /// The width and height in pixels of the images that the network sees.
    pub resolution: [u32; 2],
    /// The standard deviations of the noise that is added to steering and throttle while the expert drives.
    pub disturbance: [f64; 2],
    /// The weights of the squared errors of steering and throttle.
    pub weights: [f32; 2],
    /// The distance n between held-out runs: every n-th run is left out of the training and measures the network's
    /// error. `None` if no run can be spared.
    pub held_out: Option<usize>,
    /// The rounds of the training, in their order. In the first round the expert drives, in later rounds the network.
    pub rounds: &'static [Round],
    /// The contents of the files of the course's networks of the seeds from 2 on. The network of seed 1 comes with the
    /// software.
    others: &'static [&'static [u8]],
    /// The conditions in which the networks are trained.
    conditions: fn() -> Result<StudyBuilder, Error>,
}

/// The networks of the seeds 2 to 5 of a course.
macro_rules! others {
    ($name:literal) => {
        &[
            include_bytes!(concat!("../../networks/", $name, "-2.onnx")),
            include_bytes!(concat!("../../networks/", $name, "-3.onnx")),
            include_bytes!(concat!("../../networks/", $name, "-4.onnx")),
            include_bytes!(concat!("../../networks/", $name, "-5.onnx")),
        ]
    };
}

/// The course for Figures 10a and 10c: driving behind a slow leader in broad daylight.
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
    others: others!("follow"),
    conditions: || {
        let range = |lo, hi| Domain::Interval { lo, hi };
        Ok(scenario("follow-leader")?.open_over("leader_speed", range(2.0, 12.0)).open_over("gap", range(18.0, 40.0)))
    },
};

/// The course for Figure 9: a pedestrian crosses a straight road at 1 m/s and sets out at any of the study's distances.
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
    others: &[],
    conditions: || Ok(Study::of(crate::crossing::PROGRAM).fix("speed", 1.0)),
};

/// The course for Figure 10b: driving round the loop with right turns only, without fog.
pub const LOOP: Course = Course {
    name: "loop",
    resolution: [100, 33],
    disturbance: [0.08, 0.1],
    weights: [4.0, 1.0],
    // With so few runs, none can be spared.
    held_out: None,
    rounds: &[
        Round { tests: 1, epochs: 24 },
        Round { tests: 1, epochs: 12 },
        Round { tests: 1, epochs: 12 },
        Round { tests: 1, epochs: 24 },
    ],
    others: &[],
    conditions: || {
        let speeds = Domain::Interval { lo: 7.5, hi: 8.5 };
        Ok(Study::of(LESSON).open_over("speed", speeds).fix("friction", 0.8))
    },
};

/// The scenario of the lessons on the loop: one round, in which every corner has different light.
const LESSON: Program = Program::new("t-loop-lesson", "once round the loop", |s| {
    scenarios::find("t-loop").expect("it comes with the software").build(s);
    s.duration(52.0);
});

/// Returns the study, driven by a network.
pub fn driven(study: StudyBuilder, network: Model) -> StudyBuilder {
    let pilot = Pilot::new(network);
    study.own_driver("cnn", move || Box::new(pilot.clone()))
}

impl Course {
    /// Returns a study with this number of tests of the training conditions.
    pub fn study(&self, seed: u64, tests: usize) -> Result<StudyBuilder, Error> {
        Ok((self.conditions)()?.seed(seed).budget(tests))
    }

    /// Returns the course's network that comes with the software: the network of seed 1.
    pub fn network(&self) -> Model {
        let network = CLONED.iter().find(|network| network.name == self.name).expect("every course has been held");
        Model::read(network.contents).expect("it was written as a driver")
    }

    /// Returns the course's networks with their seeds.
    pub fn networks(&self) -> impl Iterator<Item = (u64, Model)> {
        let others = self.others.iter().map(|contents| Model::read(contents).expect("it was written as a driver"));
        SEEDS.into_iter().zip(std::iter::once(self.network()).chain(others))
    }

    /// Returns the settings of the learning.
    pub fn recipe(&self, seed: u64) -> Recipe {
        Recipe {
            resolution: self.resolution,
            look: LOOK,
            seed,
            batch: 32,
            rates: [1e-3, 1e-4],
            weights: self.weights,
            held_out: self.held_out,
        }
    }

    /// Returns the text in the network's file that says how the network was made.
    pub fn story(&self) -> String {
        let name = self.name;
        format!("made by: cargo run --release -p paracosm-experiments --features neural -- train-{name}")
    }
}
