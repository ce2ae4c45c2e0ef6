//! The choices of a study, by the names of their keywords.

use crate::driver::{given_to, of_python};
use crate::error::raised;
use crate::own_strategy;
use crate::space::parameter;
use crate::value::value_of;
use crate::whole::whole;
use paracosm::campaign::study::Variation;
use paracosm::campaign::{Sampling, StudyBuilder};
use paracosm::engine::vehicle::VehicleModel;
use paracosm::generators::{DiscreteFamily, Strategy};
use paracosm::oracles::Semantics;
use paracosm::space::{Distribution, Value, did_you_mean, nearest};
use paracosm::standards::openscenario::{DURATION, EGO};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::path::PathBuf;

/// The names of the choices that say what is tested, in the order of the documentation.
const SUBJECT: [&str; 16] = [
    "driver",
    "driver_command",
    "driver_settings",
    "open",
    "fix",
    "continuous",
    "ego",
    "duration",
    "models",
    "vehicle",
    "vehicle_settings",
    "spec",
    "dense",
    "requirements",
    "references",
    "timeout",
];

/// The names of the choices that say which tests run, in the order of the documentation.
pub const SAMPLING: [&str; 11] =
    ["strategy", "budget", "seed", "skip", "k", "epsilon", "discrete", "delta", "measure", "batch", "stop_at_first"];

/// Returns a copy of the choices.
///
/// # Errors
/// A study has no such choice; the message has the most similar name.
pub fn checked<'py>(py: Python<'py>, choices: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyDict>> {
    let choices = match choices {
        Some(choices) => deep_copy(choices)?,
        None => PyDict::new(py),
    };
    let all: Vec<&str> = SUBJECT.into_iter().chain(SAMPLING).collect();
    for name in choices.keys() {
        let name: String = name.extract()?;
        if !all.contains(&name.as_str()) {
            let meant = did_you_mean(&nearest(&name, all.iter().copied()));
            return Err(raised(format!("a study has no choice `{name}`{meant}; the choices are {}", all.join(", "))));
        }
    }
    Ok(choices)
}

/// Copies choices with all that they hold, so that nobody changes a study.
///
/// # Errors
/// A choice cannot be copied.
pub fn deep_copy<'py>(choices: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
    let copied = choices.py().import("copy")?.call_method1("deepcopy", (choices,));
    let copied = copied.map_err(|error| raised(format!("the choices of the study cannot be copied: {error}")))?;
    Ok(copied.cast_into::<PyDict>()?)
}

/// Makes the choices for a study, and builds the study.
///
/// # Errors
/// A choice makes no sense.
pub fn built(mut study: StudyBuilder, choices: &Bound<PyDict>) -> PyResult<paracosm::Study> {
    let choices = Choices(choices);
    if choices.get::<Bound<PyAny>>("driver")?.is_some() && choices.get::<String>("driver_command")?.is_some() {
        return Err(raised("driver and driver_command exclude each other: give one of them, and None for the other"));
    }
    let own = choices.get::<Bound<PyAny>>("driver")?.map(|driver| of_python(&driver)).transpose()?.flatten();
    match own {
        Some(own) => study = given_to(study, own, choices.entries("driver_settings")?)?,
        None => {
            if let Some(driver) = choices.get::<String>("driver")? {
                study = study.driver(&driver);
            }
            for (name, value) in choices.entries::<f64>("driver_settings")? {
                study = study.set_driver(&name, value);
            }
        }
    }
    if let Some(command) = choices.get::<String>("driver_command")? {
        study = study.driver_command(&command);
    }
    if let Some(seconds) = choices.get("timeout")? {
        study = study.driver_timeout(seconds);
    }
    if let Some(model) = choices.get::<String>("vehicle")? {
        study = study.vehicle(VehicleModel::find(&model).map_err(raised)?);
    }
    for (name, value) in choices.entries::<f64>("vehicle_settings")? {
        study = study.set_vehicle(&name, value);
    }
    for (name, value) in choices.entries::<Bound<PyAny>>("fix")? {
        study = study.fix(&name, value_of(&value, &format!("fix: parameter `{name}`"))?);
    }
    if choices.get("continuous")?.unwrap_or(false) {
        study = study.continuous();
    }
    if let Some(entity) = choices.get::<String>("ego")? {
        study = study.fix(EGO, Value::from(entity.as_str()));
    }
    if let Some(seconds) = choices.get::<f64>("duration")? {
        study = study.fix(DURATION, Value::from(seconds));
    }
    for (actor, file) in choices.entries::<PathBuf>("models")? {
        study = study.show(&actor, &file.to_string_lossy());
    }
    study = opened(study, &choices)?;
    if let Some(file) = choices.get::<PathBuf>("requirements")? {
        study = study.require(&file);
    }
    let time = if choices.get("dense")?.unwrap_or(false) { Semantics::Dense } else { Semantics::Sampled };
    for formula in choices.texts("spec")? {
        study = study.spec_in(time, &formula);
    }
    for name in choices.texts("references")? {
        study = study.reference(&name);
    }
    study.sampling(sampling(&choices)?).maybe_one_test().build().map_err(raised)
}

