//! The errors between a study and its log, sorted by what the caller can do about them.
//!
//! An [`Error`] is one of four kinds. All but the last hold a typed reason (a [`Reason`] or a [`Failure`]), which knows
//! what was found and what was expected, and says so in words. No part of the software reads the message of an error to
//! decide what to do.

use paracosm_space::plural;
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
    /// The request of the user is invalid. Change the request.
    #[error("{0}")]
    Use(Box<dyn Reason>),
    /// A file has wrong contents. Correct the file.
    #[error(transparent)]
    File(#[from] BadFile),
    /// A part of the environment failed, for example the disk, a process, or a graphics adapter. Repair it, and try
    /// again.
    #[error(transparent)]
    Environment(#[from] Failure),
    /// The work was interrupted before its end.
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

/// The error that a file has wrong contents.
#[derive(Debug, Error)]
#[error("{}{}: {reason}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct BadFile {
    /// The path of the file.
    pub path: PathBuf,
    /// The number of the wrong line, from 1; `None` if the error is not in a single line.
    pub line: Option<usize>,
    /// The reason why the contents of the file are wrong.
    pub reason: Box<dyn Reason>,
}

/// The reason why a file is not a CSV file.
#[derive(Debug, Error)]
pub enum CsvFlaw {
    /// A line has more or fewer fields than the header.
    #[error("found {}, expected {expected}", plural(*found as usize, "field"))]
    Fields {
        /// The number of fields in the line.
        found: u64,
        /// The number of fields in the header.
        expected: u64,
    },
    /// The text of the file is not UTF-8.
    #[error("found bytes that are not UTF-8")]
    NoText,
    /// An error of the CSV reader other than a wrong number of fields or bytes that are not UTF-8.
    #[error(transparent)]
    Other(csv::Error),
}

impl Reason for CsvFlaw {}

/// A failure of the environment, for example of the disk, a process or a graphics adapter.
#[derive(Debug, Error)]
pub enum Failure {
    /// A file or a folder cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The operation that failed, which is `read`, `write`, `create` or `lock`.
        action: &'static str,
        /// The path of the file or folder that cannot be read or written.
        path: PathBuf,
        /// The error that the operating system reported.
        source: std::io::Error,
    },
    /// A file or a folder was removed or moved while the campaign used it.
    #[error("{} was removed or moved while the campaign ran", path.display())]
    Removed {
        /// The path of the removed file or folder.
        path: PathBuf,
    },
    /// A picture cannot be drawn.
    #[error("cannot draw {}: {source}", path.display())]
    Drawing {
        /// The path of the picture.
        path: PathBuf,
        /// The error that occurred while the picture was drawn.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The worker threads cannot be started.
    #[error("cannot start the worker threads (number: {threads}): {source}")]
    Threads {
        /// The number of worker threads that should be started.
        threads: usize,
        /// The error that the operating system reported.
        source: rayon::ThreadPoolBuildError,
    },
    /// A system, a driver or a graphics adapter is not available.
    #[error("{0}")]
    Unavailable(Box<dyn Reason>),
    /// A system or a driver gave no result for any of its first tests.
    #[error("each of the first {tests} tests ended in an error, so the campaign was given up; test {test}: {problem}")]
    Unanswered {
        /// The number of tests that ended without a result.
        tests: usize,
        /// The index of the test whose problem is reported.
        test: usize,
        /// The problem of the reported test.
        problem: crate::Problem,
    },
}

impl Error {
    /// Returns the reason of an [`Error::Use`], if the reason has the type `R`.
    pub fn reason<R: Reason>(&self) -> Option<&R> {
        match self {
            Self::Use(reason) => (&**reason as &dyn std::error::Error).downcast_ref(),
            Self::File(_) | Self::Environment(_) | Self::Interrupted => None,
        }
    }

    /// Returns a function that makes the error of a failed file operation.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Failure::Io { action, path, source }.into()
    }

    /// Makes the error that a file has wrong contents.
    pub fn in_file(path: &Path, line: impl Into<Option<usize>>, reason: impl Reason) -> Self {
        BadFile { path: path.to_owned(), line: line.into(), reason: Box::new(reason) }.into()
    }

    /// Makes the error that a file is not a valid CSV file.
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

    /// Makes the error that a system, a driver or a graphics adapter is not available.
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
    impl Reason for paracosm_engine::vehicle::VehicleSettingFlaw {}
    impl Reason for crate::Problem {}
    impl Reason for paracosm_generators::GeneratorError {}
    impl Reason for paracosm_oracles::EvaluationError {}
    impl Reason for paracosm_oracles::ParseError {}
    impl Reason for paracosm_space::ParameterError {}
    impl Reason for paracosm_space::ShapeError {}
    impl Reason for paracosm_space::SpaceError {}
    impl Reason for paracosm_space::pict::PictError {}
    #[cfg(feature = "neural")]
    impl Reason for paracosm_neural::ModelError {}
    #[cfg(feature = "neural")]
    impl Reason for paracosm_neural::vision::DescriptionFlaw {}
    impl Reason for serde_json::Error {}
}
