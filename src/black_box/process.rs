//! A process that answers lines with lines, and what becomes of it when it does not.
//!
//! Three threads stand between it and whoever waits, so that nothing that it does or leaves undone can hold up the
//! campaign for longer than the time-out: one writes to it, one reads its answers, one keeps the last of what it
//! complains of. It leads a process group of its own, which is killed as a whole: a shell takes its children with it.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The longest answer in bytes.
const LONGEST_ANSWER: u64 = 1 << 28;

/// How many of its last words are kept, in bytes.
const LAST_WORDS: usize = 400;

/// How often a process that says nothing is looked after.
const PATIENCE: Duration = Duration::from_millis(20);

/// How long what a process said before it ended may take to arrive.
const ARRIVAL: Duration = Duration::from_secs(1);

/// How long a process may take to end when it is asked nothing more.
const FAREWELL: Duration = Duration::from_millis(500);

/// What is read from a process.
enum Heard {
    Line(String),
    /// A line that is longer than any answer may be, or no text: what is wrong with it.
    Noise(String),
}

pub(super) struct Process {
    child: Child,
    questions: Option<Sender<Vec<u8>>>,
    heard: Receiver<Heard>,
    complaints: Arc<Mutex<VecDeque<u8>>>,
    listener: JoinHandle<()>,
    answered: bool,
}

impl Process {
    /// Starts the command of these words, of which there is at least one.
    pub fn start(words: &[String]) -> Result<Self, String> {
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let started = command.spawn();
        let mut child = started.map_err(|error| format!("cannot start the system `{}`: {error}", words[0]))?;
        let (mut stdin, stdout) = (child.stdin.take().expect("it is piped"), child.stdout.take().expect("it is piped"));
        let stderr = child.stderr.take().expect("it is piped");
        let (questions, asked) = mpsc::channel::<Vec<u8>>();
        // A process that does not listen is known by its silence; that a question was not heard says nothing more.
        thread::spawn(move || asked.iter().try_for_each(|question| stdin.write_all(&question)));
        let (speaker, heard) = mpsc::channel();
        thread::spawn(move || hear(stdout, &speaker));
        let complaints = Arc::new(Mutex::new(VecDeque::new()));
        let kept = complaints.clone();
        let listener = thread::spawn(move || keep_last(stderr, &kept));
        Ok(Self { child, questions: Some(questions), heard, complaints, listener, answered: false })
    }

    /// Whether it has answered anything.
    pub fn has_answered(&self) -> bool {
        self.answered
    }

    /// The line with which it answers a question, or why there is none. Nobody waits for it once `stop` is set.
    pub fn ask(&mut self, question: &[u8], timeout: Duration, stop: &AtomicBool) -> Result<String, String> {
        let asked = Instant::now();
        if let Some(questions) = &self.questions {
            // The thread that writes ends with the process, which is noticed below.
            let _ = questions.send(question.to_vec());
        }
        loop {
            let left = timeout.saturating_sub(asked.elapsed());
            match self.heard.recv_timeout(left.min(PATIENCE)) {
                Ok(heard) => return self.take(heard),
                Err(RecvTimeoutError::Disconnected) => return Err(self.obituary()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if stop.load(Ordering::Relaxed) {
                return Err("interrupted".into());
            }
            if asked.elapsed() >= timeout {
                return Err(format!("no answer within {} s", timeout.as_secs_f64()));
            }
            // Its children may hold its end of the pipe open.
            if self.status().is_some() {
                return match self.heard.recv_timeout(ARRIVAL) {
                    Ok(heard) => self.take(heard),
                    Err(_) => Err(self.obituary()),
                };
            }
        }
    }

    fn take(&mut self, heard: Heard) -> Result<String, String> {
        match heard {
            Heard::Line(line) => {
                self.answered = true;
                Ok(line)
            }
            Heard::Noise(noise) => Err(noise),
        }
    }

    fn status(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// How it ended without an answer.
    fn obituary(&mut self) -> String {
        // It closes its output a moment before it is known to have ended.
        let ended = wait_until(ARRIVAL, || self.status().is_some());
        let how = match self.status().filter(|_| ended) {
            Some(status) => format!("the system ended without an answer ({status})"),
            None => "the system closed its output without an answer".to_owned(),
        };
        self.end_group();
        wait_until(ARRIVAL, || self.listener.is_finished());
        let complaints = self.complaints.lock().unwrap_or_else(PoisonError::into_inner);
        let words = String::from_utf8_lossy(&complaints.iter().copied().collect::<Vec<u8>>()).into_owned();
        match words.trim() {
            "" => how,
            words => format!("{how}; its last words: {words}"),
        }
    }

    /// Ends it and all that it started, at once.
    pub fn kill(mut self) {
        self.end_group();
    }

    fn end_group(&mut self) {
        // Those that have ended already cannot be ended.
        #[cfg(unix)]
        let _ = rustix::process::kill_process_group(
            rustix::process::Pid::from_child(&self.child),
            rustix::process::Signal::KILL,
        );
        let _ = self.child.kill();
        let _ = self.child.wait();
        self.questions = None;
    }
}

/// A process that is not needed any more may end by itself before it is killed.
impl Drop for Process {
    fn drop(&mut self) {
        if self.questions.take().is_some() {
            wait_until(FAREWELL, || self.status().is_some());
            self.end_group();
        }
    }
}

/// Waits until something is so, but no longer than that; whether it is.
fn wait_until(longest: Duration, mut so: impl FnMut() -> bool) -> bool {
    let begun = Instant::now();
    while !so() {
        if begun.elapsed() >= longest {
            return false;
        }
        thread::sleep(Duration::from_millis(1));
    }
    true
}

/// Passes on what a process says line by line, until it says no more or nobody listens.
fn hear(stdout: impl Read, speaker: &Sender<Heard>) {
    let mut stdout = BufReader::new(stdout);
    loop {
        let mut bytes = Vec::new();
        let read = stdout.by_ref().take(LONGEST_ANSWER).read_until(b'\n', &mut bytes);
        if read.is_err() || bytes.is_empty() {
            return;
        }
        let heard = match String::from_utf8(bytes) {
            Ok(line) if line.ends_with('\n') => Heard::Line(line),
            Ok(line) if line.len() as u64 == LONGEST_ANSWER => Heard::Noise(format!(
                "found a line without an end, expected an answer of at most {LONGEST_ANSWER} bytes"
            )),
            // A last line without an end is what is left of an answer.
            Ok(_) => return,
            Err(_) => Heard::Noise("found bytes that are no UTF-8, expected an answer as JSON".to_owned()),
        };
        if speaker.send(heard).is_err() {
            return;
        }
    }
}

/// Keeps the last that a process complains of.
fn keep_last(mut stderr: impl Read, kept: &Mutex<VecDeque<u8>>) {
    let mut bytes = [0; 4096];
    while let Ok(count @ 1..) = stderr.read(&mut bytes) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&bytes[..count]);
        let surplus = kept.len().saturating_sub(LAST_WORDS);
        kept.drain(..surplus);
    }
}
