//! The options that put a perception network on trial.

use super::arguments::TRIED;
use super::subject::Subject;
use super::usage;
use clap::Args;
use paracosm_campaign::cameras::{VariedCameras, read_cameras, standard_cameras};
use paracosm_campaign::{Error, StudyBuilder};
use paracosm_engine::sensor::Look;
use std::path::PathBuf;

/// The options of the perceiver on trial and of its camera.
#[derive(Debug, Args)]
#[group(skip)]
pub(super) struct Options {
    /// The network on trial
    ///
    /// A file with the same name and the ending .toml describes it.
    #[arg(long, value_name = "MODEL.onnx", help_heading = TRIED)]
    perceiver: Option<PathBuf>,
    /// The description of the network
    ///
    /// The option is needed if the description has another name than the network.
    #[arg(long, value_name = "FILE.toml", requires = "perceiver", help_heading = TRIED, hide_short_help = true)]
    description: Option<PathBuf>,
    /// A command that starts your own perceiver
    ///
    /// The program gets images on its standard input and answers on its standard output. Each worker starts the command
    /// once.
    #[arg(long, value_name = "COMMAND", conflicts_with = "perceiver", help_heading = TRIED)]
    perceiver_command: Option<String>,
    /// Limit the seconds for an answer of the perceiver
    ///
    /// [default: 60]
    #[arg(long, value_name = "SECONDS", requires = "perceiver_command", help_heading = TRIED, hide_short_help = true)]
    perceiver_timeout: Option<f64>,
    /// The camera on the ego vehicle
    ///
    /// A setting that is a range, "LO..HI", or a list, "A,B,C", becomes a parameter of the tests, named camera.NAME.SETTING
    /// [default: the camera of `record --print-cameras`, in the look textured].
    #[arg(long, value_name = "CAMERAS.toml", help_heading = TRIED)]
    cameras: Option<PathBuf>,
}

impl Options {
    /// Returns `true` if a perceiver is on trial.
    pub fn are_given(&self) -> bool {
        self.perceiver.is_some() || self.perceiver_command.is_some()
    }

    /// Checks that a perceiver on trial has a world to see.
    pub fn check(&self, subject: &Subject) -> Result<(), Error> {
        if self.are_given() && subject.is_system() {
            let message = "--system: a system has no world that a camera could see; a perceiver needs a scenario";
            return Err(usage(message.into()));
        }
        Ok(())
    }

    /// Puts the perceiver on trial, if there is one.
    pub fn seen(&self, study: StudyBuilder) -> Result<StudyBuilder, Error> {
        let cameras = || match &self.cameras {
            Some(path) => read_cameras(path),
            None => Ok(VariedCameras::from(standard_cameras()).in_look(Look::Textured)),
        };
        match (&self.perceiver, &self.perceiver_command) {
            (Some(network), _) => {
                let description = self.description.clone().unwrap_or_else(|| network.with_extension("toml"));
                Ok(study.perceiver(&network.to_string_lossy(), &description.to_string_lossy(), cameras()?))
            }
            (None, Some(command)) => Ok(study.perceiver_command(command, self.perceiver_timeout, cameras()?)),
            (None, None) if self.cameras.is_some() => Err(usage(
                "--cameras: there is no perceiver that sees the images: add --perceiver MODEL.onnx or --perceiver-command \
                 COMMAND"
                    .to_owned(),
            )),
            (None, None) => Ok(study),
        }
    }
}
