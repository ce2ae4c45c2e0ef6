//! A process of somebody else's, and what becomes of it.
//!
//! It leads a process group of its own, which is ended as a whole: a shell takes its children with it. The last of what it
//! complains of is kept, for whoever has to say why it ended.

use crate::Reason;
use std::collections::VecDeque;
use std::io::{self, Read};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use thiserror::Error;

/// How many of its last words are kept, in bytes.
const LAST_WORDS: usize = 400;

/// How long what a process said before it ended may take to arrive.
pub const ARRIVAL: Duration = Duration::from_secs(1);

/// How long a process may take to end when it is asked nothing more.
const FAREWELL: Duration = Duration::from_millis(500);

/// A process with its standard streams in hand.
pub struct Process {
    child: Child,
    complaints: Arc<Mutex<VecDeque<u8>>>,
    listeners: Vec<JoinHandle<()>>,
}

impl Process {
    /// Starts the command of these words, of which there is at least one, with these additions to its environment.
    pub fn start(words: &[String], environment: &[(&str, String)]) -> io::Result<Self> {
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).envs(environment.iter().map(|(name, value)| (name, value)));
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let stderr = child.stderr.take().expect("it is piped");
        let mut process = Self { child, complaints: Arc::default(), listeners: Vec::new() };
        process.keep_last_of(stderr);
        Ok(process)
    }

    /// Its standard input, if nobody has taken it yet.
    pub fn stdin(&mut self) -> Option<ChildStdin> {
        self.child.stdin.take()
    }

    /// Its standard output, if nobody has taken it yet.
    pub fn stdout(&mut self) -> Option<ChildStdout> {
        self.child.stdout.take()
    }

    /// Keeps the last of what is read here among its last words.
    pub fn keep_last_of(&mut self, stream: impl Read + Send + 'static) {
        let kept = self.complaints.clone();
        self.listeners.push(thread::spawn(move || keep_last(stream, &kept)));
    }

    /// How it ended, if it has.
    pub fn status(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// How it ended, if it does so within a moment: it closes its streams before it is known to have ended.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        wait_until(ARRIVAL, || self.status().is_some());
        self.status()
    }

    /// What happened to it, with its last words. It is ended if it has not ended yet.
    pub fn post_mortem(&mut self, how: String) -> String {
        self.end();
        wait_until(ARRIVAL, || self.listeners.iter().all(JoinHandle::is_finished));
        let complaints = self.complaints.lock().unwrap_or_else(PoisonError::into_inner);
        let words = String::from_utf8_lossy(&complaints.iter().copied().collect::<Vec<u8>>()).into_owned();
        match words.trim() {
            "" => how,
            words => format!("{how}; its last words: {words}"),
        }
    }

    /// Ends it and all that it started, at once.
    pub fn end(&mut self) {
        // Those that have ended already cannot be ended.
        #[cfg(unix)]
        let _ = rustix::process::kill_process_group(
            rustix::process::Pid::from_child(&self.child),
            rustix::process::Signal::KILL,
        );
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A process that is not needed any more may end by itself, now that it is asked nothing more, before it is ended.
impl Drop for Process {
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        wait_until(FAREWELL, || self.status().is_some());
        self.end();
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

fn keep_last(mut stream: impl Read, kept: &Mutex<VecDeque<u8>>) {
    let mut bytes = [0; 4096];
    while let Ok(count @ 1..) = stream.read(&mut bytes) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&bytes[..count]);
        let surplus = kept.len().saturating_sub(LAST_WORDS);
        kept.drain(..surplus);
    }
}

/// What keeps a text from being a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CommandFlaw {
    /// A quote that is opened and not closed.
    #[error("a quote is not closed")]
    OpenQuote,
    /// No word, or an empty one.
    #[error("found no program, expected the command that starts it")]
    NoProgram,
}

impl Reason for CommandFlaw {}

/// The words of a command as a shell splits them.
///
/// # Errors
/// The text is no command.
pub fn words(command: &str) -> Result<Vec<String>, CommandFlaw> {
    let words = shell_words::split(command).map_err(|_| CommandFlaw::OpenQuote)?;
    if words.first().is_none_or(String::is_empty) {
        return Err(CommandFlaw::NoProgram);
    }
    Ok(words)
}
