//! The commands that the tests of a study run, and the check that they may be run.

use super::{PerceiverChoice, Study, Subject};
use crate::{Error, Reason};
use thiserror::Error;

/// A command that a study names, with the option by which a user gives such a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedCommand<'a> {
    /// The option, `--system`, `--driver-command` or `--perceiver-command`.
    pub option: &'static str,
    /// The command, with words separated and quoted as in a shell.
    pub command: &'a str,
}

/// The error that a study that was read from a file names a command that the user does not trust.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the file names the command `{}`, which is not run unless you ask for it: if you know what the command does, add \
     {option} {}, or --trust", on_one_line(.command), on_one_line(&shell_words::quote(.command))
)]
pub struct Untrusted {
    /// The command.
    pub command: String,
    /// The option by which the user can give the same command.
    pub option: &'static str,
}

/// The error that a study that was read from a file names the address of a driver, to which nothing is sent without the
/// trust of the user.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the file names a driver at {address}, to which nothing is sent unless you ask for it: add --trust")]
pub struct UntrustedAddress {
    /// The address.
    pub address: String,
}

/// Returns a command with its line breaks escaped. A stranger's command could otherwise add lines to the message.
fn on_one_line(command: &str) -> String {
    command.replace('\n', "\\n").replace('\r', "\\r")
}

impl Reason for Untrusted {}
impl Reason for UntrustedAddress {}

impl Study {
    /// Returns the commands that the tests of the study run. There are none if everything runs in this process or on a
    /// server that runs already.
    pub fn commands(&self) -> Vec<NamedCommand<'_>> {
        match self.subject() {
            Subject::System(system) => vec![NamedCommand { option: "--system", command: &system.command }],
            Subject::Scenario(simulation) => {
                let driver = simulation.driver().command();
                let perceiver = simulation.perceiver.as_ref().and_then(PerceiverChoice::command);
                let named = [("--driver-command", driver), ("--perceiver-command", perceiver)];
                named
                    .into_iter()
                    .filter_map(|(option, command)| Some(NamedCommand { option, command: command? }))
                    .collect()
            }
        }
    }

    /// Returns the address of the driver that the study tests, if the driver runs already.
    pub fn address(&self) -> Option<&str> {
        match self.subject() {
            Subject::Scenario(simulation) => simulation.driver().address(),
            Subject::System(_) => None,
        }
    }

    /// Checks that the commands of the study may be run, and that its driver may be asked.
    pub(crate) fn check_trust(&self) -> Result<(), Error> {
        if let Some(address) = self.address().filter(|address| !self.trust().covers(address)) {
            return Err(UntrustedAddress { address: address.to_owned() }.into());
        }
        match self.commands().iter().find(|named| !self.trust().covers(named.command)) {
            Some(NamedCommand { option, command }) => Err(Untrusted { command: (*command).to_owned(), option }.into()),
            None => Ok(()),
        }
    }
}
