//! Which parameters the tests of a study vary, and how.

use super::recorded::is_of_world;
use super::{Study, owned};
use crate::Error;
use paracosm_coverage::{Domain, Parameter, Shape, Space, Value, Values, did_you_mean, nearest};
use paracosm_engine::{Declared, Test};

impl Study {
    /// Opens a parameter: lets the tests vary it, over its declared domain or over this part of it.
    ///
    /// # Errors
    /// There is no such parameter, or `over` is no part of its domain.
    pub fn open(mut self, name: &str, over: Option<Domain>) -> Result<Self, Error> {
        let mut parameter = self.declared(name)?;
        if let Some(domain) = over {
            let ends = match &domain {
                Domain::Interval { lo, hi } => vec![Value::Number(*lo), Value::Number(*hi)],
                Domain::Choice(levels) => levels.clone(),
            };
            // Of a wrong interval the order of its ends is reported first, then that they lie outside.
            Space::new(vec![Parameter::new(name, domain.clone())])?;
            for end in &ends {
                parameter.check(end)?;
            }
            if matches!((&parameter.domain, &domain), (Domain::Choice(_), Domain::Interval { .. })) {
                let message = format!("parameter `{name}` takes {}, which is no interval", parameter.domain);
                return Err(Error::Usage(message));
            }
            parameter.domain = domain;
            parameter.default = parameter.default.take().filter(|value| parameter.check(value).is_ok());
        }
        let fixed = &mut self.subject.scenario_mut()?.fixed;
        *fixed = fixed.iter().filter(|(key, _)| *key != name).map(owned).collect();
        self.rebuild(|other| other.name == name, Some(parameter))?;
        Ok(self)
    }

    /// Lets an open parameter vary over time in this shape, or not at all.
    ///
    /// # Errors
    /// It is not open, does not vary in such a shape, or the world is built with one value of it.
    pub fn vary(mut self, name: &str, signal: Option<Shape>) -> Result<Self, Error> {
        let mut parameter = self.space.parameter(name)?.clone();
        parameter.signal = signal;
        parameter.default = parameter.default.take().filter(|value| parameter.check(value).is_ok());
        self.rebuild(|other| other.name == name, Some(parameter))?;
        self.program()?.check(Test::new(&self.nominal()?, &self.space))?;
        Ok(self)
    }

    /// A test with nominal values of the open parameters, and those that are fixed.
    pub(super) fn nominal(&self) -> Result<Values, Error> {
        let mut test = self.program()?.declare()?.nominal();
        for (name, value) in self.subject.fixed().iter() {
            test.set(name, value.clone());
        }
        for parameter in self.space.parameters().iter().filter(|parameter| is_of_world(&parameter.name)) {
            test.set(&parameter.name, Declared { parameter: parameter.clone(), open: true }.nominal());
        }
        Ok(test)
    }

    /// Fixes a parameter at a value; a signal at a value or at a list of them.
    ///
    /// # Errors
    /// There is no such parameter, it does not take the value, or it was the last open one.
    pub fn set(mut self, name: &str, value: Value) -> Result<Self, Error> {
        self.declared(name)?.check(&value)?;
        self.rebuild(|other| other.name == name, None)?;
        if self.space.parameters().is_empty() {
            return Err(Error::Usage(format!(
                "with `{name}` fixed no parameter is left open, so there is nothing to test"
            )));
        }
        self.subject.scenario_mut()?.fixed.set(name, value);
        Ok(self)
    }

    /// Replaces the open parameters that match, keeping the order in which the scenario declares them.
    fn rebuild(&mut self, matches: impl Fn(&Parameter) -> bool, with: Option<Parameter>) -> Result<(), Error> {
        if self.extends.is_some() {
            let message = "open, fix and vary parameters before tests of them are counted as done";
            return Err(Error::Usage(message.into()));
        }
        let declared = self.program()?.declare()?.parameters;
        let kept = self.space.parameters().iter().filter(|parameter| !matches(parameter)).cloned();
        let mut open: Vec<Parameter> = kept.chain(with).collect();
        open.sort_by_key(|parameter| declared.iter().position(|other| other.parameter.name == parameter.name));
        self.space = Space::new(open)?;
        Ok(())
    }

    fn declared(&self, name: &str) -> Result<Parameter, Error> {
        let scenario = &self.subject.scenario()?.scenario;
        let declared = self.program()?.declare()?.parameters;
        let found = declared.iter().find(|declared| declared.parameter.name == name);
        found.map(|declared| declared.parameter.clone()).ok_or_else(|| {
            let names = declared.iter().map(|declared| declared.parameter.name.as_str());
            let hint = did_you_mean(&nearest(name, names.clone()));
            let all = names.collect::<Vec<_>>().join(", ");
            Error::Usage(format!("scenario `{scenario}` has no parameter `{name}`{hint}; it has {all}"))
        })
    }
}
