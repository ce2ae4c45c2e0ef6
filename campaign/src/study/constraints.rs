//! Constraints of a scenario as constraints of the space.

use super::parameters::ParameterMisuse;
use super::{Study, Subject};
use crate::Error;
use paracosm_engine::Constraint;
use paracosm_space::Value;
use paracosm_space::constraint::Specialised;

impl Study {
    /// Adds the constraints of the scenario between open parameters to the space. Fixed parameters are replaced by their values.
    pub(super) fn keep_constraints(&mut self) -> Result<(), Error> {
        let Subject::Scenario(_) = &self.subject else { return Ok(()) };
        let nominal = self.nominal()?;
        let known = |name: &str| match self.space.find(name) {
            Some(_) => None,
            None => nominal.get(name).cloned(),
        };
        let takes = |name: &str, value: &Value| {
            let levels = self.space.find(name).and_then(|parameter| parameter.levels());
            levels.is_none_or(|levels| levels.iter().any(|level| level.means(value)))
        };
        let mut texts = Vec::new();
        for constraint in self.program()?.declare()?.constraints {
            match constraint.expression.specialised(&known, &takes) {
                Specialised::Always => {}
                Specialised::Open(expression) => texts.push(expression.to_string()),
                Specialised::Never => {
                    let Constraint { expression, place } = constraint;
                    let fixed = |name: &str| known(name).map(|value| format!("{name} = {value}"));
                    let values = expression.names().into_iter().filter_map(fixed).collect();
                    return Err(ParameterMisuse::Broken { place, constraint: expression.to_string(), values }.into());
                }
            }
        }
        self.space = self.space.clone().with_constraints(texts)?;
        self.space.rules()?;
        Ok(())
    }
}
