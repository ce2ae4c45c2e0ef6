//! The trial of a perceiver in one test: film, images, answers, signals.

use super::marks::Marks;
use crate::cameras::VariedCameras;
use crate::darkroom::Darkroom;
use crate::study::{Appearances, ModelFlaw, PerceiverChoice};
use crate::trial::Metric;
use crate::{Error, Problem, ProblemKind};
use paracosm_engine::Run;
use paracosm_engine::sensor::{Moment, Sample, Shutters};
use paracosm_oracles::Trace;
use paracosm_perception::{Perceiver, PerceiverError, Percept, Picture, Task};
use paracosm_render::{Cast, Exposure, Optics, Rendering, Stage, Stages, Undrawn, WantedImages, at_once};
use paracosm_space::{Space, Values};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A perceiver on trial, with its camera.
pub(crate) struct Exam {
    perceiver: Box<dyn Perceiver>,
    task: Task,
    cameras: VariedCameras,
    stages: Stages,
}

/// The notes of a test while it is filmed.
#[derive(Default)]
pub(crate) struct Notes {
    stage: Option<Arc<Stage>>,
    cast: Option<Result<Cast, ModelFlaw>>,
    seed: u64,
    taken: Vec<Sample<Moment>>,
}

impl Exam {
    /// Makes the trial of a perceiver over a space, which may vary settings of the camera. A perceiver in a process of
    /// its own is waited for until `stop` is set.
    ///
    /// # Errors
    /// The perceiver cannot be made, or the study of a file has a look that does not exist.
    pub fn new(choice: &PerceiverChoice, space: &Space, stop: Arc<AtomicBool>) -> Result<Self, Error> {
        let look = choice.look().parse().map_err(crate::cameras::CameraFileFlaw::Look)?;
        let cameras = VariedCameras::of_space(choice.cameras().clone(), space).in_look(look);
        let (perceiver, task) = (choice.build(stop)?, choice.task().clone());
        Ok(Self { perceiver, task, cameras, stages: Stages::in_look(look) })
    }

    /// Asks the perceiver for its answers to images. A panic of the perceiver ends this test alone.
    fn ask(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, Problem> {
        let asked = catch_unwind(AssertUnwindSafe(|| self.perceiver.perceive(pictures)));
        let answered = asked.map_err(|panic| Problem::panicked("perceiver", panic.as_ref()))?;
        let checked = answered.and_then(|percepts| self.task.check(pictures, &percepts).map(|()| percepts));
        checked.map_err(|error| match &error {
            PerceiverError::Failed(cause) => match cause.downcast_ref::<Problem>() {
                Some(problem) => problem.clone(),
                None => Problem::new(ProblemKind::Answer, error.to_string()),
            },
            _ => Problem::new(ProblemKind::Answer, error.to_string()),
        })
    }

    /// Returns the cameras with the usual settings.
    pub fn cameras(&self) -> &VariedCameras {
        &self.cameras
    }

    /// Returns the shutters that film a test.
    pub fn shutters(&self, test: &Values) -> Result<Shutters, Problem> {
        Shutters::of(self.cameras.of_test(test)).map_err(|flaw| Problem::new(ProblemKind::Camera, flaw.to_string()))
    }

    /// Notes the images that have arrived, each time the driver is asked and at the end of the run.
    pub fn note(&self, notes: &mut Notes, run: &Run, appearances: &Appearances) {
        if notes.stage.is_none() {
            notes.stage = Some(self.stages.of_run(run));
            notes.cast = Some(appearances.cast(run, self.stages.look()));
            notes.seed = run.filmed().cameras().seed;
        }
        notes.taken.extend(run.filmed().arrived().map(|(_, sample)| sample.clone()));
    }

    /// Shows the images of a test to the perceiver, and returns the trace with the signals of the perceiver, and the
    /// metrics of the perceiver.
    pub fn judge(
        &mut self,
        notes: Notes,
        test: &Values,
        darkroom: &Darkroom,
        trace: &Trace,
    ) -> Result<(Trace, Vec<(String, Metric)>), Problem> {
        let failed = |message: String| Problem::new(ProblemKind::Camera, message);
        let cast = notes.cast.transpose().map_err(|flaw| failed(flaw.to_string()))?.unwrap_or_default();
        let optics = Optics::of(&self.cameras.of_test(test)).map_err(|flaw| failed(flaw.to_string()))?;
        let optics = optics.first().map(|optics| optics.with_seed(notes.seed));
        let task = self.task.clone();
        let scale =
            optics.as_ref().map_or(1.0, |optics| self.perceiver.scale(optics.camera.width(), optics.camera.height()));
        let mut marks = Marks::new(scale);
        if let (Some(stage), Some(optics)) = (&notes.stage, &optics) {
            let camera = &optics.camera;
            for samples in notes.taken.chunks(at_once(camera.width() as usize * camera.height() as usize)) {
                let exposures: Vec<Exposure<'_>> = samples
                    .iter()
                    .map(|sample| Exposure {
                        stage,
                        cast: &cast,
                        moment: &sample.reading,
                        optics,
                        number: sample.number,
                    })
                    .collect();
                let mut drawn: Vec<(&Sample<Moment>, Rendering)> = Vec::with_capacity(samples.len());
                for (sample, picture) in samples.iter().zip(darkroom.draw(&exposures, WANTED)) {
                    match picture {
                        Ok(picture) => drawn.push((sample, picture)),
                        Err(Undrawn::Inside(_)) => (),
                        Err(why) => return Err(failed(format!("image {} cannot be drawn: {why}", sample.number))),
                    }
                }
                let pictures: Vec<Picture<'_>> = drawn
                    .iter()
                    .map(|(_, picture)| Picture {
                        width: picture.frame.width(),
                        height: picture.frame.height(),
                        rgb: picture.frame.rgb.as_deref().unwrap_or_default(),
                    })
                    .collect();
                let percepts = self.ask(&pictures)?;
                for ((sample, picture), percept) in drawn.iter().zip(&percepts) {
                    marks.add(&task, percept, (picture, &sample.reading), sample.time, camera);
                }
            }
        }
        let names = trace.signals().iter().cloned().chain(task.signals().iter().map(|name| (*name).to_owned()));
        let mut extended = Trace::new(trace.dt(), names.collect());
        for (tick, row) in trace.rows().enumerate() {
            let row: Vec<f64> = row.iter().copied().chain(marks.at(&task, tick as f64 * trace.dt())).collect();
            extended.record(&row);
        }
        if trace.is_complete() {
            extended.finish();
        }
        Ok((extended, marks.metrics()))
    }
}

/// The images for the perceiver and for the ground truth.
const WANTED: WantedImages =
    WantedImages { rgb: true, linear: false, depth: false, semantic: true, instance: true, alone: true, shadows: true };
