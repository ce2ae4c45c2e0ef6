//! Runs a test again and notes what its cameras see at each exposure. The images are drawn later.

use paracosm_campaign::reasons::ModelFlaw;
use paracosm_campaign::study::Appearances;
use paracosm_campaign::{Error, Reason, Trial, Worker};
use paracosm_engine::sensor::{Cameras, Chance, Moment, Sample, SensorError, Shutters};
use paracosm_engine::{Control, Run};
use paracosm_oracles::Verdict;
use paracosm_render::{Cast, Stage, Stages};
use std::sync::Arc;
use thiserror::Error;

/// The state of the world at a camera's exposure, from which the image is drawn later.
#[derive(Debug, Clone)]
pub struct Shot {
    /// The number of the image among the images of its camera.
    pub number: u64,
    /// The time at which the image was taken, in seconds since the run began.
    pub time: f64,
    /// The state of the world at the time of the exposure.
    pub moment: Moment,
    /// The control that the driver last gave before the image arrived, `latency` seconds after the exposure.
    pub control: Control,
}

/// The exposures of all cameras during a test, from which images are drawn later.
#[derive(Debug, Clone)]
pub struct Film {
    /// The roads and the scenery of the test, in the form in which they are drawn.
    pub stage: Arc<Stage>,
    /// The users' own models of bodies, by the indices of the bodies.
    pub cast: Cast,
    /// The exposures of each camera, with the cameras sorted by name.
    pub shots: Vec<Vec<Shot>>,
    /// The seed of the noise in the images, computed from the cameras' seed and the values of the test.
    pub seed: u64,
    /// The name of each body in the run.
    pub names: Arc<[String]>,
}

/// The greatest number of images that a film's colours are taken from.
const SAMPLES: usize = 12;

/// The notes of a run while it is filmed.
#[derive(Default)]
struct Notes {
    stage: Option<Arc<Stage>>,
    /// The users' own models of bodies; an error if a model cannot be loaded.
    cast: Option<Result<Cast, ModelFlaw>>,
    names: Arc<[String]>,
    seed: u64,
    /// The exposures that each camera has taken.
    taken: Vec<Vec<Sample<Moment>>>,
    /// The driver's controls, each with the time at which the driver was asked.
    answers: Vec<(f64, Control)>,
    /// The time at which the driver was asked last.
    asked: Option<f64>,
}

/// The tolerance for times in seconds, because times are sums of ticks.
const WHISKER: f64 = 1e-9;

impl Notes {
    /// Stores the exposures and the driver's last control, each time the driver is asked and at the end of the run.
    fn take(&mut self, run: &Run, stages: &Stages, appearances: &Appearances) {
        if self.stage.is_none() {
            let look = run.filmed().cameras().look;
            self.stage = Some(stages.of_run(run, look));
            self.cast = Some(appearances.cast(run, look));
            self.names = (0..run.bodies().len()).map(|body| run.name_of(body).to_owned()).collect();
            self.seed = run.filmed().cameras().seed;
        }
        self.answers.extend(self.asked.replace(run.time()).map(|asked| (asked, run.control())));
        self.taken.resize_with(run.filmed().cameras().all.len(), Vec::new);
        for (camera, sample) in run.filmed().arrived() {
            self.taken[camera].push(sample.clone());
        }
    }

    /// Returns the last control that the driver gave by the given time.
    fn answer_at(&self, time: f64) -> Control {
        let before = self.answers.partition_point(|(asked, _)| *asked <= time + WHISKER);
        before.checked_sub(1).map_or(Control::default(), |last| self.answers[last].1)
    }
}

/// The reason why a test cannot be filmed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FilmFlaw {
    /// The test ended with an error, or its world cannot be built.
    #[error(
        "test {index} ended as {verdict}, so there is nothing to film; choose a test that ended as pass, fail or inconclusive"
    )]
    Nothing {
        /// The index of the test in the campaign.
        index: usize,
        /// The verdict of the test.
        verdict: Verdict,
    },
    /// The run of the test differs from the logged run.
    #[error(
        "test {index} runs differently now than when it was logged: its trace has another hash; use the same software and the same driver as the campaign"
    )]
    Another {
        /// The index of the test in the campaign.
        index: usize,
    },
    /// The settings of a camera are not valid.
    #[error("camera {0}")]
    Camera(SensorError),
}

impl Reason for FilmFlaw {}

impl Film {
    /// Runs a test of the worker's study again and stores the exposures of the given cameras.
    ///
    /// # Errors
    /// Returns an error if the study has no scenario, the test ended as invalid or in an error, or the run differs from
    /// the run that was logged.
    pub fn of(worker: &mut Worker, trial: &Trial, cameras: &Cameras, stages: &Stages) -> Result<Self, Error> {
        worker.study().subject().scenario()?.check_rates(cameras)?;
        if !trial.covers() {
            return Err(FilmFlaw::Nothing { index: trial.index, verdict: trial.verdict }.into());
        }
        let shutters = Shutters::of(cameras.clone()).map_err(FilmFlaw::Camera)?;
        let appearances = worker.study().subject().scenario()?.appearances();
        let mut notes = Notes::default();
        let see = |run: &Run| notes.take(run, stages, appearances);
        let (again, _) = worker.film(trial.index, &trial.test, Some(shutters), see);
        let cast = notes.cast.take().transpose()?.unwrap_or_default();
        let taken = std::mem::take(&mut notes.taken);
        let stage = notes.stage.take().filter(|_| again.trace_hash == trial.trace_hash);
        let stage = stage.ok_or(FilmFlaw::Another { index: trial.index })?;
        let shots = taken.into_iter().zip(cameras.all.values()).map(|(taken, camera)| {
            let developed = |Sample { number, time, reading: moment }| Shot {
                number,
                time,
                moment,
                control: notes.answer_at(time + camera.latency),
            };
            taken.into_iter().map(developed).collect()
        });
        Ok(Self { stage, cast, shots: shots.collect(), seed: notes.seed, names: notes.names.clone() })
    }

    /// Returns the same film with only a few shots of each camera, spread evenly from the first to the last.
    pub(super) fn sample(&self) -> Self {
        let sample = |shots: &Vec<Shot>| {
            let last = shots.len().saturating_sub(1);
            let mut places: Vec<usize> = (0..SAMPLES).map(|i| i * last / (SAMPLES - 1)).collect();
            places.dedup();
            places.into_iter().filter_map(|place| shots.get(place).cloned()).collect()
        };
        Self { shots: self.shots.iter().map(sample).collect(), ..self.clone() }
    }

    /// Gives random colours to all road users except the ego vehicle. The colours follow
    /// from the seed and the test. They should not matter to a driver.
    pub fn repaint(&mut self, seed: u64, trial: usize) {
        for shot in self.shots.iter_mut().flatten() {
            for (index, state) in shot.moment.bodies.iter_mut().enumerate().skip(1) {
                if state.body.class.is_road_user() {
                    let mut chance = Chance::of(seed, &format!("colour of body {index}"), trial as u64);
                    state.body.colour = [0; 3].map(|_: u8| chance.between(0.0, 256.0) as u8);
                }
            }
        }
    }
}
