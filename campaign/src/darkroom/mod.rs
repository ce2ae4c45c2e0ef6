//! Draws the images for the drivers of a campaign, and decides which images are drawn together.
//!
//! An image depends only on its test, its moment, its camera and its number, not on the images that are drawn with it.
//! A driver therefore sees the same images as a recording shows, and all waiting images can be drawn together.

use crate::study::{Appearances, ModelFlaw};
use crate::{Error, Reason};
use paracosm_engine::Run;
use paracosm_engine::sensor::{Cameras, Image, Moment, Sample};
use paracosm_render::{
    Cast, Developer, Exposure, Frame, NoCamera, Optics, RenderError, Rendering, Sight, Stage, Stages, Undrawn,
    WantedImages,
};
use std::mem::take;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use thiserror::Error;

/// A service that draws the camera images for the drivers of a campaign and that many threads share.
///
/// A thread that wants images leaves an order and waits for the developer. The first thread that gets the developer
/// draws all orders that were left by then. The more threads there are, the more images are drawn at once.
#[derive(Debug)]
pub struct Darkroom {
    orders: Mutex<Vec<Order>>,
    developer: Mutex<Developer>,
    stages: Stages,
    appearances: Appearances,
}

/// An order for images, by one thread.
#[derive(Debug)]
struct Order {
    sights: Vec<Sight>,
    reply: Sender<Vec<Result<Frame, Undrawn>>>,
}

/// The error that a driver uses cameras, but no images can be drawn for the driver.
#[derive(Debug, Error)]
pub enum Blind {
    /// A camera of the driver is invalid.
    #[error("the driver sees through cameras: {0}")]
    Camera(NoCamera),
    /// The machine has no usable graphics adapter.
    #[error("the driver sees through cameras, but {0}")]
    Nothing(RenderError),
}

impl Reason for Blind {}
impl Reason for NoCamera {}

