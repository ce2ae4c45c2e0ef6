//! Draws many scenes at once, whatever runs they belong to.

use crate::{Adapter, Box3, Camera, Exposure, Frame, RenderError, Renderer, Sight, View, ViewError, WantedImages};
use rayon::prelude::*;
use thiserror::Error;

/// The most pixels, and the most images, that are drawn at once, so that large images do not fill the memory.
const PIXELS: usize = 1 << 22;
const IMAGES: usize = 64;

/// Returns the number of images of `pixels` pixels each that a [`Developer`] draws in one batch.
pub fn at_once(pixels: usize) -> usize {
    (PIXELS / pixels.max(1)).clamp(1, IMAGES)
}

/// The drawn images of one moment, with the boxes of the objects.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendering {
    /// The wanted images; the colours include the effects of the camera's lens and sensor.
    pub frame: Frame,
    /// The three-dimensional boxes of all objects with an id, in the camera's coordinates; empty if
    /// [`WantedImages::alone`] is not set.
    pub boxes: Vec<Box3>,
}

/// The reason why an image was not drawn.
#[derive(Debug, Clone, Error)]
pub enum Undrawn {
    /// The camera was inside an object with which the car had collided, so that nothing was visible.
    #[error("the camera was inside a thing (id {0}), so nothing was visible")]
    Inside(u16),
    /// The scene or the camera is not valid or too large for the graphics adapter.
    #[error(transparent)]
    View(ViewError),
    /// The graphics device failed.
    #[error(transparent)]
    Device(#[from] RenderError),
}

/// A renderer of camera images, including the effects of lenses and sensors.
#[derive(Debug)]
pub struct Developer {
    renderer: Renderer,
    /// The function that makes a new renderer if the graphics device is lost.
    open: fn() -> Result<Renderer, RenderError>,
}

impl Developer {
    /// Makes a developer with the best graphics adapter of this machine.
    ///
    /// # Errors
    /// There is no adapter, or it cannot be opened.
    pub fn new() -> Result<Self, RenderError> {
        Ok(Self { renderer: Renderer::new()?, open: Renderer::new })
    }

    /// Returns the graphics adapter that the developer draws with.
    pub fn adapter(&self) -> &Adapter {
        self.renderer.adapter()
    }

    /// Checks that the graphics adapter can draw images of the camera's size.
    ///
    /// # Errors
    /// The images are too large.
    pub fn check_size(&self, camera: &Camera, wanted: WantedImages) -> Result<(), ViewError> {
        self.renderer.check_size(camera, wanted)
    }

    /// Draws a list of exposures on all processor cores, and returns the results in the same order.
    pub fn draw(&mut self, exposures: &[Exposure<'_>], wanted: WantedImages) -> Vec<Result<Rendering, Undrawn>> {
        let sights: Vec<Sight> = exposures.par_iter().map(|exposure| exposure.sight(wanted)).collect();
        let frames = self.render(&sights.iter().collect::<Vec<_>>());
        let all = exposures.par_iter().zip(&sights).zip(frames);
        let picture = |((exposure, sight), frame): ((&Exposure<'_>, &Sight), Result<Frame, Undrawn>)| {
            Ok(Rendering { frame: exposure.through_lens(frame?), boxes: sight.boxes() })
        };
        all.map(picture).collect()
    }

    /// Draws the scenes without the effects of lenses and sensors, and returns the frames in the same order.
    pub fn render(&mut self, sights: &[&Sight]) -> Vec<Result<Frame, Undrawn>> {
        let mut drawn: Vec<Option<Result<Frame, Undrawn>>> = sights.iter().map(|_| None).collect();
        let mut left: Vec<usize> = (0..sights.len()).collect();
        while let Some(first) = left.first() {
            let wanted = sights[*first].wanted;
            let (alike, others) = left.into_iter().partition::<Vec<_>, _>(|i| sights[*i].wanted == wanted);
            left = others;
            for portion in portions(&alike, |i| sights[i].pixels()) {
                let views: Vec<View<'_>> = portion.iter().map(|i| sights[*i].view()).collect();
                for (i, frame) in portion.iter().zip(self.render_alike(&views, wanted)) {
                    drawn[*i] = Some(frame);
                }
            }
        }
        drawn.into_iter().map(|frame| frame.expect("each was drawn or could not be")).collect()
    }

    /// Draws views of which the same images are wanted. If the device fails, each view is drawn alone, so that only the
    /// views at fault fail.
    fn render_alike(&mut self, views: &[View<'_>], wanted: WantedImages) -> Vec<Result<Frame, Undrawn>> {
        match self.renderer.render(views, wanted) {
            Ok(frames) => frames.into_iter().map(|frame| frame.map_err(undrawn)).collect(),
            Err(_) => views.iter().map(|view| self.render_alone(view, wanted)).collect(),
        }
    }

    /// Draws one view, with a new device if the old one fails.
    fn render_alone(&mut self, view: &View<'_>, wanted: WantedImages) -> Result<Frame, Undrawn> {
        let view = std::slice::from_ref(view);
        let frames = self.renderer.render(view, wanted).or_else(|_| {
            self.renderer = (self.open)()?;
            self.renderer.render(view, wanted)
        });
        frames?.remove(0).map_err(undrawn)
    }

    /// Ends the graphics device for tests of the handling of a lost device; `open` makes the next renderer.
    #[doc(hidden)]
    pub fn lose(&mut self, open: fn() -> Result<Renderer, RenderError>) {
        self.renderer.lose();
        self.open = open;
    }
}

fn undrawn(error: ViewError) -> Undrawn {
    match error {
        ViewError::Inside { id, .. } => Undrawn::Inside(id),
        error => Undrawn::View(error),
    }
}

/// Divides images into batches, by the number of pixels of each image.
fn portions(all: &[usize], pixels: impl Fn(usize) -> usize) -> Vec<&[usize]> {
    let mut portions = Vec::new();
    let mut left = all;
    while !left.is_empty() {
        let mut sum = 0;
        let fits = |i: &&usize| {
            sum += pixels(**i);
            sum <= PIXELS
        };
        let (portion, later) = left.split_at(left.iter().take(IMAGES).take_while(fits).count().max(1));
        portions.push(portion);
        left = later;
    }
    portions
}
