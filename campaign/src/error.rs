//! The errors between a study and its log, sorted by what the caller can do about them.
//!
//! An [`Error`] is one of four kinds. All but the last hold a typed reason (a [`Reason`] or a [`Failure`]), which knows
//! what was found and what was expected, and says so in words. No part of the software reads the message of an error to
//! decide what to do.

use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An error type that explains a wrong request or a wrong file completely.
///
/// Every crate marks its own reasons with this trait. The operator `?` turns each into an [`Error::Use`].
pub trait Reason: std::error::Error + Send + Sync + 'static {}

/// Any error of a campaign, an analysis or a report.
#[derive(Error)]
pub enum Error {
    /// The request makes no sense. Ask for something else.
    #[error("{0}")]
    Use(Box<dyn Reason>),
    /// A file has wrong contents. Correct the file.
    #[error(transparent)]
    File(#[from] BadFile),
    /// Something other than the study failed, for example the disk, a process, or a graphics adapter. Repair it, and
    /// try again.
    #[error(transparent)]
    Environment(#[from] Failure),
    /// The work was told to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Prints the same text as [`Display`](fmt::Display), because a `main` that returns this error prints it with `Debug`.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl<R: Reason> From<R> for Error {
    fn from(reason: R) -> Self {
        Self::Use(Box::new(reason))
    }
}

/// A file has wrong contents.
#[derive(Debug, Error)]
#[error("{}{}: {reason}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct BadFile {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, if the error is in one line.
    pub line: Option<usize>,
    /// The error in the file, with the found and the expected content.
    pub reason: Box<dyn Reason>,
}

/// The reason why a file is not a CSV file.
#[derive(Debug, Error)]
pub enum CsvFlaw {
    /// A line has more or fewer fields than the header.
    #[error("the number of fields is {found}, expected {expected}")]
    Fields {
        /// The number of fields in the line.
        found: u64,
        /// The number of fields in the header.
        expected: u64,
    },
    /// The file is not UTF-8 text.
    #[error("found bytes that are not UTF-8")]
    NoText,
    /// The file cannot be read for another reason.
    #[error(transparent)]
    Other(csv::Error),
}

impl Reason for CsvFlaw {}

/// Something other than the study failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// A file or a folder cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The operation that failed, which is `read`, `write`, `create` or `lock`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A file or a folder was removed while it was in use.
    #[error("{} was removed while the campaign ran", path.display())]
    Removed {
        /// The file or folder.
        path: PathBuf,
    },
    /// A picture cannot be drawn.
    #[error("cannot draw {}: {source}", path.display())]
    Drawing {
        /// The file of the picture.
        path: PathBuf,
        /// The error of the plotter.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Threads cannot be started.
    #[error("cannot start the worker threads (number: {threads}): {source}")]
    Threads {
        /// The number of threads.
        threads: usize,
        /// The error of the operating system.
        source: rayon::ThreadPoolBuildError,
    },
    /// A system, a driver or a graphics adapter is not available.
    #[error("{0}")]
    Unavailable(Box<dyn Reason>),
    /// A system or a driver gave no result for any of its first tests.
    #[error("each of the first {tests} tests ended in an error, so the campaign was given up; test {test}: {problem}")]
    Unanswered {
        /// The number of tests.
        tests: usize,
        /// The index of the first test that states a reason.
        test: usize,
        /// The problem of that test.
        problem: crate::Problem,
    },
}

impl Error {
    /// Returns the reason if this is an [`Error::Use`] whose reason has the type `R`.
    pub fn reason<R: Reason>(&self) -> Option<&R> {
        match self {
            Self::Use(reason) => (&**reason as &dyn std::error::Error).downcast_ref(),
            Self::File(_) | Self::Environment(_) | Self::Interrupted => None,
        }
    }

    /// Makes the error of a file operation that failed.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Failure::Io { action, path, source }.into()
    }

    /// Makes the error of a file with wrong contents.
    pub fn in_file(path: &Path, line: impl Into<Option<usize>>, reason: impl Reason) -> Self {
        BadFile { path: path.to_owned(), line: line.into(), reason: Box::new(reason) }.into()
    }

    /// Makes the error of a file that is not a valid CSV file.
    pub fn in_csv(path: &Path, error: csv::Error) -> Self {
        let line = error.position().map(|position| position.line() as usize);
        let flaw = match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                CsvFlaw::Fields { found: *len, expected: *expected_len }
            }
            csv::ErrorKind::Utf8 { .. } => CsvFlaw::NoText,
            _ => CsvFlaw::Other(error),
        };
        Self::in_file(path, line, flaw)
    }

    /// Makes the error of something that is not available.
    pub fn unavailable(reason: impl Reason) -> Self {
        Failure::Unavailable(Box::new(reason)).into()
    }
}

/// The errors of lower crates that explain themselves completely.
mod below {
    use super::Reason;

    impl Reason for paracosm_coverage::PointSetError {}
    impl Reason for paracosm_coverage::kwise::KwiseError {}
    impl Reason for paracosm_engine::ProgramError {}
    impl Reason for paracosm_engine::sensor::SensorError {}
    impl Reason for paracosm_engine::vehicle::UnknownModel {}
    impl Reason for paracosm_generators::GeneratorError {}
    impl Reason for paracosm_oracles::EvaluationError {}
    impl Reason for paracosm_oracles::ParseError {}
    impl Reason for paracosm_space::ParameterError {}
    impl Reason for paracosm_space::ShapeError {}
    impl Reason for paracosm_space::SpaceError {}
    impl Reason for paracosm_space::pict::PictError {}
    #[cfg(feature = "neural")]
    impl Reason for paracosm_neural::ModelError {}
    impl Reason for serde_json::Error {}
}
