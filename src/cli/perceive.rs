//! `paracosm-fuzz perceive`: runs a campaign with a perception network on trial.

use super::run;
use super::usage;
use super::{Failure, Status, Verbosity};
use clap::Args;
use paracosm_campaign::StudyBuilder;
use paracosm_campaign::cameras::{VariedCameras, read_cameras, standard_cameras};
use paracosm_perception::{Detector, Segmenter, Task};
use paracosm_render::Look;
use paracosm_report::record::check_rates;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz perceive highway-traffic --perceiver detector.onnx --open light --open fog --strategy auto
  paracosm-fuzz perceive grid-traffic --perceiver-command 'python3 my_detector.py' --cameras cameras.toml --k 2
  paracosm-fuzz perceive highway-traffic --perceiver detector.onnx --spec 'always (perception.false_alarms < 3)'

detector.toml beside detector.onnx describes the input and the outputs of the network (docs/perception.md).
The driver only drives [default: planner], and its requirements do not count. Without --spec, a detector has the
requirement `detection`: every road user that is visible to 75 % and within 40 m is matched within 0.5 s.";

/// Returns the examples, and the signals for formulas.
pub(super) fn examples() -> String {
    let detector = Task::Detection(Detector::of(Vec::new()));
    let signals = |of: &Task| {
        let names = of.signals().iter().map(|name| format!("  {name}\n"));
        names.collect::<String>()
    };
    format!(
        "{EXAMPLES}\n\nSignals of a detector for formulas (docs/perception.md):\n{}\nSignals of a segmentation network:\n{}",
        signals(&detector),
        signals(&Task::Segmentation(Segmenter::default())),
    )
}

/// The options of `perceive`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    run: run::Options,
    /// The network on trial. A file with the same name and the ending .toml describes it
    #[arg(long, value_name = "MODEL.onnx", required_unless_present = "perceiver_command")]
    perceiver: Option<PathBuf>,
    /// The description of the network, if it has another name
    #[arg(long, value_name = "FILE.toml", requires = "perceiver")]
    description: Option<PathBuf>,
    /// Put your own perceiver on trial: a command that starts a program, which gets images on its standard input and
    /// answers on its standard output. Each worker starts the command once
    #[arg(long, value_name = "COMMAND", conflicts_with = "perceiver")]
    perceiver_command: Option<String>,
    /// The time limit for an answer of the perceiver [default: 60]
    #[arg(long, value_name = "SECONDS", requires = "perceiver_command")]
    perceiver_timeout: Option<f64>,
    /// The camera on the ego vehicle [default: the camera of `record --print-cameras`, in the look textured]. A setting
    /// that is a range, "LO..HI", or a list, "A,B,C", becomes a parameter of the tests, named camera.NAME.SETTING
    #[arg(long, value_name = "CAMERAS.toml")]
    cameras: Option<PathBuf>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<Status, Failure> {
        if self.run.subject.is_system() {
            let message = "--system: a system has no world that a camera could see; `perceive` needs a scenario";
            return Err(usage(message.into()).into());
        }
        let cameras = match &self.cameras {
            Some(path) => read_cameras(path)?,
            None => VariedCameras::from(standard_cameras()).in_look(Look::Textured),
        };
        let check = |study: &_| check_rates(study, cameras.nominal());
        let conducted = self.run.conduct(verbosity, |study| self.seen(study, cameras.clone()), check)?;
        Ok(conducted.found)
    }

    /// Puts the perceiver of the options on trial.
    fn seen(&self, study: StudyBuilder, cameras: VariedCameras) -> StudyBuilder {
        match (&self.perceiver, &self.perceiver_command) {
            (Some(network), _) => {
                let description = self.description.clone().unwrap_or_else(|| network.with_extension("toml"));
                study.perceiver(&network.to_string_lossy(), &description.to_string_lossy(), cameras)
            }
            (None, Some(command)) => study.perceiver_command(command, self.perceiver_timeout, cameras),
            // The options require one of the two.
            (None, None) => study,
        }
    }
}
