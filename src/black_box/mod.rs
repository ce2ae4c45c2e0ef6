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

pub(crate) use answer::Answer;

use crate::{Error, process};
use conversation::Process;
use paracosm_coverage::Values;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

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
pub(crate) fn checked_timeout(timeout: Option<f64>) -> Result<f64, Error> {
    let timeout = timeout.unwrap_or(TIMEOUT);
    if timeout > 0.0 && timeout <= LONGEST_TIMEOUT {
        return Ok(timeout);
    }
    let message = format!("the time-out is {timeout}, expected a number of seconds above 0, at most a year");
    Err(Error::Usage(message))
}

impl BlackBox {
    /// The system that is started with this command; it may take so many seconds for an answer, 60 where nothing is said.
    ///
    /// # Errors
    /// The command is empty or has a quote without an end; or the time is no positive number of seconds.
    pub fn new(command: &str, timeout: Option<f64>) -> Result<Self, Error> {
        let timeout = checked_timeout(timeout)?;
        let system = Self { command: command.to_owned(), timeout };
        system.words().map(|_| system)
    }

    fn words(&self) -> Result<Vec<String>, Error> {
        process::words(&self.command).map_err(|what| Error::Usage(format!("--system '{}': {what}", self.command)))
    }
}

/// A system with a process of its own.
pub(crate) struct Connection {
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
            self.process = Some(Process::start(&self.words).map_err(Error::Usage)?);
        }
        Ok(())
    }

    /// The answer to a test, or why there is none.
    pub fn ask(&mut self, index: usize, test: &Values) -> Result<Answer, String> {
        let mut question = serde_json::to_vec(&Question { index, test }).expect("a test is always JSON");
        question.push(b'\n');
        let has_past = self.process.as_ref().is_some_and(Process::has_answered);
        let answer = self.ask_process(index, &question);
        if answer.is_err() && has_past && !self.stop.load(Ordering::Relaxed) {
            return self.ask_process(index, &question);
        }
        answer
    }

    fn ask_process(&mut self, index: usize, question: &[u8]) -> Result<Answer, String> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => Process::start(&self.words)?,
        };
        let answer = process.ask(question, self.timeout, &self.stop);
        match answer.and_then(|line| Answer::read(&line, index)) {
            Ok(answer) => {
                self.process = Some(process);
                Ok(answer)
            }
            Err(message) => {
                process.kill();
                Err(message)
            }
        }
    }
}

#[derive(Serialize)]
struct Question<'a> {
    index: usize,
    test: &'a Values,
}
