//! The result of a measure that may be stopped early (a certified interval), and the deadline that may stop it.

use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A certified interval that contains an exact value, so that `lower <= exact <= upper`.
///
/// `lower == upper` means that the value was computed to the end. It is exact but for the rounding of that
/// computation: a product of differences for a volume, a distance for a radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// The lower bound on the exact value, which is the largest value that the search found.
    pub lower: f64,
    /// The upper bound on the exact value, which is the smallest bound that the search proved.
    pub upper: f64,
}

impl Bracket {
    /// Makes a bracket whose lower and upper bound are the given exact value.
    pub fn exact(value: f64) -> Self {
        Self { lower: value, upper: value }
    }

    /// Returns `true` if the lower and the upper bound are equal, so that the value is exact.
    pub fn is_exact(&self) -> bool {
        self.lower == self.upper
    }
}

/// The moment at which a search must stop and return the best result that it has.
#[derive(Debug, Clone, Copy)]
pub struct Deadline {
    at: Option<Instant>,
    called: Option<&'static AtomicBool>,
}

impl Deadline {
    /// Makes a deadline that never passes, so that the search runs until the result is complete.
    pub const fn never() -> Self {
        Self { at: None, called: None }
    }

    /// Makes a deadline that passes once `limit` elapses. It is unlimited if the clock cannot represent that moment.
    pub fn after(limit: Duration) -> Self {
        Self { at: Instant::now().checked_add(limit), called: None }
    }

    /// Returns the deadline with a flag that ends the search early. The deadline passes at the same moment as before,
    /// or as soon as `called` is set.
    pub const fn or_when(self, called: &'static AtomicBool) -> Self {
        Self { called: Some(called), ..self }
    }

    /// Returns a deadline that passes after `share` of the remaining time, or never if this deadline has no time limit.
    pub fn part(self, share: f64) -> Self {
        Self { at: self.left().map(|left| Instant::now() + left.mul_f64(share)), ..self }
    }

    /// Returns the remaining time, which ends earlier if the flag is set; `None` without a time limit.
    pub(crate) fn left(self) -> Option<Duration> {
        self.at.map(|at| at.saturating_duration_since(Instant::now()))
    }

    /// Returns `true` if the time limit is over or the flag of the deadline is set.
    pub fn passed(&self) -> bool {
        self.called.is_some_and(|flag| flag.load(Ordering::Relaxed)) || self.at.is_some_and(|at| Instant::now() >= at)
    }
}

/// A deadline for a search with short steps. It reads the clock only from time to time, because reading the clock takes
/// as long as looking at some hundred numbers.
#[derive(Debug)]
pub(crate) struct Watch {
    deadline: Deadline,
    work: usize,
}

impl Watch {
    /// The number of numbers that are looked at between two looks at the clock.
    const WORK_BETWEEN_LOOKS: usize = 1 << 14;

    pub(crate) fn new(deadline: Deadline) -> Self {
        Self { deadline, work: 0 }
    }

    /// Counts the numbers that a step looked at, and checks the deadline from time to time. Returns `true` if the
    /// deadline was seen to pass, now or before.
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
