//! What can go wrong between a command and its result. Messages are for the people who gave the command: what,
//! where, what was expected.

use paracosm_coverage::{PointSetError, SpaceError, kwise::KwiseError};
use paracosm_engine::{ProgramError, driver::DriverError, vehicle::UnknownModel};
use paracosm_generators::GeneratorError;
use paracosm_scenarios::UnknownScenario;
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Any error of a campaign or a measurement.
#[derive(Error)]
pub enum Error {
    /// No such scenario.
    #[error("{0}; `paracosm-fuzz list` shows them all")]
    Scenario(#[from] UnknownScenario),
    /// A scenario that cannot be run.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// No such model of the car.
    #[error(transparent)]
    Vehicle(#[from] UnknownModel),
    /// No such driver or setting.
    #[error("{0}; `paracosm-fuzz list` shows them all")]
    Driver(#[from] DriverError),
    /// No such strategy, or one that cannot do what is asked.
    #[error(transparent)]
    Generator(#[from] GeneratorError),
    /// A space or a test that cannot be.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// Points that are none of the unit cube.
    #[error(transparent)]
    Points(#[from] PointSetError),
    /// A strength that the space does not have.
    #[error(transparent)]
    Kwise(#[from] KwiseError),
    /// A file that cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// What was tried: `read`, `write`, `create`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file whose contents are not what they should be.
    #[error("{}{}: {message}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
    Content {
        /// The file.
        path: PathBuf,
        /// The line, from 1, if it is one line's fault.
        line: Option<usize>,
        /// What was found and what was expected.
        message: String,
    },
    /// A picture that could not be drawn.
    #[error("cannot draw {}: {message}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What the plotter said.
        message: String,
    },
    /// A system that others wrote did none of its first tests.
    #[error("each of the first {tests} tests ended in an error, so the campaign was given up; test {test}: {why}")]
    Unanswered {
        /// How many tests there were.
        tests: usize,
        /// The first of those that say what was wrong.
        test: usize,
        /// What it said.
        why: String,
    },
    /// The campaign was told to stop.
    #[error("interrupted")]
    Interrupted,
    /// A command that makes no sense as it is.
    #[error("{0}")]
    Usage(String),
}

/// As [`Display`](fmt::Display): a `main` that returns this error prints it by `Debug`, to people.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Error {
    /// An operation on a file that failed.
    pub(crate) fn file(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File { action, path, source }
    }

    /// Contents that are not what they should be.
    pub(crate) fn content(path: &Path, line: impl Into<Option<usize>>, message: impl Into<String>) -> Self {
        Self::Content { path: path.to_owned(), line: line.into(), message: message.into() }
    }
}
