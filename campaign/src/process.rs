//! Runs an external process, and finds out how it ended.
//!
//! The process leads a process group of its own, which is ended as a whole, so that the children of a shell end with
//! it. The last output of the process on its standard error is kept, for the message that says why the process ended.

use crate::{Output, Reason, Supervision};
use std::collections::VecDeque;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use thiserror::Error;

/// The number of bytes of the process's last words that are kept.
const LAST_WORDS: usize = 400;

/// The length in bytes from which a line of output is taken in parts.
const LONGEST_LINE: usize = 1 << 16;

/// The longest time that the last output of a process may take to arrive after the process ended.
pub const ARRIVAL: Duration = Duration::from_secs(1);

/// The longest time that a process may take to end by itself after its standard input is closed.
const FAREWELL: Duration = Duration::from_millis(500);

/// The ids of all processes that were started and not ended.
static RUNNING: Mutex<Vec<u32>> = Mutex::new(Vec::new());

/// Kills all processes that this software has started, with the processes that those have started, before this process
/// ends. From then on no process can be started. A process that has left its process group (`setsid`) survives.
pub fn end_all_processes() {
    let running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
    running.iter().for_each(|id| end_group(*id));
    // Whoever starts a process now waits until this process has ended.
    std::mem::forget(running);
}

/// Kills the processes of a group. Processes that have ended already cannot be killed.
fn end_group(leader: u32) {
    #[cfg(unix)]
    if let Some(group) = i32::try_from(leader).ok().and_then(rustix::process::Pid::from_raw) {
        let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
    }
    #[cfg(not(unix))]
    let _ = leader;
}

/// An external process with its standard streams.
pub struct Process {
    child: Child,
    complaints: Arc<Mutex<VecDeque<u8>>>,
    output: (Output, &'static str),
    listeners: Vec<JoinHandle<()>>,
}

impl Process {
    /// Starts the process of a command, with additional environment variables. The command is a list of words, which
    /// must not be empty and begins with the program. The standard error of the process goes to the place for output, under the role of the
    /// process.
    pub fn start(
        words: &[String],
        environment: &[(&str, String)],
        supervision: &Supervision,
        role: &'static str,
    ) -> io::Result<Self> {
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        let mut command = Command::new(program(&words[0], supervision.folder.as_deref()));
        command.args(&words[1..]).envs(environment.iter().map(|(name, value)| (name, value)));
        if let Some(folder) = &supervision.folder {
            command.current_dir(folder);
        }
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        running.push(child.id());
        drop(running);
        let stderr = child.stderr.take().expect("it is piped");
        let mut process = Self {
            child,
            complaints: Arc::default(),
            output: (supervision.output.clone(), role),
            listeners: Vec::new(),
        };
        process.keep_last_of(stderr);
        Ok(process)
    }

    /// Takes the standard input of the process; `None` if the standard input was taken before.
    pub fn stdin(&mut self) -> Option<ChildStdin> {
        self.child.stdin.take()
    }

    /// Takes the standard output of the process; `None` if the standard output was taken before.
    pub fn stdout(&mut self) -> Option<ChildStdout> {
        self.child.stdout.take()
    }

    /// Reads a stream of the process to the place of its output, and keeps the last bytes for messages about the end of the process.
    pub fn keep_last_of(&mut self, stream: impl Read + Send + 'static) {
        let (kept, output) = (self.complaints.clone(), self.output.clone());
        self.listeners.push(thread::spawn(move || keep_last(stream, &kept, &output)));
    }

    /// Returns the exit status of the process, if it has ended.
    pub fn status(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// Waits up to 1 s for the end of the process, and returns the exit status if the process has ended. A process
    /// closes its streams before its end is known.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        wait_until(ARRIVAL, || self.status().is_some());
        self.status()
    }

    /// Ends the process if it still runs, and returns the text `how` together with the last output of the process.
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

    /// Kills the process and all processes that it started.
    pub fn end(&mut self) {
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        // Once the process has been waited for, its number may be another process's.
        if let Some(place) = running.iter().position(|id| *id == self.child.id()) {
            running.swap_remove(place);
            end_group(self.child.id());
        }
        drop(running);
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Closes the standard input of a process that is no longer needed, gives it a moment to end by itself, then ends it, and
/// reads the rest of its output.
impl Drop for Process {
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        wait_until(FAREWELL, || self.status().is_some());
        self.end();
        wait_until(ARRIVAL, || self.listeners.iter().all(JoinHandle::is_finished));
    }
}

/// Waits until a condition holds, but no longer than `longest`; returns `true` if the condition holds.
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

/// Returns the path of a program that starts in a folder. A path with several parts begins in this folder, a single name is searched for.
fn program(word: &str, folder: Option<&Path>) -> PathBuf {
    match folder.filter(|_| Path::new(word).components().count() > 1) {
        Some(folder) => folder.join(word),
        None => PathBuf::from(word),
    }
}

fn keep_last(mut stream: impl Read, kept: &Mutex<VecDeque<u8>>, (output, role): &(Output, &'static str)) {
    let mut bytes = [0; 4096];
    let mut line = Vec::new();
    while let Ok(count @ 1..) = stream.read(&mut bytes) {
        for part in bytes[..count].split_inclusive(|byte| *byte == b'\n') {
            line.extend_from_slice(part);
            if line.ends_with(b"\n") || line.len() >= LONGEST_LINE {
                output.take(role, &std::mem::take(&mut line));
            }
        }
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&bytes[..count]);
        let surplus = kept.len().saturating_sub(LAST_WORDS);
        kept.drain(..surplus);
    }
    if !line.is_empty() {
        line.push(b'\n');
        output.take(role, &line);
    }
}

/// The reason why a text is not a valid command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CommandFlaw {
    /// A quote is opened and not closed.
    #[error("a quote is not closed")]
    OpenQuote,
    /// The command is empty, or its first word is empty.
    #[error("found no program, expected a command that starts a program")]
    NoProgram,
}

impl Reason for CommandFlaw {}

/// Splits a command into words as a shell does.
///
/// # Errors
/// The text is not a command.
pub fn words(command: &str) -> Result<Vec<String>, CommandFlaw> {
    let words = shell_words::split(command).map_err(|_| CommandFlaw::OpenQuote)?;
    if words.first().is_none_or(String::is_empty) {
        return Err(CommandFlaw::NoProgram);
    }
    Ok(words)
}
