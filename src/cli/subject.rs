//! The options that say what is tested, which all verbs that run tests share.

use super::Verbosity;
use super::system::System;
use crate::coverage::{Domain, Shape, Value, did_you_mean, nearest};
use crate::oracles::Semantics;
use crate::{Error, RequirementText, Study};
use clap::Args;
use std::path::PathBuf;

/// What is tested.
#[derive(Debug, Clone, Args)]
pub(super) struct Subject {
    /// The world to test in; `paracosm-fuzz list` shows them all
    #[arg(default_value = "pedestrian-crossing")]
    scenario: String,
    /// Open a parameter that the scenario leaves at its nominal value, or narrow an open one. With a SHAPE each test
    /// lets it vary over time: polynomial:DEGREE, piecewise-linear:PIECES, piecewise-constant:PIECES, per-tick,
    /// constant
    #[arg(long, value_name = "NAME[:SHAPE][=LO..HI|=A,B,C]")]
    open: Vec<String>,
    /// Fix a parameter, a signal at one value or at A,B,C; or change a setting of the driver with driver.NAME=VALUE
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// The system under test: one of `paracosm-fuzz list`; `grpc://HOST:PORT`, one that listens there; a network, if the
    /// program was built with them: `cnn`, one that comes with it, or MODEL.onnx [default: aeb]
    #[arg(long, value_name = "NAME|grpc://HOST:PORT|MODEL.onnx")]
    driver: Option<String>,
    /// Test a driver of your own: a command that starts one, once for each worker, which listens over gRPC at the address
    /// in PARACOSM_ADDRESS
    #[arg(long, value_name = "COMMAND", conflicts_with = "driver")]
    driver_command: Option<String>,
    /// Show an actor to cameras as the model in a glTF file, stretched to the actor's size; `car` is the car under test, the
    /// others are called as in traces; `tree` stands for `tree-2` and so on, too
    #[arg(long, value_name = "ACTOR=FILE.glb")]
    model: Vec<String>,
    #[command(flatten)]
    system: System,
    /// Ask what this file says, too: requirements with their sources and severities, and what of the design domain is tested
    #[arg(long, value_name = "FILE.toml")]
    requirements: Option<PathBuf>,
    /// Ask a formula of every trace, too; several times for several. Its requirements are called spec-1, spec-2, ..;
    /// `paracosm-fuzz describe SCENARIO` shows the signals that it may speak of
    #[arg(long, value_name = "FORMULA")]
    spec: Vec<String>,
    /// Take signals for straight lines from sample to sample, and the formulas of --spec to speak of every instant. A file of
    /// requirements says it of each of its own with time = "dense"
    #[arg(long, requires = "spec")]
    dense: bool,
    /// End a run as soon as all its requirements are decided. That never changes a verdict, but the robustness is of what was
    /// run; a scenario that asks for something over its whole time goes on to its end
    #[arg(long, conflicts_with_all = ["system", "dense"])]
    stop_runs_early: bool,
}

impl Subject {
    /// Whether it is a system that others wrote.
    pub fn is_system(&self) -> bool {
        self.system.is_given()
    }

    /// The same of another scenario, with further parameters opened.
    pub fn on(&self, scenario: &str, opened: impl Iterator<Item = String>) -> Self {
        let mut subject = Self { scenario: scenario.to_owned(), ..self.clone() };
        subject.open.extend(opened);
        subject
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        self.system.name().unwrap_or(&self.scenario)
    }

