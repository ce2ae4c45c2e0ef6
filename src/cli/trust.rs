//! `--trust` and the options that repeat a command: they let a file of somebody else run a command.

use super::Verbosity;
use clap::Args;
use paracosm_campaign::{Catalogue, Doubts, Folder, Log, NamedCommand, Trust};
use paracosm_space::plural;
use std::path::Path;

/// The options of the commands that run tests of a folder or a file again.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    drives: OfDrivers,
    /// Run this command as the perceiver, if the folder or the file names one
    #[arg(long, value_name = "COMMAND")]
    perceiver_command: Option<String>,
}

/// The options of the commands that run tests again, but not with a perceiver.
#[derive(Debug, Args)]
pub(super) struct OfDrivers {
    /// Run this command as the system, if the folder or the file names one
    #[arg(long, value_name = "COMMAND")]
    system: Option<String>,
    /// Run this command as the driver, if the folder or the file names one
    ///
    /// In a file, and for `blame`, the command has to be exactly the command of the file or of the folder. Otherwise another command
    /// takes its place, for example if the driver has moved.
    #[arg(long, value_name = "COMMAND")]
    driver_command: Option<String>,
    /// Run the commands that the folder or the file names
    ///
    /// The commands of a campaign run in the folder in which the campaign ran them.
    #[arg(long)]
    trust: bool,
}

/// Reads the log of a campaign. Notes if the campaign has not ended, and the doubts about its programs.
///
/// # Errors
/// The folder holds no campaign, or one of its files is broken.
pub(super) fn read_results(
    dir: &Path,
    catalogue: &Catalogue,
    verbosity: Verbosity,
) -> Result<Log, paracosm_campaign::Error> {
    let log = Log::read(dir, catalogue)?;
    if Folder::is_unfinished(dir, log.study(), log.trials().len()) {
        let (ran, budget, dir) = (log.trials().len(), plural(log.study().sampling().budget, "test"), dir.display());
        verbosity.note(format_args!("the campaign in {dir} has not ended: {ran} of at most {budget} have run"));
    }
    Doubts::read(dir)?.iter().for_each(|doubt| verbosity.note(format_args!("{}: {doubt}", dir.display())));
    Ok(log)
}

/// Reads the log of a campaign with the trust that the options state. Notes in which folder the commands ran, if they run in another now.
///
/// # Errors
/// The folder holds no campaign, or one of its files is broken.
pub(super) fn read_log(
    dir: &Path,
    catalogue: &Catalogue,
    trust: &Trust,
    verbosity: Verbosity,
) -> Result<Log, paracosm_campaign::Error> {
    let log = read_results(dir, &catalogue.trusting(trust), verbosity)?.trusting(trust);
    let here = std::env::current_dir().and_then(|here| here.canonicalize()).ok();
    if let Some(folder) = log.run_in().filter(|folder| Some(*folder) != here.as_deref() && !trust.is_all()) {
        let folder = folder.display();
        verbosity.note(format_args!("commands.json says that the commands of this campaign ran in {folder}; if you trust the campaign, --trust runs them there"));
    }
    Ok(log)
}

impl Options {
    /// Reads the log of a campaign with the trust that the options state. A command of the options takes the place of the command of
    /// the campaign; `true` is returned beside the log if it is another command.
    ///
    /// # Errors
    /// The folder holds no campaign, or one of its files is broken; or the campaign has no command of this kind.
    pub fn read(
        &self,
        dir: &Path,
        catalogue: &Catalogue,
        verbosity: Verbosity,
    ) -> Result<(Log, bool), paracosm_campaign::Error> {
        let mut log = read_log(dir, catalogue, &self.trust(), verbosity)?;
        let OfDrivers { system, driver_command, .. } = &self.drives;
        let given = [
            (NamedCommand::SYSTEM, system),
            (NamedCommand::DRIVER, driver_command),
            (NamedCommand::PERCEIVER, &self.perceiver_command),
        ];
        let mut is_other = false;
        for (option, command) in given.into_iter().filter_map(|(option, command)| Some((option, command.as_ref()?))) {
            let named = log.study().commands().into_iter().find(|named| named.option == option);
            if let Some(other) = named.filter(|named| named.command != command) {
                verbosity.note(format_args!("the campaign ran `{}`; now `{command}` runs in its place", other.command));
                is_other = true;
            }
            log = log.with_command(option, command)?;
        }
        Ok((log, is_other))
    }

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
