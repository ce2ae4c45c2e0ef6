//! Where moments become images: those that recordings keep, and those that drivers see while they drive.
//!
//! An image depends on its test, its moment, its camera and its number alone, and not on what it is drawn with: so a driver
//! sees what a recording shows, and whatever waits to be drawn is drawn in one go.

mod developer;
mod exposure;
mod optics;

pub use developer::Picture;
pub(crate) use developer::{Developer, Undrawn, at_once};
pub(crate) use exposure::{Exposure, Sight};
pub(crate) use optics::{Optics, camera, check};

use crate::Error;
use crate::study::Appearances;
use paracosm_engine::Run;
use paracosm_engine::sensor::{Cameras, Image, Moment, Sample};
use paracosm_render::{Cast, Frame, Outputs, RenderError, Stage, Stages};
use std::mem::take;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// What draws for the drivers of a campaign, on whatever threads they are.
///
/// Who wants something drawn leaves an order and waits for the developer; who gets to it first draws all that was ordered
/// by then, so that the more threads there are, the more is drawn at once.
#[derive(Debug)]
pub(crate) struct Darkroom {
    orders: Mutex<Vec<Order>>,
    developer: Mutex<Developer>,
    stages: Stages,
    appearances: Appearances,
}

/// What somebody wants to see.
#[derive(Debug)]
struct Order {
    sights: Vec<Sight>,
    reply: Sender<Vec<Result<Frame, Undrawn>>>,
}

impl Darkroom {
    /// A darkroom for the cameras that a driver sees through, to which actors look so.
    ///
    /// # Errors
    /// There is nothing to draw with, or no such camera.
    pub fn open(cameras: &Cameras, appearances: &Appearances) -> Result<Self, Error> {
        Optics::of(cameras).map_err(|error| Error::Usage(format!("the driver sees through cameras: {error}")))?;
        let unusable = |error: RenderError| Error::Usage(format!("the driver sees through cameras, but {error}"));
        let developer = Mutex::new(Developer::new().map_err(unusable)?);
        let (stages, appearances) = (Stages::default(), appearances.clone());
        Ok(Self { orders: Mutex::default(), developer, stages, appearances })
    }

    /// What the drivers of these runs see of the moments that have arrived. What keeps an image from being drawn is told
    /// of its run alone.
    pub fn develop(&self, runs: &[&Run]) -> Vec<Result<Vec<Image>, String>> {
        let seen: Vec<_> = runs.iter().map(|run| Seen::by(run, self)).collect();
        let colours = Outputs { rgb: true, ..Outputs::default() };
        let exposures = seen.iter().flatten().flat_map(Seen::exposures);
        let mut drawn = self.order(exposures.map(|exposure| exposure.sight(colours)).collect()).into_iter();
        let images = |seen: Result<Seen<'_>, String>| seen.and_then(|seen| seen.images(&mut drawn));
        seen.into_iter().map(images).collect()
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
            // Who does not wait any more needs no answer.
            let _ = reply.send(drawn.by_ref().take(sights.len()).collect());
        }
        drop(orders);
        frames.recv().unwrap_or_default()
    }
}

#[cfg(test)]
impl Darkroom {
    /// Loses the device that it draws with; `open` makes the next one.
    pub fn lose(&self, open: fn() -> Result<paracosm_render::Renderer, RenderError>) {
        self.developer.lock().unwrap_or_else(PoisonError::into_inner).lose(open);
    }
}

/// What has arrived from the eyes of a run.
struct Seen<'a> {
    stage: Arc<Stage>,
    cast: Cast,
    optics: Vec<Optics>,
    /// Each with the place of its camera.
    moments: Vec<(usize, &'a Sample<Moment>)>,
}

impl<'a> Seen<'a> {
    fn by(run: &'a Run, darkroom: &Darkroom) -> Result<Self, String> {
        let optics = Optics::of(run.eyes().cameras()).map_err(|error| error.to_string())?;
        let (stage, cast) = (darkroom.stages.of(run.network()), darkroom.appearances.cast(run)?);
        Ok(Self { stage, cast, optics, moments: run.eyes().arrived().collect() })
    }

    fn exposures(&self) -> impl Iterator<Item = Exposure<'_>> {
        self.moments.iter().map(|(camera, sample)| Exposure {
            stage: &self.stage,
            cast: &self.cast,
            moment: &sample.reading,
            optics: &self.optics[*camera],
            number: sample.number,
        })
    }

    /// The images of what was drawn of these moments, which comes next of all that was drawn.
    fn images(&self, drawn: &mut impl Iterator<Item = Result<Frame, Undrawn>>) -> Result<Vec<Image>, String> {
        let mine: Vec<_> = drawn.take(self.moments.len()).collect();
        let mut images = Vec::with_capacity(mine.len());
        for (((camera, sample), exposure), frame) in self.moments.iter().zip(self.exposures()).zip(mine) {
            let (number, time) = (sample.number, sample.time);
            match frame {
                Err(Undrawn::Inside(_)) => (),
                Err(Undrawn::Failed(message)) => {
                    return Err(format!("camera `{}`, image {number}: {message}", exposure.optics.name));
                }
                Ok(frame) => {
                    let frame = exposure.through_lens(frame);
                    let (width, height) = (frame.width(), frame.height());
                    let rgb = frame.rgb.ok_or("no colours were drawn")?;
                    images.push(Image { camera: *camera, number, time, width, height, rgb });
                }
            }
        }
        Ok(images)
    }
}
