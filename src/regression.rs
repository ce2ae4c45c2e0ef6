//! Regression files: one test with all that is needed to run it again, and what is to become of it.
//!
//! A campaign's folder is large and of one version of the software; what is worth keeping of it is a few failing tests.
//! Such a file is made when a test fails and says so. Who mends what failed edits `expect` to `"pass"`, and the file
//! watches that it stays mended.

use crate::folder::{is_new, write_whole};
use crate::{Campaign, Error, Folder, RequirementText, Study, Trial, older};
use paracosm_coverage::Values;
use paracosm_oracles::Verdict;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

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
    study: Study,
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

impl Regression {
    /// The test of a failing trial, expected to fail.
    pub fn new(about: String, study: &Study, trial: &Trial) -> Self {
        let violates = trial.violated().map(str::to_owned).collect();
        // How the campaign went about its tests is of no concern to this one.
        let mut study = study.clone().stop_at_first(false).with_scales(BTreeMap::new(), &[]);
        (study.extends, study.odd, study.budget) = (None, None, 1);
        let (test, trace_hash) = (trial.test.clone(), trial.trace_hash.clone());
        Self { about, expect: Expectation::Fail, violates, test, trace_hash, study }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, is no such file, or its test is none of its study.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
        let mut regression: Self = serde_json::from_str(&text)
            .map_err(|error| Error::content(path, error.line(), format!("no regression test: {error}")))?;
        older::complete(&mut regression.study);
        let Self { study, test, violates, .. } = &regression;
        study.check_format().map_err(|message| Error::content(path, None, message))?;
        study.space.encode(test).map_err(|error| Error::content(path, None, format!("`test`: {error}")))?;
        // What a system that answers with robustness is asked is only known when it answers.
        let judges_itself = !study.requirements.iter().any(RequirementText::has_formula);
        let stated = |id: &&String| judges_itself || study.requirement(id).is_some();
        match violates.iter().find(|id| !stated(id)) {
            Some(id) => Err(Error::content(path, None, format!("`violates`: no requirement is called `{id}`"))),
            None => Ok(regression),
        }
    }

    /// Writes a file that does not exist yet, in a folder that is made if need be.
    ///
    /// # Errors
    /// It exists or cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        Self::check_path(path)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(Error::file("create", folder))?;
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
            let message = "expected the name of a regression file, as regressions/NAME.json";
            return Err(Error::Usage(format!("{}: {message}", path.display())));
        }
        is_new(path, "a regression file")
    }

    /// The study that it is a test of.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Runs it again.
    ///
    /// # Errors
    /// Its study cannot be run.
    pub fn run(&self) -> Result<Replayed, Error> {
        let mut ran = None;
        Campaign::new(&self.study)?.run_tests(std::slice::from_ref(&self.test), 0, |trial| {
            ran = Some(trial.clone());
            Ok(())
        })?;
        let trial = ran.expect("a test that is run is shown");
        let as_expected = match self.expect {
            Expectation::Fail => trial.is_failure() && self.violates.iter().all(|id| trial.violates(id)),
            Expectation::Pass => trial.verdict == Verdict::Pass,
        };
        let comparable = self.expect == Expectation::Fail && self.study.is_of_this_software();
        let recorded = self.trace_hash.as_ref().filter(|_| comparable);
        let same_trace = recorded.map(|recorded| trial.trace_hash.as_ref() == Some(recorded));
        Ok(Replayed { expect: self.expect, as_expected, same_trace, trial })
    }
}
