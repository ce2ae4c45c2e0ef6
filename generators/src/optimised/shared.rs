//! The best set of points so far, which the threads of a search share.

use crate::seeded::{Purpose, seeded};
use rand_pcg::Pcg64;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

/// The best set so far, with the value of its measure.
pub(super) struct Shared<'a, T> {
    best: Mutex<(T, f64)>,
    /// The function that hears of each better value.
    watch: &'a (dyn Fn(f64) + Sync),
}

impl<'a, T: Clone + Send> Shared<'a, T> {
    /// Makes the first set the best one.
    pub fn new(first: T, value: f64, watch: &'a (dyn Fn(f64) + Sync)) -> Self {
        Self { best: Mutex::new((first, value)), watch }
    }

    /// Returns the best set and its value.
    pub fn best(&self) -> (T, f64) {
        self.locked().clone()
    }

    /// Returns the value of the best set.
    pub fn value(&self) -> f64 {
        self.locked().1
    }

    /// Keeps a set if its value is less than the best value by more than a margin. Another thread may have found a better set meanwhile.
    pub fn improve(&self, value: f64, margin: f64, set: impl FnOnce() -> T) {
        let mut best = self.locked();
        if value < best.1 - margin {
            *best = (set(), value);
            (self.watch)(value);
        }
    }

    /// Runs a search in each thread, with random numbers of its own, and returns the best set. The threads are separate, so that the searches share the time on a
    /// single core, too.
    pub fn searched(self, seed: u64, search: impl Fn(&Self, &mut Pcg64) + Sync) -> T {
        thread::scope(|scope| {
            for chain in 0..rayon::current_num_threads() {
                let (shared, search) = (&self, &search);
                scope.spawn(move || search(shared, &mut seeded(seed, Purpose::Search, chain as u64)));
            }
        });
        self.into_best()
    }

    /// Returns the best set.
    pub fn into_best(self) -> T {
        self.best.into_inner().unwrap_or_else(PoisonError::into_inner).0
    }

    fn locked(&self) -> MutexGuard<'_, (T, f64)> {
        self.best.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
