//! What can go wrong between a study and its log, sorted by what the caller can do about it.
//!
//! An [`Error`] is one of four kinds. Each holds a typed [`Reason`], which knows what was found, what was expected, and says
//! so to people. No part of the software reads the message of an error to decide what to do.

use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why something makes no sense: an error type that says it all.
///
/// Every crate has reasons of its own and marks them with this trait; `?` turns each into an [`Error::Use`].
pub trait Reason: std::error::Error + Send + Sync + 'static {}

/// Any error of a campaign, an analysis or a report.
#[derive(Error)]
pub enum Error {
    /// What was asked for makes no sense. Ask for something else.
    #[error("{0}")]
    Use(Box<dyn Reason>),
    /// A file holds what it should not hold. Mend the file.
    #[error(transparent)]
    File(#[from] BadFile),
    /// Something beside the study failed: the disk, a process, a graphics adapter. Mend that, and try again.
    #[error(transparent)]
    Environment(#[from] Failure),
    /// The work was told to stop.
    #[error("interrupted")]
    Interrupted,
}

/// As [`Display`](fmt::Display): a `main` that returns this error prints it by `Debug`, to people.
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

/// A file whose contents are not what they should be.
#[derive(Debug, Error)]
#[error("{}{}: {reason}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct BadFile {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, if it is one line's fault.
    pub line: Option<usize>,
    /// What was found and what was expected.
    pub reason: Box<dyn Reason>,
}

/// What keeps a file from being a CSV.
#[derive(Debug, Error)]
pub enum CsvFlaw {
    /// A line has more or fewer fields than the header.
    #[error("found {found} fields, expected {expected}")]
    Fields {
        /// How many the line has.
        found: u64,
        /// How many the header has.
        expected: u64,
    },
    /// It is no text.
    #[error("found bytes that are no UTF-8")]
    NoText,
    /// It cannot be read.
    #[error(transparent)]
    Other(csv::Error),
}

impl Reason for CsvFlaw {}

/// Something beside the study that failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// A file or a folder that cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried: `read`, `write`, `create`, `lock`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file or a folder that is gone while it is in use.
    #[error("{} was removed while the campaign ran", path.display())]
    Removed {
        /// The file or folder.
        path: PathBuf,
    },
    /// A picture that cannot be drawn.
    #[error("cannot draw {}: {source}", path.display())]
    Drawing {
        /// The file that it was for.
        path: PathBuf,
        /// What the plotter said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Threads that cannot be started.
    #[error("cannot start {threads} threads: {source}")]
    Threads {
        /// How many.
        threads: usize,
        /// What the system said.
        source: rayon::ThreadPoolBuildError,
    },
    /// A system, a driver or a graphics adapter that cannot be had.
    #[error("{0}")]
    Unavailable(Box<dyn Reason>),
    /// A system or a driver that did none of its first tests.
    #[error("each of the first {tests} tests ended in an error, so the campaign was given up; test {test}: {problem}")]
    Unanswered {
        /// How many tests there were.
        tests: usize,
        /// The first test that says what is wrong.
        test: usize,
        /// What it says.
        problem: crate::Problem,
    },
}

impl Error {
    /// The reason of this kind, if that is why something makes no sense.
    pub fn reason<R: Reason>(&self) -> Option<&R> {
        match self {
            Self::Use(reason) => (&**reason as &dyn std::error::Error).downcast_ref(),
            Self::File(_) | Self::Environment(_) | Self::Interrupted => None,
        }
    }

    /// An operation on a file that failed.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Failure::Io { action, path, source }.into()
    }

    /// Contents of a file that are not what they should be.
    pub fn in_file(path: &Path, line: impl Into<Option<usize>>, reason: impl Reason) -> Self {
        BadFile { path: path.to_owned(), line: line.into(), reason: Box::new(reason) }.into()
    }

    /// A CSV file that is none.
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

    /// Something that cannot be had.
    pub fn unavailable(reason: impl Reason) -> Self {
        Failure::Unavailable(Box::new(reason)).into()
    }
}

/// Errors of the crates below that say all there is to say.
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
