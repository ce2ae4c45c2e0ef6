//! What stands in for the darkroom in a program that draws nothing.

use crate::study::{Appearances, WithoutCameras};
use crate::{Error, Reason};
use paracosm_engine::Run;
use paracosm_engine::sensor::{Cameras, Image};
use std::sync::Arc;
use thiserror::Error;

/// There is none.
pub enum Darkroom {}

/// Why a driver was not shown what its cameras see.
#[derive(Debug, Clone, Error)]
pub enum NoImage {
    /// There is nothing to draw with.
    #[error("{0}")]
    Closed(Arc<Error>),
}

/// A driver that sees, where nothing draws.
#[derive(Debug, Error)]
#[error("the driver sees through cameras ({}), and {WithoutCameras}", cameras.join(", "))]
pub struct Blind {
    /// The names of the cameras.
    pub cameras: Vec<String>,
}

impl Reason for Blind {}

impl Darkroom {
    /// Says so.
    pub fn open(cameras: &Cameras, _: &Appearances) -> Result<Self, Error> {
        Err(Error::unavailable(Blind { cameras: cameras.all.keys().cloned().collect() }))
    }

    /// The images of nothing.
    pub fn develop(&self, _: &[&Run]) -> Vec<Result<Vec<Image>, NoImage>> {
        match *self {}
    }
}
