//! Times at which the driver sees nothing, or nothing new.

use super::share;
use crate::chance::unit;
use crate::flaw::{Flaw, flawed, is_disturbed, seeing};
use crate::kind::Kind;
use paracosm_engine::{Briefing, Observation, Other};

/// The probabilities in percent with which something is lost in a step.
const PERCENT: &[f64] = &[5.0, 10.0, 20.0, 35.0, 50.0, 65.0, 80.0, 92.0];
/// The seconds in every four seconds that a disturbance lasts.
const SECONDS: &[f64] = &[0.4, 0.7, 1.0, 1.4, 1.9, 2.5, 3.1, 3.8];
/// A number that stands for all bodies.
const ALL_BODIES: usize = 0xffff_ffff;

pub(crate) const LOST_FRAMES: Kind = Kind {
    name: "lost-frames",
    about: "sees no body at all in some steps; the size is their share",
    unit: "%",
    sizes: PERCENT,
    source: "fault model: random loss of messages",
    make: |percent, driver| flawed(driver, Lost { percent, each: false, step: 0 }),
};

pub(crate) const LOST_BODIES: Kind = Kind {
    name: "lost-bodies",
    about: "misses each body in some steps, independently of the others; the size is the share of these steps",
    unit: "%",
    sizes: PERCENT,
    source: "fault model: random false negatives of a detector",
    make: |percent, driver| flawed(driver, Lost { percent, each: true, step: 0 }),
};

struct Lost {
    percent: f64,
    /// True if bodies are lost one by one.
    each: bool,
    /// The number of the step in the run.
    step: u64,
}

impl Flaw for Lost {
    const SEES: bool = true;

    fn reset(&mut self, _briefing: &Briefing) {
        self.step = 0;
    }

    fn see(&mut self, seen: &mut Observation) {
        let (step, each, lost) = (self.step, self.each, share(self.percent));
        self.step += 1;
        let number = |body: &Other| if each { body.id } else { ALL_BODIES };
        seen.others.retain(|body| unit(step, number(body)) >= lost);
    }
}

pub(crate) const OUTAGES: Kind = Kind {
    name: "outages",
    about: "sees no body at all at the end of every 4 s, for as long as the size",
    unit: "s",
    sizes: SECONDS,
    source: "fault model: intermittent loss of a sensor",
    make: |lasts, driver| {
        seeing(driver, move |seen| {
            if is_disturbed(seen.time, lasts) {
                seen.others.clear();
            }
        })
    },
};

pub(crate) const FROZEN_SENSOR: Kind = Kind {
    name: "frozen-sensor",
    about: "sees the same bodies at the same places at the end of every 4 s, for as long as the size",
    unit: "s",
    sizes: SECONDS,
    source: "fault model: frozen values of a sensor",
    make: |lasts, driver| flawed(driver, Frozen { lasts, last: Vec::new(), has_seen: false }),
};

struct Frozen {
    lasts: f64,
    last: Vec<Other>,
    has_seen: bool,
}

impl Flaw for Frozen {
    const SEES: bool = true;

    fn reset(&mut self, _briefing: &Briefing) {
        self.has_seen = false;
    }

    fn see(&mut self, seen: &mut Observation) {
        if self.has_seen && is_disturbed(seen.time, self.lasts) {
            seen.others.clone_from(&self.last);
        } else {
            self.last.clone_from(&seen.others);
            self.has_seen = true;
        }
    }
}
