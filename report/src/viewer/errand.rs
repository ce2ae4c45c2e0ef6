//! Answers the questions that take many runs: the simplest failing test, who could have prevented a failure, and the film of a camera.

use super::wanted::{Wanted, numbers_of};
use super::{Answer, Viewer, json};
use crate::record::{cameras_of, mp4};
use paracosm_analysis::blame::{Blamed, Inquiry, REFERENCES};
use paracosm_analysis::{Sameness, Shrunk};
use paracosm_campaign::cameras::VariedCameras;
use paracosm_campaign::{Error, Reason, Supervision, Worker};
use paracosm_engine::sensor::Cameras;
use paracosm_space::{Values, plural};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A question that takes many runs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Errand {
    /// The simplest test near a failing test that still fails.
    Shrink(Wanted),
    /// The reference drivers that prevent a failure.
    Blame(Wanted),
    /// The names of the cameras that can film a test.
    Cameras,
    /// The film of a test by one camera, as an MP4 file.
    Film { test: Wanted, camera: String },
}

/// The error that no camera has this name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no camera is named `{camera}`")]
struct NoCamera {
    camera: String,
}

impl Reason for NoCamera {}

/// The simplest failing test.
#[derive(Serialize)]
struct Simplest<'a> {
    sentence: String,
    /// The number of runs that the search took, and whether a larger search may find more.
    search: String,
    /// The numbers with which the page asks for the test.
    numbers: Vec<f64>,
    #[serde(flatten)]
    shrunk: &'a Shrunk,
}

/// A failure with a sentence that says who could have prevented it.
#[derive(Serialize)]
struct Fault<'a> {
    sentence: String,
    #[serde(flatten)]
    blamed: &'a Blamed,
}

impl Errand {
    /// Answers the question. The flag ends the work once it is set.
    pub fn answer(self, viewer: &Viewer<'_>, stop: Arc<AtomicBool>) -> Result<Answer, Error> {
        let study = viewer.study;
        let supervision = Supervision { stop, ..viewer.supervision.clone() };
        let log = (viewer.read)()?;
        let mut worker = Worker::until(study, supervision.clone())?;
        match self {
            Self::Shrink(wanted) => {
                let failing = wanted.run(&mut worker, &log, |_| ())?.0;
                let shrunk = Shrunk::until(&log, &failing, Sameness::Requirements, Shrunk::BUDGET, &supervision)?;
                let more = if shrunk.minimal { "" } else { "; more runs may find a simpler test" };
                Ok(json(&Simplest {
                    sentence: shrunk.sentence(),
                    search: format!("found in {}{more}", plural(shrunk.runs, "run")),
                    numbers: numbers_of(study.space(), &shrunk.trial.test),
                    shrunk: &shrunk,
                }))
            }
            Self::Blame(wanted) => {
                let inquiry = Inquiry::new(study, &REFERENCES)?.until(supervision.stop);
                let failing = wanted.run(&mut worker, &log, |_| ())?.0;
                let blamed = inquiry.judge_one(&failing)?;
                Ok(json(&Fault { sentence: blamed.sentence(), blamed: &blamed }))
            }
            Self::Cameras => {
                let cameras = cameras_for(viewer.cameras, &mut worker, None)?;
                Ok(json(&cameras.all.keys().collect::<Vec<_>>()))
            }
            Self::Film { test, camera } => {
                let trial = test.run(&mut worker, &log, |_| ())?.0;
                let mut cameras = cameras_for(viewer.cameras, &mut worker, Some(&trial.test))?;
                cameras.all.retain(|name, _| *name == camera);
                if cameras.all.is_empty() {
                    return Err(NoCamera { camera }.into());
                }
                Ok(Answer::Film(mp4(&mut worker, &trial, &cameras, &supervision.stop)?))
            }
        }
    }
}

/// Returns the cameras of a file with the settings of a test, or the cameras of the driver.
fn cameras_for(given: Option<&VariedCameras>, worker: &mut Worker, test: Option<&Values>) -> Result<Cameras, Error> {
    Ok(match (given, test) {
        (Some(given), Some(test)) => given.of_test(test),
        (Some(given), None) => given.nominal().clone(),
        (None, _) => cameras_of(worker)?,
    })
}
