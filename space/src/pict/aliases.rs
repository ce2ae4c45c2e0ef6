//! Other names of values, which tests of PICT may contain.

use super::parameters::{Declared, folded};
use std::collections::HashMap;

/// The aliases in a model: in the line `A: x | y, z` the value `x` also has the name `y`. PICT writes each name of a
/// value in turn. So a test of PICT may contain an alias instead of the value.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Aliases(HashMap<(usize, String), usize>);

impl Aliases {
    pub(super) fn of(declared: &[Declared]) -> Self {
        let mut levels = HashMap::new();
        for (position, parameter) in declared.iter().enumerate() {
            for (level, listed) in parameter.values.iter().enumerate() {
                for alias in &listed.aliases {
                    levels.entry((position, folded(alias))).or_insert(level);
                }
            }
        }
        Self(levels)
    }

    /// Returns the level of a discrete parameter that has the alias, ignoring case. The parameter is given by its
    /// position among the discrete parameters.
    pub fn level(&self, parameter: usize, alias: &str) -> Option<usize> {
        if self.0.is_empty() {
            return None;
        }
        self.0.get(&(parameter, folded(alias.trim()))).copied()
    }
}
