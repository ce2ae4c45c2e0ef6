//! A test as a program sees it: the values of its parameters, and the shapes of those that vary.

use crate::chance::{hashed, mixed};
use paracosm_space::{Domain, Parameter, ParameterError, ParameterFlaw, Shape, Space, Value, Values};

/// A parameter that a program asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Declared {
    /// The parameter with its name, domain, unit and nominal value.
    pub parameter: Parameter,
    /// True if the parameter is open by default; a study may change this default.
    pub open: bool,
    /// The domain that tests vary the parameter over if a study opens it and names no range; `None` for the domain of
    /// the parameter.
    pub opens: Option<Domain>,
    /// The least and the greatest value that occur in the world, as far as the program says; tests with other values can be run, but
    /// do not count as plausible.
    pub plausible: Option<[f64; 2]>,
    /// True if the parameter takes any text, such as the path of a file. Its domain then lists the texts that the program
    /// knows.
    pub takes_texts: bool,
    /// True if the parameter takes only the whole numbers of its domain. A study that opens the parameter over an interval opens
    /// the list of the whole numbers in the interval.
    pub whole: bool,
}

impl Declared {
    /// Makes an open parameter, which a study varies over its whole domain.
    pub fn open(parameter: Parameter) -> Self {
        Self { parameter, open: true, opens: None, plausible: None, takes_texts: false, whole: false }
    }

    /// Returns a value as the parameter has it: a number is a text if the parameter takes texts, or if this text is one of its
    /// levels.
    pub fn taken(&self, value: Value) -> Value {
        let text = || Value::from(value.to_string().as_str());
        let is_level = || self.parameter.levels().is_some_and(|levels| levels.contains(&text()));
        if value.number().is_some() && (self.takes_texts || is_level()) { text() } else { value }
    }

    /// Checks that the parameter can take a value.
    ///
    /// # Errors
    /// The parameter does not take the value. The error says which values it takes.
    pub fn check(&self, value: &Value) -> Result<(), ParameterError> {
        if self.takes_texts && !matches!(value, Value::List(_)) {
            return Ok(());
        }
        self.parameter.check(value)?;
        let broken = value.scalars().iter().find(|value| value.number().is_some_and(|number| number.fract() != 0.0));
        match broken.filter(|_| self.whole) {
            Some(value) => {
                let (name, value) = (self.parameter.name.clone(), value.clone());
                Err(ParameterError { name, flaw: ParameterFlaw::NotWhole { value } })
            }
            None => Ok(()),
        }
    }

    /// Returns the parameter as a study has it that opens it and names no range. A nominal value outside of the domain
    /// is left out.
    pub fn opened(&self) -> Parameter {
        let mut parameter = self.parameter.clone();
        if let Some(domain) = &self.opens {
            parameter.domain = domain.clone();
            parameter.default = parameter.default.take().filter(|value| parameter.check(value).is_ok());
        }
        parameter
    }

    /// Returns the least and the greatest value that occur in the world; without any, those of the interval that tests vary the parameter
    /// over if a study opens it and names no range.
    pub fn plausible(&self) -> Option<[f64; 2]> {
        self.plausible.or(match self.opens {
            Some(Domain::Interval { lo, hi }) => Some([lo, hi]),
            _ => None,
        })
    }

    /// Returns the nominal value of the parameter; by default the middle of an interval or the first level of a choice.
    pub fn nominal(&self) -> Value {
        self.parameter.default.clone().unwrap_or_else(|| match &self.parameter.domain {
            Domain::Interval { lo, hi } => Value::Number(0.5 * (lo + hi)),
            // An empty choice is refused as soon as the program has returned.
            Domain::Choice(levels) => levels.first().cloned().unwrap_or(Value::Number(f64::NAN)),
        })
    }
}

/// The values that a test gives to all parameters of a program, and the shapes of the parameters that vary over time.
///
/// Plain values are a test, too: their parameters vary as the program declares.
#[derive(Debug, Clone, Copy)]
pub struct Test<'a> {
    pub(crate) values: &'a Values,
    space: Option<&'a Space>,
}

impl<'a> Test<'a> {
    /// Makes a test from the values of all parameters and the space that gives the shapes of the parameters.
    pub fn new(values: &'a Values, space: &'a Space) -> Self {
        Self { values, space: Some(space) }
    }

    /// Returns a hash of the values by their names, whatever their order. Two tests hardly ever have the same hash.
    pub(crate) fn key(&self) -> u64 {
        self.values.iter().map(|(name, value)| entry(name, value)).fold(0, u64::wrapping_add)
    }

    /// Returns the shape of a parameter's signal; `None` if the test leaves the shape to the program.
    pub(crate) fn signal(&self, name: &str) -> Option<Option<Shape>> {
        self.space?.find(name).map(|parameter| parameter.signal)
    }
}

impl<'a> From<&'a Values> for Test<'a> {
    fn from(values: &'a Values) -> Self {
        Self { values, space: None }
    }
}

/// Returns the part of a test's key that one value adds.
pub(crate) fn entry(name: &str, value: &Value) -> u64 {
    let scalar = |hash: u64, value: &Value| {
        let bits = value.number().map_or_else(|| hashed(&value.to_string()), f64::to_bits);
        mixed(hash ^ bits)
    };
    value.scalars().iter().fold(hashed(name), scalar)
}
