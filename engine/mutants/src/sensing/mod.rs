//! Defects that change what the driver sees of the world.

pub(crate) mod classes;
pub(crate) mod gaps;
pub(crate) mod late;
pub(crate) mod nearest;
pub(crate) mod places;
pub(crate) mod unseen;
pub(crate) mod wrong;

use crate::flaw::seeing;
use paracosm_engine::Other;
use paracosm_engine::driver::Driver;

/// Hides some bodies from a driver. `is_hidden` gets a body and the speed of the car in m/s.
fn hiding(driver: Box<dyn Driver>, is_hidden: impl Fn(&Other, f64) -> bool + Send + 'static) -> Box<dyn Driver> {
    seeing(driver, move |seen| {
        let speed = seen.speed;
        seen.others.retain(|body| !is_hidden(body, speed));
    })
}

/// Changes what a driver sees of each body.
fn changing(driver: Box<dyn Driver>, change: impl Fn(&mut Other) + Send + 'static) -> Box<dyn Driver> {
    seeing(driver, move |seen| seen.others.iter_mut().for_each(&change))
}

/// Returns the share that a number of percent is.
fn share(percent: f64) -> f64 {
    0.01 * percent
}
