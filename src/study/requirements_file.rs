//! `requirements.toml`: requirements as a test engineer keeps them, with the source that they come from and how severe
//! a violation is. It may say what of the operational design domain the tests are about, too.

use super::odd::Written;
use super::{RequirementText, Study, Subject};
use crate::Error;
use paracosm_coverage::{did_you_mean, nearest};
use paracosm_oracles::{Formula, Semantics, Trace};
use serde::Deserialize;
use std::fs;
use std::path::Path;
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

/// What may stand in the file and in its tables.
const KEYS: [&str; 13] = [
    "requirement",
    "odd",
    "id",
    "text",
    "source",
    "severity",
    "formula",
    "unit",
    "scale",
    "time",
    "varied",
    "fixed",
    "excluded",
];

impl Study {
    /// Asks what a file says of every trace. An id that is the study's own gives that requirement a text, a source and a
    /// severity; another one needs a formula, without which nothing judges it unless the system under test does. What the
    /// file says of the design domain is kept. To be called when all parameters are opened, fixed and varied.
    ///
    /// # Errors
    /// The file cannot be read or is none, an id stands twice or is none, a formula is none of this study's signals or is
    /// given for a requirement of the scenario's, or the design domain is said to be varied by what is not open. The error
    /// says in which line.
    pub fn require(mut self, path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
        let file: File = toml::from_str(&text).map_err(|error| wrong(path, &text, &error))?;
        let at = |offset: usize, message: String| Error::content(path, line(&text, offset), message);
        let mut ids: Vec<String> = Vec::new();
        for entry in file.requirement {
            let (offset, id) = (entry.id.span().start, entry.id.get_ref().clone());
            check_id(&id).map_err(|message| at(offset, message))?;
            if ids.contains(&id) {
                return Err(at(offset, format!("requirement `{id}` stands twice in the file")));
            }
            let known = self.requirements.iter().position(|requirement| requirement.id == id);
            match known {
                Some(position) => {
                    let claim = if entry.formula.is_some() {
                        Some("a formula")
                    } else if entry.unit.is_some() || entry.scale.is_some() || entry.time.is_some() {
                        Some("a unit, a scale and a time")
                    } else {
                        None
                    };
                    if let Some(claim) = claim {
                        let message = format!("requirement `{id}` is the scenario's, which has {claim} for it");
                        return Err(at(offset, format!("{message}: leave it out, or take another id")));
                    }
                    let requirement = &mut self.requirements[position];
                    requirement.text = entry.text.unwrap_or_else(|| requirement.text.clone());
                    (requirement.source, requirement.severity) = (entry.source, entry.severity);
                }
                None => {
                    let requirement = self.stated(entry).map_err(|(offset, message)| at(offset, message))?;
                    self.requirements.push(requirement);
                }
            }
            ids.push(id);
        }
        match file.odd {
            Some(odd) => self.with_odd(odd, path, &text),
            None => Ok(self),
        }
    }

    /// A requirement that is none of the study's own yet; or what is wrong with it, and where.
    fn stated(&self, entry: Entry) -> Result<RequirementText, (usize, String)> {
        let id = entry.id.into_inner();
        let time = entry.time.unwrap_or_default();
        let formula = match &entry.formula {
            None => String::new(),
            Some(formula) => self
                .checked(formula.get_ref(), time)
                .map_err(|message| (formula.span().start, format!("requirement `{id}`: {message}")))?
                .to_string(),
        };
        if let Some(scale) =
            entry.scale.as_ref().filter(|scale| !(*scale.get_ref() > 0.0 && scale.get_ref().is_finite()))
        {
            let found = scale.get_ref();
            let message = format!("requirement `{id}`: `scale` is {found}, expected a number above 0");
            return Err((scale.span().start, message));
        }
        Ok(RequirementText {
            text: entry.text.unwrap_or_else(|| formula.clone()),
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

    /// A formula that can be asked of this study's traces, as far as these are known.
    pub(super) fn checked(&self, text: &str, time: Semantics) -> Result<Formula, String> {
        let formula: Formula = text.parse().map_err(|error| format!("{error}"))?;
        let signals = self.signals().map_err(|error| error.to_string())?;
        if let (Subject::Scenario(simulation), Some(signals)) = (&self.subject, &signals) {
            let describe = format!("`paracosm-fuzz describe {}` shows its signals", simulation.scenario);
            Formula::parse(text, signals).map_err(|error| format!("{error}; {describe}"))?;
            if time == Semantics::Sampled {
                let nothing = Trace::new(simulation.dt(), signals.clone());
                formula.evaluate(&nothing).map_err(|error| error.to_string())?;
            }
        }
        if time == Semantics::Dense {
            // It has to be one whose comparisons are straight between samples, of whatever signals.
            let names: Vec<String> = formula.signals().into_iter().map(str::to_owned).chain([String::new()]).collect();
            let mut sample = Trace::new(1.0, names.clone());
            sample.record(&vec![0.0; names.len()]);
            formula.evaluate_in(time, &sample).map_err(|error| error.to_string())?;
        }
        Ok(formula)
    }
}

/// What is wrong with the text of a file that has requirements or a design domain.
pub(super) fn wrong(path: &Path, text: &str, error: &toml::de::Error) -> Error {
    let message = error.message();
    let unknown = message.strip_prefix("unknown field `").and_then(|rest| rest.split('`').next());
    let meant = did_you_mean(&unknown.and_then(|word| nearest(word, KEYS)));
    Error::content(path, error.span().map(|span| line(text, span.start)), format!("{message}{meant}"))
}

/// The line, from 1, of a byte of a text.
pub(super) fn line(text: &str, offset: usize) -> usize {
    text[..offset.min(text.len())].matches('\n').count() + 1
}

/// Ids are names of columns and metrics, and words of commands.
fn check_id(id: &str) -> Result<(), String> {
    let fine = |c: char| c.is_alphanumeric() || "-_.:/".contains(c);
    if !id.is_empty() && id.chars().all(fine) {
        return Ok(());
    }
    Err(format!("`id` is `{id}`, expected a word of letters, digits and - _ . : /"))
}
