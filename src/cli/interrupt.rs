//! Ctrl-C during a search that has a result at any moment: it ends the search, not the program.

use crate::coverage::Deadline;
use std::process;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

/// True if the search should stop. It is also true while no search runs: then Ctrl-C ends the program.
static STOPPED: AtomicBool = AtomicBool::new(true);

/// The exit status of a program that an interrupt ended, as shells count it: 128 and the number of SIGINT.
const INTERRUPTED: i32 = 130;

/// A search that the first Ctrl-C stops. The next Ctrl-C ends the program.
pub(super) struct Interruptible {
    /// The deadline at which the search returns its best result so far.
    pub deadline: Deadline,
}

impl Interruptible {
    /// Makes a search that stops at the deadline at the latest. There is at most one search at a time.
    pub fn new(deadline: Deadline) -> Self {
        static HANDLER: Once = Once::new();
        STOPPED.store(false, Ordering::Relaxed);
        HANDLER.call_once(|| {
            // Without a handler, an interrupt ends the program at once.
            let _ = ctrlc::set_handler(|| {
                if STOPPED.swap(true, Ordering::Relaxed) {
                    process::exit(INTERRUPTED);
                }
            });
        });
        Self { deadline: deadline.or_when(&STOPPED) }
    }

    /// Ends the search, and returns true if an interrupt had stopped the search.
    pub fn end(self) -> bool {
        STOPPED.swap(true, Ordering::Relaxed)
    }
}
