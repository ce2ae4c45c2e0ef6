//! Conditions on the values of a test.

use paracosm_space::{Value, Values};
use serde::{Deserialize, Serialize};
use std::fmt;
use thiserror::Error;

/// A condition on the value of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Entry", into = "Entry")]
pub enum Condition {
    /// The value is a number from `lo` to `hi`; both ends count.
    Within {
        /// The name of the parameter.
        parameter: String,
        /// The least value.
        lo: f64,
        /// The greatest value.
        hi: f64,
    },
    /// The value is a number between `lo` and `hi`; the ends do not count.
    Between {
        /// The name of the parameter.
        parameter: String,
        /// The number below all values.
        lo: f64,
        /// The number above all values.
        hi: f64,
    },
    /// The value is the given value, in whatever notation.
    Is {
        /// The name of the parameter.
        parameter: String,
        /// The value.
        value: Value,
    },
}

/// An error in a condition.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ConditionError {
    /// A condition has none of its three forms, or more than one.
    #[error("the condition on `{parameter}` has {found} of `within`, `between` and `is`, expected one")]
    Forms {
        /// The name of the parameter.
        parameter: String,
        /// The number of forms that were found.
        found: usize,
    },
    /// No number is in the interval, or an end of the interval is not finite.
    #[error(
        "the condition on `{parameter}` has the interval [{lo}, {hi}], expected two numbers, the first below the second"
    )]
    Interval {
        /// The name of the parameter.
        parameter: String,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
    /// The value is a list, but conditions are about parameters that are constant in a test.
    #[error("the condition on `{parameter}` has the list {value}, expected a number or a word")]
    List {
        /// The name of the parameter.
        parameter: String,
        /// The list that was found.
        value: Value,
    },
}

impl Condition {
    /// Returns the name of the parameter.
    pub fn parameter(&self) -> &str {
        match self {
            Self::Within { parameter, .. } | Self::Between { parameter, .. } | Self::Is { parameter, .. } => parameter,
        }
    }

    /// Returns `true` if the condition holds for a test. It does not hold if the test does not have the parameter, or has
    /// a word where the condition needs a number.
    pub fn holds(&self, values: &Values) -> bool {
        let Some(found) = values.get(self.parameter()) else { return false };
        match self {
            Self::Within { lo, hi, .. } => found.number().is_some_and(|number| (*lo..=*hi).contains(&number)),
            Self::Between { lo, hi, .. } => found.number().is_some_and(|number| *lo < number && number < *hi),
            Self::Is { value, .. } => value.means(found),
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within { parameter, lo, hi } => write!(f, "{parameter} is {lo} to {hi}"),
            Self::Between { parameter, lo, hi } => write!(f, "{parameter} is between {lo} and {hi}"),
            Self::Is { parameter, value } => write!(f, "{parameter} is {value}"),
        }
    }
}

/// A condition as it is written in a file. It is not checked yet.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    parameter: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    within: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    between: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    is: Option<Value>,
}

impl TryFrom<Entry> for Condition {
    type Error = ConditionError;

    fn try_from(entry: Entry) -> Result<Self, ConditionError> {
        let Entry { parameter, within, between, is } = entry;
        let found = usize::from(within.is_some()) + usize::from(between.is_some()) + usize::from(is.is_some());
        match (within, between, is) {
            (Some([lo, hi]), None, None) if lo <= hi => Ok(Self::Within { parameter, lo, hi }),
            (None, Some([lo, hi]), None) if lo < hi => Ok(Self::Between { parameter, lo, hi }),
            (Some([lo, hi]), None, None) | (None, Some([lo, hi]), None) => {
                Err(ConditionError::Interval { parameter, lo, hi })
            }
            (None, None, Some(value @ Value::List(_))) => Err(ConditionError::List { parameter, value }),
            (None, None, Some(value)) => Ok(Self::Is { parameter, value }),
            _ => Err(ConditionError::Forms { parameter, found }),
        }
    }
}

impl From<Condition> for Entry {
    fn from(condition: Condition) -> Self {
        let (mut within, mut between, mut is) = (None, None, None);
        let parameter = match condition {
            Condition::Within { parameter, lo, hi } => {
                within = Some([lo, hi]);
                parameter
            }
            Condition::Between { parameter, lo, hi } => {
                between = Some([lo, hi]);
                parameter
            }
            Condition::Is { parameter, value } => {
                is = Some(value);
                parameter
            }
        };
        Self { parameter, within, between, is }
    }
}
