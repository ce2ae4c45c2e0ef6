//! What a formula is worth over time, up to the end of the trace and with an eye on what comes after it.

use super::wave::{TOLERANCE, Wave};

/// Whether a time is as late as another one, but for rounding.
pub(super) fn reaches(time: f64, other: f64) -> bool {
    time + TOLERANCE * other.max(1.0) >= other
}

/// The worth of a formula over time.
pub(super) struct Track {
    /// By what was recorded.
    pub recorded: Wave,
    /// Until when that is all there is to it; before time 0 if it never is.
    pub settled: f64,
    /// What it is from that time or time 0 on, counted from there, had the trace gone on in the worst and in the best
    /// way.
    pub open: Option<[Wave; 2]>,
}

impl Track {
    /// A track that depends on nothing that was not recorded, until the time for which it is asked.
    pub fn settled(recorded: Wave, needed: f64) -> Self {
        Self { recorded, settled: needed, open: None }
    }

    /// At time 0: by what was recorded, at worst and at best.
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

    /// From a time on, counted from there, at worst or at best.
    pub fn after(&self, side: usize, time: f64) -> Wave {
        match &self.open {
            None => self.recorded.after(time),
            Some(open) if time >= self.settled => open[side].after(time - self.settled.max(0.0)),
            Some(open) => self.recorded.after(time).cut(self.settled - time).followed_by(&open[side]),
        }
    }
}
