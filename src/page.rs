//! Shows the results of a campaign as one HTML page, and in Markdown for the summary of a step of a workflow.

use crate::Report;
use crate::analysis::{Difference, Growth, Modes};
use crate::campaign::{Error, Folder, JsonArtefact, Reason};
use crate::findings;
use crate::report::StepSummary;
use crate::report::html::Page;
use serde_json::{Map, Value};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The results beside those of a campaign that its page shows.
#[derive(Debug, Clone, Copy, Default)]
pub struct Beside<'a> {
    /// The comparison with an earlier campaign.
    pub changes: Option<&'a Difference>,
    /// The folder of an audit of tests for the same scenario and driver.
    pub audit: Option<&'a Path>,
}

/// The error that an audit and a campaign have different titles.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the audit in {} is about `{audit}`, and the campaign about `{campaign}`", folder.display())]
pub struct OtherAudit {
    /// The folder of the audit.
    pub folder: PathBuf,
    /// The title of the audit.
    pub audit: String,
    /// The title of the campaign.
    pub campaign: String,
}

impl Reason for OtherAudit {}

/// The files of results that other commands write into the folder of a campaign.
const BESIDE: [&str; 2] = ["blame.json", "located.json"];

/// The file of results in the folder of an audit.
const AUDIT: &str = "audit.json";

impl Report {
    /// Makes the page of the campaign in a folder. `program` is the name of the program in commands on the
    /// page, usually `paracosm-fuzz`.
    ///
    /// # Errors
    /// A test does not belong to the space, a file of the folder or of the audit cannot be read, or the audit is of another scenario or
    /// driver.
    pub fn page(&self, folder: &Path, program: &str, beside: Beside) -> Result<Page<'_>, Error> {
        let mut results = Map::new();
        self.artefacts(|artefact| {
            let of_json = |file: &&str| file.ends_with(".json") && *file != Modes::FILE;
            for file in artefact.files().into_iter().filter(of_json) {
                let contents = artefact.contents(file)?;
                results.insert(file.to_owned(), serde_json::from_slice(&contents).unwrap_or_default());
            }
            Ok(())
        })?;
        let files = BESIDE.map(|file| (folder, file)).into_iter();
        for (folder, file) in files.chain(beside.audit.map(|folder| (folder, AUDIT))) {
            let path = folder.join(file);
            match std::fs::read(&path) {
                Ok(text) => {
                    let value =
                        serde_json::from_slice(&text).map_err(|error| Error::io("read", &path)(error.into()))?;
                    results.insert(file.to_owned(), value);
                }
                Err(error) if error.kind() == ErrorKind::NotFound && file != AUDIT => {}
                Err(error) => return Err(Error::io("read", &path)(error)),
            }
        }
        if let (Some(folder), Some(audit)) = (beside.audit, results.get(AUDIT)) {
            let (folder, campaign) = (folder.to_owned(), self.log.study().title());
            let audit = audit.get("title").and_then(Value::as_str).unwrap_or_default().to_owned();
            if audit != campaign {
                return Err(OtherAudit { folder, audit, campaign }.into());
            }
        }
        let unfinished = Folder::is_unfinished(folder, self.log.study(), self.log.trials().len());
        let mut findings = findings::of_tests(self);
        findings.extend(findings::suspects(self));
        // A campaign that runs changes its sensitivity with every test.
        findings.extend((!unfinished).then(|| findings::sensitivity(self)).flatten());
        findings.extend(results.get("blame.json").and_then(findings::blame));
        findings.extend(results.get("located.json").and_then(findings::located));
        findings.extend(results.get(AUDIT).and_then(findings::audit));
        Ok(Page {
            log: &self.log,
            folder: folder.display().to_string(),
            program: program.to_owned(),
            unfinished,
            summary: &self.summary,
            plausible: self.plausible.as_ref(),
            coverage: &self.coverage,
            growth: Growth::of(&self.log)?,
            modes: &self.modes,
            effects: self.effects.as_ref(),
            axes: self.axes()?,
            findings,
            results,
            changes: beside.changes.map(|changes| serde_json::to_value(changes).unwrap_or(Value::Null)),
        })
    }

    /// Makes the summary of the campaign in a folder for a step of a GitHub workflow. `program` is the name of the program in its commands.
    pub fn step_summary(&self, folder: &Path, program: &str) -> StepSummary<'_> {
        StepSummary {
            log: &self.log,
            summary: &self.summary,
            plausible: self.plausible.as_ref(),
            map: self.map.as_ref(),
            modes: &self.modes,
            findings: findings::of_tests(self),
            folder: folder.display().to_string(),
            program: program.to_owned(),
        }
    }
}
