//! Draws the shots of films.

use super::{Film, Shot};
use crate::Error;
use crate::darkroom::{Developer, Exposure, IMAGES, Optics, Picture};
use paracosm_engine::sensor::Cameras;
use paracosm_render::{Adapter, Outputs};

/// Draws the films of one set of cameras.
#[derive(Debug)]
pub struct Projector {
    developer: Developer,
    cameras: Vec<Optics>,
    wanted: Outputs,
}

impl Projector {
    /// A projector of these cameras' films on the best adapter of this machine. Colours come with shadows.
    ///
    /// # Errors
    /// There is no adapter, or no such camera.
    pub fn new(cameras: &Cameras, wanted: Outputs) -> Result<Self, Error> {
        let cameras = Optics::of(cameras)?;
        let developer = Developer::new().map_err(|error| Error::Usage(error.to_string()))?;
        Ok(Self { developer, cameras, wanted })
    }

    /// What it draws with.
    pub fn adapter(&self) -> &Adapter {
        self.developer.adapter()
    }

    /// Draws all shots of a camera, which is given by its place among the names, and shows them in order. A shot from
    /// within something that the car ran into shows nothing, and is none.
    ///
    /// # Errors
    /// A view cannot be drawn, the adapter is lost, or `show` fails.
    pub fn show(
        &mut self,
        film: &Film,
        camera: usize,
        mut show: impl FnMut(Vec<(&Shot, Picture)>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        film.shots[camera].chunks(IMAGES).try_for_each(|shots| show(self.draw(film, camera, shots)?))
    }

    fn draw<'f>(&mut self, film: &Film, camera: usize, shots: &'f [Shot]) -> Result<Vec<(&'f Shot, Picture)>, Error> {
        let optics = &self.cameras[camera];
        let exposure = |shot: &'f Shot| {
            let Shot { number, moment, .. } = shot;
            Exposure { stage: &film.stage, moment, optics, number: *number }
        };
        let exposures: Vec<_> = shots.iter().map(exposure).collect();
        let mut drawn = Vec::with_capacity(shots.len());
        for (shot, picture) in shots.iter().zip(self.developer.draw(&exposures, self.wanted)) {
            match picture {
                Ok(picture) => drawn.push((shot, picture)),
                Err(None) => (),
                Err(Some(message)) => {
                    let message = format!("camera `{}`, image {}: {message}", optics.name, shot.number);
                    return Err(Error::Usage(message));
                }
            }
        }
        Ok(drawn)
    }
}
