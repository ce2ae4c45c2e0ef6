//! The measurements of a test, as the flat list of named metrics in logs and tables.
//!
//! A simulated run has `travelled` (m) and `triggered`; for a contact, `impact_speed` (of the ego vehicle, m/s; 0
//! without a contact), `contact_face`, `contact_with`, `contact_class`, `contact_motion` and `other_speed` (of the
//! object, m/s). Every violated requirement ID has `critical_time.ID` (s), `critical_travelled.ID` (m),
//! `critical_speed.ID` (m/s) and `critical_part.ID`.

use super::Trial;
use crate::json::Number;
use paracosm_engine::object::Class;
use paracosm_engine::{Contact, ContactMotion, Face, Judgement, Measurements, Violation};
use paracosm_space::Record;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt::{self, Display};

/// A measured number, flag or word that describes a test.
#[derive(Debug, Clone, PartialEq)]
pub enum Metric {
    /// The number of a measured quantity.
    Number(f64),
    /// A flag, for example `true` if the situation that the test is about occurred.
    Flag(bool),
    /// A word from a fixed list; `None` if no word applies.
    Word(Option<String>),
}

impl Metric {
    /// Returns the unit of the metric with the given name; the text is empty if the metric has no unit.
    pub fn unit(name: &str) -> &'static str {
        match name.split('.').next().unwrap_or_default() {
            "travelled" | "critical_travelled" => "m",
            "impact_speed" | "other_speed" | "critical_speed" => "m/s",
            "critical_time" => "s",
            _ => "",
        }
    }
}

impl Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Metric::Number(number) => write!(f, "{number}"),
            Metric::Flag(flag) => write!(f, "{flag}"),
            Metric::Word(word) => f.write_str(word.as_deref().unwrap_or_default()),
        }
    }
}

impl Serialize for Metric {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Metric::Number(number) => Number(Some(*number)).serialize(serializer),
            Metric::Flag(flag) => serializer.serialize_bool(*flag),
            Metric::Word(word) => word.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Metric {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match serde_json::Value::deserialize(deserializer)? {
            serde_json::Value::Null => Metric::Word(None),
            serde_json::Value::Bool(flag) => Metric::Flag(flag),
            serde_json::Value::String(word) => match word.as_str() {
                "inf" => Metric::Number(f64::INFINITY),
                "-inf" => Metric::Number(f64::NEG_INFINITY),
                _ => Metric::Word(Some(word)),
            },
            serde_json::Value::Number(number) => Metric::Number(number.as_f64().unwrap_or(f64::NAN)),
            other => return Err(D::Error::custom(format!("found {other}, expected a number, true, false or a word"))),
        })
    }
}

/// Returns all metrics of a trial, in the order of the log.
pub(super) fn flat(trial: &Trial) -> Vec<(String, Metric)> {
    let mut metrics = Vec::new();
    if let Some(measured) = &trial.measured {
        metrics.extend(of_run(measured).map(|(name, metric)| (name.to_owned(), metric)));
    }
    metrics.extend(trial.others.iter().map(|(name, metric)| (name.to_owned(), metric.clone())));
    for Judgement { requirement, violation, .. } in &trial.judgements {
        let Some(violation) = violation else { continue };
        let of = |(name, metric): (&str, Metric)| (format!("{name}.{requirement}"), metric);
        metrics.extend(of_violation(violation).into_iter().map(of));
    }
    metrics
}

