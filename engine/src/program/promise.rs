//! The requirements, the premise and the tick have to be the same in every test. Otherwise, a test that omits a requirement would pass.

use super::{Declaration, ProgramError};
use crate::scenario::Scenario;

/// The requirements, the premise and the tick that a program has declared.
#[derive(Debug)]
pub struct Promise {
    requirements: Vec<String>,
    has_premise: bool,
    dt: f64,
}

impl Promise {
    /// Returns the promise of a declaration.
    pub fn of(declaration: &Declaration) -> Self {
        Self {
            requirements: declaration.requirements.iter().map(|one| one.id.clone()).collect(),
            has_premise: declaration.premise.is_some(),
            dt: declaration.dt,
        }
    }

    /// Checks that the world of a test keeps the promise of a program.
    ///
    /// # Errors
    /// The world has other requirements or another tick, or only one of the two has a premise.
    pub fn check(&self, program: &str, scenario: &Scenario) -> Result<(), ProgramError> {
        let program = || program.to_owned();
        let stated = scenario.requirements.borrow();
        let stated = || stated.iter().map(|stated| stated.requirement.id.as_str());
        let missing = self.requirements.iter().map(String::as_str).filter(|id| !stated().any(|own| own == *id));
        let new = stated().filter(|id| !self.requirements.iter().any(|own| own == id));
        let names: Vec<String> = missing.chain(new).map(str::to_owned).collect();
        if !names.is_empty() {
            return Err(ProgramError::OtherRequirements { program: program(), names });
        }
        let same = |found: String, expected: String| match found == expected {
            true => Ok(()),
            false => Err(ProgramError::Other { program: program(), found, expected }),
        };
        let premise = |is_there| if is_there { "a premise" } else { "no premise" }.to_owned();
        let tick = |dt: f64| format!("a tick of {dt} s");
        same(premise(scenario.premise.is_some()), premise(self.has_premise))?;
        same(tick(scenario.dt), tick(self.dt))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AutonomousVehicle, Monitor, Program, RoadSegment, Stream};
    use paracosm_space::{Value, Values};

    /// A scenario that states another requirement, sets another tick, or has a premise, as its parameter says.
    fn wavering(s: &mut Scenario) {
        let kind = s.interval("kind", 0.0..=3.0).default(0.0).value();
        let road = s.place(RoadSegment::new(300.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
        if kind != 1.0 {
            s.monitor(Monitor::no_collision(&car));
        }
        if kind == 2.0 {
            s.tick(0.02);
        }
        if kind == 3.0 {
            s.premise(&Stream::time().above(1.0));
        }
    }

    #[test]
    fn a_test_keeps_the_requirements_the_premise_and_the_tick_of_the_declaration() {
        let program = Program::new("wavering", "changes its mind", wavering);
        let program = program.keeping(&program.declare().unwrap());
        let check = |kind| {
            let test: Values = [("kind".to_owned(), Value::Number(kind))].into_iter().collect();
            program.check(&test).map_err(|error| error.to_string())
        };
        assert_eq!(check(0.0), Ok(()));
        for (kind, why) in [(1.0, "on one side only: no-collision"), (2.0, "a tick of 0.02 s"), (3.0, "a premise")] {
            assert!(check(kind).is_err_and(|error| error.contains(why)), "{kind}");
        }
    }
}
