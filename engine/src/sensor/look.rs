//! The versions of the look of images, so that a study or a recording can pin the look that it was made with.

use paracosm_space::{did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A version of the look of images. A look changes colours and shapes, and never a run. The images of a look stay the
/// same from version to version of this software, so that networks keep the meaning that they were trained on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Look {
    /// Surfaces of one colour with a little grain, one shape for all cars, and one for all adults.
    #[default]
    Flat,
    /// Surfaces with textures, cars of many bodies and colours, and people of different build and clothes.
    Textured,
}

/// The error that no look has the requested name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no look is called `{name}`{}; the looks are {}", did_you_mean(.nearest), Look::ALL.map(Look::name).join(", "))]
pub struct UnknownLook {
    /// The name that no look has.
    pub name: String,
    /// The most similar name of a look; `None` if no name is similar.
    pub nearest: Option<&'static str>,
}

impl Look {
    /// All looks, the oldest first.
    pub const ALL: [Self; 2] = [Self::Flat, Self::Textured];

    /// Returns the name of the look in files and commands.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Textured => "textured",
        }
    }

    /// Returns a short description of the look.
    pub fn about(self) -> &'static str {
        match self {
            Self::Flat => "surfaces of one colour with a little grain, and one shape for all cars",
            Self::Textured => "surfaces with textures, and cars and people of many shapes and colours",
        }
    }
}

impl fmt::Display for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Look {
    type Err = UnknownLook;

    fn from_str(name: &str) -> Result<Self, UnknownLook> {
        Self::ALL
            .into_iter()
            .find(|look| look.name() == name)
            .ok_or_else(|| UnknownLook { name: name.to_owned(), nearest: nearest(name, Self::ALL.map(Self::name)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_is_found_by_its_name_and_a_wrong_name_gets_the_nearest() {
        for look in Look::ALL {
            assert_eq!(look.name().parse(), Ok(look));
        }
        let message = "texture".parse::<Look>().unwrap_err().to_string();
        assert_eq!(message, "no look is called `texture` (did you mean `textured`?); the looks are flat, textured");
        assert_eq!(Look::default(), Look::Flat, "old studies keep their meaning");
    }
}