fn of_run(Measurements { travelled, contact, triggered }: &Measurements) -> [(&'static str, Metric); 8] {
    let contact = contact.as_ref();
    let number = |of: fn(&Contact) -> f64| Metric::Number(contact.map_or(0.0, of));
    let word = |of: fn(&Contact) -> &dyn Display| Metric::Word(contact.map(|contact| of(contact).to_string()));
    [
        ("travelled", Metric::Number(*travelled)),
        ("impact_speed", number(|contact| contact.speed)),
        ("contact_face", word(|contact| &contact.face)),
        ("contact_with", word(|contact| &contact.with)),
        ("contact_class", word(|contact| &contact.class)),
        ("contact_motion", word(|contact| &contact.motion)),
        ("other_speed", number(|contact| contact.other_speed)),
        ("triggered", Metric::Flag(*triggered)),
    ]
}

fn of_violation(Violation { time, travelled, speed, part }: &Violation) -> Vec<(&'static str, Metric)> {
    let numbers = [("critical_time", Some(*time)), ("critical_travelled", *travelled), ("critical_speed", *speed)];
    let numbers = numbers.into_iter().filter_map(|(name, number)| Some((name, Metric::Number(number?))));
    numbers.chain([("critical_part", Metric::Word(Some(part.clone())))]).collect()
}

/// Reads a list of metrics. Returns the measurements of a run, if they are complete, and all other metrics; stores each
/// requirement's violation in `judgements`.
pub(super) fn read(
    metrics: Record<Metric>,
    judgements: &mut [Judgement],
) -> Result<(Option<Measurements>, Record<Metric>), UnknownWord> {
    let number = |name: &str| match metrics.get(name) {
        Some(Metric::Number(number)) => Some(*number),
        _ => None,
    };
    for judgement in judgements {
        let of = |name: &str| format!("{name}.{}", judgement.requirement);
        let part = match metrics.get(&of("critical_part")) {
            Some(Metric::Word(Some(part))) => Some(part.clone()),
            _ => None,
        };
        judgement.violation = number(&of("critical_time")).zip(part).map(|(time, part)| {
            let (travelled, speed) = (number(&of("critical_travelled")), number(&of("critical_speed")));
            Box::new(Violation { time, travelled, speed, part })
        });
    }
    let triggered = match metrics.get("triggered") {
        Some(Metric::Flag(triggered)) => Some(*triggered),
        _ => None,
    };
    let measured = match (number("travelled"), triggered) {
        (Some(travelled), Some(triggered)) => Some(Measurements { travelled, contact: contact(&metrics)?, triggered }),
        _ => None,
    };
    let known =
        |name: &str| measured.is_some() && RUN.contains(&name) || VIOLATION.iter().any(|of| name.starts_with(of));
    let others = metrics.iter().filter(|(name, _)| !known(name));
    Ok((measured.clone(), others.map(|(name, metric)| (name.to_owned(), metric.clone())).collect()))
}

/// The metrics of a run, and the prefixes of the metrics of a violation.
const RUN: [&str; 8] = [
    "travelled",
    "impact_speed",
    "contact_face",
    "contact_with",
    "contact_class",
    "contact_motion",
    "other_speed",
    "triggered",
];
const VIOLATION: [&str; 4] = ["critical_time.", "critical_travelled.", "critical_speed.", "critical_part."];

fn contact(metrics: &Record<Metric>) -> Result<Option<Contact>, UnknownWord> {
    let word = |name: &'static str| match metrics.get(name) {
        Some(Metric::Word(Some(word))) => Some((name, word.as_str())),
        _ => None,
    };
    let number = |name: &str| match metrics.get(name) {
        Some(Metric::Number(number)) => *number,
        _ => f64::NAN,
    };
    let (Some((_, with)), Some(class), Some(face), Some(motion)) =
        (word("contact_with"), word("contact_class"), word("contact_face"), word("contact_motion"))
    else {
        return Ok(None);
    };
    Ok(Some(Contact {
        with: with.to_owned(),
        class: among(&Class::ALL, class)?,
        face: among(&Face::ALL, face)?,
        motion: among(&ContactMotion::ALL, motion)?,
        speed: number("impact_speed"),
        other_speed: number("other_speed"),
    }))
}

/// The error that this version of the software does not know the word of a metric.
#[derive(Debug, thiserror::Error)]
#[error("metric `{metric}` is `{word}`, expected one of {}", expected.join(", "))]
pub struct UnknownWord {
    /// The name of the metric.
    pub metric: &'static str,
    /// The unknown word.
    pub word: String,
    /// The known words.
    pub expected: Vec<String>,
}

/// Returns the value that a word means.
fn among<T: Copy + Display>(all: &[T], (metric, word): (&'static str, &str)) -> Result<T, UnknownWord> {
    all.iter().find(|value| value.to_string() == word).copied().ok_or_else(|| UnknownWord {
        metric,
        word: word.to_owned(),
        expected: all.iter().map(ToString::to_string).collect(),
    })
}
