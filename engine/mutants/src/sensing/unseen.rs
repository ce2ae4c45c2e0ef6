//! Bodies that the driver does not see, because of their place, their motion or their size.

use super::hiding;
use crate::kind::Kind;
use paracosm_engine::Other;

/// The speed of the car in m/s around which the driver is blind.
const BLIND_SPEED: f64 = 12.0;
/// The bearing in degrees from which on bodies are beside the car, and not right ahead of it.
const RIGHT_AHEAD: f64 = 2.0;

/// Returns the bearing of a body in degrees, positive to the left.
fn bearing(body: &Other) -> f64 {
    libm::atan2(body.position.y, body.position.x).to_degrees()
}

pub(crate) const SHORT_RANGE: Kind = Kind {
    name: "short-range",
    about: "sees no body that is farther away than the size",
    unit: "m",
    sizes: &[80.0, 60.0, 46.0, 35.0, 25.0, 17.0, 11.0, 7.0],
    source: "UN Regulation No. 157 asks for a detection range of at least 46 m ahead at 60 km/h",
    make: |range, driver| hiding(driver, move |body, _| body.position.norm() > range),
};

pub(crate) const NARROW_VIEW: Kind = Kind {
    name: "narrow-view",
    about: "sees only bodies within a field of view ahead, whose opening angle is the size",
    unit: "deg",
    sizes: &[120.0, 60.0, 40.0, 30.0, 22.0, 16.0, 10.0, 5.0],
    source: "fault model: limited field of view",
    make: |angle, driver| hiding(driver, move |body, _| bearing(body).abs() > 0.5 * angle),
};

pub(crate) const BLIND_LEFT: Kind = Kind {
    name: "blind-left",
    about: "sees no body in a sector that begins 2 degrees to the left and is as wide as the size",
    unit: "deg",
    sizes: &[3.0, 6.0, 10.0, 20.0, 35.0, 60.0, 90.0, 178.0],
    source: "fault model: a part of the sensor is covered",
    make: |width, driver| hiding(driver, move |body, _| (RIGHT_AHEAD..=RIGHT_AHEAD + width).contains(&bearing(body))),
};

pub(crate) const BLIND_RIGHT: Kind = Kind {
    name: "blind-right",
    about: "sees no body in a sector that begins 2 degrees to the right and is as wide as the size",
    unit: "deg",
    sizes: &[3.0, 6.0, 10.0, 20.0, 35.0, 60.0, 90.0, 178.0],
    source: "fault model: a part of the sensor is covered",
    make: |width, driver| hiding(driver, move |body, _| (RIGHT_AHEAD..=RIGHT_AHEAD + width).contains(&-bearing(body))),
};

pub(crate) const BLIND_NEAR: Kind = Kind {
    name: "blind-near",
    about: "sees no body that is nearer than the size, from middle to middle",
    unit: "m",
    sizes: &[5.0, 7.0, 10.0, 14.0, 19.0, 26.0, 40.0, 60.0],
    source: "fault model: dead zone of a sensor",
    make: |range, driver| hiding(driver, move |body, _| body.position.norm() < range),
};

pub(crate) const BLIND_SPEEDS: Kind = Kind {
    name: "blind-speeds",
    about: "sees no body while its own speed is in a band around 12 m/s that is as wide as the size",
    unit: "m/s",
    sizes: &[0.5, 1.0, 2.0, 4.0, 7.0, 12.0, 24.0],
    source: "fault model: a table with a wrong row",
    make: |width, driver| hiding(driver, move |_, speed| (speed - BLIND_SPEED).abs() <= 0.5 * width),
};

pub(crate) const NARROW_CORRIDOR: Kind = Kind {
    name: "narrow-corridor",
    about: "sees no body whose middle is farther to the side than the size",
    unit: "m",
    sizes: &[6.0, 4.5, 3.5, 2.8, 2.2, 1.7, 1.2, 0.7],
    source: "fault model: objects outside of the car's own path are discarded",
    make: |width, driver| hiding(driver, move |body, _| body.position.y.abs() > width),
};

pub(crate) const UNSEEN_STANDING: Kind = Kind {
    name: "unseen-standing",
    about: "sees no body that is slower over the ground than the size",
    unit: "m/s",
    sizes: &[0.1, 0.3, 0.7, 1.2, 2.0, 4.0, 8.0],
    source: "NTSB/HAB-19/07 (Culver City: a standing fire truck was struck); filters of radars for standing objects",
    make: |speed, driver| hiding(driver, move |body, _| body.velocity.norm() < speed),
};

pub(crate) const UNSEEN_CROSSING: Kind = Kind {
    name: "unseen-crossing",
    about: "sees no body whose speed across the car's heading is greater than the size",
    unit: "m/s",
    sizes: &[5.0, 3.5, 2.5, 1.8, 1.3, 0.9, 0.5, 0.2],
    source: "NTSB/HAR-17/02 (Williston: a crossing truck was not detected)",
    make: |speed, driver| hiding(driver, move |body, _| body.velocity.y.abs() > speed),
};

pub(crate) const UNSEEN_ONCOMING: Kind = Kind {
    name: "unseen-oncoming",
    about: "sees no body that comes the other way faster than the size",
    unit: "m/s",
    sizes: &[20.0, 14.0, 10.0, 7.0, 4.0, 2.0, 1.0, 0.3],
    source: "fault model: filter for oncoming traffic",
    make: |speed, driver| hiding(driver, move |body, _| body.velocity.x < -speed),
};

pub(crate) const UNSEEN_SMALL: Kind = Kind {
    name: "unseen-small",
    about: "sees no body whose length and width are below the size",
    unit: "m",
    sizes: &[0.4, 0.55, 0.7, 1.0, 1.5, 2.5, 5.0],
    source: "AAA 2019, Automatic Emergency Braking with Pedestrian Detection (89 % collisions with a child at 20 mph)",
    make: |length, driver| hiding(driver, move |body, _| 2.0 * body.outline.half_extent().max() < length),
};
