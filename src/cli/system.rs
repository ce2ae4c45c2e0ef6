//! The options that put a system of the user in the place of a scenario.

use super::arguments::TESTED;
use super::usage;
use super::{Strict, Verbosity};
use crate::space::demand::Demand;
use clap::Args;
use paracosm_campaign::{BlackBox, Catalogue, Error, SpaceFile, Study, StudyBuilder, is_model};
use std::path::PathBuf;

/// A system in its own process, and the space of its tests.
#[derive(Debug, Clone, Args)]
pub(super) struct System {
    /// Test your own system instead: a command
    ///
    /// Each worker starts the command once. The command reads a test as a line of JSON from standard input, and answers
    /// with a line of JSON.
    #[arg(long, value_name = "COMMAND", requires = "space", conflicts_with_all = ["scenario", "driver", "driver_command", "open", "set"], help_heading = TESTED)]
    system: Option<String>,
    /// The parameters of your own system
    ///
    /// SPACE.toml, or a PICT model.
    #[arg(long, value_name = "SPACE.toml", requires = "system", help_heading = TESTED)]
    space: Option<PathBuf>,
    #[command(flatten)]
    strict: Strict,
    /// Limit the seconds for an answer [default: 60]
    ///
    /// This is the limit for an answer of your own system, or of a driver in a process of its own. A driver that the
    /// program starts has ten times as long until it listens.
    #[arg(long, value_name = "SECONDS", help_heading = TESTED, hide_short_help = true)]
    timeout: Option<f64>,
}

impl System {
    /// Returns true if the user gave a system under test.
    pub fn is_given(&self) -> bool {
        self.system.is_some()
    }

    /// Returns the time limit for an answer in seconds, if the user gave a limit.
    pub fn timeout(&self) -> Option<f64> {
        self.timeout
    }

    /// Returns the command of the system under test, if the user gave a system.
    pub fn name(&self) -> Option<&str> {
        self.system.as_deref()
    }

    /// Begins a study of the system under test, if the user gave a system.
    pub fn study(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Option<StudyBuilder>, Error> {
        let (Some(command), Some(path)) = (&self.system, &self.space) else { return Ok(None) };
        let system = BlackBox::new(command, self.timeout)?;
        let SpaceFile { space, demand, .. } = self.strict.read(path, catalogue, verbosity)?;
        if demand != Demand::default() {
            let message = "the model has sub-models or negative values (`~`), which campaigns do not support; \
                           `paracosm-cover generate` makes such tests";
            return Err(usage(format!("{}: {message}", path.display())));
        }
        let study = Study::of_system(system, space);
        Ok(Some(if is_model(path) { study } else { study.odd_of(path) }))
    }
}
