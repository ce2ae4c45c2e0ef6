//! Values of parameters: numbers, words, and the lists of them that make signals.

use crate::Record;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A number, a word, or a list of them.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number; whole ones are written without a point.
    Number(f64),
    /// A level that is a number and is written otherwise than [`Value::Number`] would be, as `1.10` or `007`: its text.
    /// It is another value than the number, which [`Value::means`] it all the same.
    Written(Box<str>),
    /// A word.
    Word(String),
    /// The values of a signal's coordinates.
    List(Box<[Value]>),
}

impl Value {
    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(number) => Some(*number),
            Value::Written(text) => text.parse().ok(),
            Value::Word(_) | Value::List(_) => None,
        }
    }

    /// The word, if it is one.
    pub fn word(&self) -> Option<&str> {
        match self {
            Value::Word(word) => Some(word),
            Value::Number(_) | Value::Written(..) | Value::List(_) => None,
        }
    }

    /// The value as a list: its own elements, or itself alone.
    pub fn scalars(&self) -> &[Value] {
        match self {
            Value::List(values) => values,
            value => std::slice::from_ref(value),
        }
    }

    /// Reads a finite number where the text is one, a word otherwise.
    pub fn parse(text: &str) -> Self {
        let text = text.trim();
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.map_or_else(|| Value::Word(text.to_owned()), Value::Number)
    }

    /// Reads a value as [`Value::parse`] does, and keeps how a number is written:
    ///
    /// ```
    /// use paracosm_space::Value;
    /// assert_eq!(Value::written("1.5"), Value::Number(1.5));
    /// assert_eq!(Value::written("1.50").to_string(), "1.50");
    /// assert!(Value::written("1.50").means(&Value::Number(1.5)));
    /// ```
    pub fn written(text: &str) -> Self {
        let text = text.trim();
        match Self::parse(text) {
            Value::Number(number) if number.to_string() != text => Value::Written(text.into()),
            value => value,
        }
    }

    /// Whether both are the same number, however they are written, or else the same value.
    pub fn means(&self, other: &Value) -> bool {
        match (self.number(), other.number()) {
            (Some(number), Some(other)) => number == other,
            _ => self == other,
        }
    }

    /// The number as an integer, where nothing is lost by that.
    fn whole(number: f64) -> Option<i64> {
        // Beyond 2^53 neighbouring integers share a float; -0 would lose its sign.
        let whole = number.trunc() == number && number.abs() < 9e15 && !(number == 0.0 && number.is_sign_negative());
        whole.then_some(number as i64)
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(number) => write!(f, "{number}"),
            Value::Written(text) => f.write_str(text),
            Value::Word(word) => f.write_str(word),
            Value::List(values) => {
                f.write_str("[")?;
                for (i, value) in values.iter().enumerate() {
                    write!(f, "{}{value}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str("]")
            }
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Number(number)
    }
}

impl From<i32> for Value {
    fn from(number: i32) -> Self {
        Value::Number(number.into())
    }
}

impl From<&str> for Value {
    fn from(word: &str) -> Self {
        Value::Word(word.to_owned())
    }
}

/// A list.
impl<T: Into<Value>, const N: usize> From<[T; N]> for Value {
    fn from(values: [T; N]) -> Self {
        values.into_iter().collect()
    }
}

/// A list.
impl<T: Into<Value>> FromIterator<T> for Value {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Value::List(values.into_iter().map(Into::into).collect())
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Value::Number(number) => match Value::whole(*number) {
                Some(integer) => serializer.serialize_i64(integer),
                None => serializer.serialize_f64(*number),
            },
            // How a level is written is said by the space; elsewhere it is the number that is used.
            Value::Written(text) => match self.number() {
                Some(number) => Value::Number(number).serialize(serializer),
                None => serializer.serialize_str(text),
            },
            Value::Word(word) => serializer.serialize_str(word),
            Value::List(values) => values.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AnyValue;
        impl<'de> Visitor<'de> for AnyValue {
            type Value = Value;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, a word or a list of them")
            }

            fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
                Ok(Value::Number(number as f64))
            }

            fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
                Ok(Value::Number(number as f64))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
                Ok(Value::Number(number))
            }

            fn visit_str<E>(self, word: &str) -> Result<Value, E> {
                Ok(Value::Word(word.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    if matches!(value, Value::List(_)) {
                        return Err(A::Error::custom("found a list within a list, expected numbers and words"));
                    }
                    values.push(value);
                }
                Ok(values.into_iter().collect())
            }
        }
        deserializer.deserialize_any(AnyValue)
    }
}

/// The values of a test by parameter name.
pub type Values = Record<Value>;
