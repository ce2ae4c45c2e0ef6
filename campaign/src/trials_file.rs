//! Reads `trials.jsonl`, which has one trial per line.

use crate::{Error, Reason, Trial};
use std::io::{BufRead, BufReader, Read};
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

/// Reads the trials of a log line by line. Returns the trials, and the number of bytes that they take. A last line
/// without its end is ignored.
pub(crate) fn read_trials(file: &Path, log: impl Read) -> Result<(Vec<Trial>, u64), Error> {
    let mut log = BufReader::new(log);
    let (mut trials, mut whole): (Vec<Trial>, u64) = (Vec::new(), 0);
    let mut line = Vec::new();
    loop {
        line.clear();
        log.read_until(b'\n', &mut line).map_err(Error::io("read", file))?;
        let Some(text) = line.strip_suffix(b"\n") else { break };
        let trial = parse(text, trials.len()).map_err(|flaw| Error::in_file(file, trials.len() + 1, flaw))?;
        trial.append_to(&mut trials);
        whole += line.len() as u64;
    }
    Ok((trials, whole))
}

/// Reads a line of a log, which should be the trial with the given index.
fn parse(line: &[u8], index: usize) -> Result<Trial, LogFlaw> {
    let line = std::str::from_utf8(line).map_err(|_| LogFlaw::NoText)?;
    if line.ends_with('\r') {
        return Err(LogFlaw::CarriageReturn);
    }
    let trial: Trial = serde_json::from_str(line).map_err(LogFlaw::NoTrial)?;
    if trial.index == index { Ok(trial) } else { Err(LogFlaw::Index { found: trial.index, expected: index }) }
}
