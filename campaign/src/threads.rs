//! A wrapper around the work of the threads that run tests. An interpreter attaches each thread once, and not at every question to a driver.

use std::fmt;
use std::sync::Arc;

/// A function that does the work of a thread, between what it does before and after.
type Around = dyn Fn(&mut (dyn FnMut() + Send)) + Send + Sync;

/// The function that wraps the work of each thread that runs tests. By default there is none.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::executor::{in_order, pool_of};
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    #[test]
    fn each_thread_works_within_what_the_program_does_around_it() {
        let (begun, ended) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let (begins, ends) = (begun.clone(), ended.clone());
        let threads = Threads::around(move |work| {
            begins.fetch_add(1, Ordering::SeqCst);
            work();
            ends.fetch_add(1, Ordering::SeqCst);
        });
        let mut results = Vec::new();
        let sink = |result| {
            results.push(result);
            Ok::<_, ()>(())
        };
        let pool = pool_of(3, &threads).unwrap();
        in_order(&pool, 0..100, || (), |(), i| Some(i), sink).unwrap();
        assert_eq!(results, (0..100).collect::<Vec<_>>());
        drop(pool);
        // A thread may begin after the others have done all the work, and the threads of a pool end after the pool is gone.
        let begin = Instant::now();
        while ended.load(Ordering::SeqCst) < 3 && begin.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!((begun.load(Ordering::SeqCst), ended.load(Ordering::SeqCst)), (3, 3));
    }
}
