//! The layout of an element in its own frame: the points where it can be connected, its lanes, and its strips.

mod conflicts;
mod intersection;
mod roundabout;
mod segment;

use super::curve::Curve;
use super::element::{ElementShape, Profile};
use super::lane::LaneKind;
use super::strip::{Strip, Surface};
use crate::geometry::Pose;
use nalgebra::Vector2;
use std::f64::consts::PI;

pub(super) use conflicts::{CLOSE, ConflictPlan, span};
pub(super) use segment::ZEBRA;

/// The largest number of lanes of both directions together.
const MOST_LANES: i32 = 16;
/// Width of a painted line in metres.
const LINE: f64 = 0.12;
/// Width of a kerb in metres.
const KERB: f64 = 0.15;
/// The width in metres of the line where cars stop.
const STOP_LINE: f64 = 0.5;

/// A point where an element can be connected. Its heading points outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Port {
    pub name: &'static str,
    pub pose: Pose,
}

/// The end of a lane at the edge of its element: the port, and the lane's number there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Mouth {
    pub port: usize,
    pub number: i32,
}

/// A lane of an element. It refers to other lanes by their indices in the element.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LanePlan {
    pub kind: LaneKind,
    pub number: i32,
    pub curve: Curve,
    /// The port and lane number at which the lane enters the element; `None` if the lane begins within the element.
    pub from: Option<Mouth>,
    /// The port and lane number at which the lane leaves the element; `None` if the lane ends within the element.
    pub to: Option<Mouth>,
    pub successors: Vec<usize>,
    pub left: Option<usize>,
    pub right: Option<usize>,
    pub conflicts: Vec<ConflictPlan>,
}

impl LanePlan {
    fn new(kind: LaneKind, number: i32, curve: Curve) -> Self {
        let (successors, conflicts) = Default::default();
        Self { kind, number, curve, from: None, to: None, successors, left: None, right: None, conflicts }
    }
}

/// The lanes and strips of an element.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub lanes: Vec<LanePlan>,
    pub strips: Vec<Strip>,
}

/// The shape of an element and the cross-section of its roads.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    pub shape: ElementShape,
    pub profile: Profile,
}

/// The names of points, in their order.
pub(super) const POINTS: [&str; 8] = ["one", "two", "three", "four", "five", "six", "seven", "eight"];

impl Plan {
    /// Returns the name that a road element has by default.
    pub fn kind(&self) -> &'static str {
        match self.shape {
            ElementShape::Segment(_) => "road",
            ElementShape::Tee(_) => "t-intersection",
            ElementShape::Cross(_) => "cross-intersection",
            ElementShape::Ring(_) => "roundabout",
        }
    }

    /// Returns the mistake in the description of the element; `None` if the description is valid.
    pub fn problem(&self) -> Option<String> {
        let Profile { lanes, lane_width, sidewalk } = self.profile;
        if !(2..=MOST_LANES).contains(&lanes) || lanes % 2 != 0 {
            return Some(format!("has {lanes} lanes, expected an even number from 2 to {MOST_LANES}"));
        }
        if !(2.0..=10.0).contains(&lane_width) {
            return Some(format!("has lanes with a width of {lane_width} m, expected 2 to 10 m"));
        }
        if !(0.0..=20.0).contains(&sidewalk) {
            return Some(format!("has sidewalks with a width of {sidewalk} m, expected 0 to 20 m"));
        }
        match &self.shape {
            ElementShape::Segment(road) => segment::problem(road, &self.profile),
            ElementShape::Tee(corner) | ElementShape::Cross(corner) => kerb_problem("kerbs", *corner, sidewalk),
            ElementShape::Ring(ring) => kerb_problem("kerbs at its entries", ring.entry, sidewalk)
                .or_else(|| roundabout::problem(ring, &self.profile)),
        }
    }

    /// Returns the headings of the arms, seen from the middle of the element.
    fn arms(&self) -> Vec<f64> {
        let quarter = 0.5 * PI;
        match &self.shape {
            ElementShape::Segment(_) => Vec::new(),
            ElementShape::Tee(_) => vec![0.0, -quarter, PI],
            ElementShape::Cross(_) => vec![0.0, -quarter, PI, quarter],
            ElementShape::Ring(ring) => roundabout::headings(ring.arms).collect(),
        }
    }

    pub fn ports(&self) -> Vec<Port> {
        let reach = match &self.shape {
            ElementShape::Segment(road) => return segment::ports(road).into(),
            ElementShape::Tee(corner) | ElementShape::Cross(corner) => self.profile.half_width() + corner,
            ElementShape::Ring(ring) => ring.reach(&self.profile),
        };
        let port = |(heading, name)| Port { name, pose: arm(heading).then(&pose(reach, 0.0, 0.0)) };
        self.arms().into_iter().zip(POINTS).map(port).collect()
    }

    pub fn layout(&self) -> Layout {
        match &self.shape {
            ElementShape::Segment(road) => segment::layout(road, &self.profile),
            ElementShape::Tee(corner) | ElementShape::Cross(corner) => {
                intersection::layout(&self.arms(), *corner, &self.profile)
            }
            ElementShape::Ring(ring) => roundabout::layout(ring, &self.profile),
        }
    }
}

fn kerb_problem(what: &str, radius: f64, sidewalk: f64) -> Option<String> {
    let least = sidewalk.max(1.0);
    // In this form, the condition refuses NaN as well.
    let fits = radius > least && radius <= 1000.0;
    (!fits).then(|| format!("has {what} with a radius of {radius} m, expected more than {least} m and at most 1000 m"))
}

fn pose(x: f64, y: f64, heading: f64) -> Pose {
    Pose { position: Vector2::new(x, y), heading }
}

/// Returns the frame of an arm, whose x axis points from the middle of the element outward along the arm.
fn arm(heading: f64) -> Pose {
    pose(0.0, 0.0, heading)
}

impl Layout {
    /// Adds a kerb along this curve, with the road to its left and the sidewalk to its right. If there is no sidewalk,
    /// it adds the line at the edge instead.
    fn add_kerb(&mut self, curve: Curve, profile: &Profile) {
        if profile.sidewalk > 0.0 {
            self.strips.push(Strip::new(Surface::Sidewalk, curve, -profile.sidewalk, 0.0));
            self.strips.push(Strip::new(Surface::Kerb, curve, -KERB, 0.0));
        } else {
            self.strips.push(Strip::new(Surface::EdgeLine, curve, LINE, 2.0 * LINE));
        }
    }
}
