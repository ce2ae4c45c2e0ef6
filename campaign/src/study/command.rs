//! The command that the tests of a study run, and the check that it may be run.

use super::{Study, Subject};
use crate::Reason;
use thiserror::Error;

/// A command that a study names, with the option by which a user gives such a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedCommand<'a> {
    /// The option, `--system` or `--driver-command`.
    pub option: &'static str,
    /// The command, with words separated and quoted as in a shell.
    pub command: &'a str,
}

/// The error that a study that was read from a file names a command that the user does not trust.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the file names the command `{command}`, which is not run unless you ask for it: if you know what the command does, add \
     {option} {}, or --trust", shell_words::quote(.command)
)]
pub struct Untrusted {
    /// The command.
    pub command: String,
    /// The option by which the user can give the same command.
    pub option: &'static str,
}

impl Reason for Untrusted {}

impl Study {
    /// Returns the command that the tests of the study run; `None` if everything runs in this process or on a server
    /// that runs already.
    pub fn command(&self) -> Option<NamedCommand<'_>> {
        match self.subject() {
            Subject::System(system) => Some(NamedCommand { option: "--system", command: &system.command }),
            Subject::Scenario(simulation) => {
                let command = simulation.driver().command()?;
                Some(NamedCommand { option: "--driver-command", command })
            }
        }
    }

    /// Checks that the command of the study may be run.
    pub(crate) fn check_trust(&self) -> Result<(), Untrusted> {
        match self.command() {
            Some(NamedCommand { option, command }) if !self.trust().covers(command) => {
                Err(Untrusted { command: command.to_owned(), option })
            }
            _ => Ok(()),
        }
    }
}
