//! Reads `trials.jsonl`, which has one trial per line.

use crate::{Error, Reason, Trial};
use std::path::Path;
use thiserror::Error;

/// The error in a line of a log.
#[derive(Debug, Error)]
pub enum LogFlaw {
    /// The text of the file is not UTF-8.
    #[error("found bytes that are not UTF-8, expected a trial as JSON")]
    NoText,
    /// The line ends with a carriage return.
    #[error("found a carriage return at the end of the line, expected none")]
    CarriageReturn,
    /// The line is not a trial in JSON.
    #[error("the line is not a trial: {0}")]
    NoTrial(serde_json::Error),
    /// The index of the trial does not match the number of the line.
    #[error("found trial {found}, expected trial {expected}")]
    Index {
        /// The index that the trial has.
        found: usize,
        /// The index that the trial should have, which matches the number of the line.
        expected: usize,
    },
}

impl Reason for LogFlaw {}

/// Returns the trials of a log, and the number of bytes that they take. A last line without its end is ignored.
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
