//! The film of a test: the moments at which a camera takes images, and the images with their ground truth.

use crate::cameras::VariedCameras;
use crate::darkroom::Darkroom;
use crate::study::{Appearances, ModelFlaw};
use crate::{Problem, ProblemKind};
use paracosm_engine::Run;
use paracosm_engine::sensor::{Moment, Sample, Shutters};
use paracosm_render::{Cast, Exposure, Optics, Rendering, Stage, Stages, Undrawn, WantedImages, at_once};
use paracosm_space::Values;
use std::sync::Arc;

/// The images for a perceiver and for the ground truth.
const WANTED: WantedImages =
    WantedImages { rgb: true, linear: false, depth: false, semantic: true, instance: true, alone: true, shadows: true };

/// A camera that films tests.
pub(crate) struct Film {
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

/// An image with the moment that it shows.
pub(crate) struct Taken {
    pub sample: Sample<Moment>,
    pub picture: Rendering,
}

impl Film {
    /// Makes the film for cameras, whose settings may vary with the test.
    pub fn new(cameras: VariedCameras) -> Self {
        Self { cameras, stages: Stages::default() }
    }

    /// Returns the cameras with the usual settings.
    pub fn cameras(&self) -> &VariedCameras {
        &self.cameras
    }

    /// Returns the shutters that film a test.
    pub fn shutters(&self, test: &Values) -> Result<Shutters, Problem> {
        Shutters::of(self.cameras.of_test(test)).map_err(|flaw| failed(flaw.to_string()))
    }

    /// Notes the images that have arrived, each time the driver is asked and at the end of the run.
    pub fn note(&self, notes: &mut Notes, run: &Run, appearances: &Appearances) {
        if notes.stage.is_none() {
            let look = self.cameras.look();
            notes.stage = Some(self.stages.of_run(run, look));
            notes.cast = Some(appearances.cast(run, look));
            notes.seed = run.filmed().cameras().seed;
        }
        notes.taken.extend(run.filmed().arrived().map(|(_, sample)| sample.clone()));
    }

    /// Returns the optics of the first camera in a test; `None` without a camera.
    pub fn optics(&self, test: &Values) -> Result<Option<Optics>, Problem> {
        Ok(Optics::of(&self.cameras.of_test(test)).map_err(|flaw| failed(flaw.to_string()))?.first().cloned())
    }

    /// Draws the images of the notes, and hands them to `see` in their order, many at a time. An image from inside of
    /// another body is left out.
    pub fn develop(
        notes: Notes,
        optics: &Optics,
        darkroom: &Darkroom,
        mut see: impl FnMut(Vec<Taken>) -> Result<(), Problem>,
    ) -> Result<(), Problem> {
        let Notes { stage: Some(stage), cast, seed, taken } = notes else { return Ok(()) };
        let cast = cast.transpose().map_err(|flaw| failed(flaw.to_string()))?.unwrap_or_default();
        let optics = optics.with_seed(seed);
        let camera = &optics.camera;
        for samples in taken.chunks(at_once(camera.width() as usize * camera.height() as usize)) {
            let expose = |sample| {
                let Sample { reading, number, .. }: &Sample<Moment> = sample;
                Exposure { stage: &stage, cast: &cast, moment: reading, optics: &optics, number: *number }
            };
            let exposures: Vec<Exposure<'_>> = samples.iter().map(expose).collect();
            let mut drawn = Vec::with_capacity(samples.len());
            for (sample, picture) in samples.iter().zip(darkroom.draw(&exposures, WANTED)) {
                match picture {
                    Ok(picture) => drawn.push(Taken { sample: sample.clone(), picture }),
                    Err(Undrawn::Inside(_)) => (),
                    Err(why) => return Err(failed(format!("image {} cannot be drawn: {why}", sample.number))),
                }
            }
            see(drawn)?;
        }
        Ok(())
    }
}

fn failed(message: String) -> Problem {
    Problem::new(ProblemKind::Camera, message)
}
