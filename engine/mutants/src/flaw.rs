//! The decorator of a driver that has a flaw.

use paracosm_engine::driver::{Driver, Equipment, Fault};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{Briefing, Control, Observation};

/// The seconds by which two times may differ and still be the same, because times are sums of ticks.
pub(crate) const SAME_TIME: f64 = 1e-9;
/// The seconds from the begin of one disturbance to the begin of the next, for flaws that come and go.
const EVERY: f64 = 4.0;

/// A change of the data between a run and a driver.
pub(crate) trait Flaw: Send {
    /// True if the flaw changes what the driver sees. Otherwise no observation is copied.
    const SEES: bool;

    /// Forgets the last run, because a new run begins.
    fn reset(&mut self, _briefing: &Briefing) {}

    /// Returns the seconds by which the answers of the driver take effect later.
    fn latency(&self) -> f64 {
        0.0
    }

    /// Changes an observation before the driver sees it.
    fn see(&mut self, _seen: &mut Observation) {}

    /// Changes the answer of the driver to the given observation, which is the true observation.
    fn act(&mut self, _truth: &Observation, _control: &mut Control) {}
}

/// A driver with a flaw. In everything that the flaw does not change, it is the driver without the flaw.
struct Flawed<F> {
    driver: Box<dyn Driver>,
    flaw: F,
    /// The observation that the driver sees, kept because its list needs memory.
    seen: Observation,
}

/// Puts a flaw into a driver.
pub(crate) fn flawed(driver: Box<dyn Driver>, flaw: impl Flaw + 'static) -> Box<dyn Driver> {
    Box::new(Flawed { driver, flaw, seen: Observation::default() })
}

impl<F: Flaw> Driver for Flawed<F> {
    fn period(&self) -> f64 {
        self.driver.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.driver.equipment()
    }

    fn latency(&self) -> f64 {
        self.driver.latency() + self.flaw.latency()
    }

    fn takes_over(&self) -> bool {
        self.driver.takes_over()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.flaw.reset(briefing);
        self.driver.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.driver.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let mut control = if F::SEES {
            copy(observation, &mut self.seen);
            self.flaw.see(&mut self.seen);
            self.driver.step(&self.seen)?
        } else {
            self.driver.step(observation)?
        };
        self.flaw.act(observation, &mut control);
        Ok(control)
    }
}

/// Copies an observation into the memory of an earlier observation.
fn copy(from: &Observation, to: &mut Observation) {
    let Observation { time, speed, travelled, odometry, way, others } = from;
    (to.time, to.speed, to.travelled) = (*time, *speed, *travelled);
    (to.odometry, to.way) = (*odometry, *way);
    to.others.clone_from(others);
}

struct Sees<S>(S);

impl<S: Fn(&mut Observation) + Send> Flaw for Sees<S> {
    const SEES: bool = true;

    fn see(&mut self, seen: &mut Observation) {
        self.0(seen);
    }
}

/// Puts a flaw without memory into a driver, which changes what the driver sees.
pub(crate) fn seeing(driver: Box<dyn Driver>, see: impl Fn(&mut Observation) + Send + 'static) -> Box<dyn Driver> {
    flawed(driver, Sees(see))
}

struct Acts<A>(A);

impl<A: Fn(&Observation, &mut Control) + Send> Flaw for Acts<A> {
    const SEES: bool = false;

    fn act(&mut self, truth: &Observation, control: &mut Control) {
        self.0(truth, control);
    }
}

/// Puts a flaw without memory into a driver, which changes what the driver does.
pub(crate) fn acting(
    driver: Box<dyn Driver>,
    act: impl Fn(&Observation, &mut Control) + Send + 'static,
) -> Box<dyn Driver> {
    flawed(driver, Acts(act))
}

/// Returns `true` during the last seconds of every four seconds; `lasts` is their number.
pub(crate) fn is_disturbed(time: f64, lasts: f64) -> bool {
    libm::fmod(time + SAME_TIME, EVERY) >= EVERY - lasts
}
