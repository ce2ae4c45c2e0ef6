//! Brakes that depend on how long or how often the driver has braked.

use super::{BRAKING, limit, release};
use crate::flaw::{Flaw, SAME_TIME, flawed};
use crate::kind::Kind;
use paracosm_engine::{Briefing, Control, Observation};

pub(crate) const SLOW_BRAKES: Kind = Kind {
    name: "slow-brakes",
    about: "builds up its brakes slowly; the size is the time to the strongest braking",
    unit: "s",
    sizes: &[0.4, 0.7, 1.0, 1.5, 2.5, 4.0, 6.0],
    source: "fault model: slow actuator",
    make: |seconds, driver| flawed(driver, Slow { seconds, last: None }),
};

struct Slow {
    seconds: f64,
    /// The time and the brakes at the last question.
    last: Option<(f64, f64)>,
}

impl Flaw for Slow {
    const SEES: bool = false;

    fn reset(&mut self, _briefing: &Briefing) {
        self.last = None;
    }

    fn act(&mut self, truth: &Observation, control: &mut Control) {
        let (before, brakes) = self.last.unwrap_or((truth.time, 0.0));
        limit(control, brakes - (truth.time - before).max(0.0) / self.seconds);
        self.last = Some((truth.time, control.throttle.min(0.0)));
    }
}

/// The times at which the driver wants to brake.
#[derive(Default)]
struct Wish {
    /// The time since which the driver has wanted to brake without a break.
    since: Option<f64>,
    /// The number of times that the driver has begun to brake.
    count: usize,
}

impl Wish {
    /// Takes in a control and returns the seconds since which the driver has wanted to brake, if it wants to brake.
    fn lasts(&mut self, truth: &Observation, control: &Control) -> Option<f64> {
        if control.throttle >= BRAKING {
            self.since = None;
            return None;
        }
        if self.since.is_none() {
            self.count += 1;
        }
        let since = *self.since.get_or_insert(truth.time);
        Some(truth.time - since)
    }
}

/// A flaw that releases the brakes, as a function of the times at which the driver wants to brake.
struct Releases<R> {
    wish: Wish,
    /// Returns `true` if the brakes are released, for the seconds since which the driver has wanted to brake and the
    /// number of times that it has.
    releases: R,
}

impl<R: Fn(f64, usize) -> bool + Send> Flaw for Releases<R> {
    const SEES: bool = false;

    fn reset(&mut self, _briefing: &Briefing) {
        self.wish = Wish::default();
    }

    fn act(&mut self, truth: &Observation, control: &mut Control) {
        if let Some(lasts) = self.wish.lasts(truth, control)
            && (self.releases)(lasts, self.wish.count)
        {
            release(control);
        }
    }
}

fn releasing(releases: impl Fn(f64, usize) -> bool + Send) -> impl Flaw {
    Releases { wish: Wish::default(), releases }
}

pub(crate) const FADING_BRAKES: Kind = Kind {
    name: "fading-brakes",
    about: "lets go of the brakes after it has braked for as long as the size, until it no longer wants to brake",
    unit: "s",
    sizes: &[3.5, 2.5, 1.8, 1.3, 0.9, 0.6, 0.4, 0.2],
    source: "fault model: a time limit of an emergency function",
    make: |after, driver| flawed(driver, releasing(move |lasts, _| lasts >= after - SAME_TIME)),
};

pub(crate) const FEW_BRAKINGS: Kind = Kind {
    name: "few-brakings",
    about: "brakes only so many times as the size says, rounded down, and then never again",
    unit: "times",
    sizes: &[8.0, 5.0, 4.0, 3.0, 2.0, 1.0],
    source: "fault model: a flag that nobody clears",
    make: |most, driver| flawed(driver, releasing(move |_, count| count as f64 > most)),
};

pub(crate) const SUPPRESSED_BRAKING: Kind = Kind {
    name: "suppressed-braking",
    about: "ignores each wish to brake until the wish has lasted for as long as the size",
    unit: "s",
    sizes: &[0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.5],
    source: "NTSB/HAR-19/03 (Tempe: actions were suppressed for one second after a hazard was detected)",
    make: |until, driver| flawed(driver, releasing(move |lasts, _| lasts < until - SAME_TIME)),
};
