//! The models of users that replace actors in images, with their hashes, so that a test is never shown again with other
//! models.

#[cfg(feature = "camera")]
mod model;

#[cfg(feature = "camera")]
use model::Loaded;
#[cfg(feature = "camera")]
pub use model::ModelFlaw;

use crate::Reason;
use paracosm_engine::object::Class;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// The 3D models that replace actors in images, by the names of the actors. Actors without an entry have their usual
/// look.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Appearances(BTreeMap<String, Appearance>);

/// The model in a glTF file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Appearance {
    file: String,
    /// The hash of the model that was read, which is the 128-bit XXH3.
    hash: String,
    #[cfg(feature = "camera")]
    #[serde(skip)]
    loaded: Loaded,
}

impl Appearances {
    /// Returns `true` if no 3D model replaces an actor.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Shows an actor as the model in a glTF file. Returns the file of the model that the actor had before, if any.
    pub(super) fn show(&mut self, actor: &str, class: Class, file: &str) -> Result<Option<String>, ModelFlaw> {
        let before = self.0.insert(actor.to_owned(), Appearance::read(file, class)?);
        Ok(before.map(|before| before.file))
    }
}

/// The error that the program was built without the renderer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("this program draws nothing: it was built without the feature `camera`")]
pub struct WithoutCameras;

/// The reason why a file cannot be used as the 3D model of an actor.
#[cfg(not(feature = "camera"))]
pub type ModelFlaw = WithoutCameras;

impl Reason for WithoutCameras {}

/// Returns the name of the first actor of a numbered series: `tree` for `tree-2`.
pub(super) fn first_of(name: &str) -> &str {
    match name.rsplit_once('-') {
        Some((first, number)) if number.bytes().all(|byte| byte.is_ascii_digit()) => first,
        _ => name,
    }
}

#[cfg(not(feature = "camera"))]
impl Appearance {
    fn read(_: &str, _: Class) -> Result<Self, ModelFlaw> {
        Err(WithoutCameras)
    }
}
