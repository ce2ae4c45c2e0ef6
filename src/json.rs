//! How numbers are written as JSON where serde has no form for them: infinities as "inf" and "-inf".

use paracosm_engine::Metric;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number of a log, or none: infinities are words, NaN is null.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number(pub Option<f64>);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Some(f64::INFINITY) => serializer.serialize_str("inf"),
            Some(f64::NEG_INFINITY) => serializer.serialize_str("-inf"),
            Some(number) if number.is_finite() => serializer.serialize_f64(number),
            _ => serializer.serialize_none(),
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match serde_json::Value::deserialize(deserializer)? {
            serde_json::Value::Null => Ok(Self(None)),
            serde_json::Value::Number(number) => Ok(Self(number.as_f64())),
            serde_json::Value::String(word) if word == "inf" => Ok(Self(Some(f64::INFINITY))),
            serde_json::Value::String(word) if word == "-inf" => Ok(Self(Some(f64::NEG_INFINITY))),
            other => Err(D::Error::custom(format!("found {other}, expected a number, \"inf\", \"-inf\" or null"))),
        }
    }
}

/// A [`Metric`] as JSON: a number, a truth, a word or null.
#[derive(Debug, Clone, PartialEq)]
pub struct MetricValue(pub Metric);

impl Serialize for MetricValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0 {
            Metric::Number(number) => Number(Some(*number)).serialize(serializer),
            Metric::Flag(flag) => serializer.serialize_bool(*flag),
            Metric::Word(word) => word.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for MetricValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let metric = match serde_json::Value::deserialize(deserializer)? {
            serde_json::Value::Null => Metric::Word(None),
            serde_json::Value::Bool(flag) => Metric::Flag(flag),
            serde_json::Value::String(word) => match word.as_str() {
                "inf" => Metric::Number(f64::INFINITY),
                "-inf" => Metric::Number(f64::NEG_INFINITY),
                _ => Metric::Word(Some(word)),
            },
            serde_json::Value::Number(number) => Metric::Number(number.as_f64().unwrap_or(f64::NAN)),
            other => return Err(D::Error::custom(format!("found {other}, expected a number, a truth or a word"))),
        };
        Ok(Self(metric))
    }
}
