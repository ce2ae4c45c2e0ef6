//! Constraints that a program states between its parameters.

use paracosm_space::Values;
use paracosm_space::constraint::Expression;

/// A constraint between the parameters of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraint {
    /// The constraint, in the language of [`paracosm_space::constraint`].
    pub expression: Expression,
    /// The file and the line that state the constraint; `None` if the program itself states it.
    pub place: Option<String>,
}

impl From<Expression> for Constraint {
    fn from(expression: Expression) -> Self {
        Self { expression, place: None }
    }
}

impl Constraint {
    /// Returns the reason why a test breaks the constraint; `None` if the test keeps it.
    pub(crate) fn broken(&self, test: &Values) -> Option<String> {
        let Self { expression, place } = self;
        if expression.holds(test) {
            return None;
        }
        let value = |name: &str| test.get(name).map(|value| format!("{name} = {value}"));
        let values: Vec<String> = expression.names().into_iter().filter_map(value).collect();
        let place = place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default();
        Some(format!("{place}the constraint `{expression}` does not hold for {}", values.join(", ")))
    }
}
