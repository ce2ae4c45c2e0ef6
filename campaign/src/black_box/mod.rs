//! Tests external systems. Each test is a question to a process: one line of JSON in, one line of JSON out. A system may also be a
//! function of this process (`here.rs`).
//!
//! The question is `{"index":3,"test":{"throttle":[0.1,0.9],"brake":0}}`. The answer is a trace
//! (`{"index":3,"trace":{"time":[0,0.1],"speed":[0,0.2]}}`), the robustness of requirements
//! (`{"index":3,"robustness":{"stays-below":0.4}}`, negative if a requirement is violated), or an error
//! (`{"index":3,"error":"diverged"}`). `answer.rs` checks the answers, and `conversation.rs` of the crate talks to a process.
//!
//! A process that does not answer, gives a wrong answer or ends is killed with everything that it started. An error
//! counts against a test only if the process was new: an error in a process that answered before may be due to earlier
//! tests, which depend on the distribution of the work. Such a test is asked once more of a new process. A system whose
//! answers depend only on the test thus gives the same trials for any number of workers.

mod answer;
mod here;

pub use answer::{Answer, AnswerFlaw};
pub use here::NotHere;

use here::Here;

use crate::conversation::Process;
use crate::process::{self, CommandFlaw};
use crate::{Error, Problem, ProblemKind, Reason, Supervision};
use paracosm_space::Values;
use serde::Serialize;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use thiserror::Error;

/// An external system under test, which a command starts, or which is a function of this process.
#[derive(Debug, Clone, PartialEq)]
pub struct BlackBox {
    /// The command that starts the system, with words separated and quoted as in a shell; or the name of a function of this process.
    pub command: String,
    /// The time that the system may take to answer, in seconds. A function of this process may take any time.
    pub timeout: f64,
    /// The function, if the system is one.
    here: Option<Here>,
}

/// The role of the process in messages.
const ROLE: &str = "system";

/// The default time-out of an answer, in seconds.
const TIMEOUT: f64 = 60.0;

/// The longest time-out in seconds: a year.
const LONGEST_TIMEOUT: f64 = 366.0 * 86400.0;

/// Returns the given time-out in seconds after a check, or the default time-out of 60 s for `None`.
///
/// # Errors
/// The time-out is not a positive number of seconds, or is longer than a year.
pub fn checked_timeout(timeout: Option<f64>) -> Result<f64, TimeoutFlaw> {
    let seconds = timeout.unwrap_or(TIMEOUT);
    if seconds > 0.0 && seconds <= LONGEST_TIMEOUT { Ok(seconds) } else { Err(TimeoutFlaw { seconds }) }
}

/// The error that a time-out is out of range.
#[derive(Debug, Error)]
#[error("the time-out is {seconds} s, expected more than 0 s and at most a year")]
pub struct TimeoutFlaw {
    /// The given time-out, in seconds.
    pub seconds: f64,
}

/// The error that the command of an external system is invalid.
#[derive(Debug, Error)]
#[error("--system '{command}': {flaw}")]
pub struct NoSystem {
    /// The invalid command.
    pub command: String,
    /// The error in the command.
    pub flaw: CommandFlaw,
}

impl Reason for TimeoutFlaw {}
impl Reason for NoSystem {}

impl BlackBox {
    /// Makes an external system that the given command starts, with a time-out per answer in seconds (60 by default).
    ///
    /// # Errors
    /// The command is empty or has a quote without an end; or the time-out is not positive or longer than a year.
    pub fn new(command: &str, timeout: Option<f64>) -> Result<Self, Error> {
        let system = Self { command: command.to_owned(), timeout: checked_timeout(timeout)?, here: None };
        system.words()?;
        Ok(system)
    }

