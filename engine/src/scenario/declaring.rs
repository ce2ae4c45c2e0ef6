//! The parameters that a program declares: intervals, choices, texts, and parameters that are described as data.

use super::param::{Param, Read};
use super::{Scenario, reach};
use crate::test::Declared;
use paracosm_space::{Domain, Parameter, Value};
use std::ops::RangeInclusive;

impl Scenario {
    /// Declares an open parameter with values in an interval.
    pub fn interval(&mut self, name: &str, range: RangeInclusive<f64>) -> Param<f64> {
        let (lo, hi) = range.into_inner();
        self.declare(name, Domain::Interval { lo, hi }, None, Read::number())
    }

    /// Declares a closed parameter, which stays at `nominal` until a study opens it within the interval `range`.
    pub fn nominal(&mut self, name: &str, range: RangeInclusive<f64>, nominal: f64) -> Param<f64> {
        let (lo, hi) = range.into_inner();
        self.declare(name, Domain::Interval { lo, hi }, Some(nominal.into()), Read::number())
    }

    /// Declares an open parameter that takes one of the given values. At least one value is given.
    pub fn choice<T: Into<Value> + Clone + 'static, const N: usize>(&mut self, name: &str, levels: [T; N]) -> Param<T> {
        const { assert!(N > 0, "a choice needs at least one value") }
        self.declare(name, Domain::Choice(levels.clone().map(Into::into).into()), None, Read::level(levels))
    }

    /// Declares a closed parameter, which stays at `nominal` until a study opens it to all values in `levels`.
    pub fn nominal_choice<T: Into<Value> + Clone + 'static, const N: usize>(
        &mut self,
        name: &str,
        levels: [T; N],
        nominal: T,
    ) -> Param<T> {
        const { assert!(N > 0, "a choice needs at least one value") }
        let domain = Domain::Choice(levels.clone().map(Into::into).into());
        self.declare(name, domain, Some(nominal.into()), Read::level(levels))
    }

    /// Declares a parameter that was described as data, for example in a file.
    pub fn parameter(&mut self, declared: Declared) -> Param<Value> {
        self.described(declared, Read::value())
    }

    /// Declares a parameter of numbers that was described as data. It can vary over time.
    pub fn number(&mut self, declared: Declared) -> Param<f64> {
        self.described(declared, Read::number())
    }

    /// Declares a closed parameter that takes any text, such as the path of a file. It stays at `nominal` until a study sets
    /// it, or opens it to several texts.
    pub fn text(&mut self, name: &str, nominal: &str) -> Param<String> {
        let text = self.declare(name, Domain::Choice(vec![nominal.into()]), Some(nominal.into()), Read::text());
        text.taking_texts()
    }

    fn declare<T: Clone>(&mut self, name: &str, domain: Domain, nominal: Option<Value>, read: Read<T>) -> Param<T> {
        let open = nominal.is_none();
        let mut parameter = Parameter::new(name, domain);
        parameter.default = nominal;
        self.described(Declared { open, ..Declared::open(parameter) }, read)
    }

    fn described<T: Clone>(&mut self, declared: Declared, read: Read<T>) -> Param<T> {
        // A name that the test does not know is reported once the program has returned, together with all the others.
        let name = &declared.parameter.name;
        let given = self.given.iter().find(|(given, _)| given == name).map(|(_, given)| given.clone());
        self.parameters.borrow_mut().push(declared);
        self.uses.borrow_mut().push(reach::Use::default());
        Param::new(self, given.unwrap_or_default(), read)
    }
}

#[cfg(test)]
mod tests {
    use crate::{AutonomousVehicle, Declared, Program, ProgramError, RoadSegment, Scenario, Test, never};
    use paracosm_space::{Domain, Parameter, Shape, Space, Value, Values};

    fn street(s: &mut Scenario) {
        let road = s.place(RoadSegment::new(300.0));
        s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
    }

    #[test]
    fn a_parameter_of_numbers_that_is_described_as_data_can_vary() {
        let program = Program::of("described", "a parameter as data", |s| {
            let domain = Domain::Interval { lo: 0.0, hi: 1.0 };
            let speed = s.number(Declared::open(Parameter::new("speed", domain)));
            street(s);
            s.require("slow", never(speed.above(2.0)));
        });
        let mut parameter = program.declare().unwrap().parameters.remove(0).parameter;
        parameter.signal = Some(Shape::PiecewiseConstant { pieces: 2 });
        let (space, values) = (Space::new(vec![parameter]).unwrap(), [Value::Number(0.1), Value::Number(0.2)]);
        let test = Values::from_iter([("speed".to_owned(), Value::from_iter(values))]);
        assert_eq!(program.check(Test::new(&test, &space)), Ok(()));
    }

    #[test]
    fn a_program_that_fails_says_why_and_nothing_else() {
        let program = Program::of("fails", "a program that fails", |s| {
            s.fail("the interpreter is gone");
            s.fail("and more");
        });
        let error = program.declare().unwrap_err();
        assert!(matches!(&error, ProgramError::Failed { why, .. } if why == "the interpreter is gone"), "{error}");
        assert_eq!(error.to_string(), "scenario `fails` failed: the interpreter is gone");
    }

    #[test]
    fn an_interpreter_can_take_the_scenario_and_gives_it_back() {
        let program = Program::of("lent", "a scenario that somebody else builds", |s| {
            let mut taken = std::mem::take(s);
            taken.interval("speed", 0.0..=1.0);
            street(&mut taken);
            assert!(taken.flaws().is_empty());
            taken.place(RoadSegment::new(300.0)).on_lane(7, 10.0);
            assert_eq!(taken.flaws().len(), 1);
            *s = taken;
        });
        let error = program.declare().unwrap_err().to_string();
        assert!(error.contains("has no lane 7"), "{error}");
    }
}
