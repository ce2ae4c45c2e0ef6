//! Signals that end the program: the first one stops the work that knows how to stop, another one ends the program.
//!
//! Ctrl-C, a request to end (SIGTERM) and the end of the terminal (SIGHUP) have the same effect. No process that the
//! program has started survives the program. A limit on the size of files gives an error instead of a signal.

use crate::coverage::Deadline;
use paracosm_campaign::end_all_processes;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The flags of the work that stops when its flag is set.
static FLAGS: Mutex<Vec<Arc<AtomicBool>>> = Mutex::new(Vec::new());

/// True if the search should stop. It is also true while no search runs.
static STOPPED: AtomicBool = AtomicBool::new(true);

/// Lets the next signal set `stop` instead of ending the program.
pub(super) fn on_interrupt(stop: Arc<AtomicBool>) {
    FLAGS.lock().unwrap_or_else(PoisonError::into_inner).push(stop);
}

/// Stops the work. If nothing is left that can be stopped, ends the program with the exit status that shells give to a
/// program that a signal has ended.
fn stop(signal: i32) {
    let flags = std::mem::take(&mut *FLAGS.lock().unwrap_or_else(PoisonError::into_inner));
    flags.iter().for_each(|flag| flag.store(true, Ordering::Relaxed));
    let was_searching = !STOPPED.swap(true, Ordering::Relaxed);
    if flags.is_empty() && !was_searching {
        end_all_processes();
        process::exit(128 + signal);
    }
}

/// Listens to signals. Without this a signal ends the program at once, but not the processes that it has started.
#[cfg(unix)]
pub(super) fn listen() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    // With a handler, a write beyond the limit is an error that names the file. The flag is not read.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let heard: Vec<i32> = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal)).collect();
    // If no thread can be started, signals end the program as they end other programs.
    if let Ok(mut signals) = Signals::new(heard) {
        let _ = std::thread::Builder::new().spawn(move || signals.forever().for_each(stop));
    }
}

/// Returns `true` if whoever started the program wants it to ignore a signal, as `nohup` does.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
pub(super) fn listen() {
    const SIGINT: i32 = 2;
    let _ = ctrlc::set_handler(|| stop(SIGINT));
}

/// A search that the first signal stops. The next signal ends the program.
pub(super) struct Interruptible {
    /// The deadline at which the search returns its best result so far.
    pub deadline: Deadline,
}

impl Interruptible {
    /// Makes a search that stops at the deadline at the latest. There is at most one search at a time.
    pub fn new(deadline: Deadline) -> Self {
        STOPPED.store(false, Ordering::Relaxed);
        Self { deadline: deadline.or_when(&STOPPED) }
    }

    /// Ends the search, and returns true if a signal had stopped the search.
    pub fn end(self) -> bool {
        STOPPED.swap(true, Ordering::Relaxed)
    }
}
