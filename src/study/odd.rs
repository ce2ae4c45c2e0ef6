//! What of the operational design domain (ODD) a study's tests are about, as its owner states it: attribute by attribute
//! what is varied, and by which parameters; what is fixed; what is excluded, and why.
//!
//! Attributes have whatever names their owner gives them; those of ISO 34503 and BSI PAS 1883 (scenery, environmental
//! conditions, dynamic elements, and what is below them) are a good start. That a parameter is varied is checked; what
//! words say is not.

use super::Study;
use super::requirements_file::{line, wrong};
use crate::Error;
use paracosm_coverage::{Record, did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use toml::Spanned;

/// Attributes of the design domain by their names.
pub type Odd = Record<Attribute>;

/// What becomes of an attribute in the tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attribute {
    /// The open parameters by which it is varied.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub varied: Vec<String>,
    /// What it is in all tests.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fixed: Option<String>,
    /// What of it no test is about, and why.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub excluded: Option<String>,
}

/// The table `[odd]` of a file.
pub(super) type Written = BTreeMap<String, Spanned<WrittenAttribute>>;

/// An attribute as it is written there.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WrittenAttribute {
    #[serde(default)]
    varied: Vec<Spanned<String>>,
    fixed: Option<String>,
    excluded: Option<String>,
}

impl Study {
    /// Keeps what the table `[odd]` of a SPACE.toml says, if it has one.
    ///
    /// # Errors
    /// The file cannot be read, or an attribute is said to be varied by what is not open, or nothing is said of it.
    pub fn odd_of(self, path: &Path) -> Result<Self, Error> {
        #[derive(Deserialize)]
        struct Beside {
            odd: Option<Written>,
        }
        let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
        let file: Beside = toml::from_str(&text).map_err(|error| wrong(path, &text, &error))?;
        match file.odd {
            Some(odd) => self.with_odd(odd, path, &text),
            None => Ok(self),
        }
    }

    pub(super) fn with_odd(mut self, written: Written, path: &Path, text: &str) -> Result<Self, Error> {
        let at = |offset: usize, message: String| Error::content(path, line(text, offset), message);
        let mut odd = Odd::default();
        for (name, attribute) in written {
            let start = attribute.span().start;
            let WrittenAttribute { varied, fixed, excluded } = attribute.into_inner();
            if varied.is_empty() && fixed.is_none() && excluded.is_none() {
                let message = format!("attribute `{name}`: expected `varied`, `fixed` or `excluded`");
                return Err(at(start, message));
            }
            for parameter in &varied {
                self.check_varied(parameter.get_ref())
                    .map_err(|message| at(parameter.span().start, format!("attribute `{name}`: {message}")))?;
            }
            let varied = varied.into_iter().map(Spanned::into_inner).collect();
            odd.set(name, Attribute { varied, fixed, excluded });
        }
        if self.odd.is_some() {
            return Err(Error::content(path, None, "[odd] stands in the space as well, expected it once"));
        }
        self.odd = Some(odd);
        Ok(self)
    }

    fn check_varied(&self, name: &str) -> Result<(), String> {
        if self.space.parameter(name).is_ok() {
            return Ok(());
        }
        if let Some(value) = self.subject.fixed().get(name) {
            return Err(format!("`{name}` is not varied but {value} in all tests; --open {name} lets tests vary it"));
        }
        let open: Vec<&str> = self.space.parameters().iter().map(|parameter| parameter.name.as_str()).collect();
        let hint = did_you_mean(&nearest(name, open.iter().copied()));
        Err(format!("the tests vary no `{name}`{hint}; they vary {}", open.join(", ")))
    }
}
