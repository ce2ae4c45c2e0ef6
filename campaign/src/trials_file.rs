//! Reads `trials.jsonl`, which has one trial per line.

use crate::json_text::{JsonFlaw, read_json};
use crate::study::Study;
use crate::study_file::STUDY;
use crate::trial::{Line, UnknownWord};
use crate::{Error, Reason, Subject, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{SpaceError, did_you_mean, nearest, plural};
use rayon::prelude::*;
use std::collections::HashSet;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::Path;
use thiserror::Error;

/// The name of the file in the folder of a campaign.
pub(crate) const TRIALS: &str = "trials.jsonl";

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
    NoTrial(JsonFlaw),
    /// A word in the trial is not known.
    #[error("the line is not a trial: {0}")]
    Word(#[from] UnknownWord),
    /// The trial lacks an error text, or has one beside a verdict without an error.
    #[error("`verdict` is `{verdict}`, but `{entry}` is {}", if *is_there { "there" } else { "missing" })]
    Problem {
        /// The verdict of the trial.
        verdict: Verdict,
        /// The entry: `error` or `cause`.
        entry: &'static str,
        /// True if the line has the entry.
        is_there: bool,
    },
    /// The log has more trials than the campaign or the shard has tests.
    #[error("found another trial, expected at most {} in this log", plural(*most, "test"))]
    Surplus {
        /// The greatest number of tests in the log.
        most: usize,
    },
    /// The index of the trial does not match the number of the line.
    #[error("found trial {found}, expected trial {expected}")]
    Index {
        /// The index that the trial has.
        found: usize,
        /// The index that the trial should have, which matches the number of the line.
        expected: usize,
    },
    /// The test of the trial does not belong to the space of the study.
    #[error("`test`: {0}")]
    Test(SpaceError),
    /// The trial has a requirement that the study does not have.
    #[error("`robustness`: the study has no requirement `{id}`{}", did_you_mean(.nearest))]
    Requirement {
        /// The id that no requirement of the study has.
        id: String,
        /// The most similar id; `None` if no id is similar.
        nearest: Option<String>,
    },
    /// The verdict of the trial contradicts the least robustness of the trial.
    #[error("`verdict` is `{verdict}`, but the least robustness is {robustness}, of `{id}`")]
    Verdict {
        /// The verdict of the trial.
        verdict: Verdict,
        /// The id of the requirement with the least robustness.
        id: String,
        /// The least robustness.
        robustness: f64,
    },
    /// The verdict of the trial is that of a study with reference drivers, but the study has none.
    #[error("`verdict` is `{}`, but the study has no reference drivers", Verdict::Unpreventable)]
    NoReferences,
    /// Some lines name their study, and others do not.
    #[error(
        "the lines before name their study and this line does not, or the other way round: two campaigns were mixed"
    )]
    Mixed,
    /// The trial belongs to another study than the file `campaign.json`.
    #[error(
        "found a trial of the study {found}, but {STUDY} in the same folder is the study {expected}: two \
         campaigns were mixed, or {STUDY} was changed"
    )]
    OtherStudy {
        /// The hash of the study that the trial names.
        found: String,
        /// The hash of the study in `campaign.json`.
        expected: String,
    },
}

impl Reason for LogFlaw {}

/// The trials of a log.
#[derive(Default)]
pub(crate) struct Read {
    pub trials: Vec<Trial>,
    /// The number of bytes that the trials take.
    pub bytes: u64,
    /// True if a line does not name its study, as in logs of older versions.
    pub is_older: bool,
}

/// Reads the trials of a log line by line. A last line without its end is ignored. The trials have to belong to
/// the study, which has the given hash, and to have these indices.
pub(crate) fn read_trials(
    file: &Path,
    log: impl io::Read,
    study: &Study,
    hash: &str,
    indices: Range<usize>,
) -> Result<Read, Error> {
    let mut log = BufReader::new(log);
    let mut found = Read::default();
    let ids: HashSet<&str> = study.requirements().iter().map(|requirement| requirement.id.as_str()).collect();
    loop {
        let (lines, is_last) = next_lines(&mut log).map_err(Error::io("read", file))?;
        let first = indices.start + found.trials.len();
        let read = |(at, line): (usize, &Vec<u8>)| -> Result<(bool, Result<Trial, LogFlaw>), LogFlaw> {
            let line = parse(&line[..line.len() - 1], first + at, hash)?;
            let (is_older, problem) = (line.study().is_none(), line.contradiction());
            let trial = Trial::try_from(line).map_err(LogFlaw::Word).and_then(|trial| {
                study.space().encode(&trial.test).map_err(LogFlaw::Test)?;
                agrees(&trial, study, &ids)?;
                match problem {
                    Some((entry, is_there)) => Err(LogFlaw::Problem { verdict: trial.verdict, entry, is_there }),
                    None => Ok(trial),
                }
            });
            Ok((is_older, trial))
        };
        let all: Vec<_> = lines.par_iter().enumerate().map(read).collect();
        for (line, read) in lines.iter().zip(all) {
            let number = found.trials.len() + 1;
            if number > indices.len() {
                return Err(Error::in_file(file, number, LogFlaw::Surplus { most: indices.len() }));
            }
            let (is_older, trial) = read.map_err(|flaw| Error::in_file(file, number, flaw))?;
            if number > 1 && is_older != found.is_older {
                return Err(Error::in_file(file, number, LogFlaw::Mixed));
            }
            found.is_older = is_older;
            trial.map_err(|flaw| Error::in_file(file, number, flaw))?.append_to(&mut found.trials);
            found.bytes += line.len() as u64;
        }
        if is_last {
            return Ok(found);
        }
    }
}

