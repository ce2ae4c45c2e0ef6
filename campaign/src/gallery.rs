//! The images of tests with their ground truth, for programs that train perceivers or measure them in their own way.

use crate::cameras::VariedCameras;
use crate::perception::{Film, Notes, RoadUser, Taken, mask, road_users};
use crate::{Error, Problem, Study, Worker};
use paracosm_perception::{Extent, Mask, Picture};
use paracosm_render::Camera;
use paracosm_space::Values;

/// A camera on the ego vehicle of a study, which takes images of tests with their ground truth.
pub struct Gallery<'a> {
    worker: Worker<'a>,
    film: Film,
}

/// An image of a test with its ground truth.
pub struct Shown {
    taken: Taken,
    camera: Camera,
}

impl<'a> Gallery<'a> {
    /// Makes the gallery of a study. The cameras have one camera; settings that vary are parameters of the study.
    ///
    /// # Errors
    /// The study cannot be run, or the machine has nothing to draw with.
    pub fn new(study: &'a Study, cameras: VariedCameras) -> Result<Self, Error> {
        let mut worker = Worker::new(study)?;
        worker.open_darkroom(cameras.nominal())?;
        Ok(Self { worker, film: Film::new(cameras) })
    }

    /// Runs a test, and returns all images that the camera takes.
    ///
    /// # Errors
    /// The test cannot be run, or an image cannot be drawn.
    pub fn show(&mut self, test: &Values) -> Result<Vec<Shown>, Problem> {
        let mut notes = Notes::default();
        self.worker.film_with(&self.film, test, &mut notes)?;
        let (mut shown, optics) = (Vec::new(), self.film.optics(test)?);
        if let (Some(optics), Some(darkroom)) = (optics, self.worker.darkroom()) {
            Film::develop(notes, &optics, darkroom, |taken| {
                shown.extend(taken.into_iter().map(|taken| Shown { taken, camera: optics.camera.clone() }));
                Ok(())
            })?;
        }
        Ok(shown)
    }
}

impl Shown {
    /// Returns the time of the image in seconds from the beginning of the test.
    pub fn time(&self) -> f64 {
        self.taken.sample.time
    }

    /// Returns the image.
    pub fn picture(&self) -> Picture<'_> {
        self.taken.shown()
    }

    /// Returns the road users in the image, sorted by id, with boxes around the visible part or the whole object.
    pub fn road_users(&self, extent: Extent) -> Vec<RoadUser> {
        road_users(&self.taken.picture, &self.taken.sample.reading, &self.camera, extent)
    }

    /// Returns the pixels that show one of these semantic classes.
    pub fn mask(&self, classes: &[String]) -> Mask {
        mask(&self.taken.picture, classes)
    }
}
