//! The options by which a system that others wrote takes the place of a scenario.

use super::Verbosity;
use super::usage;
use crate::space::demand::Demand;
use clap::Args;
use paracosm_campaign::{BlackBox, Error, SpaceFile, Study, StudyBuilder, is_model};
use std::path::PathBuf;

/// A system in its own process, and the space of its tests.
#[derive(Debug, Clone, Args)]
pub(super) struct System {
    /// Test a system of your own instead of a scenario: a command that reads a test as a line of JSON from standard input
    /// and answers with a line of JSON. It is started once for each worker
    #[arg(long, value_name = "COMMAND", requires = "space", conflicts_with_all = ["scenario", "driver", "driver_command", "open", "set"])]
    system: Option<String>,
    /// The parameters of the system's tests, or a model file of PICT
    #[arg(long, value_name = "SPACE.toml", requires = "system")]
    space: Option<PathBuf>,
    /// How long the system, or a driver in a process of its own, may take for an answer; a driver that is started here, ten
    /// times as long until it listens [default: 60]
    #[arg(long, value_name = "SECONDS")]
    timeout: Option<f64>,
}

impl System {
    /// Whether there is one.
    pub fn is_given(&self) -> bool {
        self.system.is_some()
    }

    /// How long an answer may take in seconds, if it was said.
    pub fn timeout(&self) -> Option<f64> {
        self.timeout
    }

    /// The command, if there is one.
    pub fn name(&self) -> Option<&str> {
        self.system.as_deref()
    }

    /// A study of the system, if there is one.
    pub fn study(&self, verbosity: Verbosity) -> Result<Option<StudyBuilder>, Error> {
        let (Some(command), Some(path)) = (&self.system, &self.space) else { return Ok(None) };
        let system = BlackBox::new(command, self.timeout)?;
        let SpaceFile { space, demand, .. } = verbosity.noted(SpaceFile::read(path)?);
        if demand != Demand::default() {
            let message = "asks for groups of more parameters or has negative values, which campaigns do not know; \
                           `paracosm-cover generate` makes such tests";
            return Err(usage(format!("{}: {message}", path.display())));
        }
        let study = Study::of_system(system, space);
        Ok(Some(if is_model(path) { study } else { study.odd_of(path) }))
    }
}
