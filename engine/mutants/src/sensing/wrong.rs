//! Quantities that the driver measures wrongly.

use super::{changing, share};
use crate::chance::normal;
use crate::flaw::{Flaw, flawed, seeing};
use crate::kind::Kind;
use nalgebra::{Rotation2, Vector2};
use paracosm_engine::object::Outline;
use paracosm_engine::{Briefing, Observation, Other};

pub(crate) const POSITION_NOISE: Kind = Kind {
    name: "position-noise",
    about: "sees each body at a place with a random error in each step; the size is its standard deviation",
    unit: "m",
    sizes: &[0.2, 0.4, 0.7, 1.0, 1.5, 2.5, 4.0],
    source: "fault model: noise",
    make: |deviation, driver| flawed(driver, Noise { deviation, of: |body| &mut body.position, step: 0 }),
};

pub(crate) const SPEED_NOISE: Kind = Kind {
    name: "speed-noise",
    about: "sees each body with a random error of its velocity in each step; the size is its standard deviation",
    unit: "m/s",
    sizes: &[0.2, 0.4, 0.8, 1.5, 2.5, 4.0, 7.0, 12.0],
    source: "fault model: noise",
    make: |deviation, driver| flawed(driver, Noise { deviation, of: |body| &mut body.velocity, step: 0 }),
};

struct Noise {
    deviation: f64,
    of: fn(&mut Other) -> &mut Vector2<f64>,
    step: u64,
}

impl Flaw for Noise {
    const SEES: bool = true;

    fn reset(&mut self, _briefing: &Briefing) {
        self.step = 0;
    }

    fn see(&mut self, seen: &mut Observation) {
        for body in &mut seen.others {
            let error = normal(self.step, body.id) * self.deviation;
            *(self.of)(body) += error;
        }
        self.step += 1;
    }
}

pub(crate) const FAR_DISTANCES: Kind = Kind {
    name: "far-distances",
    about: "takes all distances of bodies for greater than they are; the size is the excess",
    unit: "%",
    sizes: &[3.0, 6.0, 10.0, 20.0, 35.0, 60.0, 100.0],
    source: "fault model: wrong scale",
    make: |percent, driver| changing(driver, move |body| body.position *= 1.0 + share(percent)),
};

pub(crate) const SLOW_OTHERS: Kind = Kind {
    name: "slow-others",
    about: "takes the speeds of bodies for lower than they are; the size is the missing share",
    unit: "%",
    sizes: &[20.0, 35.0, 50.0, 65.0, 80.0, 90.0, 100.0],
    source: "fault model: wrong scale",
    make: |percent, driver| changing(driver, move |body| body.velocity *= 1.0 - share(percent)),
};

pub(crate) const FAST_OTHERS: Kind = Kind {
    name: "fast-others",
    about: "takes the speeds of bodies for higher than they are; the size is the excess",
    unit: "%",
    sizes: &[3.0, 6.0, 10.0, 20.0, 35.0, 60.0, 100.0],
    source: "fault model: wrong scale",
    make: |percent, driver| changing(driver, move |body| body.velocity *= 1.0 + share(percent)),
};

pub(crate) const NO_SIDEWAYS: Kind = Kind {
    name: "no-sideways",
    about: "takes the speeds of bodies across its heading for lower than they are; the size is the missing share",
    unit: "%",
    sizes: &[20.0, 35.0, 50.0, 65.0, 80.0, 90.0, 100.0],
    source: "fault model: a model of motion along the lane only",
    make: |percent, driver| changing(driver, move |body| body.velocity.y *= 1.0 - share(percent)),
};

pub(crate) const SLOW_SELF: Kind = Kind {
    name: "slow-self",
    about: "takes its own speed for lower than it is; the size is the missing share",
    unit: "%",
    sizes: &[2.0, 5.0, 10.0, 15.0, 25.0, 40.0, 60.0],
    source: "fault model: wrong scale of the own speed",
    make: |percent, driver| seeing(driver, move |seen| seen.speed *= 1.0 - share(percent)),
};

pub(crate) const THIN_BODIES: Kind = Kind {
    name: "thin-bodies",
    about: "takes bodies for smaller than they are; the size is the missing share of length and width",
    unit: "%",
    sizes: &[10.0, 20.0, 35.0, 50.0, 65.0, 80.0, 95.0],
    source: "fault model: only a part of a body is detected",
    make: |percent, driver| {
        let left = 1.0 - share(percent);
        changing(driver, move |body| {
            body.outline = match body.outline {
                Outline::Rectangle { length, width } => {
                    Outline::Rectangle { length: left * length, width: left * width }
                }
                Outline::Disc { radius } => Outline::Disc { radius: left * radius },
            }
        })
    },
};

pub(crate) const MISALIGNED: Kind = Kind {
    name: "misaligned",
    about: "sees all bodies turned to the left around the car; the size is the angle",
    unit: "deg",
    sizes: &[0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0],
    source: "fault model: a sensor that is not calibrated",
    make: |angle, driver| {
        let (sin, cos) = libm::sincos(angle.to_radians());
        let turn = Rotation2::from_matrix_unchecked(nalgebra::Matrix2::new(cos, -sin, sin, cos));
        changing(driver, move |body| {
            body.position = turn * body.position;
            body.velocity = turn * body.velocity;
            body.heading += angle.to_radians();
        })
    },
};
