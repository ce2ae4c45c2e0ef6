//! Spaces as files: SPACE.toml, or a model file of PICT wherever one is read.

use super::Verbosity;
use crate::Error;
use crate::coverage::demand::Demand;
use crate::coverage::pict::Model;
use crate::coverage::{Space, SpaceError};
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

/// The extensions by which a file is known as a model of PICT; any other is taken for TOML.
const PICT: [&str; 3] = ["pict", "txt", "model"];

/// What a file says of a space.
pub(super) struct SpaceFile {
    pub space: Space,
    /// What a model asks for beside all combinations of k values.
    pub demand: Demand,
}

/// Whether a file is a model of PICT by its name.
pub(super) fn is_model(path: &Path) -> bool {
    let extension = path.extension().and_then(OsStr::to_str);
    extension.is_some_and(|extension| PICT.contains(&extension.to_lowercase().as_str()))
}

impl SpaceFile {
    pub fn read(path: &Path, verbosity: Verbosity) -> Result<Self, Error> {
        let text = String::from_utf8(fs::read(path).map_err(Error::file("read", path))?);
        let text = text.map_err(|error| {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
            Error::content(path, line, "found bytes that are no UTF-8, expected a text in UTF-8")
        })?;
        if is_model(path) {
            let model = Model::from_pict(&text).map_err(|error| {
                Error::content(path, error.line, format!("column {}: {}", error.column, error.message))
            })?;
            for note in &model.notes {
                verbosity.note(format_args!("{}: {note}", path.display()));
            }
            check(path, &model.space, &model.statements)?;
            return Ok(Self { space: model.space, demand: model.demand });
        }
        let space = Space::from_toml(&text).map_err(|error| match error {
            SpaceError::Syntax { message, at: Some((line, column)) } => {
                Error::content(path, line, format!("column {column}: {message}"))
            }
            error => Error::content(path, None, error.to_string()),
        })?;
        let texts = space.constraints().iter().map(|constraint| constraint.text().to_owned());
        let written: Vec<(usize, String)> = Space::constraint_lines(&text).into_iter().zip(texts).collect();
        check(path, &space, &written)?;
        Ok(Self { space, demand: Demand::default() })
    }
}

/// Checks that some test keeps all constraints; the first of them stand written in the file, each from a line on.
fn check(path: &Path, space: &Space, written: &[(usize, String)]) -> Result<(), Error> {
    let located = |(index, text): (usize, String)| match written.get(index) {
        Some((line, statement)) => (index, format!("{}:{line}: {statement}", path.display())),
        None => (index, text),
    };
    space.rules().map(drop).map_err(|mut error| {
        if let SpaceError::Conflict { constraints, .. } = &mut error {
            *constraints = std::mem::take(constraints).into_iter().map(located).collect();
        }
        Error::content(path, None, error.to_string())
    })
}
