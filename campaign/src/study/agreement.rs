//! Checks that a study of a file agrees with the program of its scenario, if this version of the software wrote the file.
//! A study of another version may differ, and a study without a program can be analysed but not run.

use super::entries::EntryFlaw;
use super::parameters::{ParameterMisuse, is_of_world};
use super::{Simulation, StatedRequirement, Study, Subject};
use crate::Error;
use paracosm_engine::Declaration;

impl Study {
    /// Checks the entries of a study that was read from a file against the program of its scenario.
    pub(crate) fn check_program(&self) -> Result<(), EntryFlaw> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(()) };
        // If the scenario cannot be declared, the first test reports the reason.
        let declared = simulation.program().ok().and_then(|program| program.declare().ok());
        let Some(declared) = declared.filter(|_| self.is_of_this_software()) else { return Ok(()) };
        let check = || {
            simulation.check_length(&declared)?;
            simulation.driver.check().map_err(EntryFlaw::Driver)?;
            self.check_parameters(simulation, &declared)?;
            self.check_requirements(simulation, &declared)
        };
        check().map_err(|flaw| EntryFlaw::Changed(Box::new(flaw)))
    }

    /// Checks that every parameter of the scenario is fixed or open, at a value or over a domain that the scenario
    /// allows, and that no other parameter is.
    fn check_parameters(&self, simulation: &Simulation, declared: &Declaration) -> Result<(), EntryFlaw> {
        let in_entry = |entry| move |flaw: Error| EntryFlaw::Parameter { entry, flaw: Box::new(flaw) };
        for (name, value) in simulation.fixed.iter() {
            let check = || Ok(self.find_declared(name)?.check(value)?);
            check().map_err(in_entry("fixed"))?;
        }
        for parameter in self.space.parameters().iter().filter(|parameter| is_of_world(&parameter.name)) {
            let name = &parameter.name;
            let twice = || ParameterMisuse::Twice { name: name.clone() }.into();
            let check = || simulation.fixed.get(name).map_or(Ok(()), |_| Err(twice()));
            check().and_then(|()| self.over(name, &parameter.domain).map(drop)).map_err(in_entry("space"))?;
        }
        let is_there = |name: &str| simulation.fixed.get(name).is_some() || self.space.parameter(name).is_ok();
        let mut names = declared.parameters.iter().map(|declared| &declared.parameter.name);
        match names.find(|name| !is_there(name)) {
            Some(name) => Err(EntryFlaw::NoParameter { name: name.clone(), scenario: simulation.scenario.clone() }),
            None => Ok(()),
        }
    }

    /// Checks that the study states the requirements of the scenario, and that formulas of users can judge its traces.
    fn check_requirements(&self, simulation: &Simulation, declared: &Declaration) -> Result<(), EntryFlaw> {
        // A perceiver is not judged by the requirements on the driver.
        let of_driver = declared.requirements.iter().filter(|_| simulation.perceiver.is_none());
        for own in of_driver.cloned().map(StatedRequirement::from) {
            let missing = || EntryFlaw::Missing { id: own.id.clone(), scenario: simulation.scenario.clone() };
            let stated = self.requirement(&own.id).ok_or_else(missing)?;
            let formula =
                |of: &StatedRequirement| of.formula.as_ref().map_or("nothing".to_owned(), ToString::to_string);
            let scale = |of: &StatedRequirement| of.scale.map_or("nothing".to_owned(), |scale| scale.to_string());
            let same = |entry: &str, found, expected| {
                simulation.same(&format!("{entry} of requirement {}", own.id), found, expected)
            };
            same("formula", formula(stated), formula(&own))?;
            same("scale", scale(stated), scale(&own))?;
            same("unit", stated.unit.clone(), own.unit.clone())?;
        }
        for StatedRequirement { id, formula, time, .. } in self.given() {
            let text = formula.as_ref().map(ToString::to_string).unwrap_or_default();
            let wrong = |flaw| EntryFlaw::Formula { id: id.clone(), flaw: Box::new(flaw) };
            self.checked(&text, *time).map_err(wrong)?;
        }
        Ok(())
    }
}

impl Simulation {
    fn check_length(&self, declared: &Declaration) -> Result<(), EntryFlaw> {
        let seconds = |seconds: f64| format!("{seconds} s");
        self.same("dt", seconds(self.dt), seconds(declared.dt))?;
        self.same("duration", seconds(self.duration), seconds(declared.duration))
    }

    /// Checks that an entry has the value of the scenario.
    fn same(&self, entry: &str, found: String, expected: String) -> Result<(), EntryFlaw> {
        if found == expected {
            return Ok(());
        }
        Err(EntryFlaw::Other { entry: entry.to_owned(), found, expected, scenario: self.scenario.clone() })
    }
}
