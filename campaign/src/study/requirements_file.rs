//! Reads `requirements.toml`: requirements as a test engineer keeps them, with their source and the severity of a
//! violation. The file may also state the part of the operational design domain that the tests are about.

use super::odd::Written;
use super::toml_file::TomlFile;
use super::{FormulaFlaw, StatedRequirement, Study};
use crate::{Error, Reason};
use paracosm_oracles::Semantics;
use serde::Deserialize;
use std::path::Path;
use thiserror::Error;
use toml::Spanned;

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    requirement: Vec<Entry>,
    odd: Option<Written>,
}

/// A requirement in the form of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    id: Spanned<String>,
    text: Option<String>,
    source: Option<String>,
    severity: Option<String>,
    formula: Option<Spanned<String>>,
    unit: Option<String>,
    scale: Option<Spanned<f64>>,
    time: Option<Semantics>,
}

/// The error in a requirement of a requirements file.
#[derive(Debug, Error)]
pub enum RequirementFlaw {
    /// Two requirements have the same id.
    #[error("requirement `{id}` stands twice in the file")]
    Twice {
        /// The id that two requirements share.
        id: String,
    },
    /// The id of a requirement is not a valid name.
    #[error("`id` is `{id}`, expected a word of letters, digits and - _ . : /")]
    Id {
        /// The id that is not a valid name.
        id: String,
    },
    /// The file states a formula, unit, scale or time for a requirement of the scenario.
    #[error("requirement `{id}` is the scenario's own, which has {claim}: remove these keys, or take another id")]
    OfScenario {
        /// The id of the scenario's requirement.
        id: String,
        /// The properties that the scenario already states, in words.
        claim: &'static str,
    },
    /// The formula of a requirement cannot judge any trace.
    #[error("requirement `{id}`: {flaw}")]
    Formula {
        /// The id of the requirement with the formula.
        id: String,
        /// The reason why the formula cannot judge any trace.
        flaw: Box<FormulaFlaw>,
    },
    /// The scale of a requirement is not a positive number.
    #[error("requirement `{id}`: `scale` is {found}, expected a number above 0")]
    Scale {
        /// The id of the requirement with the invalid scale.
        id: String,
        /// The invalid scale.
        found: f64,
    },
}

impl Reason for RequirementFlaw {}

impl Study {
    /// Judges every trace by the requirements of a file, and keeps the design domain that the file states. If an id is
    /// that of a requirement of the study, the file gives that requirement a text, a source and a severity. Any other
    /// id needs a formula; without a formula nothing judges the requirement, unless the system under test does.
    pub(super) fn require(&mut self, path: &Path) -> Result<(), Error> {
        let source = TomlFile::read(path)?;
        let file: File = source.parse(&KEYS)?;
        let mut ids: Vec<String> = Vec::new();
        for entry in file.requirement {
            let (offset, id) = (entry.id.span().start, entry.id.get_ref().clone());
            if !is_id(&id) {
                return Err(source.at(offset, RequirementFlaw::Id { id }));
            }
            if ids.contains(&id) {
                return Err(source.at(offset, RequirementFlaw::Twice { id }));
            }
            match self.requirements.iter_mut().find(|requirement| requirement.id == id) {
                Some(requirement) => {
                    let claim = if entry.formula.is_some() {
                        Some("a formula")
                    } else if entry.unit.is_some() || entry.scale.is_some() || entry.time.is_some() {
                        Some("a unit, a scale and a time")
                    } else {
                        None
                    };
                    if let Some(claim) = claim {
                        return Err(source.at(offset, RequirementFlaw::OfScenario { id, claim }));
                    }
                    requirement.text = entry.text.unwrap_or_else(|| requirement.text.clone());
                    (requirement.source, requirement.severity) = (entry.source, entry.severity);
                }
                None => {
                    entry.formula.iter().for_each(|formula| self.record_for(formula.get_ref()));
                    let stated = self.stated(entry).map_err(|(offset, flaw)| source.at(offset, flaw))?;
                    self.requirements.push(stated);
                }
            }
            ids.push(id);
        }
        match file.odd {
            Some(odd) => self.keep_odd(odd, &source),
            None => Ok(()),
        }
    }

    /// Returns a new requirement of the file; or the error in it, with its place.
    fn stated(&self, entry: Entry) -> Result<StatedRequirement, (usize, RequirementFlaw)> {
        let id = entry.id.into_inner();
        let time = entry.time.unwrap_or_default();
        let parse = |formula: &Spanned<String>| {
            let checked = self.checked(formula.get_ref(), time);
            checked
                .map_err(|flaw| (formula.span().start, RequirementFlaw::Formula { id: id.clone(), flaw: flaw.into() }))
        };
        let formula = entry.formula.as_ref().map(parse).transpose()?;
        let is_scale = |scale: &f64| *scale > 0.0 && scale.is_finite();
        if let Some(scale) = entry.scale.as_ref().filter(|scale| !is_scale(scale.get_ref())) {
            return Err((scale.span().start, RequirementFlaw::Scale { id, found: *scale.get_ref() }));
        }
        let words = || formula.as_ref().map(ToString::to_string).unwrap_or_default();
        Ok(StatedRequirement {
            text: entry.text.unwrap_or_else(words),
            id,
            formula,
            unit: entry.unit.unwrap_or_default(),
            scale: entry.scale.map(Spanned::into_inner),
            source: entry.source,
            severity: entry.severity,
            time,
            given: true,
        })
    }
}

/// The keys of the file: those of its root, and those of the tables below it.
const KEYS: [(&str, &[&str]); 3] = [
    ("", &["requirement", "odd"]),
    ("requirement", &["id", "text", "source", "severity", "formula", "unit", "scale", "time"]),
    ("odd.*", &["varied", "fixed", "excluded"]),
];

/// Returns `true` if a text can be an id. Ids are names of columns and metrics, and words in commands.
fn is_id(id: &str) -> bool {
    let fine = |c: char| c.is_alphanumeric() || "-_.:/".contains(c);
    !id.is_empty() && id.chars().all(fine)
}
