//! A requirement in the form in which a study states it: one of the scenario's own, or one that was given in addition.

use paracosm_oracles::{Formula, Requirement, Semantics};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A requirement that every test of a study should satisfy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a requirement")]
pub struct StatedRequirement {
    /// The id of the requirement, which is a short name.
    pub id: String,
    /// The description of the requirement in one sentence.
    pub text: String,
    /// The formula that every trace should satisfy. `None` if the formula is not known here: the system under test
    /// judges itself by it, or nobody does.
    #[serde(serialize_with = "write_formula", deserialize_with = "read_formula")]
    pub formula: Option<Formula>,
    /// The unit of the requirement's robustness.
    pub unit: String,
    /// The scale by which the robustness is divided to compare requirements, in the unit of the robustness. `None` if
    /// no scale was stated, so that a search has to learn the scale.
    pub scale: Option<f64>,
    /// The source of the requirement, for example a regulation, a specification or a hazard.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub source: Option<String>,
    /// The severity of a violation, in a word chosen by the author.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub severity: Option<String>,
    /// The semantics of time in the formula, which is sampled or dense. Sampled time has only the samples; dense time
    /// also has the time between samples.
    #[serde(skip_serializing_if = "is_sampled", default)]
    pub time: Semantics,
    /// True if the user added the requirement; false if the scenario states the requirement.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub given: bool,
}

/// Returns `true` for the default semantics, which is not written to files.
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
