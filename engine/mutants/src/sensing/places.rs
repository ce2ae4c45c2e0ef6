//! Mistakes in the code between a sensor and a driver: units, signs, indices, places.

use super::changing;
use crate::flaw::{Flaw, flawed, is_disturbed, seeing};
use crate::kind::Kind;
use nalgebra::Vector2;
use paracosm_engine::object::{Class, Outline};
use paracosm_engine::{Observation, Other};

/// The speed in m/s of 1 km/h.
const KM_PER_H: f64 = 1.0 / 3.6;
/// The width of a lane in metres.
const LANE: f64 = 3.5;
/// The distance in metres of a phantom ahead.
const PHANTOM_AHEAD: f64 = 20.0;
/// The number of the phantom, unless the world has so many bodies.
const PHANTOM_ID: usize = 1000;

pub(crate) const MIXED_UNITS: Kind = Kind {
    name: "mixed-units",
    about: "takes m/s for km/h in the speeds of bodies that are farther away than the size",
    unit: "m",
    sizes: &[60.0, 45.0, 35.0, 28.0, 20.0, 14.0, 8.0, 0.0],
    source: "NASA 1999, Mars Climate Orbiter Mishap Investigation Board, Phase I Report (units were mixed up)",
    make: |from, driver| {
        changing(driver, move |body| {
            if body.position.norm() > from {
                body.velocity *= KM_PER_H;
            }
        })
    },
};

pub(crate) const FLIPPED_SIDE: Kind = Kind {
    name: "flipped-side",
    about: "sees a body on its right at the same distance on its left, if the body is farther to the side than the size",
    unit: "m",
    sizes: &[4.5, 3.5, 2.8, 2.2, 1.6, 1.0, 0.5, 0.0],
    source: "fault model: wrong sign in one branch",
    make: |from, driver| {
        changing(driver, move |body| {
            if body.position.y < -from {
                body.position.y = -body.position.y;
            }
        })
    },
};

pub(crate) const OFF_BY_ONE_LANE: Kind = Kind {
    name: "off-by-one-lane",
    about: "sees bodies that are farther ahead than the size one lane (3.5 m) too far to the left",
    unit: "m",
    sizes: &[60.0, 45.0, 35.0, 28.0, 20.0, 14.0, 8.0, 0.0],
    source: "fault model: the index of the lane is off by one",
    make: |from, driver| {
        changing(driver, move |body| {
            if body.position.x > from {
                body.position.y += LANE;
            }
        })
    },
};

pub(crate) const MISLOCATED: Kind = Kind {
    name: "mislocated",
    about: "takes its own place for farther to the left of its way than it is; the size is the error",
    unit: "m",
    sizes: &[0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.2, 3.5],
    source: "fault model: error of localisation",
    make: |error, driver| {
        seeing(driver, move |seen| {
            seen.way.offset += error;
            seen.way.ahead.iter_mut().for_each(|point| point.position.y -= error);
        })
    },
};

pub(crate) const PHANTOM: Kind = Kind {
    name: "phantom",
    about: "sees a standing car 20 m ahead that is not there, at the end of every 4 s, for as long as the size",
    unit: "s",
    sizes: &[0.3, 0.6, 1.0, 1.5, 2.5, 4.0],
    source: "NHTSA PE22-002 (complaints about unexpected braking)",
    make: |lasts, driver| flawed(driver, Phantom { lasts }),
};

struct Phantom {
    lasts: f64,
}

impl Flaw for Phantom {
    const SEES: bool = true;

    fn see(&mut self, seen: &mut Observation) {
        if is_disturbed(seen.time, self.lasts) {
            let next = seen.others.last().map_or(0, |body| body.id + 1);
            seen.others.push(Other {
                id: next.max(PHANTOM_ID),
                class: Class::Car,
                position: Vector2::new(PHANTOM_AHEAD, 0.0),
                velocity: Vector2::zeros(),
                heading: 0.0,
                outline: Outline::Rectangle { length: 4.5, width: 1.8 },
            });
        }
    }
}
