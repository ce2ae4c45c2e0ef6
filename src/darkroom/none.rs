//! What stands in for the darkroom in a program that draws nothing.

use crate::Error;
use crate::study::Appearances;
use paracosm_engine::Run;
use paracosm_engine::sensor::{Cameras, Image};

/// There is none.
pub(crate) enum Darkroom {}

impl Darkroom {
    /// Says so.
    pub fn open(cameras: &Cameras, _: &Appearances) -> Result<Self, Error> {
        let names: Vec<_> = cameras.all.keys().map(String::as_str).collect();
        let message = "this program draws nothing: it was built without the feature `camera`";
        Err(Error::Usage(format!("the driver sees through cameras ({}), and {message}", names.join(", "))))
    }

    /// The images of nothing.
    pub fn develop(&self, _: &[&Run]) -> Vec<Result<Vec<Image>, String>> {
        match *self {}
    }
}
