//! Systems that others wrote, each test a question to a process: one line of JSON in, one line of JSON out.
//!
//! `{"index":3,"test":{"throttle":[0.1,0.9],"brake":0}}` is asked, and answered with a trace
//! (`{"index":3,"trace":{"time":[0,0.1],"speed":[0,0.2]}}`), with the robustness of requirements
//! (`{"index":3,"robustness":{"stays-below":0.4}}`, negative where one is violated), or with an error
//! (`{"index":3,"error":"diverged"}`). `answer.rs` says what is accepted, `conversation.rs` talks to a process.
//!
//! A process that does not answer, answers something else or ends is killed with all that it started. A test is only
//! held against it if the process was new: what went wrong in one that had answered before may be the fault of its
//! past, which depends on who worked on what. So such a test is asked once more of a new process, and a system whose
//! answers depend on the test alone gives the same trials for any number of workers.

mod answer;
mod conversation;

pub use answer::{Answer, AnswerFlaw};
pub use conversation::NotStarted;

use crate::process::{self, CommandFlaw};
use crate::{Error, Problem, ProblemKind, Reason};
use conversation::Process;
use paracosm_space::Values;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use thiserror::Error;

/// A system that others wrote: the command that starts it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlackBox {
    /// The command, whose words are separated and quoted as in a shell.
    #[serde(rename = "system")]
    pub command: String,
    /// How long it may take to answer, in seconds.
    pub timeout: f64,
}

/// How long an answer may take where nothing is said, in seconds.
const TIMEOUT: f64 = 60.0;

/// The longest time-out in seconds: a year.
const LONGEST_TIMEOUT: f64 = 366.0 * 86400.0;

/// A time-out in seconds, the usual where nothing is said.
///
/// # Errors
/// It is no positive number of seconds.
pub fn checked_timeout(timeout: Option<f64>) -> Result<f64, TimeoutFlaw> {
    let seconds = timeout.unwrap_or(TIMEOUT);
    if seconds > 0.0 && seconds <= LONGEST_TIMEOUT { Ok(seconds) } else { Err(TimeoutFlaw { seconds }) }
}

/// A time-out that is none.
#[derive(Debug, Error)]
#[error("the time-out is {seconds}, expected a number of seconds above 0, at most a year")]
pub struct TimeoutFlaw {
    /// What was given.
    pub seconds: f64,
}

/// A command that starts no system.
#[derive(Debug, Error)]
#[error("--system '{command}': {flaw}")]
pub struct NoSystem {
    /// The command.
    pub command: String,
    /// What is wrong with it.
    pub flaw: CommandFlaw,
}

impl Reason for TimeoutFlaw {}
impl Reason for NoSystem {}

impl BlackBox {
    /// The system that is started with this command; it may take so many seconds for an answer, 60 where nothing is said.
    ///
    /// # Errors
    /// The command is empty or has a quote without an end; or the time is no positive number of seconds.
    pub fn new(command: &str, timeout: Option<f64>) -> Result<Self, Error> {
        let system = Self { command: command.to_owned(), timeout: checked_timeout(timeout)? };
        system.words()?;
        Ok(system)
    }

    fn words(&self) -> Result<Vec<String>, NoSystem> {
        process::words(&self.command).map_err(|flaw| NoSystem { command: self.command.clone(), flaw })
    }
}

/// A system with a process of its own.
pub struct Connection {
    words: Vec<String>,
    timeout: Duration,
    process: Option<Process>,
    stop: Arc<AtomicBool>,
}

impl Connection {
    /// A connection on which nothing is waited for any more once `stop` is set.
    ///
    /// # Errors
    /// The command was read from a file and is none.
    pub fn new(system: &BlackBox, stop: Arc<AtomicBool>) -> Result<Self, Error> {
        let system = BlackBox::new(&system.command, Some(system.timeout))?;
        let timeout = Duration::from_secs_f64(system.timeout);
        Ok(Self { words: system.words()?, timeout, process: None, stop })
    }

    /// Starts the process.
    ///
    /// # Errors
    /// It cannot be started: there is no such program, say.
    pub fn start(&mut self) -> Result<(), Error> {
        if self.process.is_none() {
            self.process = Some(Process::start(&self.words).map_err(Error::unavailable)?);
        }
        Ok(())
    }

    /// The answer to a test, or why there is none.
    pub fn ask(&mut self, index: usize, test: &Values) -> Result<Answer, Problem> {
        let mut question = serde_json::to_vec(&Question { index, test }).expect("a test is always JSON");
        question.push(b'\n');
        let has_past = self.process.as_ref().is_some_and(Process::has_answered);
        let answer = self.ask_process(index, &question);
        if answer.is_err() && has_past && !self.stop.load(Ordering::Relaxed) {
            return self.ask_process(index, &question);
        }
        answer
    }

    fn ask_process(&mut self, index: usize, question: &[u8]) -> Result<Answer, Problem> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => {
                Process::start(&self.words).map_err(|error| Problem::new(ProblemKind::Process, error.to_string()))?
            }
        };
        let read = |line: String| {
            Answer::read(&line, index).map_err(|flaw| Problem::new(ProblemKind::Answer, flaw.to_string()))
        };
        match process.ask(question, self.timeout, &self.stop).and_then(read) {
            Ok(answer) => {
                self.process = Some(process);
                Ok(answer)
            }
            Err(problem) => {
                process.kill();
                Err(problem)
            }
        }
    }
}

#[derive(Serialize)]
struct Question<'a> {
    index: usize,
    test: &'a Values,
}
