//! The end of the interpreter waits until the work of other threads has stopped. If a thread of Rust calls the interpreter after its end, the process
//! crashes.

use crate::{busy, threads};
use pyo3::exceptions::PySystemExit;
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Is set once the interpreter is about to end.
static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// The number of tasks in progress.
static WORKS: AtomicUsize = AtomicUsize::new(0);

/// The longest wait at the end for work that does not stop.
const PATIENCE: Duration = Duration::from_secs(10);

/// The time for which a function of Python may go on at the end.
const INTERRUPT: Duration = Duration::from_secs(1);

/// A task in progress, for which the end of the interpreter waits.
pub struct Work(());

impl Work {
    /// Registers the task of a thread of Rust, which looks at [`has_begun`] by itself.
    pub fn of_thread() -> Self {
        WORKS.fetch_add(1, Ordering::SeqCst);
        Self(())
    }

    /// Registers a task.
    ///
    /// # Errors
    /// The interpreter is about to end.
    pub fn begin(py: Python) -> PyResult<Self> {
        check(py)?;
        WORKS.fetch_add(1, Ordering::SeqCst);
        Ok(Self(()))
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        WORKS.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Returns `true` once the interpreter is about to end.
pub fn has_begun() -> bool {
    IS_ENDING.load(Ordering::SeqCst)
}

/// Checks that this thread may go on working. The end of the interpreter stops the work of all threads but the main thread.
///
/// # Errors
/// The interpreter is about to end.
pub fn check(py: Python) -> PyResult<()> {
    if IS_ENDING.load(Ordering::SeqCst) && !busy::is_main_thread(py)? {
        return Err(PySystemExit::new_err(()));
    }
    Ok(())
}

/// Stops the work of other threads, and waits for it. Python calls it before the interpreter ends.
#[pyfunction]
fn stop(py: Python) {
    IS_ENDING.store(true, Ordering::SeqCst);
    let begun = Instant::now();
    let mut next = INTERRUPT;
    while WORKS.load(Ordering::SeqCst) > 0 && begun.elapsed() < PATIENCE {
        py.detach(|| thread::sleep(Duration::from_millis(5)));
        // A function of Python that does not return by itself is interrupted.
        if begun.elapsed() >= next {
            next += INTERRUPT;
            let _ = busy::interrupt(py);
        }
    }
}

/// Forgets the work of the process that was forked: its threads do not exist in the new process.
#[pyfunction]
fn forget() {
    WORKS.store(0, Ordering::SeqCst);
    busy::forget();
    threads::note_fork();
}

/// Lets Python stop the work of other threads at its end.
///
/// # Errors
/// Python raises an error.
pub fn register(module: &Bound<PyModule>) -> PyResult<()> {
    let py = module.py();
    let stop = wrap_pyfunction!(stop, py)?;
    if let Some(at_fork) = py.import("os")?.getattr_opt("register_at_fork")? {
        at_fork.call((), Some(&[("after_in_child", wrap_pyfunction!(forget, py)?)].into_py_dict(py)?))?;
    }
    // `concurrent.futures` ends its threads in the same way: before any function of `atexit`, and so while the folders of the work still exist.
    let early = py.import("threading")?.call_method1("_register_atexit", (&stop,));
    early.or_else(|_| py.import("atexit")?.call_method1("register", (stop,))).map(drop)
}
