//! Replaces the darkroom in a program that is built without the renderer.

use crate::study::{Appearances, WithoutCameras};
use crate::{Error, Reason};
use paracosm_engine::Run;
use paracosm_engine::sensor::{Cameras, Image};
use std::sync::Arc;
use thiserror::Error;

/// A darkroom that cannot exist.
pub enum Darkroom {}

/// The reason why a driver did not get the images of its cameras.
#[derive(Debug, Clone, Error)]
pub enum NoImage {
    /// The program has nothing to draw with.
    #[error("{0}")]
    Closed(Arc<Error>),
}

/// The driver uses cameras, but the program cannot draw images.
#[derive(Debug, Error)]
#[error("the driver sees through cameras ({}), and {WithoutCameras}", cameras.join(", "))]
pub struct Blind {
    /// The names of the cameras.
    pub cameras: Vec<String>,
}

impl Reason for Blind {}

impl Darkroom {
    /// Returns the error that this program cannot draw images.
    pub fn open(cameras: &Cameras, _: &Appearances) -> Result<Self, Error> {
        Err(Error::unavailable(Blind { cameras: cameras.all.keys().cloned().collect() }))
    }

    /// Returns no images, since there is no darkroom.
    pub fn develop(&self, _: &[&Run]) -> Vec<Result<Vec<Image>, NoImage>> {
        match *self {}
    }
}
