//! Replaces the darkroom in a program that is built without the renderer.

use crate::study::{Appearances, WithoutCameras};
use crate::{Error, Reason};
use paracosm_engine::Run;
use paracosm_engine::sensor::{Cameras, Image};
use std::sync::Arc;
use thiserror::Error;

/// An empty type that replaces the darkroom in a program that was built without the renderer.
pub enum Darkroom {}

/// An empty type that replaces the set of a run.
#[derive(Debug)]
pub enum Set {}

/// The reason why a driver did not get the images of its cameras.
#[derive(Debug, Clone, Error)]
pub enum NoImage {
    /// The darkroom could not be opened.
    #[error("{0}")]
    Closed(Arc<Error>),
}

/// The error that a driver uses cameras, but the program was built without the renderer.
#[derive(Debug, Error)]
#[error("the driver sees through cameras ({}), and {WithoutCameras}", cameras.join(", "))]
pub struct Blind {
    /// The names of the driver's cameras.
    pub cameras: Vec<String>,
}

impl Reason for Blind {}

impl Darkroom {
    /// Returns the error that the program was built without the renderer.
    pub fn open(cameras: &Cameras, _: &Appearances) -> Result<Self, Error> {
        Err(Error::unavailable(Blind { cameras: cameras.all.keys().cloned().collect() }))
    }

    /// Returns no set, because a program without the renderer has no darkroom.
    pub fn set(&self, _: &Run) -> Result<Set, NoImage> {
        match *self {}
    }

    /// Returns no images, because a program without the renderer has no darkroom.
    pub fn develop(&self, _: &[(&Run, &Set)]) -> Vec<Result<Vec<Image>, NoImage>> {
        match *self {}
    }
}
