//! Models of users' own that stand for actors, and which they are, so that nobody sees a test again with others.

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

/// What actors look like to cameras, by their names, where it is not the usual.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Appearances(BTreeMap<String, Appearance>);

/// The model of a glTF file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Appearance {
    file: String,
    /// The hash of what is read of it: XXH3, 128 bits.
    hash: String,
    #[cfg(feature = "camera")]
    #[serde(skip)]
    loaded: Loaded,
}

impl Appearances {
    /// Whether all look as usual.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Shows an actor as the model in a glTF file; gives the file of the model that it had, if it had one.
    pub(super) fn show(&mut self, actor: &str, class: Class, file: &str) -> Result<Option<String>, ModelFlaw> {
        let before = self.0.insert(actor.to_owned(), Appearance::read(file, class)?);
        Ok(before.map(|before| before.file))
    }
}

/// A program that draws nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("this program draws nothing: it was built without the feature `camera`")]
pub struct WithoutCameras;

/// What keeps a file from being a model.
#[cfg(not(feature = "camera"))]
pub type ModelFlaw = WithoutCameras;

impl Reason for WithoutCameras {}

/// The name of the first of those that are numbered under a name: of `tree` for `tree-2`.
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
