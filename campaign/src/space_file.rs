//! Reads spaces from files: SPACE.toml, or a model file of PICT.

use crate::files::read_bytes;
use crate::{Error, Reason};
use paracosm_space::demand::Demand;
use paracosm_space::pict::{Aliases, Model, PictError};
use paracosm_space::{Position, Space, SpaceError, some_of};
use std::ffi::OsStr;
use std::path::Path;
use thiserror::Error;

/// The endings of the names of PICT models; all other files are read as TOML.
const PICT: [&str; 3] = ["pict", "txt", "model"];

/// The contents of a file that describes a space of parameters.
#[derive(Debug, Clone)]
pub struct SpaceFile {
    /// The space of parameters that the file describes.
    pub space: Space,
    /// The combinations of values that a PICT model requires in addition to all combinations of values of any k
    /// parameters.
    pub demand: Demand,
    /// The other names that a PICT model gives to values.
    pub aliases: Aliases,
    /// Notes about the interpretation of the file, each in one sentence.
    pub notes: Vec<String>,
}

/// The error in a file that describes a space of parameters.
#[derive(Debug, Error)]
pub enum SpaceFileFlaw {
    /// The text of the file is not UTF-8.
    #[error("found bytes that are not UTF-8, expected a text in UTF-8")]
    NoText,
    /// The file is not a valid PICT model.
    #[error("column {}: {}", .0.column, .0.flaw)]
    Pict(PictError),
    /// The file does not describe a valid space of parameters.
    #[error("{}{}", .0.at().map(|at| format!("column {}: ", at.column)).unwrap_or_default(), .0)]
    Space(SpaceError),
}

impl Reason for SpaceFileFlaw {}

/// Returns `true` if a file name ends in `.pict`, `.txt` or `.model`, which are the endings of PICT models.
pub fn is_model(path: &Path) -> bool {
    let ending = path.extension().and_then(OsStr::to_str);
    ending.is_some_and(|ending| PICT.contains(&ending.to_lowercase().as_str()))
}

impl SpaceFile {
    /// Reads a space from a PICT model or from a TOML file, depending on the ending of the file name.
    ///
    /// # Errors
    /// The file cannot be read or is not valid, or no test satisfies its constraints. The error names the line, and the
    /// column if it is known.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = String::from_utf8(read_bytes(path)?);
        let text = text.map_err(|error| {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
            Error::in_file(path, line, SpaceFileFlaw::NoText)
        })?;
        if is_model(path) {
            let model = Model::from_pict(&text)
                .map_err(|error| Error::in_file(path, error.line, SpaceFileFlaw::Pict(error)))?;
            let never = check(path, &model.space, &model.statements)?;
            let notes =
                model.notes.into_iter().chain(never).map(|note| format!("{}: {note}", path.display())).collect();
            return Ok(Self { space: model.space, demand: model.demand, aliases: model.aliases, notes });
        }
        let space = Space::from_toml(&text).map_err(|error| {
            let line = error.at().map(|Position { line, .. }| line);
            Error::in_file(path, line, SpaceFileFlaw::Space(error))
        })?;
        let texts = space.constraints().iter().map(|constraint| constraint.text().to_owned());
        let written: Vec<(usize, String)> = Space::constraint_lines(&text).into_iter().zip(texts).collect();
        let notes = check(path, &space, &written)?;
        let notes = notes.into_iter().map(|note| format!("{}: {note}", path.display())).collect();
        Ok(Self { notes, ..Self::from(space) })
    }
}

impl From<Space> for SpaceFile {
    /// Makes the contents of a file that describes only this space.
    fn from(space: Space) -> Self {
        Self { space, demand: Demand::default(), aliases: Aliases::default(), notes: Vec::new() }
    }
}

/// The most values that a note lists.
const MOST_LISTED: usize = 10;

/// Checks that some test satisfies all constraints, and returns a note on each parameter with values that no test has.
/// `written` holds the line and the text of the first constraints.
fn check(path: &Path, space: &Space, written: &[(usize, String)]) -> Result<Vec<String>, Error> {
    let located = |(index, text): (usize, String)| match written.get(index) {
        Some((line, statement)) => (index, format!("{}:{line}: {statement}", path.display())),
        None => (index, text),
    };
    let rules = space.rules().map_err(|mut error| {
        if let SpaceError::Conflict { constraints, .. } = &mut error {
            *constraints = std::mem::take(constraints).into_iter().map(located).collect();
        }
        Error::in_file(path, None, SpaceFileFlaw::Space(error))
    })?;
    let mut notes = Vec::new();
    for group in 0..rules.groups() {
        for (&member, supported) in rules.members(group).iter().zip(rules.supported(group, |_| None)) {
            let coordinate = space.discrete().nth(member).expect("rules are about discrete parameters");
            let levels = coordinate.parameter.levels().unwrap_or_default();
            let never = levels.iter().zip(supported).filter(|(_, supported)| !supported);
            let never: Vec<String> = never.map(|(level, _)| format!("`{level}`")).collect();
            if !never.is_empty() {
                let never = some_of(&never, MOST_LISTED);
                let name = coordinate.name();
                notes.push(format!("the constraints exclude {never} of parameter `{name}` from all tests"));
            }
        }
    }
    Ok(notes)
}