/// Opens parameters: a list of names, or a dictionary with a domain for each name, or `None` for the range that the scenario states.
fn opened(mut study: StudyBuilder, choices: &Choices) -> PyResult<StudyBuilder> {
    let Some(open) = choices.get::<Bound<PyAny>>("open")? else { return Ok(study) };
    let Ok(domains) = open.cast::<PyDict>() else {
        return Ok(choices.texts("open")?.iter().fold(study, |study, name| study.open(name)));
    };
    for (name, domain) in domains {
        let name: String = name.extract()?;
        if domain.is_none() {
            study = study.open(&name);
            continue;
        }
        let parameter = parameter(&name, &domain)?;
        study = study.opened(&name, Some(parameter.domain), parameter.signal.map(Variation::Shape));
        if parameter.distribution != Distribution::default() {
            study = study.distribute(&name, parameter.distribution);
        }
    }
    Ok(study)
}

fn sampling(choices: &Choices) -> PyResult<Sampling> {
    let usual = Sampling::default();
    let own = choices
        .get::<Bound<PyAny>>("strategy")?
        .map(|strategy| own_strategy::of_python(&strategy))
        .transpose()?
        .flatten();
    let named = || choices.get::<String>("strategy")?.map(|name| name.parse::<Strategy>().map_err(raised)).transpose();
    let strategy = if own.is_some() { Some(Strategy::OWN) } else { named()? };
    let family = choices.get::<String>("discrete")?.map(|name| name.parse::<DiscreteFamily>().map_err(raised));
    let family = family.transpose()?.unwrap_or_default().with_delta(choices.get("delta")?).map_err(raised)?;
    let aim = choices.get::<String>("measure")?.map(|name| name.parse().map_err(raised)).transpose()?;
    Ok(Sampling {
        strategy: strategy.unwrap_or(usual.strategy),
        own,
        discrete: family,
        k: choices.whole("k")?,
        epsilon: choices.get("epsilon")?,
        aim,
        skip: choices.whole("skip")?,
        seed: choices.whole("seed")?,
        batch: choices.whole("batch")?,
        budget: choices.whole("budget")?.unwrap_or(usual.budget),
        stop_at_first: choices.get("stop_at_first")?.unwrap_or(false),
    })
}

/// The choices of a study by their names. `None` is the default of a choice.
struct Choices<'d, 'py>(&'d Bound<'py, PyDict>);

impl<'py> Choices<'_, 'py> {
    fn get<T>(&self, name: &str) -> PyResult<Option<T>>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        let Some(value) = self.0.get_item(name)?.filter(|value| !value.is_none()) else { return Ok(None) };
        let read = value.extract::<T>();
        read.map(Some).map_err(|error| {
            let why: PyErr = error.into();
            let found = value.repr().map(|text| text.to_string()).unwrap_or_default();
            raised(format!("{name} is {found}: {}", why.value(value.py())))
        })
    }

    /// Returns a choice that is a whole number from 0 on.
    fn whole<T: TryFrom<u64>>(&self, name: &str) -> PyResult<Option<T>> {
        let Some(value) = self.get::<Bound<PyAny>>(name)? else { return Ok(None) };
        let found = value.repr()?;
        let flaw = |_| raised(format!("{name} is {found}, expected a whole number from 0 on"));
        whole(&value).map(Some).map_err(flaw)
    }

    /// Returns the entries of a choice that is a dictionary.
    fn entries<T>(&self, name: &str) -> PyResult<Vec<(String, T)>>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        let Some(value) = self.get::<Bound<PyAny>>(name)? else { return Ok(Vec::new()) };
        let Ok(dict) = value.cast::<PyDict>() else {
            return Err(raised(format!(
                "{name} is {}, expected a dictionary with a value for each name",
                value.repr()?
            )));
        };
        let read = |(key, value): (Bound<'py, PyAny>, Bound<'py, PyAny>)| {
            let key: String = key.extract()?;
            let found = value.extract::<T>();
            let found =
                found.map_err(|error| raised(format!("{name}: `{key}`: {}", error.into().value(value.py()))))?;
            PyResult::Ok((key, found))
        };
        dict.iter().map(read).collect()
    }

    /// Returns the texts of a choice that is a text or a list of texts.
    fn texts(&self, name: &str) -> PyResult<Vec<String>> {
        match self.get::<Bound<PyAny>>(name)? {
            None => Ok(Vec::new()),
            Some(value) if value.is_instance_of::<PyString>() => Ok(vec![value.extract()?]),
            Some(_) => Ok(self.get::<Vec<String>>(name)?.unwrap_or_default()),
        }
    }
}
