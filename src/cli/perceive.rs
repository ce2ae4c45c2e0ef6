//! `paracosm-fuzz perceive`: runs a campaign with a perception network on trial.

use super::usage;
use super::{Failure, Status, Verbosity, perceiver, run};
use clap::Args;
use paracosm_campaign::Catalogue;
use paracosm_perception::{Detector, Segmenter, Task};

const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz perceive highway-traffic --perceiver detector.onnx --open light --open fog --strategy auto
  paracosm-fuzz perceive grid-traffic --perceiver-command 'python3 my_detector.py' --cameras cameras.toml --k 2
  paracosm-fuzz perceive highway-traffic --perceiver detector.onnx --spec 'always (perception.false_alarms < 3)'

detector.toml beside detector.onnx describes the input and the outputs of the network (docs/perception.md). The \
    driver only drives [default: planner], and its requirements do not count. Without --spec, a detector has the \
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
    #[command(flatten)]
    perceiver: perceiver::Options,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        self.perceiver.check(&self.run.subject)?;
        if !self.perceiver.are_given() {
            let message = "expected a perceiver: --perceiver MODEL.onnx or --perceiver-command COMMAND";
            return Err(usage(message.into()).into());
        }
        let conducted = self.run.conduct(catalogue, verbosity, |study| self.perceiver.seen(study))?;
        Ok(conducted.found)
    }
}
