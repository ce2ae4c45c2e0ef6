//! What a measure knows when it stops: a certified interval, and the clock that may stop it.

use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A certified interval around an exact value: `lower <= exact <= upper`.
///
/// `lower == upper` says that the value was computed to the end, and is exact but for the rounding of that computation: a
/// product of differences for a volume, a distance for a radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// The largest value that was witnessed.
    pub lower: f64,
    /// The smallest value that was proved not to be exceeded.
    pub upper: f64,
}

impl Bracket {
    /// The bracket of a value that is known exactly.
    pub fn exact(value: f64) -> Self {
        Self { lower: value, upper: value }
    }

    /// Whether the value was computed to the end.
    pub fn is_exact(&self) -> bool {
        self.lower == self.upper
    }
}

/// When an anytime algorithm has to come back with what it has.
#[derive(Debug, Clone, Copy)]
pub struct Deadline {
    at: Option<Instant>,
    called: Option<&'static AtomicBool>,
}

impl Deadline {
    /// No limit: the algorithm runs to the end.
    pub const fn never() -> Self {
        Self { at: None, called: None }
    }

    /// The moment `limit` from now; never, where that lies beyond what the clock can say.
    pub fn after(limit: Duration) -> Self {
        Self { at: Instant::now().checked_add(limit), called: None }
    }

    /// The same moment, or that at which somebody sets the flag, if it comes first.
    pub const fn or_when(self, called: &'static AtomicBool) -> Self {
        Self { called: Some(called), ..self }
    }

    /// The moment at which a share of what time is left has gone by.
    pub fn part(self, share: f64) -> Self {
        Self { at: self.left().map(|left| Instant::now() + left.mul_f64(share)), ..self }
    }

    /// The time that is left if nobody sets the flag; none where there is no limit.
    pub(crate) fn left(self) -> Option<Duration> {
        self.at.map(|at| at.saturating_duration_since(Instant::now()))
    }

    /// Whether the moment has come.
    pub fn passed(&self) -> bool {
        self.called.is_some_and(|flag| flag.load(Ordering::Relaxed)) || self.at.is_some_and(|at| Instant::now() >= at)
    }
}

/// A deadline for a search whose steps are short: reading the clock takes as long as looking at some hundred numbers.
#[derive(Debug)]
pub(crate) struct Watch {
    deadline: Deadline,
    work: usize,
}

impl Watch {
    /// How many numbers are looked at before the clock is.
    const WORK_BETWEEN_LOOKS: usize = 1 << 14;

    pub(crate) fn new(deadline: Deadline) -> Self {
        Self { deadline, work: 0 }
    }

    /// Counts `work` more numbers; whether the deadline has been seen to pass. Once it has, it always has.
    pub(crate) fn passed_after(&mut self, work: usize) -> bool {
        self.work = self.work.saturating_add(work);
        if self.work < Self::WORK_BETWEEN_LOOKS {
            return false;
        }
        let passed = self.deadline.passed();
        if !passed {
            self.work = 0;
        }
        passed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deadline_has_passed_once_the_flag_is_set_and_so_has_each_part_of_it() {
        static FLAG: AtomicBool = AtomicBool::new(false);
        for deadline in [Deadline::never(), Deadline::after(Duration::from_secs(3600))] {
            FLAG.store(false, Ordering::Relaxed);
            let deadline = deadline.or_when(&FLAG);
            let part = deadline.part(0.5);
            assert!(!deadline.passed() && !part.passed());
            FLAG.store(true, Ordering::Relaxed);
            assert!(deadline.passed() && part.passed());
        }
    }
}
