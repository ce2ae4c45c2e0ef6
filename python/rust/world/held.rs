//! Values of the library that belong to one thread. Any thread may get or drop a handle of Python, for example the garbage collector. Only the thread
//! that made the value reads it and drops it.

use crate::error::raised;
use fragile::Fragile;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A value that only the thread that made it can read. Any thread can clone and drop the handle.
pub struct Held<T: 'static>(Arc<Own<T>>);

impl<T> Clone for Held<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Held<T> {
    /// Holds a value for this thread.
    pub fn new(value: T) -> Self {
        Self(Arc::new(Own { value: Some(Fragile::new(value)), thread: thread() }))
    }

    /// Returns the value.
    ///
    /// # Errors
    /// Another thread made the value, so it belongs to the world of another test.
    pub fn get(&self) -> PyResult<&T> {
        self.0.value.as_ref().and_then(|value| value.try_get().ok()).ok_or_else(over)
    }
}

/// A value that is dropped in its own thread.
struct Own<T: 'static> {
    value: Option<Fragile<T>>,
    thread: u64,
}

impl<T> Drop for Own<T> {
    fn drop(&mut self) {
        if let Some(value) = self.value.take()
            && !value.is_valid()
        {
            let mut left = LEFT.lock().unwrap_or_else(PoisonError::into_inner);
            left.entry(self.thread).or_default().push(Box::new(value));
        }
    }
}

/// The values that other threads have left to their own threads. If a thread has ended, its values are never freed.
static LEFT: Mutex<BTreeMap<u64, Vec<Box<dyn Send>>>> = Mutex::new(BTreeMap::new());

/// Returns the number of this thread.
fn thread() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    thread_local!(static OWN: u64 = NEXT.fetch_add(1, Ordering::Relaxed));
    OWN.with(|own| *own)
}

/// Drops the values of this thread that other threads have left to it.
pub fn clear() {
    let own = LEFT.lock().unwrap_or_else(PoisonError::into_inner).remove(&thread());
    // A value may hold others, which look at the list again.
    drop(own);
}

/// The error that a function uses something of another world.
pub fn over() -> PyErr {
    raised(
        "this object belongs to the world of an earlier test, or was made outside of the function of the scenario: make all streams and statements \
         inside the function, and keep none",
    )
}
