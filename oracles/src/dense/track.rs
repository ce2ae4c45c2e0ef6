//! The worth of a formula over time, for the recorded samples and for the worst and best continuation.

use super::wave::{TOLERANCE, Wave};

/// Returns `true` if `time` is not before `other`, up to rounding.
pub(super) fn reaches(time: f64, other: f64) -> bool {
    time + TOLERANCE * other.max(1.0) >= other
}

/// The worth of a formula over time.
pub(super) struct Track {
    /// The robustness of the formula over time, for the recorded samples only.
    pub recorded: Wave,
    /// The time up to which samples after the end of the trace have no influence on the robustness. It is negative if
    /// such samples always have influence.
    pub settled: f64,
    /// The robustness over time for the worst and the best continuation of the trace, from `settled` or time 0 on,
    /// whichever is later. Times are counted from this time.
    pub open: Option<[Wave; 2]>,
}

impl Track {
    /// Makes the track of a robustness that depends on recorded samples only, up to the time `needed`.
    pub fn settled(recorded: Wave, needed: f64) -> Self {
        Self { recorded, settled: needed, open: None }
    }

    /// Returns the robustness at time 0 for the recorded samples, for the worst continuation and for the best
    /// continuation.
    pub fn first(&self) -> [f64; 3] {
        let recorded = self.recorded.first();
        match &self.open {
            Some([worst, best]) if self.settled < 0.0 => [recorded, worst.first(), best.first()],
            _ => [recorded; 3],
        }
    }

    pub fn negated(self) -> Self {
        let open = self.open.map(|[worst, best]| [best.scaled(-1.0), worst.scaled(-1.0)]);
        Self { recorded: self.recorded.scaled(-1.0), settled: self.settled, open }
    }

    pub fn joined(&self, other: &Self, join: fn(&Wave, &Wave) -> Wave) -> Self {
        let settled = self.settled.min(other.settled);
        let is_open = self.open.is_some() || other.open.is_some();
        let open = is_open.then(|| {
            [0, 1].map(|side| {
                let from = settled.max(0.0);
                join(&self.after(side, from), &other.after(side, from))
            })
        });
        Self { recorded: join(&self.recorded, &other.recorded), settled, open }
    }

    /// Returns the robustness from the given time on, for the worst (`side` 0) or the best continuation (`side` 1).
    /// Times are counted from the given time.
    pub fn after(&self, side: usize, time: f64) -> Wave {
        match &self.open {
            None => self.recorded.after(time),
            Some(open) if time >= self.settled => open[side].after(time - self.settled.max(0.0)),
            Some(open) => self.recorded.after(time).cut(self.settled - time).followed_by(&open[side]),
        }
    }
}
