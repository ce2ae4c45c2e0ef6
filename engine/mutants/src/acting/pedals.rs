//! Pedals and a steering wheel that have an offset, or that do less than they should.

use crate::flaw::acting;
use crate::kind::Kind;

pub(crate) const BIASED_THROTTLE: Kind = Kind {
    name: "biased-throttle",
    about: "brakes less and accelerates more than it wants; the size is the offset, in percent of the full throttle",
    unit: "%",
    sizes: &[2.0, 5.0, 10.0, 20.0, 35.0, 60.0, 100.0],
    source: "fault model: offset of an actuator",
    make: |percent, driver| {
        acting(driver, move |_, control| control.throttle = (control.throttle + 0.01 * percent).min(1.0))
    },
};

pub(crate) const WEAK_STEERING: Kind = Kind {
    name: "weak-steering",
    about: "steers less than it wants; the size is the missing share",
    unit: "%",
    sizes: &[10.0, 20.0, 35.0, 50.0, 70.0, 85.0, 100.0],
    source: "fault model: weak actuator",
    make: |percent, driver| acting(driver, move |_, control| control.steering *= 1.0 - 0.01 * percent),
};

pub(crate) const BIASED_STEERING: Kind = Kind {
    name: "biased-steering",
    about: "steers too far to the right; the size is the offset, in percent of the full turn",
    unit: "%",
    sizes: &[0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0],
    source: "fault model: offset of an actuator",
    make: |percent, driver| {
        acting(driver, move |_, control| control.steering = (control.steering - 0.01 * percent).max(-1.0))
    },
};
