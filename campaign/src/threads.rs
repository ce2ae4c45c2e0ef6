//! The threads that run tests, as the program wants them. An interpreter attaches each thread once, and not at every question to a driver.

use std::fmt;
use std::sync::Arc;

/// A function that does the work of a thread, between what it does before and after.
type Around = dyn Fn(&mut (dyn FnMut() + Send)) + Send + Sync;

/// What happens around the work of each thread that runs tests. Usually nothing.
#[derive(Clone, Default)]
pub struct Threads(Option<Arc<Around>>);

impl Threads {
    /// Lets a function do the work of each thread. The function calls the work exactly once.
    pub fn around(work: impl Fn(&mut (dyn FnMut() + Send)) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(work)))
    }

    /// Does the work of a thread.
    pub(crate) fn work(&self, work: impl FnOnce() + Send) {
        let mut work = Some(work);
        let mut once = || work.take().into_iter().for_each(|work| work());
        match &self.0 {
            Some(around) => around(&mut once),
            None => once(),
        }
    }
}

impl fmt::Debug for Threads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Threads").field(&self.0.is_some()).finish()
    }
}