    /// Makes a system of this process: `answer` gets the index of a test and the test, and returns a trace, the robustness of requirements, or the
    /// reason why it cannot run the test. Several threads call it at the same time. Its answer should depend on the test alone.
    ///
    /// ```
    /// use paracosm_campaign::{Answer, BlackBox, Campaign, Study};
    /// use paracosm_space::Space;
    ///
    /// let system = BlackBox::own("disc", |_, test| {
    ///     let x = test.get("x1").and_then(|x| x.number()).unwrap_or(0.0);
    ///     Answer::of_robustness(vec![("inside".into(), x - 0.25)])
    /// });
    /// let study = Study::of_system(system, Space::unit_cube(1)).budget(20).build()?;
    /// let log = Campaign::new(&study)?.into_log()?;
    /// assert_eq!(log.trials().iter().filter(|trial| trial.is_failure()).count(), 5);
    /// # Ok::<(), paracosm_campaign::Error>(())
    /// ```
    pub fn own(
        name: &str,
        answer: impl Fn(usize, &Values) -> Result<Answer, AnswerFlaw> + Send + Sync + 'static,
    ) -> Self {
        Self { command: name.to_owned(), timeout: TIMEOUT, here: Some(Here::new(answer)) }
    }

    /// Makes the system that a file names. A function of another process cannot run tests.
    pub(crate) fn of_file(command: String, timeout: f64, is_function: bool) -> Self {
        Self { command, timeout, here: is_function.then(Here::default) }
    }

    /// Returns `true` if the system is a function, and not the process of a command.
    pub fn is_function(&self) -> bool {
        self.here.is_some()
    }

    fn words(&self) -> Result<Vec<String>, NoSystem> {
        process::words(&self.command).map_err(|flaw| NoSystem { command: self.command.clone(), flaw })
    }
}

/// A connection to an external system, which runs in a separate process or is a function of this process.
pub struct Connection {
    here: Option<(String, Here)>,
    words: Vec<String>,
    timeout: Duration,
    process: Option<Process>,
    supervision: Supervision,
}

impl Connection {
    /// Makes a connection to an external system; the connection stops waiting for answers once the campaign is stopped.
    ///
    /// # Errors
    /// The system was read from a file, and its command or its time-out is invalid.
    pub fn new(system: &BlackBox, supervision: Supervision) -> Result<Self, Error> {
        let timeout = Duration::from_secs_f64(checked_timeout(Some(system.timeout))?);
        if let Some(here) = &system.here {
            here.check(&system.command)?;
            let here = Some((system.command.clone(), here.clone()));
            return Ok(Self { here, words: Vec::new(), timeout, process: None, supervision });
        }
        Ok(Self { here: None, words: system.words()?, timeout, process: None, supervision })
    }

    /// Starts the process of the external system, if the process does not run yet.
    ///
    /// # Errors
    /// The process cannot be started, for example because the program does not exist.
    pub fn start(&mut self) -> Result<(), Error> {
        if self.process.is_none() && self.here.is_none() {
            self.process = Some(Process::start(&self.words, ROLE, &self.supervision).map_err(Error::unavailable)?);
        }
        Ok(())
    }

    /// Sends a test to the system and returns the answer, or the problem if the answer is missing or invalid.
    pub fn ask(&mut self, index: usize, test: &Values) -> Result<Answer, Problem> {
        if let Some((name, here)) = &self.here {
            return here.ask(name, index, test);
        }
        let mut question = serde_json::to_vec(&Question { index, test }).expect("a test is always JSON");
        question.push(b'\n');
        let has_past = self.process.as_ref().is_some_and(Process::has_answered);
        match self.ask_process(index, &question) {
            Err(first) if has_past && !self.supervision.stop.load(Ordering::Relaxed) => {
                let answer = self.ask_process(index, &question);
                if let Ok(Answer::Trace(_) | Answer::Robustness(_)) = &answer {
                    self.supervision.doubts.recover(index, &first.message);
                }
                answer
            }
            answer => answer,
        }
    }

    fn ask_process(&mut self, index: usize, question: &[u8]) -> Result<Answer, Problem> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => Process::start(&self.words, ROLE, &self.supervision)
                .map_err(|error| Problem::new(ProblemKind::Process, error.to_string()))?,
        };
        let asked = Instant::now();
        let read = |line: String| {
            let answer = Answer::read(&line, index);
            // The time-out covers the reading of the answer, too.
            if asked.elapsed() >= self.timeout {
                return Err(Problem::timed_out(self.timeout));
            }
            answer.map_err(|flaw| Problem::new(ProblemKind::Answer, flaw.to_string()))
        };
        match process.ask(question, self.timeout, &self.supervision.stop).and_then(read) {
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
