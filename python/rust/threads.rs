//! The threads that work for the library: their stack, and their absence from a process that was forked. The threads of the library stay in the process that
//! made them, so work in a forked process that waited for them would never end.

use rayon::ThreadPoolBuilder;
use std::sync::atomic::{AtomicBool, Ordering};

/// The stack of a thread that works: as large as the stack of a main thread.
pub const STACK: usize = 8 << 20;

/// Is set in a process that was forked after the package was imported.
static IS_FORKED: AtomicBool = AtomicBool::new(false);

/// Notes that this process was forked.
pub fn note_fork() {
    IS_FORKED.store(true, Ordering::Relaxed);
}

/// Does some work, in a forked process with threads that are made for this work.
pub fn with_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if !IS_FORKED.load(Ordering::Relaxed) {
        return work();
    }
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    match pool(0).or_else(|_| pool(1)) {
        Ok(pool) => pool.install(work),
        // The system has no room for a thread. Most work needs none.
        Err(_) => work(),
    }
}
