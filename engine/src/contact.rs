//! How the car under test touches something.

use crate::object::Class;
use std::fmt;

/// How the car under test touched something.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// The name of the object.
    pub with: String,
    /// What it is taken for.
    pub class: Class,
    /// The side of the car.
    pub face: Face,
    /// What the car was doing.
    pub motion: ContactMotion,
    /// How fast the car was, in m/s.
    pub speed: f64,
    /// How fast the object was, in m/s.
    pub other_speed: f64,
}

/// A side of the car's body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Face {
    /// The front.
    Front,
    /// The left side.
    Left,
    /// The right side.
    Right,
    /// The rear.
    Rear,
}

impl Face {
    /// All sides.
    pub const ALL: [Self; 4] = [Self::Front, Self::Left, Self::Right, Self::Rear];
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Front => "front",
            Self::Left => "left",
            Self::Right => "right",
            Self::Rear => "rear",
        })
    }
}

/// What a car does at a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ContactMotion {
    /// It drives and does not brake.
    Driving,
    /// It brakes by more than 0.5 m/s².
    Braking,
    /// It is slower than 0.1 m/s.
    Standing,
}

impl ContactMotion {
    /// All there are.
    pub const ALL: [Self; 3] = [Self::Driving, Self::Braking, Self::Standing];
}

impl fmt::Display for ContactMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Driving => "driving",
            Self::Braking => "braking",
            Self::Standing => "standing",
        })
    }
}