/// The number of lines that are read together, on all cores.
const TOGETHER: usize = 4096;

/// Returns the next lines of a log, each with its end, and `true` if no more lines follow. A last line without its end is left out, also if
/// another process writes the rest of the line meanwhile.
fn next_lines(log: &mut impl BufRead) -> io::Result<(Vec<Vec<u8>>, bool)> {
    let mut lines = Vec::new();
    while lines.len() < TOGETHER {
        let mut line = Vec::new();
        log.read_until(b'\n', &mut line)?;
        if line.last() != Some(&b'\n') {
            return Ok((lines, true));
        }
        lines.push(line);
    }
    Ok((lines, false))
}

/// Checks that the verdict of a trial agrees with its robustness, and that the study has its requirements. A system that
/// judges itself may have any requirements.
fn agrees(trial: &Trial, study: &Study, ids: &HashSet<&str>) -> Result<(), LogFlaw> {
    if let Subject::Scenario(_) = study.subject()
        && let Some(id) = trial.requirements().find(|id| !ids.contains(id))
    {
        let nearest = nearest(id, ids.iter().copied()).map(str::to_owned);
        return Err(LogFlaw::Requirement { id: id.to_owned(), nearest });
    }
    if trial.verdict == Verdict::Unpreventable && study.references().is_empty() {
        return Err(LogFlaw::NoReferences);
    }
    let worst = trial.decided().min_by(|a, b| a.1.total_cmp(&b.1));
    let contradicts = |robustness: f64| match trial.verdict {
        Verdict::Pass => robustness < 0.0,
        Verdict::Fail | Verdict::Unpreventable => robustness > 0.0,
        Verdict::Inconclusive | Verdict::Invalid | Verdict::Error => false,
    };
    match worst.filter(|(_, robustness)| contradicts(*robustness)) {
        Some((id, robustness)) => Err(LogFlaw::Verdict { verdict: trial.verdict, id: id.to_owned(), robustness }),
        None => Ok(()),
    }
}

impl Trial {
    /// Returns the trial as JSON in one line: a line of `trials.jsonl` without the hash of a study.
    pub fn as_line(&self) -> String {
        serde_json::to_string(&Line::of(self, None)).expect("a trial is always JSON")
    }

    /// Reads the line that [`as_line`](Self::as_line) returns.
    ///
    /// # Errors
    /// The line is no trial.
    pub fn of_line(line: &str) -> Result<Self, LogFlaw> {
        Ok(Self::try_from(read_json::<Line>(line).map_err(LogFlaw::NoTrial)?)?)
    }
}

/// Reads a line of a log, which should be the trial with the given index.
fn parse(line: &[u8], index: usize, study: &str) -> Result<Line, LogFlaw> {
    let line = std::str::from_utf8(line).map_err(|_| LogFlaw::NoText)?;
    if line.ends_with('\r') {
        return Err(LogFlaw::CarriageReturn);
    }
    // The second reading, which is slower, finds the entry of an error.
    let line: Line = serde_json::from_str(line).or_else(|_| read_json(line)).map_err(LogFlaw::NoTrial)?;
    if let Some(found) = line.study().filter(|found| *found != study) {
        return Err(LogFlaw::OtherStudy { found: found.to_owned(), expected: study.to_owned() });
    }
    if line.index() == index { Ok(line) } else { Err(LogFlaw::Index { found: line.index(), expected: index }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    /// A log whose last line is torn, and which gets the rest of the line after its reader has seen the end.
    struct Torn(Vec<&'static [u8]>);

    impl Read for Torn {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            if self.0.is_empty() {
                return Ok(0);
            }
            let part = self.0.remove(0);
            into[..part.len()].copy_from_slice(part);
            Ok(part.len())
        }
    }

    #[test]
    fn a_line_that_another_process_is_writing_is_left_out() {
        let mut log = BufReader::new(Torn(vec![b"one\ntw", b"", b"o\nthree\n"]));
        assert_eq!(next_lines(&mut log).unwrap(), (vec![b"one\n".to_vec()], true));
    }
}
