//! Regression files: one test with everything that is needed to run it again, and its expected result.
//!
//! A campaign's folder is large and belongs to one version of the software; usually only a few failing tests are worth
//! keeping. A regression file is made from a failing test, and says that the test fails. When the failure is repaired,
//! change `expect` to `"pass"`; from then on the file checks that the failure stays repaired.

use crate::files::{create_folder, is_new, read_text, write_whole};
use crate::json_text::{JsonFlaw, read_json};
use crate::study_file::StudyFile;
use crate::{Campaign, Catalogue, Error, Folder, Reason, Study, Trial, Trust};
use paracosm_oracles::Verdict;
use paracosm_space::{SpaceError, Values};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A regression test, which is a test with a study and an expected result.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Regression {
    /// The description of the regression test in one sentence.
    pub about: String,
    /// The expected result of the test.
    pub expect: Expectation,
    /// The ids of the requirements that the test violated when the file was written.
    pub violates: Vec<String>,
    /// The values of the open parameters in the test.
    pub test: Values,
    /// The hash of the trace when the file was written; `None` if traces are not compared.
    pub trace_hash: Option<String>,
    study: StudyFile,
}

/// The expected result of a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Expectation {
    /// The test violates all requirements that it violated when the file was written.
    Fail,
    /// The verdict of the test is `pass`.
    Pass,
}

/// The result of a regression test that was run again.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Replayed {
    /// The expected result of the test.
    pub expect: Expectation,
    /// True if the test had the expected result.
    pub as_expected: bool,
    /// True if the trace was exactly equal to the recorded trace; `None` if the traces cannot be compared. This is so
    /// if the test should now pass, or was written by another version of the software, or without a trace.
    pub same_trace: Option<bool>,
    /// The trial of the new run of the test.
    pub trial: Trial,
}

/// The error in a regression file.
#[derive(Debug, Error)]
pub enum RegressionFlaw {
    /// The contents of the file do not have the form of a regression test.
    #[error("the file is not a regression test: {0}")]
    Json(JsonFlaw),
    /// The test does not belong to the study of the file.
    #[error("`test`: {0}")]
    Test(SpaceError),
    /// The test breaks a constraint of the study.
    #[error("`test`: the values break the constraint `{constraint}`; change the values")]
    Broken {
        /// The text of the constraint.
        constraint: String,
    },
    /// The file names a requirement that the study of the file does not have.
    #[error("`violates`: no requirement is called `{id}`")]
    NoRequirement {
        /// The id that no requirement of the study has.
        id: String,
    },
}

/// The error that a regression file cannot have the given name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{} cannot be a regression file, expected a name like regressions/NAME.json", path.display())]
pub struct NoRegressionName {
    /// The path with the invalid file name.
    pub path: PathBuf,
}

impl Reason for RegressionFlaw {}
impl Reason for NoRegressionName {}

impl Regression {
    /// Makes a regression test from a failing trial, with the expectation that the test fails again.
    pub fn new(about: String, study: &Study, trial: &Trial) -> Self {
        let violates = trial.violated().map(str::to_owned).collect();
        let study = StudyFile { study: study.of_one_test(), learned: Default::default(), extends: None };
        let (test, trace_hash) = (trial.test.clone(), trial.trace_hash.clone());
        Self { about, expect: Expectation::Fail, violates, test, trace_hash, study }
    }

    /// Reads a regression test from a file.
    ///
    /// # Errors
    /// The file cannot be read, is not a regression file, or its test does not belong to its study.
    pub fn read(path: &Path, catalogue: &Catalogue) -> Result<Self, Error> {
        let text = read_text(path)?;
        let mut read: Self =
            read_json(&text).map_err(|flaw| Error::in_file(path, flaw.line(), RegressionFlaw::Json(flaw)))?;
        let wrong = |flaw| Error::in_file(path, None, flaw);
        let near = catalogue.near(path.parent().unwrap_or(Path::new("")));
        read.study = read.study.with_program_of(&near).map_err(|flaw| Error::in_file(path, None, flaw))?;
        let study = read.study();
        let test = study.space().encode(&read.test).map_err(|error| wrong(RegressionFlaw::Test(error)))?;
        if let Some(constraint) = study.space().broken(&test) {
            return Err(wrong(RegressionFlaw::Broken { constraint: constraint.text().to_owned() }));
        }
        // The requirements of a system that answers with robustness are known only from its answer.
        let judges_itself = !study.requirements().iter().any(|requirement| requirement.formula.is_some());
        let stated = |id: &&String| judges_itself || study.requirement(id).is_some();
        match read.violates.iter().find(|id| !stated(id)) {
            Some(id) => Err(wrong(RegressionFlaw::NoRequirement { id: id.clone() })),
            None => Ok(read),
        }
    }

    /// Writes the regression test to a new file, and creates the folder of the file if necessary.
    ///
    /// # Errors
    /// The file exists or cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        Self::check_path(path)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            create_folder(folder)?;
        }
        let mut text = serde_json::to_string_pretty(self).expect("a regression test is always JSON");
        text.push('\n');
        write_whole(path, text.as_bytes())
    }

    /// Checks that a regression file may be written at a path.
    ///
    /// # Errors
    /// The file exists, or its name is reserved for a campaign's own files.
    pub fn check_path(path: &Path) -> Result<(), Error> {
        if path.file_name().is_none_or(Folder::owns) {
            return Err(NoRegressionName { path: path.to_owned() }.into());
        }
        Ok(is_new(path, "a regression file")?)
    }

    /// Returns the regression test with the trust of the user in the command that its study names. Without trust, a
    /// test that was read from a file cannot be run if it needs the command.
    pub fn trusting(mut self, trust: &Trust) -> Self {
        self.study.study = self.study.study.trusting(trust);
        self
    }

    /// Returns the study to which the regression test belongs.
    pub fn study(&self) -> &Study {
        &self.study.study
    }

    /// Runs the test again, and compares the result with the expected result.
    ///
    /// # Errors
    /// The study cannot be run.
    pub fn run(&self) -> Result<Replayed, Error> {
        let trial = Campaign::new(self.study())?.run_test(&self.test, 0)?;
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
