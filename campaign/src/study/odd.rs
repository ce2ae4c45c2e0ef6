//! The part of the operational design domain (ODD) that a study's tests are about, as its owner states it. For each
//! attribute it says by which parameters it is varied, what it is fixed at, or what is excluded and why.
//!
//! The owner may give attributes any names. The names in ISO 34503 and BSI PAS 1883 (scenery, environmental
//! conditions, dynamic elements, and their parts) are a good start. The software checks that the named parameters are
//! varied; it does not check texts.

use super::Study;
use super::toml_file::TomlFile;
use crate::{Error, Reason};
use paracosm_space::{Record, Value, did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use thiserror::Error;
use toml::Spanned;

/// The attributes of the operational design domain, by their names.
pub type Odd = Record<Attribute>;

/// An attribute of the operational design domain, with the attribute's treatment in the tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attribute {
    /// The names of the open parameters that vary the attribute.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub varied: Vec<String>,
    /// The constant value of the attribute in all tests.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fixed: Option<String>,
    /// The part of the attribute that no test covers, with the reason.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub excluded: Option<String>,
}

/// The table `[odd]` of a file.
pub(super) type Written = BTreeMap<String, Spanned<WrittenAttribute>>;

/// An attribute in the form of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WrittenAttribute {
    #[serde(default)]
    varied: Vec<Spanned<String>>,
    fixed: Option<String>,
    excluded: Option<String>,
}

/// The error in an attribute of the operational design domain.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OddFlaw {
    /// The attribute has no entry `varied`, `fixed` or `excluded`.
    #[error("attribute `{attribute}`: expected `varied`, `fixed` or `excluded`")]
    Nothing {
        /// The name of the attribute.
        attribute: String,
    },
    /// A parameter that should vary the attribute is fixed.
    #[error(
        "attribute `{attribute}`: `{parameter}` is not varied but {value} in all tests; --open {parameter} lets tests vary it"
    )]
    Fixed {
        /// The name of the attribute.
        attribute: String,
        /// The name of the parameter.
        parameter: String,
        /// The fixed value of the parameter.
        value: Value,
    },
    /// A name in the entry `varied` is not the name of an open parameter.
    #[error(
        "attribute `{attribute}`: the tests vary no `{parameter}`{}; they vary {}", did_you_mean(.nearest), open.join(", ")
    )]
    NotOpen {
        /// The name of the attribute.
        attribute: String,
        /// The name in the entry `varied` that no open parameter has.
        parameter: String,
        /// The most similar name of a parameter; `None` if no name is similar.
        nearest: Option<String>,
        /// The names of the open parameters.
        open: Vec<String>,
    },
    /// Two files state the operational design domain.
    #[error("[odd] stands in another file as well, expected it in one file only")]
    Twice,
}

impl Reason for OddFlaw {}

impl Study {
    /// Keeps the table `[odd]` of a SPACE.toml, if the file has one.
    pub(super) fn odd_of_space(&mut self, path: &Path) -> Result<(), Error> {
        #[derive(Deserialize)]
        struct Beside {
            odd: Option<Written>,
        }
        let source = TomlFile::read(path)?;
        let file: Beside = source.parse(&[("odd.*", &["varied", "fixed", "excluded"])])?;
        match file.odd {
            Some(odd) => self.keep_odd(odd, &source),
            None => Ok(()),
        }
    }

    pub(super) fn keep_odd(&mut self, written: Written, source: &TomlFile<'_>) -> Result<(), Error> {
        let mut odd = Odd::default();
        for (name, attribute) in written {
            let start = attribute.span().start;
            let WrittenAttribute { varied, fixed, excluded } = attribute.into_inner();
            if varied.is_empty() && fixed.is_none() && excluded.is_none() {
                return Err(source.at(start, OddFlaw::Nothing { attribute: name }));
            }
            for parameter in &varied {
                let checked = self.check_varied(&name, parameter.get_ref());
                checked.map_err(|flaw| source.at(parameter.span().start, flaw))?;
            }
            let varied = varied.into_iter().map(Spanned::into_inner).collect();
            odd.set(name, Attribute { varied, fixed, excluded });
        }
        if self.odd.is_some() {
            return Err(Error::in_file(source.path(), None, OddFlaw::Twice));
        }
        self.odd = Some(odd);
        Ok(())
    }

    fn check_varied(&self, attribute: &str, parameter: &str) -> Result<(), OddFlaw> {
        if self.space.find(parameter).is_some() {
            return Ok(());
        }
        let (attribute, name) = (attribute.to_owned(), parameter.to_owned());
        if let Some(value) = self.fixed().get(parameter) {
            return Err(OddFlaw::Fixed { attribute, parameter: name, value: value.clone() });
        }
        let open: Vec<String> = self.space.parameters().iter().map(|parameter| parameter.name.clone()).collect();
        let nearest = nearest(parameter, open.iter().map(String::as_str)).map(str::to_owned);
        Err(OddFlaw::NotOpen { attribute, parameter: name, nearest, open })
    }
}
