//! Long work beside the interpreter: other threads of Python run meanwhile, and Ctrl-C ends the work.

use crate::busy;
use crate::ending::{self, Work};
use crate::threads::{STACK, with_threads};
use paracosm::campaign::Threads;
use pyo3::{PyResult, Python};
use std::panic;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// Is set while a search of a measure or of a strategy should end. Python tells only its main thread of Ctrl-C, so there is one flag.
pub static STOP: AtomicBool = AtomicBool::new(false);

/// The time between two looks at the signals of Python.
pub const LOOK: Duration = Duration::from_millis(50);

/// The time for which a function of Python may go on after Ctrl-C.
const PATIENCE: Duration = Duration::from_secs(1);

/// Does some work without the lock of the interpreter. If Python receives a signal with a handler that raises, such as Ctrl-C, the flag is
/// set, and the exception of the handler is raised once the work has ended.
///
/// # Errors
/// A handler of a signal raised an exception, or the system cannot start a thread.
pub fn detached<T: Send>(py: Python, stop: &AtomicBool, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    watched(py, stop, &mut |_| Ok(()), work)
}

/// Does some work as [`detached`] does, and calls `watch` some times in a second. An exception of `watch` ends the work, too.
///
/// # Errors
/// `watch` or a handler of a signal raised an exception, or the system cannot start a thread.
pub fn watched<T: Send>(
    py: Python,
    stop: &AtomicBool,
    watch: &mut (dyn FnMut(Python) -> PyResult<()> + Send),
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let _work = Work::begin(py)?;
    stop.store(false, Ordering::Relaxed);
    py.detach(|| {
        thread::scope(|scope| {
            let (end, ended) = mpsc::channel::<()>();
            let worker = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, move || {
                let result = with_threads(work);
                drop(end);
                result
            })?;
            let mut raised = None;
            let mut waited = Duration::ZERO;
            while ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                // The first exception counts.
                if raised.is_none()
                    && let Err(error) = Python::attach(|py| {
                        ending::check(py).and_then(|()| py.check_signals()).and_then(|()| watch(py))
                    })
                {
                    raised = Some(error);
                }
                // Other work may have taken the flag back meanwhile.
                if raised.is_some() {
                    stop.store(true, Ordering::Relaxed);
                    waited += LOOK;
                }
                // A function of Python that does not return by itself is interrupted.
                if waited >= PATIENCE {
                    waited = Duration::ZERO;
                    let _ = Python::attach(busy::interrupt);
                }
            }
            let result = worker.join().unwrap_or_else(|payload| panic::resume_unwind(payload));
            // A signal may have come after the last look, and have ended the work.
            let late = || Python::attach(|py| ending::check(py).and_then(|()| py.check_signals()));
            raised.map_or_else(|| late().map(|()| result), Err)
        })
    })
}

/// Lets each thread that runs tests know the interpreter from its beginning. Otherwise every question to a driver of Python, and every world of
/// a test, would make the thread known anew.
pub fn attached() -> Threads {
    Threads::around(|work| Python::attach(|py| py.detach(work)))
}
