//! The commands that may be run. A folder or a file of a stranger may name any command: such a command is run only if
//! the user gives the same command, or trusts the file.

use std::path::{Path, PathBuf};

/// The trust of the user in the commands that files name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Trust {
    all: bool,
    commands: Vec<String>,
    /// The folder in which trusted commands run; `None` for the folder of this process.
    folder: Option<PathBuf>,
}

impl Trust {
    /// The trust in no command of a file.
    pub const NOTHING: Self = Self { all: false, commands: Vec::new(), folder: None };

    /// Returns the trust in all commands of files.
    pub fn all() -> Self {
        Self { all: true, ..Self::NOTHING }
    }

    /// Returns the trust in this command, too. The text must be the same.
    pub fn command(mut self, command: impl Into<String>) -> Self {
        self.commands.push(command.into());
        self
    }

    /// Lets commands run in a folder, if all commands are trusted.
    pub(crate) fn running_in(self, folder: &Path) -> Self {
        let folder = self.all.then(|| folder.to_owned());
        Self { folder, ..self }
    }

    /// Returns the folder in which commands run; `None` for the folder of this process.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Returns `true` if all commands may be run.
    pub fn is_all(&self) -> bool {
        self.all
    }

    /// Returns the commands that the user gave.
    pub(crate) fn given(&self) -> &[String] {
        &self.commands
    }

    /// Returns `true` if a command may be run.
    pub(crate) fn covers(&self, command: &str) -> bool {
        self.all || self.commands.iter().any(|trusted| trusted == command)
    }
}
