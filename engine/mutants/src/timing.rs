//! Defects of the time at which a driver's answers take effect.

use crate::chance::unit;
use crate::flaw::{Flaw, SAME_TIME, flawed, is_disturbed};
use crate::kind::Kind;
use paracosm_engine::{Briefing, Control, Observation};
use std::collections::VecDeque;

/// The distance in metres up to which bodies keep the driver busy.
const BUSY_WITHIN: f64 = 100.0;

pub(crate) const LATE_REACTION: Kind = Kind {
    name: "late-reaction",
    about: "answers later by the size",
    unit: "s",
    sizes: &[0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.5],
    source: "fault model: latency of a computer",
    make: |latency, driver| flawed(driver, Latency(latency)),
};

struct Latency(f64);

impl Flaw for Latency {
    const SEES: bool = false;

    fn latency(&self) -> f64 {
        self.0
    }
}

pub(crate) const BUSY: Kind = Kind {
    name: "busy",
    about: "answers later, the more bodies are within 100 m; the size is the time per body",
    unit: "s",
    sizes: &[0.03, 0.06, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2],
    source: "fault model: latency that grows with the number of objects",
    make: |per_body, driver| flawed(driver, Busy { per_body, waiting: VecDeque::new(), told: Control::default() }),
};

struct Busy {
    per_body: f64,
    /// The answers that have not taken effect yet, with the times of their questions.
    waiting: VecDeque<(f64, Control)>,
    /// The answer that is in effect.
    told: Control,
}

impl Flaw for Busy {
    const SEES: bool = false;

    fn reset(&mut self, _briefing: &Briefing) {
        self.waiting.clear();
        self.told = Control::default();
    }

    fn act(&mut self, truth: &Observation, control: &mut Control) {
        let near = truth.others.iter().filter(|body| body.position.norm() <= BUSY_WITHIN).count();
        let ready = truth.time - self.per_body * near as f64 + SAME_TIME;
        self.waiting.push_back((truth.time, *control));
        while let Some((_, answer)) = self.waiting.pop_front_if(|(asked, _)| *asked <= ready) {
            self.told = answer;
        }
        *control = self.told;
    }
}

pub(crate) const SLOW_CYCLE: Kind = Kind {
    name: "slow-cycle",
    about: "gives a new answer only once in as long as the size, and keeps the last answer in between",
    unit: "s",
    sizes: &[0.2, 0.4, 0.7, 1.0, 1.4, 2.0, 3.0],
    source: "fault model: overload of a computer",
    make: |every, driver| {
        // A step that comes on time belongs to the next cycle.
        let is_due = move |last: f64, time: f64, _| time - last >= every - SAME_TIME;
        flawed(driver, Held { is_due, step: 0, last: f64::NEG_INFINITY, told: Control::default() })
    },
};

pub(crate) const FROZEN_OUTPUT: Kind = Kind {
    name: "frozen-output",
    about: "keeps its last answer at the end of every 4 s, for as long as the size",
    unit: "s",
    sizes: &[0.2, 0.4, 0.7, 1.0, 1.5, 2.2, 3.0, 3.8],
    source: "fault model: frozen values of an actuator",
    make: |lasts, driver| {
        let is_due = move |_, time, _| !is_disturbed(time, lasts);
        flawed(driver, Held { is_due, step: 0, last: f64::NEG_INFINITY, told: Control::default() })
    },
};

pub(crate) const LOST_ANSWERS: Kind = Kind {
    name: "lost-answers",
    about: "loses some of its answers and keeps the last one instead; the size is their share",
    unit: "%",
    sizes: &[20.0, 40.0, 60.0, 75.0, 85.0, 92.0, 97.0],
    source: "fault model: random loss of messages",
    make: |percent, driver| {
        let is_due = move |_, _, step| unit(step, 0) >= 0.01 * percent;
        flawed(driver, Held { is_due, step: 0, last: f64::NEG_INFINITY, told: Control::default() })
    },
};

/// Answers that hold until another answer is due.
struct Held<D> {
    /// Returns `true` if an answer takes effect, for the time of the last one that did, the present time and the number of
    /// the step.
    is_due: D,
    step: u64,
    last: f64,
    told: Control,
}

impl<D: Fn(f64, f64, u64) -> bool + Send> Flaw for Held<D> {
    const SEES: bool = false;

    fn reset(&mut self, _briefing: &Briefing) {
        (self.step, self.last, self.told) = (0, f64::NEG_INFINITY, Control::default());
    }

    fn act(&mut self, truth: &Observation, control: &mut Control) {
        if (self.is_due)(self.last, truth.time, self.step) {
            (self.last, self.told) = (truth.time, *control);
        }
        self.step += 1;
        *control = self.told;
    }
}
