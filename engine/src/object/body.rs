//! The appearance of objects to others: their outline on the ground, height, class and colour.

use nalgebra::Vector2;
use paracosm_road::Pose;
use std::fmt;

/// The class of a body, as sensors, drivers and pictures see it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// A passenger car.
    Car,
    /// A panel van.
    Van,
    /// A lorry.
    Truck,
    /// A bus.
    Bus,
    /// A motorcycle with its rider.
    Motorcycle,
    /// A bicycle with its rider.
    Bicycle,
    /// A person on foot.
    Pedestrian,
    /// A house or another building.
    Building,
    /// A tree.
    Tree,
    /// A sign or a lamp post.
    Sign,
    /// An object of any other class.
    Prop,
}

impl Class {
    /// All classes of bodies.
    pub const ALL: [Self; 11] = [
        Self::Car,
        Self::Van,
        Self::Truck,
        Self::Bus,
        Self::Motorcycle,
        Self::Bicycle,
        Self::Pedestrian,
        Self::Building,
        Self::Tree,
        Self::Sign,
        Self::Prop,
    ];

    /// Returns `true` if bodies of this class take part in traffic. All other bodies are scenery or things.
    pub fn is_road_user(self) -> bool {
        !matches!(self, Self::Building | Self::Tree | Self::Sign | Self::Prop)
    }

    /// Returns the colour that a body of this class has by default.
    fn usual_colour(self) -> Colour {
        match self {
            Class::Car => [150, 155, 160],
            Class::Van => [225, 225, 220],
            Class::Truck => [60, 90, 140],
            Class::Bus => [190, 45, 40],
            Class::Motorcycle => [40, 40, 45],
            Class::Bicycle => [30, 30, 30],
            Class::Pedestrian => [70, 75, 110],
            Class::Building => [190, 175, 155],
            Class::Tree => [50, 95, 45],
            Class::Sign => [215, 215, 215],
            Class::Prop => [200, 140, 60],
        }
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Class::Car => "car",
            Class::Van => "van",
            Class::Truck => "truck",
            Class::Bus => "bus",
            Class::Motorcycle => "motorcycle",
            Class::Bicycle => "bicycle",
            Class::Pedestrian => "pedestrian",
            Class::Building => "building",
            Class::Tree => "tree",
            Class::Sign => "sign",
            Class::Prop => "prop",
        })
    }
}

/// The area of the ground that a body covers. Lengths are in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    /// A rectangle around the body's position, with the length along the body's heading.
    Rectangle {
        /// The length of the rectangle along the heading, in metres.
        length: f64,
        /// The width of the rectangle across the heading, in metres.
        width: f64,
    },
    /// A disc around the body's position.
    Disc {
        /// The radius of the disc, in metres.
        radius: f64,
    },
}

impl Outline {
    /// Returns half of the length and half of the width of the outline, in metres.
    pub fn half_extent(&self) -> Vector2<f64> {
        match *self {
            Outline::Rectangle { length, width } => 0.5 * Vector2::new(length, width),
            Outline::Disc { radius } => Vector2::new(radius, radius),
        }
    }

    /// Returns half the extent in metres of the outline along each axis, for a body with the given heading.
    pub fn enclosing(&self, heading: f64) -> Vector2<f64> {
        let half = self.half_extent();
        match self {
            Outline::Disc { .. } => half,
            Outline::Rectangle { .. } => {
                let (sin, cos) = libm::sincos(heading);
                let (sin, cos) = (sin.abs(), cos.abs());
                Vector2::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y)
            }
        }
    }

    /// Returns a radius in metres that is no smaller than [`Outline::reach`], without a root.
    pub(crate) fn reach_at_most(&self) -> f64 {
        match *self {
            Outline::Rectangle { length, width } => 0.5 * (length + width),
            Outline::Disc { radius } => radius,
        }
    }

    /// Returns the radius in metres of the smallest disc around the body's position that contains the outline.
    pub fn reach(&self) -> f64 {
        match self {
            Outline::Rectangle { .. } => self.half_extent().norm(),
            Outline::Disc { radius } => *radius,
        }
    }
}

/// A colour in sRGB, as red, green and blue from 0 to 255.
pub type Colour = [u8; 3];

/// A body in the world, with its class, its outline, its height and its colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// The class of the body.
    pub class: Class,
    /// The area of the ground that the body covers.
    pub outline: Outline,
    /// The height from the ground to the top of the body, in metres.
    pub height: f64,
    /// The colour of the body for sensors. Pictures draw a body in the colour of its class.
    pub colour: Colour,
}

impl Body {
    /// Makes a body with a rectangular outline of a length, width and height in metres, in the colour of its class.
    pub fn block(class: Class, length: f64, width: f64, height: f64) -> Self {
        Self { class, outline: Outline::Rectangle { length, width }, height, colour: class.usual_colour() }
    }

    /// Makes a body with a round outline of a radius and height in metres, in the colour of its class.
    pub fn disc(class: Class, radius: f64, height: f64) -> Self {
        Self { class, outline: Outline::Disc { radius }, height, colour: class.usual_colour() }
    }

    /// Makes the body of a person of average build. The Euro NCAP adult dummy is 0.5 m wide and 1.8 m tall.
    pub fn adult() -> Self {
        Self::disc(Class::Pedestrian, 0.25, 1.8)
    }

    /// Makes the body of a child. The Euro NCAP child dummy is 0.3 m wide and 1.15 m tall.
    pub fn child() -> Self {
        Self::disc(Class::Pedestrian, 0.15, 1.15)
    }

    /// Returns the same body in another colour.
    pub fn coloured(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// Returns length, width and height in metres if one of them is not a finite number above 0.
    pub(crate) fn wrong_measures(&self) -> Option<[f64; 3]> {
        let extent = self.outline.half_extent();
        let sound = [extent.x, extent.y, self.height].iter().all(|metres| *metres > 0.0 && metres.is_finite());
        (!sound).then_some([2.0 * extent.x, 2.0 * extent.y, self.height])
    }
}

/// The state of a body at the beginning of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// The class, the outline, the height and the colour of the body.
    pub body: Body,
    /// The position of the body's middle, and the body's heading.
    pub pose: Pose,
    /// The velocity of the body over the ground during the last tick, in m/s.
    pub velocity: Vector2<f64>,
    /// The height of the body's lowest point above the ground, in metres; 0 for a body that is not physical.
    pub altitude: f64,
    /// The distance that the body has travelled since the run began, in metres. Pictures move legs and wheels by it.
    pub travelled: f64,
    /// `true` if the body is in the world. A body that has left it keeps its last pose and is in nobody's way.
    pub present: bool,
}

impl BodyState {
    /// Makes the state of a body at rest on the ground.
    pub(crate) fn at_rest(body: Body, pose: Pose) -> Self {
        Self { body, pose, velocity: Vector2::zeros(), altitude: 0.0, travelled: 0.0, present: true }
    }

    /// Sets the state to that of the same body, `before`, after it moved to a pose within a tick of `dt` seconds. With
    /// `None`, it leaves the world.
    pub(crate) fn follow(&mut self, before: &Self, pose: Option<Pose>, dt: f64) {
        let present = pose.is_some();
        let pose = pose.unwrap_or(before.pose);
        // A body that enters the world has not travelled to its place.
        let way = if before.present { pose.position - before.pose.position } else { Vector2::zeros() };
        // The body itself stays the same: the states of many bodies are written at every tick.
        self.present = present;
        self.pose = pose;
        self.velocity = way / dt;
        self.travelled = before.travelled + way.norm();
        self.altitude = before.altitude;
    }
}
