//! A mutant: a defect that conditions turn on.

use crate::{Condition, Defect};
use paracosm_space::{Space, SpaceError, Values};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A defect that is in the driver in the tests that meet all conditions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mutant {
    /// The defect.
    pub defect: Defect,
    /// The conditions, which all have to hold. Without conditions the defect is always in the driver.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub when: Vec<Condition>,
}

impl Mutant {
    /// Returns `true` if the defect is in the driver in the test with the given values.
    pub fn is_active(&self, values: &Values) -> bool {
        self.when.iter().all(|condition| condition.holds(values))
    }

    /// Checks that the conditions name parameters of a space.
    ///
    /// # Errors
    /// The space does not have a parameter. The error suggests the nearest name.
    pub fn check(&self, space: &Space) -> Result<(), SpaceError> {
        self.when.iter().try_for_each(|condition| space.parameter(condition.parameter()).map(|_| ()))
    }
}

impl fmt::Display for Mutant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.defect)?;
        for (index, condition) in self.when.iter().enumerate() {
            write!(f, " {} {condition}", if index == 0 { "when" } else { "and" })?;
        }
        Ok(())
    }
}
