//! The options that describe the system under test and its world. All commands that run tests share them.

use super::Verbosity;
use super::arguments::{REQUIRED, TESTED};
use super::system::System;
use super::usage;
use crate::engine::vehicle::VehicleModel;
use crate::oracles::Semantics;
use crate::space::{Domain, Value};
use crate::standards::openscenario::{DURATION, EGO};
use clap::Args;
use paracosm_campaign::study::Variation;
use paracosm_campaign::{Catalogue, Error, Study, StudyBuilder};
use std::path::Path;
use std::path::PathBuf;

/// The options of the system under test and its world.
#[derive(Debug, Clone, Args)]
pub(super) struct Subject {
    /// A scenario, or a file of one (.xosc, .py)
    ///
    /// `paracosm-fuzz list scenarios` shows all scenarios.
    #[arg(default_value = "pedestrian-crossing")]
    scenario: String,
    /// Open a parameter, or narrow its range
    ///
    /// Without a range, the parameter gets the range that the scenario states. RANGE is LO..HI, or the values A,B,C. With
    /// NAME:SHAPE, the parameter varies while a test runs; SHAPE is polynomial:DEGREE, piecewise-linear:PIECES,
    /// piecewise-constant:PIECES, per-tick or constant. The option can be repeated.
    #[arg(long, value_name = "NAME[=RANGE]", help_heading = TESTED)]
    open: Vec<String>,
    /// Open ranges with a step as intervals
    ///
    /// Each parameter for which a scenario file has a range with a step is open over the whole range.
    #[arg(long, help_heading = TESTED, hide_short_help = true)]
    continuous: bool,
    /// Let the driver have this entity [default: Ego]
    ///
    /// Without this option, the driver of a scenario file gets the entity `Ego`, or else the first entity with a
    /// controller.
    #[arg(long, value_name = "NAME", help_heading = TESTED, hide_short_help = true)]
    ego: Option<String>,
    /// Limit the seconds of a run [default: 40]
    ///
    /// A run of a scenario file ends after this time, and after the delay of its stop trigger, if the trigger does not
    /// come. A trigger at a later time still comes.
    #[arg(long, value_name = "SECONDS", help_heading = TESTED, hide_short_help = true)]
    duration: Option<f64>,
    /// Fix a parameter, or change a setting
    ///
    /// NAME=VALUE fixes a parameter (a signal: at one value or at A,B,C). driver.NAME=VALUE and vehicle.NAME=VALUE change a
    /// setting of the driver or of the car, and vehicle=jointed chooses another vehicle. The option can be repeated.
    #[arg(long, value_name = "NAME=VALUE", help_heading = TESTED)]
    set: Vec<String>,
    /// The driver under test [default: aeb]
    ///
    /// A name of `paracosm-fuzz list drivers`; or `grpc://HOST:PORT` for a driver that listens there; or, in a program
    /// built with the feature `neural`, `cnn` for a network that comes with it, or MODEL.onnx.
    #[arg(long, value_name = "DRIVER", help_heading = TESTED)]
    driver: Option<String>,
    /// A command that starts your own driver
    ///
    /// The driver listens over gRPC at the address in PARACOSM_ADDRESS. Each worker starts the command once.
    #[arg(long, value_name = "COMMAND", conflicts_with = "driver", help_heading = TESTED)]
    driver_command: Option<String>,
    /// Show an actor to cameras as a model
    ///
    /// The model is a glTF file, stretched to the size of the actor. `car` is the ego vehicle; other actors have their
    /// names of the traces; `tree` also stands for `tree-2` and so on.
    #[arg(long, value_name = "ACTOR=FILE.glb", help_heading = TESTED, hide_short_help = true)]
    model: Vec<String>,
    #[command(flatten)]
    system: System,
    /// Add the requirements of a file
    ///
    /// The file also has the sources and severities of the requirements, and the operational design domain.
    #[arg(long, value_name = "FILE.toml", help_heading = REQUIRED)]
    requirements: Option<PathBuf>,
    /// Add a formula that every trace satisfies
    ///
    /// The option can be repeated. The requirements are called spec-1, spec-2, ..; `paracosm-fuzz describe SCENARIO` shows
    /// the signals for formulas.
    #[arg(long, value_name = "FORMULA", help_heading = REQUIRED)]
    spec: Vec<String>,
    /// Evaluate the formulas in dense time
    ///
    /// Signals are then straight lines between samples, and formulas are about every instant. In a file of requirements,
    /// time = "dense" does the same for a requirement.
    #[arg(long, requires = "spec", help_heading = REQUIRED, hide_short_help = true)]
    dense: bool,
}

