//! A test as a program sees it: the values of its parameters, and how those vary that do.

use crate::chance::{hashed, mixed};
use paracosm_space::{Domain, Parameter, Shape, Space, Value, Values};

/// A parameter that a program asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Declared {
    /// Name, domain, unit and nominal value.
    pub parameter: Parameter,
    /// Whether a test varies it where a study says nothing else.
    pub open: bool,
}

impl Declared {
    /// Its nominal value; the middle of an interval or the first level of a choice where none is declared.
    pub fn nominal(&self) -> Value {
        self.parameter.default.clone().unwrap_or_else(|| match &self.parameter.domain {
            Domain::Interval { lo, hi } => Value::Number(0.5 * (lo + hi)),
            // A choice of nothing is refused as soon as the program has returned.
            Domain::Choice(levels) => levels.first().cloned().unwrap_or(Value::Number(f64::NAN)),
        })
    }
}

/// The values that a test gives to all parameters of a program, and how those vary that do.
///
/// Mere values are a test too: their parameters vary as the program declares.
#[derive(Debug, Clone, Copy)]
pub struct Test<'a> {
    pub(crate) values: &'a Values,
    space: Option<&'a Space>,
}

impl<'a> Test<'a> {
    /// These values, of which those of the parameters of `space` vary as it says.
    pub fn new(values: &'a Values, space: &'a Space) -> Self {
        Self { values, space: Some(space) }
    }

    /// A number that another test hardly has: a hash of the values by their names, whatever their order.
    pub(crate) fn key(&self) -> u64 {
        self.values.iter().map(|(name, value)| entry(name, value)).fold(0, u64::wrapping_add)
    }

    /// How a parameter varies, if the test says so.
    pub(crate) fn signal(&self, name: &str) -> Option<Option<Shape>> {
        self.space?.parameter(name).ok().map(|parameter| parameter.signal)
    }
}

impl<'a> From<&'a Values> for Test<'a> {
    fn from(values: &'a Values) -> Self {
        Self { values, space: None }
    }
}

/// What a value adds to the key of its test.
pub(crate) fn entry(name: &str, value: &Value) -> u64 {
    let scalar = |hash: u64, value: &Value| {
        let bits = value.number().map_or_else(|| hashed(&value.to_string()), f64::to_bits);
        mixed(hash ^ bits)
    };
    value.scalars().iter().fold(hashed(name), scalar)
}
