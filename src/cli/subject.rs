//! The options that say what is tested, which all verbs that run tests share.

use super::Verbosity;
use super::system::System;
use super::usage;
use crate::campaign;
use crate::engine::vehicle::VehicleModel;
use crate::oracles::Semantics;
use crate::space::{Domain, Value, did_you_mean, nearest};
use clap::Args;
use paracosm_campaign::study::Variation;
use paracosm_campaign::{Error, StatedRequirement, Study, StudyBuilder};
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

    /// A study of it, with all else as it is where nothing is said.
    pub fn study(&self, verbosity: Verbosity) -> Result<StudyBuilder, Error> {
        let mut study = match self.system.study(verbosity)? {
            Some(study) => study,
            None => self.driven(Study::of(crate::catalogue().find(&self.scenario)?)),
        };
        for text in &self.set {
            let (name, value) = text.split_once('=').ok_or_else(|| {
                usage(format!("--set {text}: expected NAME=VALUE, driver.NAME=VALUE or vehicle=MODEL"))
            })?;
            study = match name.strip_prefix("driver.") {
                None if name == "vehicle" => study.vehicle(VehicleModel::find(value)?),
                None if value.contains(',') => study.fix(name, value.split(',').map(Value::parse).collect::<Value>()),
                None => study.fix(name, Value::parse(value)),
                Some(setting) => {
                    let number = value.parse();
                    let number =
                        number.map_err(|_| usage(format!("--set {text}: found `{value}`, expected a number")))?;
                    study.set_driver(setting, number)
                }
            };
        }
        for text in &self.open {
            let (name, over) = match text.split_once('=') {
                None => (text.as_str(), None),
                Some((name, over)) => (name, Some(domain(text, over)?)),
            };
            let (name, variation) = match name.split_once(':') {
                None => (name, None),
                Some((name, shape)) => (name, Some(variation(text, shape)?)),
            };
            study = study.opened(name, over, variation);
        }
        for text in &self.model {
            let (actor, file) = text
                .split_once('=')
                .ok_or_else(|| usage(format!("--model {text}: expected ACTOR=FILE.glb or ACTOR=FILE.gltf")))?;
            study = study.show(actor, file);
        }
        if let Some(path) = &self.requirements {
            study = study.require(path);
        }
        let time = if self.dense { Semantics::Dense } else { Semantics::Sampled };
        Ok(self.spec.iter().fold(study, |study, formula| study.spec_in(time, formula)))
    }

    /// A study with the driver that is asked for.
    fn driven(&self, study: StudyBuilder) -> StudyBuilder {
        let study = match (&self.driver_command, &self.driver) {
            (Some(command), _) => study.driver_command(command),
            (None, Some(driver)) => study.driver(driver),
            (None, None) => study,
        };
        self.system.timeout().into_iter().fold(study, StudyBuilder::driver_timeout)
    }

    /// Says which requirements of a file nothing judges, which may be a slip of the pen.
    pub fn note_unjudged(&self, study: &Study, verbosity: Verbosity) {
        if self.requirements.is_none() || matches!(study.subject(), campaign::Subject::System(_)) {
            return;
        }
        let (judged, unjudged): (Vec<_>, Vec<_>) = study.requirements().iter().partition(|r| r.formula.is_some());
        for StatedRequirement { id, .. } in unjudged {
            let meant = did_you_mean(&nearest(id, judged.iter().map(|requirement| requirement.id.as_str())));
            verbosity.note(format_args!(
                "requirement `{id}` has no formula, and the scenario has none of that name{meant}: nothing judges it"
            ));
        }
    }
}

/// Part of a parameter's domain as `--open` takes it: LO..HI or A,B,C.
fn domain(text: &str, over: &str) -> Result<Domain, Error> {
    let Some((lo, hi)) = over.split_once("..") else {
        return Ok(Domain::Choice(over.split(',').map(Value::parse).collect()));
    };
    match (lo.parse(), hi.parse()) {
        (Ok(lo), Ok(hi)) => Ok(Domain::Interval { lo, hi }),
        _ => Err(usage(format!("--open {text}: found `{over}`, expected numbers LO..HI or values A,B,C"))),
    }
}

/// How a parameter varies over time, as `--open` takes it.
fn variation(text: &str, shape: &str) -> Result<Variation, Error> {
    match shape {
        "constant" => Ok(Variation::Constant),
        "per-tick" => Ok(Variation::PerTick),
        shape => shape.parse().map(Variation::Shape).map_err(|error| usage(format!("--open {text}: {error}"))),
    }
}
