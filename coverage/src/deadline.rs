//! The moment at which a search must stop: after a time, or after an amount of work.
//!
//! A result that depends on time differs from run to run. Work is counted in numbers that a search looks at, so a search
//! on one thread with a limit of work ends at the same place on every machine.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

thread_local! {
    /// The work that searches on this thread have done so far, in numbers that they looked at.
    static DONE: Cell<u64> = const { Cell::new(0) };
}

/// The work that one look at a deadline counts as. A search that only looks at its deadline ends, too.
const LOOK: u64 = 256;

/// Adds to the work that this thread has done.
fn count(work: u64) {
    DONE.set(DONE.get().saturating_add(work));
}

/// The moment at which a search must stop and return the best result that it has.
#[derive(Debug, Clone, Copy)]
pub struct Deadline {
    end: End,
    called: Option<&'static AtomicBool>,
}

#[derive(Debug, Clone, Copy)]
enum End {
    Never,
    At(Instant),
    /// Once this thread has done so much work since it began.
    Work(u64),
}

impl Deadline {
    /// Makes a deadline that never passes, so that the search runs until the result is complete.
    pub const fn never() -> Self {
        Self { end: End::Never, called: None }
    }

    /// Makes a deadline that passes once `limit` elapses. It is unlimited if the clock cannot represent that moment.
    pub fn after(limit: Duration) -> Self {
        Self { end: Instant::now().checked_add(limit).map_or(End::Never, End::At), called: None }
    }

    /// Makes a deadline that passes once searches on the current thread have looked at `work` numbers. The search must run
    /// on this thread alone, for example in a pool of one thread. Its result is then the same on every machine.
    pub fn after_work(work: u64) -> Self {
        Self { end: End::Work(DONE.get().saturating_add(work)), called: None }
    }

    /// Returns the deadline with a flag that ends the search early. The deadline passes at the same moment as before,
    /// or as soon as `called` is set.
    pub const fn or_when(self, called: &'static AtomicBool) -> Self {
        Self { called: Some(called), ..self }
    }

    /// Returns a deadline that passes after `share` of the remaining time or work, or never if this deadline never does.
    pub fn part(self, share: f64) -> Self {
        let end = match self.end {
            End::Never => End::Never,
            End::At(at) => End::At(Instant::now() + at.saturating_duration_since(Instant::now()).mul_f64(share)),
            End::Work(end) => {
                let left = end.saturating_sub(DONE.get()) as f64 * share;
                End::Work(DONE.get().saturating_add(left as u64))
            }
        };
        Self { end, ..self }
    }

    /// Returns the remaining time in seconds or the remaining work, which ends earlier if the flag is set; `None` without
    /// a limit.
    pub(crate) fn left(self) -> Option<f64> {
        match self.end {
            End::Never => None,
            End::At(at) => Some(at.saturating_duration_since(Instant::now()).as_secs_f64()),
            End::Work(end) => Some(end.saturating_sub(DONE.get()) as f64),
        }
    }

    /// Begins a lap, which measures in the unit of [`Deadline::left`].
    pub(crate) fn lap(self) -> Lap {
        Lap { counts: matches!(self.end, End::Work(_)), begun: Instant::now(), done: DONE.get() }
    }

    /// Returns `true` if the limit is over or the flag of the deadline is set.
    pub fn passed(&self) -> bool {
        let is_over = match self.end {
            End::Never => false,
            End::At(at) => Instant::now() >= at,
            End::Work(end) => {
                count(LOOK);
                DONE.get() >= end
            }
        };
        is_over || self.called.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Counts the numbers that a step looked at, and returns `true` if the deadline has passed.
    pub(crate) fn passed_after(&self, work: usize) -> bool {
        count(work as u64);
        self.passed()
    }
}

/// A measurement of how long a part of a search takes.
#[derive(Debug)]
pub(crate) struct Lap {
    /// `true` if work is counted, and not time.
    counts: bool,
    begun: Instant,
    done: u64,
}

impl Lap {
    /// Returns the time in seconds or the work since the lap began.
    pub(crate) fn taken(&self) -> f64 {
        if self.counts { (DONE.get() - self.done) as f64 } else { self.begun.elapsed().as_secs_f64() }
    }
}

/// A deadline for a search with short steps. It looks at the deadline only from time to time, because reading the clock
/// takes as long as looking at some hundred numbers.
#[derive(Debug)]
pub(crate) struct Watch {
    deadline: Deadline,
    /// The work since the last look.
    work: usize,
    over: bool,
}

impl Watch {
    /// The number of numbers that are looked at between two looks at the deadline.
    const WORK_BETWEEN_LOOKS: usize = 1 << 14;

    pub(crate) fn new(deadline: Deadline) -> Self {
        Self { deadline, work: 0, over: false }
    }

    /// Counts the numbers that a step looked at, and checks the deadline from time to time. Returns `true` if the
    /// deadline was seen to pass, now or before.
    pub(crate) fn passed_after(&mut self, work: usize) -> bool {
        self.work = self.work.saturating_add(work);
        if self.work >= Self::WORK_BETWEEN_LOOKS {
            self.over |= self.deadline.passed_after(std::mem::take(&mut self.work));
        }
        self.over
    }
}

impl Drop for Watch {
    /// Counts the work since the last look.
    fn drop(&mut self) {
        count(self.work as u64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deadline_has_passed_once_the_flag_is_set_and_so_has_each_part_of_it() {
        static FLAG: AtomicBool = AtomicBool::new(false);
        let hour = Duration::from_secs(3600);
        for deadline in [Deadline::never(), Deadline::after(hour), Deadline::after_work(1 << 40)] {
            FLAG.store(false, Ordering::Relaxed);
            let deadline = deadline.or_when(&FLAG);
            let part = deadline.part(0.5);
            assert!(!deadline.passed() && !part.passed());
            FLAG.store(true, Ordering::Relaxed);
            assert!(deadline.passed() && part.passed());
        }
    }

    #[test]
    fn work_on_this_thread_alone_ends_a_limit_of_work() {
        let deadline = Deadline::after_work(100_000);
        let half = deadline.part(0.5);
        std::thread::spawn(|| count(1 << 40)).join().unwrap();
        assert!(!deadline.passed() && !half.passed());
        let lap = deadline.lap();
        {
            let mut watch = Watch::new(deadline);
            assert!(!watch.passed_after(60_000) && !watch.passed_after(10));
        }
        // Also the work after the last look of a watch counts.
        assert!(lap.taken() >= 60_010.0 && half.passed() && !deadline.passed());
        assert!(deadline.passed_after(40_000));
        assert_eq!(deadline.left(), Some(0.0));
    }

    #[test]
    fn looking_at_the_deadline_alone_ends_a_limit_of_work() {
        let deadline = Deadline::after_work(10_000);
        assert!((0..1000).any(|_| deadline.passed()));
    }
}
