//! `--trust` and the options that repeat a command: they let a file of somebody else run a command.

use clap::Args;
use paracosm_campaign::Trust;

/// The options of the commands that run tests of a folder or a file again.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    drives: OfDrivers,
    /// Run this command, if the folder or the file names it as the command of its perceiver
    #[arg(long, value_name = "COMMAND")]
    perceiver_command: Option<String>,
}

/// The options of the commands that run tests again, but not with a perceiver.
#[derive(Debug, Args)]
pub(super) struct OfDrivers {
    /// Run this command, if the folder or the file names it as its system
    #[arg(long, value_name = "COMMAND")]
    system: Option<String>,
    /// Run this command, if the folder or the file names it as the command of its driver
    #[arg(long, value_name = "COMMAND")]
    driver_command: Option<String>,
    /// Run the commands that the folder or the file names
    #[arg(long)]
    trust: bool,
}

impl Options {
    /// Returns the trust that the options state.
    pub fn trust(&self) -> Trust {
        self.perceiver_command.iter().fold(self.drives.trust(), Trust::command)
    }
}

impl OfDrivers {
    /// Returns the trust that the options state.
    pub fn trust(&self) -> Trust {
        let trust = if self.trust { Trust::all() } else { Trust::NOTHING };
        [&self.system, &self.driver_command].into_iter().flatten().fold(trust, Trust::command)
    }
}
