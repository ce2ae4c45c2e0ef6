//! Road elements before they are connected: what programs write.

use super::curve::Curve;
use crate::geometry::Pose;
use nalgebra::Vector2;

/// Width of a lane in metres: the usual of urban main roads.
const LANE_WIDTH: f64 = 3.5;
/// Width of a sidewalk in metres.
const SIDEWALK_WIDTH: f64 = 2.0;
/// Radius of an intersection's kerb in metres, with room for the sidewalk around it.
const CORNER: f64 = 6.0;
/// Radius in metres of the kerb at which a car enters a roundabout or leaves it.
const ENTRY: f64 = 8.0;
/// Radius of a roundabout's island in metres: with one lane around it, 28 m from kerb to kerb.
const ISLAND: f64 = 10.0;

/// What a road is across: lanes for both directions around the centre line, and a sidewalk on either side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Profile {
    /// Both directions together.
    pub lanes: i32,
    pub lane_width: f64,
    /// Its width; 0 without one.
    pub sidewalk: f64,
}

impl Profile {
    /// The number of lanes of one direction.
    pub fn each_way(&self) -> i32 {
        self.lanes / 2
    }

    /// Metres from the centre line to the kerb.
    pub fn half_width(&self) -> f64 {
        0.5 * f64::from(self.lanes) * self.lane_width
    }

    /// Metres from the centre line to the middle of a lane: 1 is the one beside it.
    pub fn lane_offset(&self, number: i32) -> f64 {
        (f64::from(number) - 0.5) * self.lane_width
    }

    /// Metres from the centre line to the middle of a sidewalk.
    pub fn sidewalk_offset(&self) -> f64 {
        self.half_width() + 0.5 * self.sidewalk
    }
}

/// A road element of some shape, not connected yet.
///
/// All have two lanes of 3.5 m, one for either direction, and sidewalks of 2 m where nothing else is said.
#[derive(Debug, Clone, PartialEq)]
pub struct Element<S> {
    pub(super) name: Option<String>,
    pub(crate) profile: Profile,
    pub(super) shape: S,
}

/// What a straight or curved road is.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    pub(super) length: f64,
    /// 1/m, positive to the left.
    pub(super) curvature: f64,
    /// Metres along the road.
    zebras: Vec<f64>,
}

/// What an intersection of three arms is.
#[derive(Debug, Clone, PartialEq)]
pub struct Tee {
    corner: f64,
}

/// What an intersection of four arms is.
#[derive(Debug, Clone, PartialEq)]
pub struct Cross {
    corner: f64,
}

/// What a roundabout is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    pub(super) arms: i32,
    pub(super) island: f64,
    pub(super) entry: f64,
}

/// Any shape. Public only because [`Element`] speaks of it; nobody outside can name it.
#[derive(Debug, Clone, PartialEq)]
pub enum ElementShape {
    Segment(Segment),
    /// With the radius of its kerbs.
    Tee(f64),
    /// With the radius of its kerbs.
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

/// A straight or curved road. It begins at its point `one` and ends at `two`; its lanes 1, 2, ... lead that way.
pub type RoadSegment = Element<Segment>;

/// A road that ends at another: arms east (`one`), south (`two`) and west (`three`), clockwise.
pub type TIntersection = Element<Tee>;

/// Two roads that cross: arms east (`one`), south (`two`), west (`three`) and north (`four`), clockwise.
pub type CrossIntersection = Element<Cross>;

/// A roundabout: its arms `one`, `two`, ... lie clockwise from the east, at equal angles, and traffic goes round it
/// counter-clockwise.
pub type Roundabout = Element<Ring>;

impl Segment {
    /// The centre line, from the origin along x.
    pub(super) fn centre_line(&self) -> Curve {
        Curve::new(Pose { position: Vector2::zeros(), heading: 0.0 }, self.curvature, self.length)
    }

    /// Where its zebra crossings are, in order.
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

    /// The number of lanes of both directions together: an even one.
    pub fn lanes(mut self, lanes: i32) -> Self {
        self.profile.lanes = lanes;
        self
    }

    /// The width of every lane in metres.
    pub fn lane_width(mut self, width: f64) -> Self {
        self.profile.lane_width = width;
        self
    }

    /// The width of the sidewalks in metres; 0 for a road without any.
    pub fn sidewalk(mut self, width: f64) -> Self {
        self.profile.sidewalk = width;
        self
    }

    /// The name by which its points are called in a composite. Without one it is called by what it is, with a
    /// number from the second of its kind on: `road`, `road-2`, ...
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}

impl RoadSegment {
    /// A straight road of this length in metres, from the origin along x.
    pub fn new(length: f64) -> Self {
        Self::of(Segment { length, curvature: 0.0, zebras: Vec::new() })
    }

    /// A road along an arc: the radius of its centre line in metres and the angle in radians by which it turns,
    /// positive to the left.
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
    /// From its middle to its points, in metres.
    pub fn reach(&self) -> f64 {
        self.profile.half_width() + self.shape.corner
    }

    /// An intersection of three arms, whose kerbs have a radius of 6 m.
    #[expect(clippy::new_without_default, reason = "as every other element it is made by its name")]
    pub fn new() -> Self {
        Self::of(Tee { corner: CORNER })
    }

    /// The radius of its kerbs in metres, more than its sidewalks are wide: that of the tightest right turn, half a
    /// lane less.
    pub fn corner(mut self, radius: f64) -> Self {
        self.shape.corner = radius;
        self
    }
}

impl CrossIntersection {
    /// From its middle to its points, in metres.
    pub fn reach(&self) -> f64 {
        self.profile.half_width() + self.shape.corner
    }

    /// An intersection of four arms, whose kerbs have a radius of 6 m.
    #[expect(clippy::new_without_default, reason = "as every other element it is made by its name")]
    pub fn new() -> Self {
        Self::of(Cross { corner: CORNER })
    }

    /// The radius of its kerbs in metres, more than its sidewalks are wide: that of the tightest right turn, half a
    /// lane less.
    pub fn corner(mut self, radius: f64) -> Self {
        self.shape.corner = radius;
        self
    }
}

impl Roundabout {
    /// From its middle to its points, in metres.
    pub fn reach(&self) -> f64 {
        self.shape.reach(&self.profile)
    }

    /// A roundabout of four arms around an island of 10 m radius, with as many lanes around it as lead into it.
    #[expect(clippy::new_without_default, reason = "as every other element it is made by its name")]
    pub fn new() -> Self {
        Self::of(Ring { arms: 4, island: ISLAND, entry: ENTRY })
    }

    /// The number of its arms: 3 to 8.
    pub fn arms(mut self, arms: i32) -> Self {
        self.shape.arms = arms;
        self
    }

    /// The radius of its island in metres.
    pub fn island(mut self, radius: f64) -> Self {
        self.shape.island = radius;
        self
    }

    /// The radius in metres of the kerbs at its entries and exits, more than its sidewalks are wide.
    pub fn entry(mut self, radius: f64) -> Self {
        self.shape.entry = radius;
        self
    }
}
