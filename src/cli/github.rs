//! `--github`: adds a summary in Markdown to the page of a run of a GitHub workflow.

use super::usage;
use crate::Report;
use paracosm_campaign::Error;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The variable in which GitHub names the file of the summary of a step.
const VARIABLE: &str = "GITHUB_STEP_SUMMARY";

/// The summary of a step that a campaign adds to.
pub(super) struct StepSummary {
    file: PathBuf,
}

impl StepSummary {
    /// Finds the file of the summary, and checks that it can be written.
    ///
    /// # Errors
    /// The environment names no file, or it cannot be written.
    pub fn of_environment() -> Result<Self, Error> {
        let file = std::env::var_os(VARIABLE).filter(|file| !file.is_empty()).map(PathBuf::from).ok_or_else(|| {
            usage(format!(
                "--github: {VARIABLE} is not set, so this is no step of a GitHub workflow; to try the option, set it to the name of a file"
            ))
        })?;
        append(&file, "")?;
        Ok(Self { file })
    }

    /// Adds the results of the campaign in a folder.
    pub fn add(&self, report: &Report, folder: &Path, program: &str) -> Result<(), Error> {
        append(&self.file, &report.step_summary(folder, program).markdown())
    }
}

fn append(file: &Path, text: &str) -> Result<(), Error> {
    let opened = OpenOptions::new().append(true).create(true).open(file);
    opened.and_then(|mut opened| opened.write_all(text.as_bytes())).map_err(Error::io("write", file))
}
