//! What a measure knows when it stops: a certified interval, and the clock that may stop it.

use serde::{Deserialize, Serialize};
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
pub struct Deadline(Option<Instant>);

impl Deadline {
    /// No limit: the algorithm runs to the end.
    pub const fn never() -> Self {
        Self(None)
    }

    /// The moment `limit` from now; never, where that lies beyond what the clock can say.
    pub fn after(limit: Duration) -> Self {
        Self(Instant::now().checked_add(limit))
    }

    /// The moment at which a share of what time is left has gone by.
    pub fn part(self, share: f64) -> Self {
        Self(self.left().map(|left| Instant::now() + left.mul_f64(share)))
    }

    /// The time that is left; none where there is no limit.
    pub(crate) fn left(self) -> Option<Duration> {
        self.0.map(|at| at.saturating_duration_since(Instant::now()))
    }

    /// Whether the moment has come.
    pub fn passed(&self) -> bool {
        self.0.is_some_and(|at| Instant::now() >= at)
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
