//! Contacts of the ego vehicle with other objects.

use crate::object::Class;
use std::fmt;

/// A contact of the ego vehicle with another object.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// The name of the object that the ego vehicle touched.
    pub with: String,
    /// The class of the object that the ego vehicle touched.
    pub class: Class,
    /// The side of the ego vehicle that touched the object.
    pub face: Face,
    /// The motion of the ego vehicle at the contact.
    pub motion: ContactMotion,
    /// The speed of the ego vehicle at the contact, in m/s.
    pub speed: f64,
    /// The speed of the object at the contact, in m/s.
    pub other_speed: f64,
}

/// A side of the ego vehicle's body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Face {
    /// The front of the ego vehicle.
    Front,
    /// The left side of the ego vehicle.
    Left,
    /// The right side of the ego vehicle.
    Right,
    /// The rear of the ego vehicle.
    Rear,
}

impl Face {
    /// All sides of the ego vehicle's body.
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

/// The motion of the ego vehicle at a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ContactMotion {
    /// The ego vehicle drives and does not brake.
    Driving,
    /// The ego vehicle brakes by more than 0.5 m/s².
    Braking,
    /// The ego vehicle is slower than 0.1 m/s.
    Standing,
}

impl ContactMotion {
    /// All kinds of motion of the ego vehicle at a contact.
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
