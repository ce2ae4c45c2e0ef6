//! Values of parameters: numbers, words, and the lists of numbers or words that make signals.

use crate::Record;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A value of a parameter, which is a number, a word, or a list of numbers and words.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A value that is a number, such as `0.5`. A whole number is written without a decimal point.
    Number(f64),
    /// A number in a notation that [`Value::Number`] would not keep, such as `1.10` or `007`, stored as text. Only
    /// levels are such values. The value is not equal to the number, but [`Value::means`] treats both as the same.
    Written(Box<str>),
    /// A value that is a word, such as `fog`.
    Word(String),
    /// A list of the values of a signal, one for each coordinate.
    List(Box<[Value]>),
}

impl Value {
    /// Returns the value as a number, or `None` if the value is a word or a list.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(number) => Some(*number),
            Value::Written(text) => text.parse().ok(),
            Value::Word(_) | Value::List(_) => None,
        }
    }

    /// Returns the value as a word, or `None` if the value is a number or a list.
    pub fn word(&self) -> Option<&str> {
        match self {
            Value::Word(word) => Some(word),
            Value::Number(_) | Value::Written(..) | Value::List(_) => None,
        }
    }

    /// Returns the elements of a list, or the value itself as the only element.
    pub fn scalars(&self) -> &[Value] {
        match self {
            Value::List(values) => values,
            value => std::slice::from_ref(value),
        }
    }

    /// Reads a text as a finite number if possible, and otherwise as a word.
    pub fn parse(text: &str) -> Self {
        let text = text.trim();
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.map_or_else(|| Value::Word(text.to_owned()), Value::Number)
    }

    /// Reads a text as [`Value::parse`] does, but keeps the notation of a number, such as `1.50`.
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

    /// Returns `true` if both values are equal, or are the same number in different notations.
    pub fn means(&self, other: &Value) -> bool {
        match (self.number(), other.number()) {
            (Some(number), Some(other)) => number == other,
            _ => self == other,
        }
    }

    /// Returns a key that two values share exactly if they mean the same; a list has the key of its text.
    pub(crate) fn meaning(&self) -> Meaning<'_> {
        match (self.number(), self) {
            // Both zeros are the same number.
            (Some(number), _) => Meaning::Number((number + 0.0).to_bits()),
            (None, Value::Word(word)) => Meaning::Word(word),
            (None, value) => Meaning::List(value.to_string()),
        }
    }

    /// Returns the number as an integer, or `None` if the integer would not be exactly the same number.
    pub(crate) fn whole(number: f64) -> Option<i64> {
        // Beyond 2^53 neighbouring integers share a float; -0 would lose its sign.
        let whole = number.trunc() == number && number.abs() < 9e15 && !(number == 0.0 && number.is_sign_negative());
        whole.then_some(number as i64)
    }
}

/// A key of a value for sets: values with the same key mean the same.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Meaning<'v> {
    Number(u64),
    Word(&'v str),
    List(String),
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

/// Makes a list.
impl<T: Into<Value>, const N: usize> From<[T; N]> for Value {
    fn from(values: [T; N]) -> Self {
        values.into_iter().collect()
    }
}

/// Makes a list.
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
            // The space says how a level is written. Everywhere else only the number is used.
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
                f.write_str("a number, a word, or a list of numbers and words")
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

/// The values of a test, by the names of the parameters.
pub type Values = Record<Value>;
