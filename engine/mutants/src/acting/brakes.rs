//! Brakes that are weak, or that do not work in some states of the car.

use super::{limit, release};
use crate::flaw::acting;
use crate::kind::Kind;

/// The speed in m/s of 1 km/h.
const KM_PER_H: f64 = 1.0 / 3.6;

pub(crate) const WEAK_BRAKES: Kind = Kind {
    name: "weak-brakes",
    about: "brakes less hard than it can; the size is the missing share of the strongest braking",
    unit: "%",
    sizes: &[20.0, 35.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0],
    source: "fault model: limited actuator",
    make: |percent, driver| {
        let strongest = 0.01 * percent - 1.0;
        acting(driver, move |_, control| limit(control, strongest))
    },
};

pub(crate) const NO_BRAKES_ABOVE: Kind = Kind {
    name: "no-brakes-above",
    about: "does not brake while it is faster than the size",
    unit: "km/h",
    sizes: &[100.0, 80.0, 60.0, 50.0, 40.0, 30.0, 20.0, 10.0],
    source: "UN Regulation No. 152 asks for emergency braking up to 60 km/h",
    make: |speed, driver| {
        acting(driver, move |truth, control| {
            if truth.speed > KM_PER_H * speed {
                release(control);
            }
        })
    },
};

pub(crate) const NO_BRAKES_BELOW: Kind = Kind {
    name: "no-brakes-below",
    about: "does not brake while it is slower than the size",
    unit: "km/h",
    sizes: &[6.0, 10.0, 15.0, 20.0, 25.0, 35.0, 50.0, 70.0],
    source: "UN Regulation No. 152 asks for emergency braking from 10 km/h on for cars, from 20 km/h on for pedestrians",
    make: |speed, driver| {
        acting(driver, move |truth, control| {
            if truth.speed < KM_PER_H * speed {
                release(control);
            }
        })
    },
};

pub(crate) const NO_BRAKES_IN_BENDS: Kind = Kind {
    name: "no-brakes-in-bends",
    about: "does not brake while it turns the wheels by more than the size, in percent of their full turn",
    unit: "%",
    sizes: &[40.0, 25.0, 15.0, 10.0, 6.0, 3.0, 1.0, 0.3],
    source: "fault model: two functions exclude each other",
    make: |percent, driver| {
        acting(driver, move |_, control| {
            if control.steering.abs() > 0.01 * percent {
                release(control);
            }
        })
    },
};
