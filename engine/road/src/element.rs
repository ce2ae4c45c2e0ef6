//! Road elements that are not connected yet, as programs describe them.

use super::curve::Curve;
use crate::geometry::Pose;
use nalgebra::Vector2;

/// The width of a lane in metres, as usual on urban main roads.
const LANE_WIDTH: f64 = 3.5;
/// Width of a sidewalk in metres.
const SIDEWALK_WIDTH: f64 = 2.0;
/// Radius of an intersection's kerb in metres, with room for the sidewalk around it.
const CORNER: f64 = 6.0;
/// Radius in metres of the kerb at which a car enters a roundabout or leaves it.
const ENTRY: f64 = 8.0;
/// Radius of a roundabout's island in metres: with one lane around it, 28 m from kerb to kerb.
const ISLAND: f64 = 10.0;

/// The cross-section of a road: lanes for both directions around the centre line, and a sidewalk on either side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Profile {
    /// The number of lanes of the road, in both directions together.
    pub lanes: i32,
    pub lane_width: f64,
    /// The width of a sidewalk in metres; 0 if the road has no sidewalks.
    pub sidewalk: f64,
}

impl Profile {
    /// Returns the number of lanes in each direction of the road.
    pub fn each_way(&self) -> i32 {
        self.lanes / 2
    }

    /// Returns the distance from the centre line to the kerb, in metres.
    pub fn half_width(&self) -> f64 {
        0.5 * f64::from(self.lanes) * self.lane_width
    }

    /// Returns the distance from the centre line to the middle of a lane, in metres. Lane 1 is next to the centre line.
    pub fn lane_offset(&self, number: i32) -> f64 {
        (f64::from(number) - 0.5) * self.lane_width
    }

    /// Returns the distance from the centre line to the middle of a sidewalk, in metres.
    pub fn sidewalk_offset(&self) -> f64 {
        self.half_width() + 0.5 * self.sidewalk
    }
}

/// A road element of the shape `S` that is not connected to other elements yet.
///
/// By default, an element has two lanes of 3.5 m, one for each direction, and sidewalks of 2 m.
#[derive(Debug, Clone, PartialEq)]
pub struct Element<S> {
    pub(super) name: Option<String>,
    pub(crate) profile: Profile,
    pub(super) shape: S,
}

/// The shape of a straight or curved road.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    pub(super) length: f64,
    /// The curvature in 1/m, positive to the left.
    pub(super) curvature: f64,
    /// The places of the zebra crossings, in metres along the road.
    zebras: Vec<f64>,
}

/// The shape of an intersection with three arms.
#[derive(Debug, Clone, PartialEq)]
pub struct Tee {
    corner: f64,
}

/// The shape of an intersection with four arms.
#[derive(Debug, Clone, PartialEq)]
pub struct Cross {
    corner: f64,
}

/// The shape of a roundabout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    pub(super) arms: i32,
    pub(super) island: f64,
    pub(super) entry: f64,
}

/// The shape of a road element. It is public only because [`Element`] refers to it; other crates cannot name it.
#[derive(Debug, Clone, PartialEq)]
pub enum ElementShape {
    Segment(Segment),
    /// An intersection with three arms, with the radius of its kerbs in metres.
    Tee(f64),
    /// An intersection with four arms, with the radius of its kerbs in metres.
    Cross(f64),
    Ring(Ring),
}

impl From<Segment> for ElementShape {
    fn from(segment: Segment) -> Self {
        ElementShape::Segment(segment)
    }
}

impl From<Tee> for ElementShape {
    fn from(tee: Tee) -> Self {
        ElementShape::Tee(tee.corner)
    }
}

impl From<Cross> for ElementShape {
    fn from(cross: Cross) -> Self {
        ElementShape::Cross(cross.corner)
    }
}

impl From<Ring> for ElementShape {
    fn from(ring: Ring) -> Self {
        ElementShape::Ring(ring)
    }
}

/// A straight or curved road from the point `one` to the point `two`. Its lanes 1, 2, ... lead in this direction.
pub type RoadSegment = Element<Segment>;

/// A road with its own friction, for programs that place roads in worlds.
#[derive(Debug, Clone)]
pub struct Paved<F> {
    /// The road.
    pub road: RoadSegment,
    /// The friction coefficient between tyre and road, as the world understands it.
    pub friction: F,
}

impl RoadSegment {
    /// Sets the friction coefficient between tyre and road, like the friction of an environment for a world with one road.
    pub fn friction<F>(self, friction: F) -> Paved<F> {
        Paved { road: self, friction }
    }
}

/// An intersection where a road ends at another road. The arms lead east (`one`), south (`two`) and west (`three`).
pub type TIntersection = Element<Tee>;

/// An intersection of two roads with arms east (`one`), south (`two`), west (`three`) and north (`four`), clockwise.
pub type CrossIntersection = Element<Cross>;