/// The reason why a driver did not get the images of its cameras.
#[derive(Debug, Clone, Error)]
pub enum NoImage {
    /// The darkroom could not be opened.
    #[error("{0}")]
    Closed(Arc<Error>),
    /// A camera of the driver is invalid.
    #[error(transparent)]
    Camera(#[from] NoCamera),
    /// A 3D model that replaces an actor in images cannot be used.
    #[error(transparent)]
    Model(#[from] Arc<ModelFlaw>),
    /// An image cannot be drawn.
    #[error("camera `{camera}`, image {number}: {why}")]
    Undrawn {
        /// The name of the camera whose image was not drawn.
        camera: String,
        /// The number of the image among the images of the camera.
        number: u64,
        /// The reason why the image was not drawn.
        why: Undrawn,
    },
}

impl Darkroom {
    /// Opens a darkroom for the cameras of a driver, with the given appearances of actors.
    ///
    /// # Errors
    /// The machine has nothing to draw with, or a camera is invalid.
    pub fn open(cameras: &Cameras, appearances: &Appearances) -> Result<Self, Error> {
        Optics::of(cameras).map_err(Blind::Camera)?;
        let developer = Developer::new().map_err(|source| Error::unavailable(Blind::Nothing(source)))?;
        let developer = Mutex::new(developer);
        let (stages, appearances) = (Stages::default(), appearances.clone());
        Ok(Self { orders: Mutex::default(), developer, stages, appearances })
    }

    /// Returns the set of a run that has just begun.
    ///
    /// # Errors
    /// A 3D model cannot be used, or a camera is invalid.
    pub fn set(&self, run: &Run) -> Result<Set, NoImage> {
        let cameras = run.eyes().cameras();
        let cast = self.appearances.cast(run, cameras.look).map_err(Arc::new)?;
        Ok(Set { stage: self.stages.of_run(run, cameras.look), cast, optics: Optics::of(cameras)? })
    }

    /// Draws and returns the camera images that have arrived at the drivers of the given runs, each with its set. An image
    /// that cannot be drawn is an error of its run alone.
    pub fn develop(&self, runs: &[(&Run, &Set)]) -> Vec<Result<Vec<Image>, NoImage>> {
        let seen: Vec<_> =
            runs.iter().map(|(run, set)| Seen { set, moments: run.eyes().arrived().collect() }).collect();
        let colours = WantedImages { rgb: true, ..WantedImages::default() };
        let exposures = seen.iter().flat_map(Seen::exposures);
        let mut drawn = self.order(exposures.map(|exposure| exposure.sight(colours)).collect()).into_iter();
        seen.into_iter().map(|seen| seen.images(&mut drawn)).collect()
    }

    /// Draws exposures with the `wanted` images, and returns the results in the same order.
    pub fn draw(&self, exposures: &[Exposure<'_>], wanted: WantedImages) -> Vec<Result<Rendering, Undrawn>> {
        let sights: Vec<Sight> = exposures.iter().map(|exposure| exposure.sight(wanted)).collect();
        let boxes: Vec<_> = sights.iter().map(Sight::boxes).collect();
        let drawn = exposures.iter().zip(boxes).zip(self.order(sights));
        drawn.map(|((exposure, boxes), frame)| Ok(Rendering { frame: exposure.through_lens(frame?), boxes })).collect()
    }

    fn order(&self, sights: Vec<Sight>) -> Vec<Result<Frame, Undrawn>> {
        let (reply, frames) = channel();
        self.orders.lock().unwrap_or_else(PoisonError::into_inner).push(Order { sights, reply });
        let mut developer = self.developer.lock().unwrap_or_else(PoisonError::into_inner);
        let orders = take(&mut *self.orders.lock().unwrap_or_else(PoisonError::into_inner));
        let sights: Vec<&Sight> = orders.iter().flat_map(|order| &order.sights).collect();
        let mut drawn = developer.render(&sights).into_iter();
        drop(developer);
        for Order { sights, reply } in &orders {
            // A thread that no longer waits needs no answer.
            let _ = reply.send(drawn.by_ref().take(sights.len()).collect());
        }
        drop(orders);
        frames.recv().unwrap_or_default()
    }
}

#[cfg(test)]
impl Darkroom {
    /// Makes the darkroom lose its graphics device; `open` then makes a new renderer.
    pub fn lose(&self, open: fn() -> Result<paracosm_render::Renderer, RenderError>) {
        self.developer.lock().unwrap_or_else(PoisonError::into_inner).lose(open);
    }
}

/// The parts of the images of a run that stay the same from image to image.
#[derive(Debug)]
pub struct Set {
    stage: Arc<Stage>,
    cast: Cast,
    optics: Vec<Optics>,
}

/// The moments that have arrived from the cameras of a run.
struct Seen<'a> {
    set: &'a Set,
    /// The moments, each with the index of its camera.
    moments: Vec<(usize, &'a Sample<Moment>)>,
}

impl<'a> Seen<'a> {
    fn exposures(&self) -> impl Iterator<Item = Exposure<'a>> {
        let set = self.set;
        self.moments.iter().map(move |(camera, sample)| Exposure {
            stage: &set.stage,
            cast: &set.cast,
            moment: &sample.reading,
            optics: &set.optics[*camera],
            number: sample.number,
        })
    }

    /// Takes the frames of these moments from `drawn`, where they come next, and returns their images.
    fn images(&self, drawn: &mut impl Iterator<Item = Result<Frame, Undrawn>>) -> Result<Vec<Image>, NoImage> {
        let mine: Vec<_> = drawn.take(self.moments.len()).collect();
        let mut images = Vec::with_capacity(mine.len());
        for (((camera, sample), exposure), frame) in self.moments.iter().zip(self.exposures()).zip(mine) {
            let (number, time) = (sample.number, sample.time);
            match frame {
                Err(Undrawn::Inside(_)) => (),
                Err(why) => {
                    return Err(NoImage::Undrawn { camera: exposure.optics.name.clone(), number, why });
                }
                Ok(frame) => {
                    let frame = exposure.through_lens(frame);
                    let (width, height) = (frame.width(), frame.height());
                    let rgb = frame.rgb.expect("colours were asked for");
                    images.push(Image { camera: *camera, number, time, width, height, rgb });
                }
            }
        }
        Ok(images)
    }
}
