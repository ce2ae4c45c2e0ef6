//! What an object is to others: its outline on the ground, its height, and what it is taken for.

use crate::geometry::Pose;
use nalgebra::Vector2;
use std::fmt;

/// What a body is taken for: by sensors, drivers and pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// A passenger car.
    Car,
    /// A lorry or a bus.
    Truck,
    /// A bicycle with its rider.
    Bicycle,
    /// A person on foot.
    Pedestrian,
    /// A house.
    Building,
    /// A tree.
    Tree,
    /// A sign or a lamp post.
    Sign,
    /// Anything else.
    Prop,
}

impl Class {
    /// All classes.
    pub const ALL: [Self; 8] =
        [Self::Car, Self::Truck, Self::Bicycle, Self::Pedestrian, Self::Building, Self::Tree, Self::Sign, Self::Prop];

    /// The colour of a body of this class where nothing else is said.
    fn usual_colour(self) -> Colour {
        match self {
            Class::Car => [150, 155, 160],
            Class::Truck => [60, 90, 140],
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
            Class::Truck => "truck",
            Class::Bicycle => "bicycle",
            Class::Pedestrian => "pedestrian",
            Class::Building => "building",
            Class::Tree => "tree",
            Class::Sign => "sign",
            Class::Prop => "prop",
        })
    }
}

/// What a body covers of the ground. Lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    /// A rectangle around the body's position, with its length along the heading.
    Rectangle {
        /// Along the heading.
        length: f64,
        /// Across it.
        width: f64,
    },
    /// A disc around the body's position.
    Disc {
        /// Its radius.
        radius: f64,
    },
}

impl Outline {
    /// Half of its length and half of its width, in metres.
    pub fn half_extent(&self) -> Vector2<f64> {
        match *self {
            Outline::Rectangle { length, width } => 0.5 * Vector2::new(length, width),
            Outline::Disc { radius } => Vector2::new(radius, radius),
        }
    }

    /// The halves, in metres, of the rectangle along the axes that encloses a body with this outline and this heading.
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

    /// The radius in metres of the least disc around the body's position that holds it.
    pub fn reach(&self) -> f64 {
        match self {
            Outline::Rectangle { .. } => self.half_extent().norm(),
            Outline::Disc { radius } => *radius,
        }
    }
}

/// Red, green and blue, as sRGB has them.
pub type Colour = [u8; 3];

/// A body: what it is, how much room it takes, and what it looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// What it is taken for.
    pub class: Class,
    /// What it covers of the ground.
    pub outline: Outline,
    /// From the ground to its top, in metres.
    pub height: f64,
    /// The colour that it has to sensors. Pictures draw it in that of its class.
    pub colour: Colour,
}

impl Body {
    /// A body with a rectangular outline: length, width and height in metres. Its colour is the usual one of its class.
    pub fn block(class: Class, length: f64, width: f64, height: f64) -> Self {
        Self { class, outline: Outline::Rectangle { length, width }, height, colour: class.usual_colour() }
    }

    /// A body with a round outline: radius and height in metres. Its colour is the usual one of its class.
    pub fn disc(class: Class, radius: f64, height: f64) -> Self {
        Self { class, outline: Outline::Disc { radius }, height, colour: class.usual_colour() }
    }

    /// A person of average build: the Euro NCAP adult dummy is 0.5 m wide and 1.8 m tall.
    pub fn adult() -> Self {
        Self::disc(Class::Pedestrian, 0.25, 1.8)
    }

    /// A child: the Euro NCAP child dummy is 0.3 m wide and 1.15 m tall.
    pub fn child() -> Self {
        Self::disc(Class::Pedestrian, 0.15, 1.15)
    }

    /// A passenger car of middle size.
    pub fn car() -> Self {
        Self::block(Class::Car, 4.5, 1.8, 1.45)
    }

    /// A lorry.
    pub fn truck() -> Self {
        Self::block(Class::Truck, 10.0, 2.5, 3.5)
    }

    /// A bicycle with its rider.
    pub fn bicycle() -> Self {
        Self::block(Class::Bicycle, 1.8, 0.6, 1.75)
    }

    /// A bicycle that nobody rides: sensors tell it from one with a rider by its height.
    pub fn parked_bicycle() -> Self {
        Self::block(Class::Bicycle, 1.8, 0.6, 1.05)
    }

    /// The same in this colour.
    pub fn coloured(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// Length, width and height in metres, if one of them is no length.
    pub(crate) fn wrong_measures(&self) -> Option<[f64; 3]> {
        let extent = self.outline.half_extent();
        let sound = [extent.x, extent.y, self.height].iter().all(|metres| *metres > 0.0 && metres.is_finite());
        (!sound).then_some([2.0 * extent.x, 2.0 * extent.y, self.height])
    }
}

/// A body where it stands at the beginning of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// What it is.
    pub body: Body,
    /// Where its middle is, and where it faces.
    pub pose: Pose,
    /// How it moved over the last tick, in m/s over the ground.
    pub velocity: Vector2<f64>,
    /// How far its lowest point is above the ground, in metres. What is not physical stays on the ground.
    pub altitude: f64,
    /// How long the way is that it has come since the run began, in metres: legs and wheels turn by it.
    pub travelled: f64,
    /// Whether it is in the world. One that has left it stands where it was last seen, and is in nobody's way.
    pub present: bool,
}

impl BodyState {
    /// A body at rest on the ground.
    pub(crate) fn at_rest(body: Body, pose: Pose) -> Self {
        Self { body, pose, velocity: Vector2::zeros(), altitude: 0.0, travelled: 0.0, present: true }
    }

    /// The pose that it takes within a tick of `dt` seconds; `None` if it leaves the world.
    pub(crate) fn move_to(&mut self, pose: Option<Pose>, dt: f64) {
        self.present = pose.is_some();
        let pose = pose.unwrap_or(self.pose);
        let way = pose.position - self.pose.position;
        self.velocity = way / dt;
        self.travelled += way.norm();
        self.pose = pose;
    }
}
