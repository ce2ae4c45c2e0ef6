//! The commands that the tests of a study run, and the check that they may be run.

use super::{PerceiverChoice, Study, Subject};
use crate::{BlackBox, Error, Reason};
use thiserror::Error;

/// A command that a study names, with the option by which a user gives such a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedCommand<'a> {
    /// The option: `--system`, `--driver-command` or `--perceiver-command`.
    pub option: &'static str,
    /// The command, with words separated and quoted as in a shell.
    pub command: &'a str,
}

/// The error that a study that was read from a file names a command that the user does not trust.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the file names the command `{}`, which is not run unless you ask for it: if you know what the command does, add \
     {option} {}, or --trust{}", on_one_line(.command), on_one_line(&shell_words::quote(.command)), unlike(.given)
)]
pub struct Untrusted {
    /// The command.
    pub command: String,
    /// The option by which the user can give the same command.
    pub option: &'static str,
    /// The other commands that the user gave.
    pub given: Vec<String>,
}

/// The error that a command was given in place of a command that the study does not name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{option} {}: the campaign tests {subject}, for which it runs no such command; leave {option} out", on_one_line(&shell_words::quote(.given)))]
pub struct NoSuchCommand {
    /// The option by which the user gave the command.
    pub option: &'static str,
    /// The command that the user gave.
    pub given: String,
    /// The title of the system or the driver that the campaign tests.
    pub subject: String,
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

/// Says which commands the user gave, because a command is run only if the user gives exactly this command.
fn unlike(given: &[String]) -> String {
    match given {
        [] => String::new(),
        given => {
            format!("; the command has to be exactly the same, but you gave `{}`", on_one_line(&given.join("`, `")))
        }
    }
}

impl Reason for Untrusted {}
impl Reason for NoSuchCommand {}
impl Reason for UntrustedAddress {}

impl NamedCommand<'_> {
    /// The option for the command of a system.
    pub const SYSTEM: &'static str = "--system";
    /// The option for the command of a driver.
    pub const DRIVER: &'static str = "--driver-command";
    /// The option for the command of a perceiver.
    pub const PERCEIVER: &'static str = "--perceiver-command";
}

impl Study {
    /// Returns the commands that the tests of the study run. There are none if everything runs in this process or on a
    /// server that runs already.
    pub fn commands(&self) -> Vec<NamedCommand<'_>> {
        match self.subject() {
            Subject::System(system) if system.is_function() => Vec::new(),
            Subject::System(system) => vec![NamedCommand { option: NamedCommand::SYSTEM, command: &system.command }],
            Subject::Scenario(simulation) => {
                let driver = simulation.driver().command();
                let perceiver = simulation.perceiver.as_ref().and_then(PerceiverChoice::command);
                let named = [(NamedCommand::DRIVER, driver), (NamedCommand::PERCEIVER, perceiver)];
                named
                    .into_iter()
                    .filter_map(|(option, command)| Some(NamedCommand { option, command: command? }))
                    .collect()
            }
        }
    }

    /// Returns a copy of the study with another command in place of the command for the given option. The new command may start
    /// the same driver in another place, or a changed driver.
    ///
    /// # Errors
    /// The study names no command for the option, or the new command is invalid.
    pub fn with_command(&self, option: &'static str, command: &str) -> Result<Self, Error> {
        if !self.commands().iter().any(|named| named.option == option) {
            return Err(NoSuchCommand { option, given: command.to_owned(), subject: self.title() }.into());
        }
        let mut study = self.clone();
        match &mut study.subject {
            Subject::System(system) => *system = BlackBox::new(command, Some(system.timeout))?,
            Subject::Scenario(simulation) if option == NamedCommand::DRIVER => {
                simulation.driver = simulation.driver.with_command(command)?;
            }
            Subject::Scenario(simulation) => {
                simulation.perceiver.iter_mut().try_for_each(|perceiver| perceiver.set_command(command))?;
            }
        }
        Ok(study)
    }

    /// Returns the address of the driver that the study tests, if the driver runs already.
    pub fn address(&self) -> Option<&str> {
        match self.subject() {
            Subject::Scenario(simulation) => simulation.driver().address(),
            Subject::System(_) => None,
        }
    }

    /// Returns `true` if a part of every test runs in another process, or is a function of the user's program. Both may have changed since.
    pub fn is_outside(&self) -> bool {
        let is_function = matches!(self.subject(), Subject::System(system) if system.is_function());
        is_function || !self.commands().is_empty() || self.address().is_some()
    }

    /// Checks that the commands of the study may be run, and that its driver may be asked.
    ///
    /// # Errors
    /// The study names a command or an address that the user does not trust.
    pub fn check_trust(&self) -> Result<(), Error> {
        if let Some(address) = self.address().filter(|address| !self.trust().covers(address)) {
            return Err(UntrustedAddress { address: address.to_owned() }.into());
        }
        match self.commands().iter().find(|named| !self.trust().covers(named.command)) {
            Some(NamedCommand { option, command }) => {
                let given = self.trust().given().to_vec();
                Err(Untrusted { command: (*command).to_owned(), option, given }.into())
            }
            None => Ok(()),
        }
    }
}
