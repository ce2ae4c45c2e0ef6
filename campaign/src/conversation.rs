//! Talks to a process that answers each line with a line.
//!
//! Two threads stand between the process and the campaign: one writes to the process, the other reads its answers.
//! Whatever the process does or fails to do, it cannot delay the campaign for longer than the time-out.

use crate::process::{self, ARRIVAL};
use crate::{Problem, ProblemKind, Reason, Supervision};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::ExitStatus;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// The longest answer in MiB.
const MOST_MEBIBYTES: u64 = 64;

/// The longest answer in bytes.
const LONGEST_ANSWER: u64 = MOST_MEBIBYTES << 20;

/// The number of lines that are read before they are asked for. A process that says more has to wait.
const AHEAD: usize = 1;

/// The time between two checks of a process that does not answer.
const PATIENCE: Duration = Duration::from_millis(20);

/// A line from a process, or an error in its output.
enum Heard {
    Line(String),
    Noise(Noise),
}

/// Output that cannot be an answer.
#[derive(Debug, Error)]
enum Noise {
    #[error("the answer is longer than {MOST_MEBIBYTES} MiB, which is the limit: leave out signals or samples")]
    TooLong,
    #[error("found bytes that are not UTF-8, expected an answer as JSON")]
    NoText,
}

/// The error that an external system or perceiver cannot be started.
#[derive(Debug, Error)]
#[error("cannot start the {role} `{program}`: {source}")]
pub struct NotStarted {
    /// The role of the program, such as "system".
    pub role: &'static str,
    /// The name of the program that cannot be started.
    pub program: String,
    /// The error that the operating system reported.
    pub source: io::Error,
}

impl Reason for NotStarted {}

/// A process that answers each question with a line.
pub(crate) struct Process {
    /// The role of the process in messages, such as "system".
    role: &'static str,
    // Dropped before the process, which may end by itself when no more questions can come.
    questions: Sender<Vec<u8>>,
    heard: Receiver<Heard>,
    process: process::Process,
    answered: bool,
}

impl Process {
    /// Starts the process of a command, which is a list of words that begins with the program. The list must not be
    /// empty. Messages call the process by its role.
    pub fn start(words: &[String], role: &'static str, supervision: &Supervision) -> Result<Self, NotStarted> {
        let started = process::Process::start(words, &[], supervision, role);
        let mut process = started.map_err(|source| NotStarted { role, program: words[0].clone(), source })?;
        let (mut stdin, stdout) = (process.stdin().expect("it is new"), process.stdout().expect("it is new"));
        let (questions, asked) = mpsc::channel::<Vec<u8>>();
        // A process that does not listen is noticed by its silence, so that an error in writing adds nothing.
        thread::spawn(move || asked.iter().try_for_each(|question| stdin.write_all(&question)));
        let (speaker, heard) = mpsc::sync_channel(AHEAD);
        thread::spawn(move || hear(stdout, &speaker));
        Ok(Self { role, questions, heard, process, answered: false })
    }

    /// Returns `true` if the process has answered at least once.
    pub fn has_answered(&self) -> bool {
        self.answered
    }

    /// Sends a question to the process and returns the line of the answer, or the reason why the answer is missing.
    /// Stops waiting once `stop` is set.
    pub fn ask(&mut self, question: &[u8], timeout: Duration, stop: &AtomicBool) -> Result<String, Problem> {
        let asked = Instant::now();
        // The thread that writes ends with the process, which is noticed below.
        let _ = self.questions.send(question.to_vec());
        loop {
            let left = timeout.saturating_sub(asked.elapsed());
            match self.heard.recv_timeout(left.min(PATIENCE)) {
                Ok(heard) => return self.take(heard),
                Err(RecvTimeoutError::Disconnected) => return Err(self.post_mortem()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if stop.load(Ordering::Relaxed) {
                return Err(Problem::new(ProblemKind::Interrupted, "interrupted"));
            }
            if asked.elapsed() >= timeout {
                return Err(Problem::timed_out(timeout));
            }
            // The children of the process may hold its end of the pipe open.
            if self.status().is_some() {
                return match self.heard.recv_timeout(ARRIVAL) {
                    Ok(heard) => self.take(heard),
                    Err(_) => Err(self.post_mortem()),
                };
            }
        }
    }

    fn take(&mut self, heard: Heard) -> Result<String, Problem> {
        match heard {
            Heard::Line(line) => {
                self.answered = true;
                Ok(line)
            }
            Heard::Noise(noise) => Err(Problem::new(ProblemKind::Answer, noise.to_string())),
        }
    }

    fn status(&mut self) -> Option<ExitStatus> {
        self.process.status()
    }

    /// Returns the problem of a process that ended without an answer.
    fn post_mortem(&mut self) -> Problem {
        let how = match self.process.ended() {
            Some(status) => format!("the {} ended without an answer ({status})", self.role),
            None => format!("the {} closed its output without an answer", self.role),
        };
        Problem::new(ProblemKind::Process, self.process.post_mortem(how))
    }

    /// Kills the process and all processes that it started.
    pub fn kill(mut self) {
        self.process.end();
    }
}

/// Passes on the output of a process line by line, until it ends or nobody listens any more.
fn hear(stdout: impl Read, speaker: &SyncSender<Heard>) {
    let mut stdout = BufReader::new(stdout);
    loop {
        let mut bytes = Vec::new();
        let read = stdout.by_ref().take(LONGEST_ANSWER).read_until(b'\n', &mut bytes);
        if read.is_err() || bytes.is_empty() {
            return;
        }
        let heard = match String::from_utf8(bytes) {
            Ok(line) if line.ends_with('\n') => Heard::Line(line),
            Ok(line) if line.len() as u64 == LONGEST_ANSWER => Heard::Noise(Noise::TooLong),
            // A last line without an end is part of an incomplete answer.
            Ok(_) => return,
            Err(_) => Heard::Noise(Noise::NoText),
        };
        if speaker.send(heard).is_err() {
            return;
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_process_that_says_more_than_it_was_asked_has_to_wait() {
        let dir = tempfile::tempdir().unwrap();
        let count = dir.path().join("count");
        let flood = "i=0; while [ $i -lt 5000 ]; do printf '%01000d\\n' $i; i=$((i + 1)); echo $i > \"$0\"; done";
        let words = ["sh", "-c", flood, count.to_str().unwrap()].map(str::to_owned);
        let process = Process::start(&words, "system", &Supervision::default()).unwrap();
        let said = || fs::read_to_string(&count).unwrap_or_default();
        // The process waits, or has ended, once the number stands still.
        let (mut before, mut now) = (String::new(), said());
        while now.is_empty() || now != before {
            thread::sleep(Duration::from_millis(300));
            (before, now) = (now, said());
        }
        let lines: usize = now.trim().parse().unwrap();
        assert!(lines < 1000, "{lines} lines of 1000 bytes were taken, though nobody asked");
        process.kill();
    }
}
