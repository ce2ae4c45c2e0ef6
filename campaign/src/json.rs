//! JSON helpers: write infinities, which JSON does not have, as "inf" and "-inf", and find the first difference of two
//! files.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number in a log, which may be infinite or missing. JSON has infinities as words, and NaN or a missing number as
/// null.
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

/// Returns the first key at which two JSON objects have different values; `None` if the objects are equal.
pub fn differing_key<'v>(there: &'v serde_json::Value, here: &'v serde_json::Value) -> Option<&'v str> {
    let keys = there.as_object().into_iter().chain(here.as_object()).flatten().map(|(key, _)| key.as_str());
    keys.into_iter().find(|key| there.get(key) != here.get(key))
}
