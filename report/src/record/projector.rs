//! Draws the shots of films, many at once.

use super::{Film, Shot};
use paracosm_campaign::{Error, Reason};
use paracosm_engine::sensor::Cameras;
use paracosm_render::{
    Adapter, Developer, Exposure, Optics, RenderError, Rendering, Undrawn, ViewError, WantedImages, at_once,
};
use thiserror::Error;

/// The error that a camera was inside an object and saw nothing, with the name of the object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inside(pub String);

/// An exposure with its image, or with the object that hid everything from the camera.
pub type Developed<'f> = (&'f Shot, Result<Rendering, Inside>);

/// The reason why the images of a recording cannot be drawn.
#[derive(Debug, Clone, Error)]
pub enum DrawingFlaw {
    /// The machine has no usable graphics adapter.
    #[error(transparent)]
    Nothing(RenderError),
    /// The images of a camera are too large for the graphics adapter.
    #[error("camera `{camera}`: {source}")]
    TooLarge {
        /// The name of the camera.
        camera: String,
        /// The limit of the graphics adapter that the images exceed.
        source: ViewError,
    },
    /// An image of a camera cannot be drawn.
    #[error("camera `{camera}`, image {number}: {why}")]
    Undrawn {
        /// The name of the camera.
        camera: String,
        /// The number of the image among the images of the camera.
        number: u64,
        /// The reason why the image cannot be drawn.
        why: Undrawn,
    },
}

impl Reason for DrawingFlaw {}

/// A renderer of the images that a set of cameras takes in tests.
#[derive(Debug)]
pub struct Projector {
    developer: Developer,
    cameras: Vec<Optics>,
    wanted: WantedImages,
}

impl Projector {
    /// Makes a renderer for the films of a set of cameras, on the best graphics adapter of this machine. Colour images
    /// have shadows.
    ///
    /// # Errors
    /// Returns an error if there is no adapter, if a camera is not possible, or if its images are too large for the
    /// adapter.
    pub fn new(cameras: &Cameras, wanted: WantedImages) -> Result<Self, Error> {
        // An error in a camera is reported even if there is no adapter.
        let optics = Optics::of(cameras)?;
        let developer = Developer::new().map_err(|source| Error::unavailable(DrawingFlaw::Nothing(source)))?;
        let mut projector = Self { developer, cameras: Vec::new(), wanted };
        projector.take(optics).map(|()| projector)
    }

    /// Sets the cameras whose films are drawn from now on.
    ///
    /// # Errors
    /// Returns an error if a camera is not possible, or if its images are too large for the adapter.
    pub fn fit(&mut self, cameras: &Cameras) -> Result<(), Error> {
        self.take(Optics::of(cameras)?)
    }

    pub(super) fn take(&mut self, cameras: Vec<Optics>) -> Result<(), Error> {
        for optics in &cameras {
            let too_large = |source| DrawingFlaw::TooLarge { camera: optics.name.clone(), source };
            self.developer.check_size(&optics.camera, optics.needs(self.wanted)).map_err(too_large)?;
        }
        self.cameras = cameras;
        Ok(())
    }

    /// Returns the graphics adapter that draws the images.
    pub fn adapter(&self) -> &Adapter {
        self.developer.adapter()
    }

    /// Draws the images of a camera in a film, and passes them to `show` in their order, in batches. `camera` is the
    /// place of the camera among the sorted names.
    ///
    /// # Errors
    /// Returns an error if a view cannot be drawn, the adapter is lost, or `show` fails.
    pub fn show(
        &mut self,
        film: &Film,
        camera: usize,
        mut show: impl FnMut(Vec<Developed<'_>>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let Optics { camera: pinhole, .. } = &self.cameras[camera];
        let at_once = at_once(pinhole.width() as usize * pinhole.height() as usize);
        film.shots[camera].chunks(at_once).try_for_each(|shots| show(self.draw(film, camera, shots)?))
    }

    fn draw<'f>(&mut self, film: &Film, camera: usize, shots: &'f [Shot]) -> Result<Vec<Developed<'f>>, Error> {
        let optics = &self.cameras[camera].with_seed(film.seed);
        let exposure = |shot: &'f Shot| {
            let Shot { number, moment, .. } = shot;
            Exposure { stage: &film.stage, cast: &film.cast, moment, optics, number: *number }
        };
        let exposures: Vec<_> = shots.iter().map(exposure).collect();
        let mut drawn = Vec::with_capacity(shots.len());
        for (shot, picture) in shots.iter().zip(self.developer.draw(&exposures, self.wanted)) {
            match picture {
                Ok(picture) => drawn.push((shot, Ok(picture))),
                Err(Undrawn::Inside(id)) => drawn.push((shot, Err(film.inside(id)))),
                Err(why) => {
                    let (camera, number) = (optics.name.clone(), shot.number);
                    return Err(Error::unavailable(DrawingFlaw::Undrawn { camera, number, why }));
                }
            }
        }
        Ok(drawn)
    }
}

impl Film {
    /// Returns the error that a camera was inside the object with this id, where the ids of bodies begin with 1.
    fn inside(&self, id: u16) -> Inside {
        let body = usize::from(id).checked_sub(1).and_then(|body| self.names.get(body));
        Inside(body.map_or("the scenery", String::as_str).to_owned())
    }
}
