//! A perceiver in a process of its own: a question is a line of JSON followed by the pixels of images, and the answer is
//! one line of JSON.
//!
//! The process is asked `{"hello":1}` first, and says what its answers mean: `{"classes":["car","person"]}` for a
//! detector, `{"segments":["road","road_line"]}` for a segmentation network. Images come as
//! `{"images":2,"width":640,"height":480}`, then red, green and blue of each pixel. The answer has one entry for each
//! image: `{"answers":[{"boxes":[{"class":"car","score":0.9,"box":[12,40,30,20]}]},{"boxes":[]}]}`, with left, top,
//! width and height in pixels, or `{"answers":[{"mask":[3,2,5]},..]}` with the lengths of runs of pixels in turns, the
//! first run outside of the mask. `{"error":"..."}` says why there is no answer.

use crate::conversation::Process;
use crate::{Error, Problem, ProblemKind, Supervision};
use paracosm_perception::{
    Detection, Detector, Extent, Group, Mask, Perceiver, PerceiverError, Percept, Picture, Rect, Segmenter, Task,
};
use paracosm_space::{did_you_mean, nearest};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The version of the questions and answers.
const PROTOCOL: u32 = 1;

/// The role of the process in messages.
const ROLE: &str = "perceiver";

/// A perceiver in a process of its own. The process is started when it is asked first.
pub(crate) struct SeeingProcess {
    words: Vec<String>,
    timeout: Duration,
    supervision: Supervision,
    task: Task,
    process: Option<Process>,
}

#[derive(Serialize)]
struct Hello {
    hello: u32,
}

/// The announcement of images of one size, whose pixels follow.
#[derive(Serialize)]
struct Announced {
    images: usize,
    width: u32,
    height: u32,
}

/// The meaning of the answers, as the process says it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the meaning of the answers")]
struct Meaning {
    classes: Option<Vec<String>>,
    threshold: Option<f64>,
    overlap: Option<f64>,
    extent: Option<Extent>,
    groups: Option<Vec<Group>>,
    segments: Option<Vec<String>>,
    error: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "answers to images")]
struct Answered {
    answers: Option<Vec<OneAnswer>>,
    error: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", expecting = "an answer to an image, `boxes` or `mask`")]
enum OneAnswer {
    Boxes(Vec<OneBox>),
    Mask(Vec<usize>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a box")]
struct OneBox {
    class: String,
    score: f64,
    /// Left, top, width and height in pixels.
    r#box: [f64; 4],
}

impl SeeingProcess {
    /// Starts the process of a command, and asks for the meaning of the answers. Stops waiting once `stop` is set.
    ///
    /// # Errors
    /// The process cannot be started, does not say what its answers mean, or says what makes no sense.
    pub fn meaning(words: &[String], timeout: Duration, supervision: &Supervision) -> Result<Task, Error> {
        let mut process = Process::start(words, ROLE, supervision).map_err(Error::unavailable)?;
        Ok(introduced(&mut process, timeout, &supervision.stop).map_err(Failed)?)
    }

    /// Makes a perceiver whose answers have the given meaning.
    pub fn new(words: Vec<String>, timeout: Duration, supervision: Supervision, task: Task) -> Self {
        Self { words, timeout, supervision, task, process: None }
    }

    /// Starts the process if it does not run, and asks it.
    fn ask(&mut self, question: &[u8], pictures: &[Picture<'_>]) -> Result<Vec<Percept>, Problem> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => {
                let started = Process::start(&self.words, ROLE, &self.supervision);
                let mut process = started.map_err(|error| Problem::new(ProblemKind::Process, error.to_string()))?;
                if introduced(&mut process, self.timeout, &self.supervision.stop)? != self.task {
                    let message = "the perceiver says another meaning of its answers than when the campaign began";
                    return Err(Problem::new(ProblemKind::Answer, message));
                }
                process
            }
        };
        let heard = process.ask(question, self.timeout, &self.supervision.stop);
        match heard.and_then(|line| read_percepts(&line, &self.task, pictures)) {
            Ok(percepts) => {
                self.process = Some(process);
                Ok(percepts)
            }
            Err(problem) => {
                process.kill();
                Err(problem)
            }
        }
    }
}

impl Perceiver for SeeingProcess {
    fn task(&self) -> &Task {
        &self.task
    }

