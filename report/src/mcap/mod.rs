//! Writes a run as an MCAP file, which Foxglove and Rerun play.
//!
//! The messages have Foxglove's schemas: the frames of all bodies, the roads and bodies as a scene, camera images, the points of a LiDAR, and
//! events. Each signal has a topic of its own, and so has the margin of each requirement. Times are seconds since the run began. The same test
//! gives the same bytes, except for images, which depend on the graphics adapter.
//!
//! A file is not compressed: the compression of MCAP files needs a compiler for C, and no other part of this project needs one.

mod events;
mod images;
mod points;
mod recorder;
mod scene;
mod series;
mod tape;

pub use recorder::Recorder;
pub use tape::Unwritable;

use crate::record::{Film, Projector};
use images::Images;
use paracosm_campaign::files::Draft;
use paracosm_campaign::{Error, Study, Trial, Worker};
use paracosm_engine::sensor::Cameras;
use paracosm_oracles::Trace;
use paracosm_render::{Stages, WantedImages};
use paracosm_space::plural;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use tape::Tape;

/// The frame in which all roads and the poses of all bodies stand: x and y in the plane of the roads, z up.
const WORLD: &str = "world";

/// A test with the facts that its file shows.
#[derive(Debug, Clone, Copy)]
pub struct Recorded<'a> {
    /// The study of the test.
    pub study: &'a Study,
    /// The hash of the study, if it is known.
    pub hash: Option<&'a str>,
    /// The test with its verdict.
    pub trial: &'a Trial,
    /// The trace of the test; `None` if the run ended before it had one.
    pub trace: Option<&'a Trace>,
}

impl Recorded<'_> {
    /// Writes the file of a run that was recorded, with the images of the given cameras, for which the worker runs the test again. Returns lines of
    /// text that say what was written and which images are missing.
    ///
    /// # Errors
    /// There is nothing to write, a camera is not possible, there is no graphics adapter for its images, the test runs differently than it was
    /// logged, or the file cannot be written.
    pub fn write(
        &self,
        recorder: &Recorder,
        filmed: Option<(&mut Worker, &Cameras)>,
        path: &Path,
    ) -> Result<Vec<String>, Error> {
        if recorder.is_empty() && self.trace.is_none() {
            let index = self.trial.index;
            return Err(Unwritable::Nothing { index }.into());
        }
        // Nothing is written if there is nothing to draw with.
        let mut drawn = match filmed {
            None => None,
            Some((worker, cameras)) => {
                let projector = Projector::new(cameras, WantedImages { rgb: true, ..WantedImages::default() })?;
                Some((Film::of(worker, self.trial, cameras, &Stages::default())?, projector, cameras))
            }
        };
        let (draft, file) = Draft::new(path)?;
        let mut tape = Tape::begin(BufWriter::new(file), path)?;
        self.tell(recorder, &mut tape)?;
        let mut notes = Vec::new();
        if let Some((film, projector, cameras)) = &mut drawn {
            notes = Images { ego: recorder.ego(), tape: &mut tape }.of_all(film, projector, cameras)?;
        }
        let [messages, topics] = tape.counts();
        tape.end(&self.facts())?;
        draft.finish()?;
        let written = format!("{} on {} written to", plural(messages, "message"), plural(topics, "topic"));
        notes.insert(0, format!("{written} {}", path.display()));
        Ok(notes)
    }

    /// Writes all messages but images, in the order of their times.
    fn tell(&self, recorder: &Recorder, tape: &mut Tape<BufWriter<File>>) -> Result<(), Error> {
        scene::tell(recorder, tape)?;
        points::tell(recorder, tape)?;
        series::tell(self, tape)?;
        events::tell(self, recorder, tape)?;
        tape.flush()
    }

    /// Returns the facts about the test as names and texts.
    fn facts(&self) -> Vec<(String, String)> {
        let Self { study, hash, trial, .. } = self;
        let scenario = study.subject().scenario().map_or_else(|_| "system".to_owned(), |s| s.scenario().to_owned());
        let mut facts = vec![
            ("subject".to_owned(), scenario),
            ("test".to_owned(), trial.index.to_string()),
            ("verdict".to_owned(), trial.verdict.to_string()),
        ];
        facts.extend(hash.map(|hash| ("study".to_owned(), hash.to_owned())));
        facts.extend(trial.trace_hash.iter().map(|hash| ("trace".to_owned(), hash.clone())));
        let parameters = study.space().parameters().iter().zip(trial.test.iter());
        facts.extend(parameters.map(|(parameter, (name, value))| {
            let unit = parameter.unit.as_deref().unwrap_or_default();
            (format!("parameter {name}"), format!("{value} {unit}").trim_end().to_owned())
        }));
        facts.extend(trial.decided().map(|(id, robustness)| (format!("robustness {id}"), robustness.to_string())));
        facts
    }
}
