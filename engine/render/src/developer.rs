//! Draws sights: many at once, whatever they belong to.

use crate::{Adapter, Box3, Camera, Exposure, Frame, RenderError, Renderer, Sight, View, ViewError, WantedImages};
use rayon::prelude::*;
use thiserror::Error;

/// How many pixels are drawn at once, so that large images do not fill the memory, and how many images at most.
const PIXELS: usize = 1 << 22;
const IMAGES: usize = 64;

/// How many images of so many pixels are drawn at once.
pub fn at_once(pixels: usize) -> usize {
    (PIXELS / pixels.max(1)).clamp(1, IMAGES)
}

/// A moment that was drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendering {
    /// All that was asked for; its colours are those that the camera gives.
    pub frame: Frame,
    /// The things in front of the camera.
    pub boxes: Vec<Box3>,
}

/// Why a moment was not drawn.
#[derive(Debug, Clone, Error)]
pub enum Undrawn {
    /// The camera was within a thing, which the car ran into, and there was nothing to see.
    #[error("the camera was within a thing (id {0})")]
    Inside(u16),
    /// It cannot be drawn.
    #[error(transparent)]
    View(ViewError),
    /// The graphics device failed.
    #[error(transparent)]
    Device(#[from] RenderError),
}

/// Draws with an adapter.
#[derive(Debug)]
pub struct Developer {
    renderer: Renderer,
    /// Makes another one in its place.
    open: fn() -> Result<Renderer, RenderError>,
}

impl Developer {
    /// One with the best adapter of this machine.
    ///
    /// # Errors
    /// There is no adapter, or it does not let itself be used.
    pub fn new() -> Result<Self, RenderError> {
        Ok(Self { renderer: Renderer::new()?, open: Renderer::new })
    }

    /// What it draws with.
    pub fn adapter(&self) -> &Adapter {
        self.renderer.adapter()
    }

    /// Whether images of such a camera are small enough for the adapter, whatever there is to see.
    ///
    /// # Errors
    /// They are not.
    pub fn check_size(&self, camera: &Camera, wanted: WantedImages) -> Result<(), ViewError> {
        self.renderer.check_size(camera, wanted)
    }

    /// Draws all these on all cores, in their order.
    pub fn draw(&mut self, exposures: &[Exposure<'_>], wanted: WantedImages) -> Vec<Result<Rendering, Undrawn>> {
        let sights: Vec<Sight> = exposures.par_iter().map(|exposure| exposure.sight(wanted)).collect();
        let frames = self.render(&sights.iter().collect::<Vec<_>>());
        let all = exposures.par_iter().zip(&sights).zip(frames);
        let picture = |((exposure, sight), frame): ((&Exposure<'_>, &Sight), Result<Frame, Undrawn>)| {
            Ok(Rendering { frame: exposure.through_lens(frame?), boxes: sight.boxes() })
        };
        all.map(picture).collect()
    }

    /// Draws what is there, before any lens.
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

    /// Where the device fails, each is drawn by itself, so that only those fail that have to.
    fn render_alike(&mut self, views: &[View<'_>], wanted: WantedImages) -> Vec<Result<Frame, Undrawn>> {
        match self.renderer.render(views, wanted) {
            Ok(frames) => frames.into_iter().map(|frame| frame.map_err(undrawn)).collect(),
            Err(_) => views.iter().map(|view| self.render_alone(view, wanted)).collect(),
        }
    }

    /// A device that is lost gives way to a new one.
    fn render_alone(&mut self, view: &View<'_>, wanted: WantedImages) -> Result<Frame, Undrawn> {
        let view = std::slice::from_ref(view);
        let frames = self.renderer.render(view, wanted).or_else(|_| {
            self.renderer = (self.open)()?;
            self.renderer.render(view, wanted)
        });
        frames?.remove(0).map_err(undrawn)
    }

    /// Loses its device, for tests of those who draw with it; `open` makes the next one.
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

/// Divides these into portions that are drawn at once, by how many pixels each has.
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