/// A roundabout with counter-clockwise traffic. Its arms `one`, `two`, ... lie clockwise from the east, at equal
/// angles.
pub type Roundabout = Element<Ring>;

impl Segment {
    /// Returns the centre line, from the origin along x.
    pub(super) fn centre_line(&self) -> Curve {
        Curve::new(Pose { position: Vector2::zeros(), heading: 0.0 }, self.curvature, self.length)
    }

    /// Returns the places of the zebra crossings in metres along the road, in order.
    pub(super) fn zebras(&self) -> Vec<f64> {
        let mut zebras = self.zebras.clone();
        zebras.sort_by(f64::total_cmp);
        zebras
    }
}

impl<S> Element<S> {
    fn of(shape: S) -> Self {
        let profile = Profile { lanes: 2, lane_width: LANE_WIDTH, sidewalk: SIDEWALK_WIDTH };
        Self { name: None, profile, shape }
    }

    /// Sets the number of lanes in both directions together, which has to be even.
    pub fn lanes(mut self, lanes: i32) -> Self {
        self.profile.lanes = lanes;
        self
    }

    /// Sets the width of every lane, in metres.
    pub fn lane_width(mut self, width: f64) -> Self {
        self.profile.lane_width = width;
        self
    }

    /// Sets the width of the sidewalks in metres; 0 for a road without sidewalks.
    pub fn sidewalk(mut self, width: f64) -> Self {
        self.profile.sidewalk = width;
        self
    }

    /// Sets the name of the element, by which a composite refers to the points of the element. An element without a
    /// name is called by its kind, with a number from the second of the kind on: `road`, `road-2`, ...
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}

impl RoadSegment {
    /// Makes a straight road of `length` metres, which begins at the origin and leads along x.
    pub fn new(length: f64) -> Self {
        Self::of(Segment { length, curvature: 0.0, zebras: Vec::new() })
    }

    /// Makes a road along a circular arc. `radius` is the radius of its centre line in metres; `angle` is the angle in
    /// radians by which the road turns, positive to the left.
    pub fn arc(radius: f64, angle: f64) -> Self {
        let length = radius * angle.abs();
        Self::of(Segment { length, curvature: angle.signum() / radius, zebras: Vec::new() })
    }

    /// Adds a zebra crossing, 4 m wide, with its middle `at` metres along the road.
    pub fn zebra(mut self, at: f64) -> Self {
        self.shape.zebras.push(at);
        self
    }
}

impl TIntersection {
    /// Returns the distance in metres from the middle of the intersection to the points at the ends of its arms.
    pub fn reach(&self) -> f64 {
        self.profile.half_width() + self.shape.corner
    }

    /// Makes an intersection with three arms. Its kerbs have a radius of 6 m.
    #[expect(clippy::new_without_default, reason = "as every other element it is made by its name")]
    pub fn new() -> Self {
        Self::of(Tee { corner: CORNER })
    }

    /// Sets the radius of the kerbs in metres, which has to be greater than the width of the sidewalks. The tightest
    /// right turn has this radius plus half a lane.
    pub fn corner(mut self, radius: f64) -> Self {
        self.shape.corner = radius;
        self
    }
}

impl CrossIntersection {
    /// Returns the distance in metres from the middle of the intersection to the points at the ends of its arms.
    pub fn reach(&self) -> f64 {
        self.profile.half_width() + self.shape.corner
    }

    /// Makes an intersection with four arms. Its kerbs have a radius of 6 m.
    #[expect(clippy::new_without_default, reason = "as every other element it is made by its name")]
    pub fn new() -> Self {
        Self::of(Cross { corner: CORNER })
    }

    /// Sets the radius of the kerbs in metres, which has to be greater than the width of the sidewalks. The tightest
    /// right turn has this radius plus half a lane.
    pub fn corner(mut self, radius: f64) -> Self {
        self.shape.corner = radius;
        self
    }
}

impl Roundabout {
    /// Returns the distance in metres from the middle of the roundabout to the points at the ends of its arms.
    pub fn reach(&self) -> f64 {
        self.shape.reach(&self.profile)
    }

    /// Makes a roundabout with four arms and an island of 10 m radius. The number of lanes around the island equals the
    /// number of lanes from an arm into the roundabout.
    #[expect(clippy::new_without_default, reason = "as every other element it is made by its name")]
    pub fn new() -> Self {
        Self::of(Ring { arms: 4, island: ISLAND, entry: ENTRY })
    }

    /// Sets the number of arms of the roundabout, from 3 to 8.
    pub fn arms(mut self, arms: i32) -> Self {
        self.shape.arms = arms;
        self
    }

    /// Sets the radius of the roundabout's island, in metres.
    pub fn island(mut self, radius: f64) -> Self {
        self.shape.island = radius;
        self
    }

    /// Sets the radius of the kerbs at entries and exits in metres, which has to exceed the width of the sidewalks.
    pub fn entry(mut self, radius: f64) -> Self {
        self.shape.entry = radius;
        self
    }
}
