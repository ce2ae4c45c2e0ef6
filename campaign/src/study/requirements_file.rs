//! `requirements.toml`: requirements as a test engineer keeps them, with the source that they come from and how severe
//! a violation is. It may say what of the operational design domain the tests are about, too.

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

/// A requirement as it is written there.
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

/// What is wrong with a requirement of a file.
#[derive(Debug, Error)]
pub enum RequirementFlaw {
    /// Two requirements have one id.
    #[error("requirement `{id}` stands twice in the file")]
    Twice {
        /// The id.
        id: String,
    },
    /// The id is no name.
    #[error("`id` is `{id}`, expected a word of letters, digits and - _ . : /")]
    Id {
        /// The id.
        id: String,
    },
    /// The scenario says that itself.
    #[error("requirement `{id}` is the scenario's, which has {claim} for it: leave it out, or take another id")]
    OfScenario {
        /// The id.
        id: String,
        /// What the scenario says.
        claim: &'static str,
    },
    /// No trace can be asked its formula.
    #[error("requirement `{id}`: {flaw}")]
    Formula {
        /// The id.
        id: String,
        /// What is wrong.
        flaw: Box<FormulaFlaw>,
    },
    /// Its scale is none.
    #[error("requirement `{id}`: `scale` is {found}, expected a number above 0")]
    Scale {
        /// The id.
        id: String,
        /// The scale.
        found: f64,
    },
}

impl Reason for RequirementFlaw {}

impl Study {
    /// Asks what a file says of every trace, and keeps what it says of the design domain. An id that is the study's own gives
    /// that requirement a text, a source and a severity; another one needs a formula, without which nothing judges it unless
    /// the system under test does.
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

    /// A requirement that is none of the study's own yet; or what is wrong with it, and where.
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

/// The keys of the file: of its root, and of the tables below.
const KEYS: [(&str, &[&str]); 3] = [
    ("", &["requirement", "odd"]),
    ("requirement", &["id", "text", "source", "severity", "formula", "unit", "scale", "time"]),
    ("odd.*", &["varied", "fixed", "excluded"]),
];

/// Whether a text is an id: ids are names of columns and metrics, and words of commands.
fn is_id(id: &str) -> bool {
    let fine = |c: char| c.is_alphanumeric() || "-_.:/".contains(c);
    !id.is_empty() && id.chars().all(fine)
}
