//! Classes of bodies that the driver does not see, or sees only when they are near.

use super::hiding;
use crate::kind::Kind;
use paracosm_engine::driver::Driver;
use paracosm_engine::object::Class;

/// The distances in metres beyond which the driver does not see the class. At 0 it never sees the class.
const RANGES: &[f64] = &[45.0, 35.0, 28.0, 22.0, 16.0, 10.0, 5.0, 0.0];

fn unseen(classes: &'static [Class], range: f64, driver: Box<dyn Driver>) -> Box<dyn Driver> {
    hiding(driver, move |body, _| classes.contains(&body.class) && (range == 0.0 || body.position.norm() > range))
}

pub(crate) const UNSEEN_PEDESTRIANS: Kind = Kind {
    name: "unseen-pedestrians",
    about: "sees no pedestrian farther away than the size, and never any if the size is 0",
    unit: "m",
    sizes: RANGES,
    source: "AAA 2019, Automatic Emergency Braking with Pedestrian Detection (no reaction to pedestrians at night)",
    make: |range, driver| unseen(&[Class::Pedestrian], range, driver),
};

pub(crate) const UNSEEN_TWO_WHEELERS: Kind = Kind {
    name: "unseen-two-wheelers",
    about: "sees no bicycle and no motorcycle farther away than the size, and never any if the size is 0",
    unit: "m",
    sizes: RANGES,
    source: "fault model: a class that the detector does not know",
    make: |range, driver| unseen(&[Class::Bicycle, Class::Motorcycle], range, driver),
};

pub(crate) const UNSEEN_CARS: Kind = Kind {
    name: "unseen-cars",
    about: "sees no car and no van farther away than the size, and never any if the size is 0",
    unit: "m",
    sizes: RANGES,
    source: "fault model: a class that the detector does not know",
    make: |range, driver| unseen(&[Class::Car, Class::Van], range, driver),
};

pub(crate) const UNSEEN_LORRIES: Kind = Kind {
    name: "unseen-lorries",
    about: "sees no lorry and no bus farther away than the size, and never any if the size is 0",
    unit: "m",
    sizes: RANGES,
    source: "NTSB/HAR-17/02 (Williston: a crossing truck was not detected)",
    make: |range, driver| unseen(&[Class::Truck, Class::Bus], range, driver),
};

pub(crate) const UNSEEN_THINGS: Kind = Kind {
    name: "unseen-things",
    about: "sees nothing that is no road user farther away than the size, and never any if the size is 0",
    unit: "m",
    sizes: RANGES,
    source: "NTSB/HAR-20/01 (Mountain View: no warning and no braking before a crash attenuator)",
    make: |range, driver| unseen(&[Class::Building, Class::Tree, Class::Sign, Class::Prop], range, driver),
};
