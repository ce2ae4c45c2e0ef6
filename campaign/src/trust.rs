//! The commands that may be run. A folder or a file of a stranger may name any command: such a command is run only if
//! the user gives the same command, or trusts the file.

/// The trust of the user in the commands that files name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Trust {
    all: bool,
    commands: Vec<String>,
}

impl Trust {
    /// The trust in no command of a file.
    pub const NOTHING: Self = Self { all: false, commands: Vec::new() };

    /// Returns the trust in all commands of files.
    pub fn all() -> Self {
        Self { all: true, commands: Vec::new() }
    }

    /// Returns the trust in this command, too. The text must be the same.
    pub fn command(mut self, command: impl Into<String>) -> Self {
        self.commands.push(command.into());
        self
    }

    /// Returns `true` if a command may be run.
    pub(crate) fn covers(&self, command: &str) -> bool {
        self.all || self.commands.iter().any(|trusted| trusted == command)
    }
}
