//! Holds the things that a campaign shares with everything that runs its tests: the flag that ends the tests, what its log
//! does not show, and for programs that it starts their folder and the place for their output.

use crate::doubts::Doubts;
use crate::threads::Threads;
use std::collections::HashMap;
use std::fmt;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The most bytes that wait for the folder of the campaign.
const MOST_WAITING: usize = 1 << 20;

/// The most bytes of a log.
const MOST_KEPT: usize = 64 << 20;

/// The flag that ends tests, the folder in which programs start, and the place for their output.
#[derive(Debug, Clone, Default)]
pub struct Supervision {
    /// Once the flag is set, nobody waits for a driver, a perceiver or a system, and runs end at the next question.
    pub stop: Arc<AtomicBool>,
    /// The place for the output of the programs that drive, perceive or answer tests.
    pub output: Output,
    /// The folder in which programs start; `None` for the folder of this process.
    pub folder: Option<PathBuf>,
    /// The function that wraps the work of each thread that runs tests.
    pub threads: Threads,
    /// The doubts about the programs of the campaign, which its log does not show.
    pub doubts: Doubts,
}

impl From<Arc<AtomicBool>> for Supervision {
    fn from(stop: Arc<AtomicBool>) -> Self {
        Self { stop, ..Self::default() }
    }
}

/// The place for what programs print that a campaign starts. Lines wait for a folder, up to 1 MiB of them.
///
/// A line is kept as a whole, whatever other programs print meanwhile.
#[derive(Clone, Default)]
pub struct Output(Arc<Mutex<Kept>>);

/// A function that gets the role of a program and a line of its output.
type Listener = dyn Fn(&str, &[u8]) + Send;

#[derive(Default)]
struct Kept {
    listener: Option<Box<Listener>>,
    /// The lines that wait for a folder, and the number of their bytes.
    waiting: Vec<(&'static str, Vec<u8>)>,
    bytes: usize,
    folder: Option<PathBuf>,
    /// The logs; `None` for a log that cannot be written.
    logs: HashMap<&'static str, Option<Log>>,
}

/// The log of the programs of one role.
struct Log {
    file: File,
    left: usize,
}

impl Output {
    /// Calls a function with the role of the program, such as "driver", and with each line that it prints.
    pub fn listen(&self, listener: impl Fn(&str, &[u8]) + Send + 'static) {
        self.kept().listener = Some(Box::new(listener));
    }

    /// Appends the output to `driver.log`, `perceiver.log` or `system.log` in this folder. A log ends after 64 MiB.
    pub fn keep_in(&self, folder: &Path) {
        let mut kept = self.kept();
        kept.folder = Some(folder.to_owned());
        for (role, line) in std::mem::take(&mut kept.waiting) {
            kept.log(role, &line);
        }
    }

    /// Takes a line that the program of a role has printed.
    pub(crate) fn take(&self, role: &'static str, line: &[u8]) {
        let mut kept = self.kept();
        if let Some(listener) = &kept.listener {
            listener(role, line);
        }
        if kept.folder.is_some() {
            kept.log(role, line);
        } else if kept.bytes < MOST_WAITING {
            kept.bytes += line.len();
            kept.waiting.push((role, line.to_owned()));
        }
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kept {
    /// Writes a line to the log of a role. A log that cannot be written ends no campaign: the tests do not depend on it.
    fn log(&mut self, role: &'static str, line: &[u8]) {
        let Some(folder) = &self.folder else { return };
        let opened = self.logs.entry(role).or_insert_with(|| Log::open(&folder.join(format!("{role}.log"))));
        let Some(log) = opened.as_mut().filter(|log| log.left > 0) else { return };
        log.left = log.left.saturating_sub(line.len());
        let rest: &[u8] = if log.left == 0 { b"\n(this log is full, and the rest is not kept)\n" } else { b"" };
        let _ = log.file.write_all(line).and_then(|()| log.file.write_all(rest));
    }
}

impl Log {
    /// Opens a log to append to it. A link could lead to a file of somebody else, and a pipe would wait for its reader.
    fn open(path: &Path) -> Option<Self> {
        let there = path.symlink_metadata().ok();
        if there.as_ref().is_some_and(|there| !there.is_file()) {
            return None;
        }
        let file = File::options().create(true).append(true).open(path).ok()?;
        let length = there.map_or(0, |there| usize::try_from(there.len()).unwrap_or(usize::MAX));
        Some(Self { file, left: MOST_KEPT.saturating_sub(length) })
    }
}

impl fmt::Debug for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Output").finish_non_exhaustive()
    }
}
