//! Draws the shots of films.

use super::{Film, Shot};
use paracosm_campaign::{Error, Reason};
use paracosm_engine::sensor::Cameras;
use paracosm_render::{
    Adapter, Developer, Exposure, Optics, RenderError, Rendering, Undrawn, ViewError, WantedImages, at_once,
};
use thiserror::Error;

/// The camera was within a thing of this name, which the car ran into, and there was nothing to see.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inside(pub String);

/// A shot and what there was to see.
pub type Developed<'f> = (&'f Shot, Result<Rendering, Inside>);

/// Why cameras cannot be drawn for.
#[derive(Debug, Clone, Error)]
pub enum DrawingFlaw {
    /// There is nothing to draw with.
    #[error(transparent)]
    Nothing(RenderError),
    /// The images of a camera are too large for the adapter.
    #[error("camera `{camera}`: {source}")]
    TooLarge {
        /// The camera.
        camera: String,
        /// What is too large.
        source: ViewError,
    },
    /// An image cannot be drawn.
    #[error("camera `{camera}`, image {number}: {why}")]
    Undrawn {
        /// The camera.
        camera: String,
        /// Which of its images.
        number: u64,
        /// Why.
        why: Undrawn,
    },
}

impl Reason for DrawingFlaw {}

/// Draws the films of one set of cameras.
#[derive(Debug)]
pub struct Projector {
    developer: Developer,
    cameras: Vec<Optics>,
    wanted: WantedImages,
}

impl Projector {
    /// A projector of these cameras' films on the best adapter of this machine. Colours come with shadows.
    ///
    /// # Errors
    /// There is no adapter, no such camera, or its images are too large for the adapter.
    pub fn new(cameras: &Cameras, wanted: WantedImages) -> Result<Self, Error> {
        // That there is no such camera is said even where there is no adapter.
        let optics = Optics::of(cameras)?;
        let developer = Developer::new().map_err(|source| Error::unavailable(DrawingFlaw::Nothing(source)))?;
        let mut projector = Self { developer, cameras: Vec::new(), wanted };
        projector.take(optics).map(|()| projector)
    }

    /// Draws the films of other cameras from now on.
    ///
    /// # Errors
    /// There is no such camera, or its images are too large for the adapter.
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

    /// What it draws with.
    pub fn adapter(&self) -> &Adapter {
        self.developer.adapter()
    }

    /// Draws all shots of a camera, which is given by its place among the names, and shows them in order, a few at a time.
    ///
    /// # Errors
    /// A view cannot be drawn, the adapter is lost, or `show` fails.
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
    /// That a camera was within the thing of this id: those of bodies begin with 1.
    fn inside(&self, id: u16) -> Inside {
        let body = usize::from(id).checked_sub(1).and_then(|body| self.names.get(body));
        Inside(body.map_or("the scenery", String::as_str).to_owned())
    }
}
