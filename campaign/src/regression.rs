//! Regression files: one test with all that is needed to run it again, and what is to become of it.
//!
//! A campaign's folder is large and of one version of the software; what is worth keeping of it is a few failing tests.
//! Such a file is made when a test fails and says so. Who mends what failed edits `expect` to `"pass"`, and the file
//! watches that it stays mended.

use crate::files::{is_new, write_whole};
use crate::study_file::StudyFile;
use crate::{Campaign, Catalogue, Error, Folder, Reason, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{SpaceError, Values};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// One test with what is expected of it.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Regression {
    /// What the test shows, in a sentence.
    pub about: String,
    /// How it is to end.
    pub expect: Expectation,
    /// What it violated when it was written down.
    pub violates: Vec<String>,
    /// The values of the open parameters.
    pub test: Values,
    /// The fingerprint of the trace that it had then; without one traces are not compared.
    pub trace_hash: Option<String>,
    study: StudyFile,
}

/// How a test is to end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Expectation {
    /// It violates what it violated when it was written down.
    Fail,
    /// It violates nothing.
    Pass,
}

/// What became of a regression test when it was run again.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Replayed {
    /// How it was to end.
    pub expect: Expectation,
    /// Whether it did.
    pub as_expected: bool,
    /// Whether the trace was the very same; `None` where that is not to be expected: the test is to pass now, was written
    /// down by another version of the software, or without a trace.
    pub same_trace: Option<bool>,
    /// The test with what became of it.
    pub trial: Trial,
}

/// What is wrong with a regression file.
#[derive(Debug, Error)]
pub enum RegressionFlaw {
    /// It is none.
    #[error("no regression test: {0}")]
    Json(serde_json::Error),
    /// Its test is none of its study.
    #[error("`test`: {0}")]
    Test(SpaceError),
    /// It is about a requirement that its study does not have.
    #[error("`violates`: no requirement is called `{id}`")]
    NoRequirement {
        /// The id.
        id: String,
    },
}

/// A name that no regression file can have.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}: expected the name of a regression file, as regressions/NAME.json", path.display())]
pub struct NoRegressionName {
    /// The file.
    pub path: PathBuf,
}

impl Reason for RegressionFlaw {}
impl Reason for NoRegressionName {}

impl Regression {
    /// The test of a failing trial, expected to fail.
    pub fn new(about: String, study: &Study, trial: &Trial) -> Self {
        let violates = trial.violated().map(str::to_owned).collect();
        let study = StudyFile { study: study.of_one_test(), learned: Default::default(), extends: None };
        let (test, trace_hash) = (trial.test.clone(), trial.trace_hash.clone());
        Self { about, expect: Expectation::Fail, violates, test, trace_hash, study }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, is no such file, or its test is none of its study.
    pub fn read(path: &Path, catalogue: &Catalogue) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
        let mut read: Self = serde_json::from_str(&text)
            .map_err(|error| Error::in_file(path, error.line(), RegressionFlaw::Json(error)))?;
        let wrong = |flaw| Error::in_file(path, None, flaw);
        read.study.study = read.study.study.with_program_of(catalogue);
        let study = read.study();
        study.space().encode(&read.test).map_err(|error| wrong(RegressionFlaw::Test(error)))?;
        // The requirements of a system that answers with robustness are only known when it answers.
        let judges_itself = !study.requirements().iter().any(|requirement| requirement.formula.is_some());
        let stated = |id: &&String| judges_itself || study.requirement(id).is_some();
        match read.violates.iter().find(|id| !stated(id)) {
            Some(id) => Err(wrong(RegressionFlaw::NoRequirement { id: id.clone() })),
            None => Ok(read),
        }
    }

    /// Writes a file that does not exist yet, in a folder that is made if need be.
    ///
    /// # Errors
    /// It exists or cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        Self::check_path(path)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        }
        let mut text = serde_json::to_string_pretty(self).expect("a regression test is always JSON");
        text.push('\n');
        write_whole(path, text.as_bytes())
    }

    /// Checks that a regression file may be written there.
    ///
    /// # Errors
    /// There is a file, or the name is that of a campaign's own.
    pub fn check_path(path: &Path) -> Result<(), Error> {
        if path.file_name().is_none_or(Folder::owns) {
            return Err(NoRegressionName { path: path.to_owned() }.into());
        }
        Ok(is_new(path, "a regression file")?)
    }

    /// The study that it is a test of.
    pub fn study(&self) -> &Study {
        &self.study.study
    }

    /// Runs it again.
    ///
    /// # Errors
    /// Its study cannot be run.
    pub fn run(&self) -> Result<Replayed, Error> {
        let mut ran = None;
        Campaign::new(self.study())?.run_tests(std::slice::from_ref(&self.test), 0, |trial| {
            ran = Some(trial.clone());
            Ok(())
        })?;
        let trial = ran.expect("a test that is run is shown");
        let as_expected = match self.expect {
            Expectation::Fail => trial.is_failure() && self.violates.iter().all(|id| trial.violates(id)),
            Expectation::Pass => trial.verdict == Verdict::Pass,
        };
        let comparable = self.expect == Expectation::Fail && self.study().is_of_this_software();
        let recorded = self.trace_hash.as_ref().filter(|_| comparable);
        let same_trace = recorded.map(|recorded| trial.trace_hash.as_ref() == Some(recorded));
        Ok(Replayed { expect: self.expect, as_expected, same_trace, trial })
    }
}