    /// An error of a process that has answered earlier images may be due to them. So these images are shown once more to
    /// a new process.
    fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError> {
        let Some(Picture { width, height, .. }) = pictures.first() else { return Ok(Vec::new()) };
        let announced = Announced { images: pictures.len(), width: *width, height: *height };
        let mut question = line(&announced);
        pictures.iter().for_each(|picture| question.extend_from_slice(picture.rgb));
        let has_past = self.process.is_some();
        let mut answered = self.ask(&question, pictures);
        if let Err(first) = &answered
            && has_past
            && !self.supervision.stop.load(Ordering::Relaxed)
        {
            let first = first.message.clone();
            answered = self.ask(&question, pictures);
            if answered.is_ok() {
                self.supervision.doubts.recover_images(&first);
            }
        }
        answered.map_err(|problem| PerceiverError::Failed(Arc::new(problem)))
    }
}

/// The error that a perceiver does not say what its answers mean.
#[derive(Debug, thiserror::Error)]
#[error("--perceiver-command: {0}")]
struct Failed(Problem);

impl crate::Reason for Failed {}

fn line(question: &impl Serialize) -> Vec<u8> {
    let mut line = serde_json::to_vec(question).expect("a question is always JSON");
    line.push(b'\n');
    line
}

/// Asks a new process what its answers mean.
fn introduced(process: &mut Process, timeout: Duration, stop: &AtomicBool) -> Result<Task, Problem> {
    read_meaning(&process.ask(&line(&Hello { hello: PROTOCOL }), timeout, stop)?)
}

/// Reads the answer to `hello`: the meaning of the answers to images.
///
/// # Errors
/// The line is not such an answer, or the meaning makes no sense.
pub fn read_meaning(line: &str) -> Result<Task, Problem> {
    let Meaning { classes, threshold, overlap, extent, groups, segments, error } = parsed(line)?;
    let wrong = |message: String| Problem::new(ProblemKind::Answer, message);
    match (classes, segments, error) {
        (_, _, Some(error)) => Err(wrong(format!("the perceiver refuses: {error}"))),
        (Some(classes), None, None) => {
            let usual = Detector::of(classes);
            let detector = Detector {
                threshold: threshold.unwrap_or(usual.threshold),
                overlap: overlap.unwrap_or(usual.overlap),
                extent: extent.unwrap_or(usual.extent),
                groups: groups.unwrap_or_else(|| usual.groups.clone()),
                ..usual
            };
            detector.check().map_err(|flaw| wrong(format!("the perceiver says that {flaw}")))?;
            Ok(Task::Detection(detector))
        }
        (None, Some(is), None) => Ok(Task::Segmentation(Segmenter { is })),
        _ => Err(wrong("found an answer to `hello` without a meaning, expected either `classes` or `segments`".into())),
    }
}

/// Reads a line of JSON.
fn parsed<'a, T: Deserialize<'a>>(line: &'a str) -> Result<T, Problem> {
    serde_json::from_str(line).map_err(|error| {
        let begin: String = line.trim_end().chars().take(40).collect();
        Problem::new(
            ProblemKind::Answer,
            format!("found `{begin}` from the perceiver, expected one line of JSON ({error})"),
        )
    })
}

/// Reads the answer to images of a perceiver with the given task: a percept for each image. [`Task::check`] checks the
/// percepts of all perceivers.
///
/// # Errors
/// The line is not such an answer, has another number of percepts than images, names an unknown class, or has a mask of
/// another size than its image.
pub fn read_percepts(line: &str, task: &Task, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, Problem> {
    let wrong = |message: String| Problem::new(ProblemKind::Answer, message);
    let answers = match parsed(line)? {
        Answered { error: Some(error), .. } => return Err(wrong(format!("the perceiver has no answer: {error}"))),
        Answered { answers: Some(answers), error: None } => answers,
        Answered { .. } => {
            return Err(wrong("found an answer without `answers`, expected one entry for each image".into()));
        }
    };
    // A mask takes as much memory as its image has pixels, so answers to no image are refused before they are read.
    let (found, expected) = (answers.len(), pictures.len());
    if found != expected {
        return Err(wrong(PerceiverError::Count { found, expected }.to_string()));
    }
    let classes = match task {
        Task::Detection(detector) => detector.classes.as_slice(),
        Task::Segmentation(_) => &[],
    };
    let one = |found: OneBox| {
        let [left, top, width, height] = found.r#box;
        let class = classes.iter().position(|class| *class == found.class).ok_or_else(|| {
            let meant = did_you_mean(&nearest(&found.class, classes.iter().map(String::as_str)));
            wrong(format!("a box has the class `{}`, expected one of {}{meant}", found.class, classes.join(", ")))
        })?;
        Ok(Detection { class, score: found.score, rect: Rect { left, top, width, height } })
    };
    let percept = |(picture, answer): (&Picture<'_>, OneAnswer)| match answer {
        OneAnswer::Boxes(boxes) => Ok(Percept::Boxes(boxes.into_iter().map(one).collect::<Result<_, Problem>>()?)),
        OneAnswer::Mask(runs) => {
            let pixels = picture.width as usize * picture.height as usize;
            let found = runs.iter().try_fold(0usize, |sum, run| sum.checked_add(*run));
            if found != Some(pixels) {
                let found = found.map_or("too many".to_owned(), |found| found.to_string());
                return Err(wrong(format!("the runs of a mask have {found} pixels, expected {pixels}")));
            }
            let mut mask = Vec::with_capacity(pixels);
            runs.iter().enumerate().for_each(|(turn, run)| mask.extend(std::iter::repeat_n(turn % 2 == 1, *run)));
            Ok(Percept::Mask(Mask { width: picture.width, height: picture.height, pixels: mask }))
        }
    };
    pictures.iter().zip(answers).map(percept).collect()
}
