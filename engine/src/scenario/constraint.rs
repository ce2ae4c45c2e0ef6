//! Constraints between the parameters of a program, which every test has to keep.

use paracosm_space::Values;
use std::fmt;
use std::sync::Arc;

/// A function that returns the reason why the values of a test break a constraint.
type Broken = dyn Fn(&Values) -> Option<String> + Send + Sync;

/// A constraint between parameters of a program. A test that breaks it is invalid, and strategies do not propose the test.
#[derive(Clone)]
pub struct Constraint {
    names: Vec<String>,
    broken: Arc<Broken>,
}

impl fmt::Debug for Constraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Constraint").field(&self.names).finish()
    }
}

impl Constraint {
    /// Makes a constraint between the parameters with the given names. The function gets the values of all parameters. It
    /// returns `None` for values that keep the constraint, and otherwise the reason why they break it.
    pub fn new(names: Vec<String>, broken: impl Fn(&Values) -> Option<String> + Send + Sync + 'static) -> Self {
        Self { names, broken: Arc::new(broken) }
    }

    /// Returns the names of the parameters on which the constraint depends.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the reason why the values of a test break the constraint; `None` if they keep it.
    pub fn broken(&self, test: &Values) -> Option<String> {
        (self.broken)(test)
    }
}
