//! The threads that a function of Python keeps busy. Ctrl-C raises `KeyboardInterrupt` in them, so that it also ends a function that never
//! returns. Python itself only tells its main thread.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// The number of calls that each thread has begun and not ended, by its Python thread id.
static BUSY: Mutex<BTreeMap<u64, usize>> = Mutex::new(BTreeMap::new());

/// Calls a function of Python in this thread.
pub fn calling<T>(py: Python, call: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    let thread = own_thread(py)?;
    let count = |by: isize| {
        let mut busy = BUSY.lock().unwrap_or_else(PoisonError::into_inner);
        let calls = busy.entry(thread).or_default();
        *calls = calls.saturating_add_signed(by);
        if *calls == 0 {
            busy.remove(&thread);
        }
    };
    count(1);
    let called = call();
    count(-1);
    called
}

/// Forgets all threads. A thread of the process that was forked may hold the list for ever, and then the list stays as it is.
pub fn forget() {
    if let Ok(mut busy) = BUSY.try_lock() {
        busy.clear();
    }
}

/// Returns the Python thread id of this thread.
fn own_thread(py: Python) -> PyResult<u64> {
    static ASK: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let ask = ASK.get_or_try_init(py, || Ok::<_, PyErr>(py.import("threading")?.getattr("get_ident")?.unbind()))?;
    ask.bind(py).call0()?.extract()
}

/// Raises `KeyboardInterrupt` in all busy threads but this one.
///
/// # Errors
/// This Python cannot do so.
pub fn interrupt(py: Python) -> PyResult<()> {
    let threads: Vec<u64> = BUSY.lock().unwrap_or_else(PoisonError::into_inner).keys().copied().collect();
    let own = own_thread(py)?;
    let ctypes = py.import("ctypes")?;
    let raise = ctypes.getattr("pythonapi")?.getattr("PyThreadState_SetAsyncExc")?;
    let exception = ctypes.call_method1("py_object", (py.get_type::<pyo3::exceptions::PyKeyboardInterrupt>(),))?;
    for thread in threads.into_iter().filter(|thread| *thread != own) {
        raise.call1((ctypes.call_method1("c_ulong", (thread,))?, &exception))?;
    }
    Ok(())
}

/// Returns `true` in the main thread of Python.
///
/// # Errors
/// Python raises an error.
pub fn is_main_thread(py: Python) -> PyResult<bool> {
    let threading = py.import("threading")?;
    Ok(threading.call_method0("current_thread")?.is(&threading.call_method0("main_thread")?))
}
