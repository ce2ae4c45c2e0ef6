//! The trial of a perceiver in one test: film, images, answers, signals.

use super::film::{Film, Notes, Taken};
use super::marks::Marks;
use crate::darkroom::Darkroom;
use crate::study::PerceiverChoice;
use crate::trial::Metric;
use crate::{Error, Problem, ProblemKind, Supervision};
use paracosm_oracles::Trace;
use paracosm_perception::{Perceiver, PerceiverError, Percept, Picture, Task};
use paracosm_space::{Space, Values};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A perceiver on trial, with its camera.
pub(crate) struct Exam {
    perceiver: Box<dyn Perceiver>,
    task: Task,
    film: Film,
}

impl Exam {
    /// Makes the trial of a perceiver over a space, which may vary settings of the camera. A perceiver in a process of
    /// its own is waited for until the campaign is stopped.
    ///
    /// # Errors
    /// The perceiver cannot be made.
    pub fn new(choice: &PerceiverChoice, space: &Space, supervision: Supervision) -> Result<Self, Error> {
        let cameras = crate::cameras::VariedCameras::of_space(choice.cameras(), space);
        let (perceiver, task) = (choice.build(supervision)?, choice.task().clone());
        Ok(Self { perceiver, task, film: Film::new(cameras) })
    }

    /// Returns the film of the tests.
    pub fn film(&self) -> &Film {
        &self.film
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

    /// Shows the images of a test to the perceiver, and returns the trace with the signals of the perceiver, and the
    /// metrics of the perceiver.
    pub fn judge(
        &mut self,
        notes: Notes,
        test: &Values,
        darkroom: &Darkroom,
        trace: &Trace,
    ) -> Result<(Trace, Vec<(String, Metric)>), Problem> {
        let task = self.task.clone();
        let mut marks = Marks::new(1.0);
        if let Some(optics) = self.film.optics(test)? {
            let camera = &optics.camera;
            marks = Marks::new(self.perceiver.scale(camera.width(), camera.height()));
            Film::develop(notes, &optics, darkroom, |taken| {
                let pictures: Vec<Picture<'_>> = taken.iter().map(Taken::shown).collect();
                let percepts = self.ask(&pictures)?;
                for (Taken { sample, picture }, percept) in taken.iter().zip(&percepts) {
                    marks.add(&task, percept, (picture, &sample.reading), sample.time, camera);
                }
                Ok(())
            })?;
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

impl Taken {
    /// Returns the image as a perceiver sees it.
    pub fn shown(&self) -> Picture<'_> {
        let frame = &self.picture.frame;
        Picture { width: frame.width(), height: frame.height(), rgb: frame.rgb.as_deref().unwrap_or_default() }
    }
}
