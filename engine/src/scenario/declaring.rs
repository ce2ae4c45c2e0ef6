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

    /// Declares an open parameter that takes one of the given values, of which there is at least one.
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
