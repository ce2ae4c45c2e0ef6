//! A requirement as a study states it: one of the scenario, or one that was given beside these.

use paracosm_oracles::{Formula, Requirement, Semantics};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A requirement as a study states it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StatedRequirement {
    /// The short name.
    pub id: String,
    /// One sentence.
    pub text: String,
    /// The formula that every trace is to satisfy. `None` where it is not known here: the system under test judges itself by
    /// it, or nobody does.
    #[serde(serialize_with = "write_formula", deserialize_with = "read_formula")]
    pub formula: Option<Formula>,
    /// The unit of its robustness.
    pub unit: String,
    /// How much robustness is a lot, in that unit; `None` where nobody said, and a search has to find out.
    pub scale: Option<f64>,
    /// Where it comes from: a regulation, a specification, a hazard.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub source: Option<String>,
    /// How severe a violation is, in a word of whoever states it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub severity: Option<String>,
    /// What is taken to happen between the samples of a trace.
    #[serde(skip_serializing_if = "is_sampled", default)]
    pub time: Semantics,
    /// Whether it is none of the scenario's own, but was given with the study.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub given: bool,
}

/// What is usual is not written down.
fn is_sampled(time: &Semantics) -> bool {
    *time == Semantics::Sampled
}

fn write_formula<S: Serializer>(formula: &Option<Formula>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&formula.as_ref().map(ToString::to_string).unwrap_or_default())
}

fn read_formula<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Formula>, D::Error> {
    let text = String::deserialize(deserializer)?;
    let parse = |text: &str| text.parse().map_err(|error| serde::de::Error::custom(format!("`{text}`: {error}")));
    (!text.is_empty()).then(|| parse(&text)).transpose()
}

impl From<Requirement> for StatedRequirement {
    fn from(requirement: Requirement) -> Self {
        let Requirement { id, text, formula, unit, scale } = requirement;
        let (scale, time) = (Some(scale), Semantics::Sampled);
        Self { id, text, formula: Some(formula), unit, scale, source: None, severity: None, time, given: false }
    }
}
