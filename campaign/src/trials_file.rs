//! Reads `trials.jsonl`, which has one trial per line.

use crate::json_text::{JsonFlaw, read_json};
use crate::study::Study;
use crate::study_file::STUDY;
use crate::trial::{Line, UnknownWord};
use crate::{Error, Reason, Subject, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{SpaceError, did_you_mean, nearest, plural};
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
    let mut line = Vec::new();
    loop {
        line.clear();
        log.read_until(b'\n', &mut line).map_err(Error::io("read", file))?;
        let Some(text) = line.strip_suffix(b"\n") else { break };
        let number = found.trials.len() + 1;
        let index = indices.start + found.trials.len();
        if index >= indices.end {
            return Err(Error::in_file(file, number, LogFlaw::Surplus { most: indices.len() }));
        }
        let line_read = parse(text, index, hash).map_err(|flaw| Error::in_file(file, number, flaw))?;
        let is_older = line_read.study().is_none();
        if number > 1 && is_older != found.is_older {
            return Err(Error::in_file(file, number, LogFlaw::Mixed));
        }
        found.is_older = is_older;
        let problem = line_read.contradiction();
        let trial = Trial::try_from(line_read).map_err(LogFlaw::Word).and_then(|trial| {
            study.space().encode(&trial.test).map_err(LogFlaw::Test)?;
            agrees(&trial, study, &ids)?;
            match problem {
                Some((entry, is_there)) => Err(LogFlaw::Problem { verdict: trial.verdict, entry, is_there }),
                None => Ok(trial),
            }
        });
        trial.map_err(|flaw| Error::in_file(file, number, flaw))?.append_to(&mut found.trials);
        found.bytes += line.len() as u64;
    }
    Ok(found)
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
