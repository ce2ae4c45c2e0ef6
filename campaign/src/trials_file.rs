//! The lines of `trials.jsonl`, a trial each.

use crate::{Error, Reason, Trial};
use std::path::Path;
use thiserror::Error;

/// What is wrong with a line of a log.
#[derive(Debug, Error)]
pub enum LogFlaw {
    /// It is no text.
    #[error("found bytes that are no UTF-8, expected a trial as JSON")]
    NoText,
    /// It ends as lines of another system do.
    #[error("found a carriage return at the end of the line, expected none")]
    CarriageReturn,
    /// It is no trial.
    #[error("no trial: {0}")]
    NoTrial(serde_json::Error),
    /// A trial is missing before it.
    #[error("found trial {found}, expected trial {expected}")]
    Index {
        /// The index of the trial.
        found: usize,
        /// Its place in the log.
        expected: usize,
    },
}

impl Reason for LogFlaw {}

/// The trials of a log, and how many bytes they take: a last line without its end is none.
pub(crate) fn parse_trials(file: &Path, bytes: &[u8]) -> Result<(Vec<Trial>, usize), Error> {
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let text = std::str::from_utf8(&bytes[..whole]).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
        Error::in_file(file, line, LogFlaw::NoText)
    })?;
    let parse = |(i, line): (usize, &str)| {
        let wrong = |flaw| Error::in_file(file, i + 1, flaw);
        if line.ends_with('\r') {
            return Err(wrong(LogFlaw::CarriageReturn));
        }
        let trial: Trial = serde_json::from_str(line).map_err(|error| wrong(LogFlaw::NoTrial(error)))?;
        if trial.index == i { Ok(trial) } else { Err(wrong(LogFlaw::Index { found: trial.index, expected: i })) }
    };
    Ok((text.split_terminator('\n').enumerate().map(parse).collect::<Result<_, _>>()?, whole))
}
