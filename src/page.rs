//! Shows the results of a campaign as one HTML page, and in Markdown for the summary of a step of a workflow.

use crate::Report;
use crate::analysis::{Difference, Growth, Modes};
use crate::campaign::{Error, Folder, JsonArtefact};
use crate::findings;
use crate::report::StepSummary;
use crate::report::html::Page;
use serde_json::{Map, Value};
use std::io::ErrorKind;
use std::path::Path;

/// The files of results that other commands write into the folder of a campaign.
const BESIDE: [&str; 2] = ["blame.json", "located.json"];

impl Report {
    /// Makes the page of the campaign in a folder. `program` is the name of the program in commands on the
    /// page, usually `paracosm-fuzz`. `changes` compares an earlier campaign with this one.
    ///
    /// # Errors
    /// A test does not belong to the space, or a file of the folder cannot be read.
    pub fn page(&self, folder: &Path, program: &str, changes: Option<&Difference>) -> Result<Page<'_>, Error> {
        let mut results = Map::new();
        self.artefacts(|artefact| {
            let of_json = |file: &&str| file.ends_with(".json") && *file != Modes::FILE;
            for file in artefact.files().into_iter().filter(of_json) {
                let contents = artefact.contents(file)?;
                results.insert(file.to_owned(), serde_json::from_slice(&contents).unwrap_or_default());
            }
            Ok(())
        })?;
        for file in BESIDE {
            let path = folder.join(file);
            match std::fs::read(&path) {
                Ok(text) => {
                    let value =
                        serde_json::from_slice(&text).map_err(|error| Error::io("read", &path)(error.into()))?;
                    results.insert(file.to_owned(), value);
                }
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(Error::io("read", &path)(error)),
            }
        }
        let unfinished = Folder::is_unfinished(folder, self.log.study(), self.log.trials().len());
        let mut findings = findings::of_tests(self);
        findings.extend(findings::suspects(self));
        // A campaign that runs changes its sensitivity with every test.
        findings.extend((!unfinished).then(|| findings::sensitivity(&self.log)).flatten());
        findings.extend(results.get("blame.json").and_then(findings::blame));
        findings.extend(results.get("located.json").and_then(findings::located));
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
            changes: changes.map(|changes| serde_json::to_value(changes).unwrap_or(Value::Null)),
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