impl Subject {
    /// Returns the files that the options name.
    pub fn files(&self) -> Vec<&Path> {
        let models = self.model.iter().filter_map(|model| model.split_once('=')).map(|(_, file)| Path::new(file));
        models.chain(self.requirements.as_deref()).collect()
    }

    /// Returns true if the subject is a system of the user.
    pub fn is_system(&self) -> bool {
        self.system.is_given()
    }

    /// Returns the same options for another scenario, with further parameters opened.
    pub fn on(&self, scenario: &str, opened: impl Iterator<Item = String>) -> Self {
        let mut subject = Self { scenario: scenario.to_owned(), ..self.clone() };
        subject.open.extend(opened);
        subject
    }

    /// Returns the name of the scenario or the command of the system.
    pub fn name(&self) -> &str {
        self.system.name().unwrap_or(&self.scenario)
    }

    /// Begins a study of the subject with these options.
    pub fn study(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<StudyBuilder, Error> {
        let mut study = match self.system.study(catalogue, verbosity)? {
            Some(study) => study,
            None => self.driven(Study::of(catalogue.find(&self.scenario)?)),
        };
        if self.continuous {
            study = study.continuous();
        }
        if let Some(entity) = &self.ego {
            study = study.fix(EGO, Value::from(entity.as_str()));
        }
        if let Some(seconds) = self.duration {
            study = study.fix(DURATION, Value::from(seconds));
        }
        for text in &self.set {
            let (name, value) = text.split_once('=').ok_or_else(|| {
                usage(format!(
                    "--set {text}: expected NAME=VALUE, driver.NAME=VALUE, vehicle.NAME=VALUE or vehicle=MODEL"
                ))
            })?;
            let number =
                || value.parse().map_err(|_| usage(format!("--set {text}: found `{value}`, expected a number")));
            study = match name.split_once('.') {
                Some(("driver", setting)) => study.set_driver(setting, number()?),
                Some(("vehicle", setting)) => study.set_vehicle(setting, number()?),
                _ if name == "vehicle" => study.vehicle(VehicleModel::find(value)?),
                _ if value.contains(',') => study.fix(name, value.split(',').map(Value::parse).collect::<Value>()),
                _ => study.fix(name, Value::parse(value)),
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

    /// Sets the driver of the study.
    fn driven(&self, study: StudyBuilder) -> StudyBuilder {
        let study = match (&self.driver_command, &self.driver) {
            (Some(command), _) => study.driver_command(command),
            (None, Some(driver)) => study.driver(driver),
            (None, None) => study,
        };
        self.system.timeout().into_iter().fold(study, StudyBuilder::driver_timeout)
    }
}

/// Reads a domain of `--open`: LO..HI or A,B,C.
fn domain(text: &str, over: &str) -> Result<Domain, Error> {
    let Some((lo, hi)) = over.split_once("..") else {
        return Ok(Domain::Choice(over.split(',').map(Value::parse).collect()));
    };
    match (lo.parse(), hi.parse()) {
        (Ok(lo), Ok(hi)) => Ok(Domain::Interval { lo, hi }),
        _ => Err(usage(format!("--open {text}: found `{over}`, expected numbers LO..HI or values A,B,C"))),
    }
}

/// Reads a shape of `--open`.
fn variation(text: &str, shape: &str) -> Result<Variation, Error> {
    match shape {
        "constant" => Ok(Variation::Constant),
        "per-tick" => Ok(Variation::PerTick),
        shape => shape.parse().map(Variation::Shape).map_err(|error| usage(format!("--open {text}: {error}"))),
    }
}
