//! Describes the signals of traces: what they measure, in which unit, and which values they can have.
//!
//! The descriptors are the one place that says so. Lists, error messages and documents are made from them. A program can have signals
//! of its own, which nobody describes here.

mod quantity;

use crate::object::Class;
pub(crate) use quantity::Quantity;

/// The description of a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalAbout {
    /// The unit of the values; empty if they have none.
    pub unit: &'static str,
    /// The definition of the signal in one line.
    pub about: &'static str,
    /// The least and the greatest value; infinite if there is no bound.
    pub range: [f64; 2],
}

impl SignalAbout {
    /// Returns the definition, with the unit and the range of the values in brackets.
    pub fn in_words(&self) -> String {
        match self.values() {
            values if values.is_empty() => self.about.to_owned(),
            values => format!("{} ({values})", self.about),
        }
    }

    /// Returns the unit and the range of the values in words, such as `m/s, 0 and more`.
    pub fn values(&self) -> String {
        let range = match self.range {
            ANY => String::new(),
            POSITIVE => "0 and more".to_owned(),
            [least, most] => format!("{}..{}", short(least), short(most)),
        };
        [self.unit.to_owned(), range].into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// Returns a number with two decimal places at most.
fn short(number: f64) -> String {
    format!("{number:.2}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The range of numbers from 0.
pub(crate) const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];
/// The range of all numbers.
pub(crate) const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// The signals of the ego vehicle that every trace has.
const CAR: [(&str, SignalAbout); 9] = [
    ("car.x", of("m", "the place of the car's middle along the x axis of the world", ANY)),
    ("car.y", of("m", "the place of the car's middle along the y axis of the world", ANY)),
    (
        "car.heading",
        of("rad", "the heading, counter-clockwise from the x axis", [-std::f64::consts::PI, std::f64::consts::PI]),
    ),
    ("car.speed", of("m/s", "the speed over the ground, in any direction", POSITIVE)),
    ("car.acceleration", of("m/s²", "the forward acceleration over the last tick; negative while braking", ANY)),
    ("car.throttle", of("", "what the driver asks of the pedals: from full braking to full throttle", [-1.0, 1.0])),
    ("car.steering", of("", "what the driver asks of the steering: from full right to full left", [-1.0, 1.0])),
    ("car.travelled", of("m", "the distance covered since the beginning", POSITIVE)),
    (
        "car.clearance",
        of(
            "m",
            "the distance to the nearest other body of any class, without the scenery beside the road; at a contact, minus the missing \
             braking distance",
            ANY,
        ),
    ),
];

/// The signals of other road users, by the end of their names.
const OTHERS: [(&str, SignalAbout); 3] = [
    ("x", of("m", "the place of its middle along the x axis of the world", ANY)),
    ("y", of("m", "the place of its middle along the y axis of the world", ANY)),
    ("speed", of("m/s", "its speed over the ground", POSITIVE)),
];

/// The classes of road users that have a clearance of their own.
pub(crate) const ROAD_USERS: [(Class, &str, &str); 7] = [
    (Class::Pedestrian, "car.clearance_to_pedestrian", "as car.clearance, from pedestrians only; infinite without one"),
    (Class::Bicycle, "car.clearance_to_bicycle", "as car.clearance, from bicycles only; infinite without one"),
    (Class::Motorcycle, "car.clearance_to_motorcycle", "as car.clearance, from motorcycles only; infinite without one"),
    (Class::Car, "car.clearance_to_car", "as car.clearance, from other cars only; infinite without one"),
    (Class::Van, "car.clearance_to_van", "as car.clearance, from vans only; infinite without one"),
    (Class::Truck, "car.clearance_to_truck", "as car.clearance, from trucks only; infinite without one"),
    (Class::Bus, "car.clearance_to_bus", "as car.clearance, from buses only; infinite without one"),
];

pub(crate) const fn of(unit: &'static str, about: &'static str, range: [f64; 2]) -> SignalAbout {
    SignalAbout { unit, about, range }
}

/// Returns the description of a signal by its name; `None` for a signal that only a program knows.
pub fn about(name: &str) -> Option<SignalAbout> {
    let measured = || on_request().find(|(known, _)| *known == name).map(|(_, about)| about);
    let of_car = CAR.iter().find(|(known, _)| *known == name).map(|(_, about)| *about);
    let of_other = || {
        let (object, end) = name.rsplit_once('.')?;
        OTHERS.iter().find(|(known, _)| object != "car" && *known == end).map(|(_, about)| *about)
    };
    of_car.or_else(measured).or_else(of_other)
}

/// Returns the signals of the ego vehicle that every trace has, with their descriptions.
pub fn always() -> impl Iterator<Item = (&'static str, SignalAbout)> {
    CAR.into_iter()
}

/// Returns the signals of the ego vehicle that a trace has if a formula or a program asks for them, with their descriptions.
pub fn on_request() -> impl Iterator<Item = (&'static str, SignalAbout)> {
    Quantity::all().map(|quantity| (quantity.name(), quantity.about()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_have_different_names_and_each_is_found_by_its_name() {
        let all: Vec<_> = always().chain(on_request()).collect();
        for (i, (name, described)) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|(other, _)| other != name), "{name} comes twice");
            assert_eq!(about(name), Some(*described), "{name}");
        }
        assert_eq!(about("pedestrian.speed").map(|about| about.unit), Some("m/s"));
        assert_eq!(about("car.speeed"), None);
    }
}