    /// The study of it, with all else as it is where nothing is said.
    pub fn study(&self, verbosity: Verbosity) -> Result<Study, Error> {
        let mut driver_settings = Vec::new();
        let mut fixed = Vec::new();
        let mut vehicle = None;
        for text in &self.set {
            let (name, value) = text.split_once('=').ok_or_else(|| {
                Error::Usage(format!("--set {text}: expected NAME=VALUE, driver.NAME=VALUE or vehicle=MODEL"))
            })?;
            match name.strip_prefix("driver.") {
                None if name == "vehicle" => vehicle = Some(value),
                None if value.contains(',') => fixed.push((name, value.split(',').map(Value::parse).collect())),
                None => fixed.push((name, Value::parse(value))),
                Some(setting) => {
                    let number = value
                        .parse()
                        .map_err(|_| Error::Usage(format!("--set {text}: found `{value}`, expected a number")))?;
                    driver_settings.push((setting.to_owned(), number));
                }
            }
        }
        let mut study = match self.system.study(verbosity)? {
            Some(study) => study,
            None => self.driven(Study::of(&self.scenario)?, &driver_settings)?,
        };
        if let Some(model) = vehicle {
            study = study.vehicle(model)?;
        }
        for text in &self.open {
            let (name, over) = match text.split_once('=') {
                None => (text.as_str(), None),
                Some((name, over)) => (name, Some(domain(text, over)?)),
            };
            let (name, shape) = match name.split_once(':') {
                None => (name, None),
                Some((name, shape)) => (name, Some(signal(text, shape, &study)?)),
            };
            study = study.open(name, over)?;
            if let Some(shape) = shape {
                study = study.vary(name, shape)?;
            }
        }
        for (i, (name, value)) in fixed.iter().enumerate() {
            let opened = self.open.iter().any(|text| text.split(['=', ':']).next() == Some(name));
            if opened || fixed[..i].iter().any(|(other, _)| other == name) {
                return Err(Error::Usage(format!("parameter `{name}` is set and opened, or set twice")));
            }
            study = study.set(name, value.clone())?;
        }
        for text in &self.model {
            let (actor, file) = text
                .split_once('=')
                .ok_or_else(|| Error::Usage(format!("--model {text}: expected ACTOR=FILE.glb or ACTOR=FILE.gltf")))?;
            study = study.show(actor, file)?;
        }
        if let Some(path) = &self.requirements {
            study = study.require(path)?;
            note_unjudged(&study, verbosity);
        }
        let time = if self.dense { Semantics::Dense } else { Semantics::Sampled };
        for formula in &self.spec {
            study = study.spec_in(time, formula)?;
        }
        if self.stop_runs_early { study.stop_runs_early() } else { Ok(study) }
    }
}

impl Subject {
    /// A study with the driver that is asked for, set so.
    fn driven(&self, study: Study, settings: &[(String, f64)]) -> Result<Study, Error> {
        let study = match &self.driver_command {
            Some(command) => study.driver_command(command, settings)?,
            None => study.driver(self.driver.as_deref().unwrap_or("aeb"), settings)?,
        };
        match self.system.timeout() {
            Some(seconds) => study.driver_timeout(seconds),
            None => Ok(study),
        }
    }
}

/// Says which requirements nothing judges, which may be a slip of the pen.
fn note_unjudged(study: &Study, verbosity: Verbosity) {
    if study.subject.scenario().is_err() {
        return;
    }
    let (judged, unjudged): (Vec<_>, Vec<_>) = study.requirements.iter().partition(|r| r.has_formula());
    for RequirementText { id, .. } in unjudged {
        let meant = did_you_mean(&nearest(id, judged.iter().map(|requirement| requirement.id.as_str())));
        verbosity.note(format_args!(
            "requirement `{id}` has no formula, and the scenario has none of that name{meant}: nothing judges it"
        ));
    }
}

/// Part of a parameter's domain as `--open` takes it: LO..HI or A,B,C.
fn domain(text: &str, over: &str) -> Result<Domain, Error> {
    let Some((lo, hi)) = over.split_once("..") else {
        return Ok(Domain::Choice(over.split(',').map(Value::parse).collect()));
    };
    match (lo.parse(), hi.parse()) {
        (Ok(lo), Ok(hi)) => Ok(Domain::Interval { lo, hi }),
        _ => Err(Error::Usage(format!("--open {text}: found `{over}`, expected numbers LO..HI or values A,B,C"))),
    }
}

/// How a parameter varies over time, as `--open` takes it.
fn signal(text: &str, shape: &str, study: &Study) -> Result<Option<Shape>, Error> {
    match shape {
        "constant" => Ok(None),
        "per-tick" => Ok(Some(Shape::PiecewiseConstant { pieces: study.subject.scenario()?.ticks() })),
        shape => shape.parse().map(Some).map_err(|message| Error::Usage(format!("--open {text}: {message}"))),
    }
}
