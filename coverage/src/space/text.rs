//! A space as text: the SPACE.toml that people write and scripts pass around.

use super::{Space, SpaceError};

/// What SPACE.toml may hold, but this version does not read yet.
const RESERVED: [&str; 3] = ["constraints", "distribution", "scale"];

impl Space {
    /// Reads a SPACE.toml.
    ///
    /// ```
    /// let space = paracosm_coverage::Space::from_toml(r#"
    ///     [[parameter]]
    ///     name = "speed"
    ///     interval = [0.5, 10.0]
    ///     unit = "m/s"
    ///     default = 1.4
    ///
    ///     [[parameter]]
    ///     name = "lanes"
    ///     choice = [2, 4, 6]
    ///
    ///     [[parameter]]
    ///     name = "leader_speed"
    ///     interval = [0.0, 20.0]
    ///     signal = { shape = "polynomial", degree = 2 }
    /// "#)?;
    /// assert_eq!((space.dims(), space.levels()), (4, vec![3]));
    /// # Ok::<(), paracosm_coverage::SpaceError>(())
    /// ```
    ///
    /// # Errors
    /// The text is no TOML, no space, or a space that cannot be: [`SpaceError`] says where and why.
    pub fn from_toml(text: &str) -> Result<Self, SpaceError> {
        toml::from_str(text).map_err(|error| {
            let at = error.span().map(|span| position(text, span.start));
            let mut message = error.message().to_owned();
            if let Some(word) = RESERVED.iter().find(|word| message.contains(&format!("`{word}`"))) {
                message = format!("`{word}` is not supported by this version");
            }
            SpaceError::Syntax { message, at }
        })
    }

    /// Writes a SPACE.toml that [`Space::from_toml`] reads back as the same space.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("names, numbers and words are always TOML")
    }
}

/// Line and column, from 1, of a byte offset.
fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..offset.min(text.len())];
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    (line, column)
}
