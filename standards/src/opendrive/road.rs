//! A road of a file: its reference line, its cross-section of lanes, and its links.

use super::cubics::Cubics;
use super::object::Object;
use super::plan_view::{PlanView, wrapped};
use nalgebra::{SVector, Vector1, Vector2};
use paracosm_engine::Pose;

/// A road.
#[derive(Debug, Clone, PartialEq)]
pub struct Road {
    /// The identifier of the road, unique in the file.
    pub id: String,
    /// The name of the road; empty if it has none.
    pub name: String,
    /// The length of the reference line in metres.
    pub length: f64,
    /// The index of the junction that the road belongs to; `None` outside of junctions.
    pub junction: Option<usize>,
    /// The side on which the traffic drives.
    pub traffic: Traffic,
    /// The road or junction before the beginning of the road.
    pub predecessor: Option<Link>,
    /// The road or junction after the end of the road.
    pub successor: Option<Link>,
    /// The reference line of the road.
    pub line: PlanView,
    /// The offset of lane 0 from the reference line, in metres to the left.
    pub offset: Cubics,
    /// The heights of the reference line in metres.
    pub elevation: Cubics,
    /// The roll of the road about the reference line in radians; positive if the right side is lower.
    pub superelevation: Cubics,
    /// The sections of lanes, in the order of their places.
    pub sections: Vec<Section>,
    /// The speed limits of the road: the place in metres along the road from which a limit holds, and the limit in m/s;
    /// `None` where there is no limit.
    pub limits: Vec<(f64, Option<f64>)>,
    /// The objects and signals of the road, in the order of the file.
    pub objects: Vec<Object>,
    /// Positions on the reference line, evenly spaced from its beginning to its end. Searches for the nearest place begin with them.
    pub(crate) milestones: Vec<Vector2<f64>>,
}

/// The greatest distance in metres along a road between two milestones.
const SPACING: f64 = 5.0;

/// Returns positions on the reference line of a road of `length` metres, evenly spaced from its beginning to its end.
pub(super) fn milestones(line: &PlanView, length: f64) -> Vec<Vector2<f64>> {
    let count = (length / SPACING).ceil().max(1.0) as usize;
    (0..=count).map(|i| line.at(length * i as f64 / count as f64).position).collect()
}

/// The side of a road on which the traffic drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Traffic {
    /// Lanes with negative numbers lead along the road.
    RightHand,
    /// Lanes with positive numbers lead along the road.
    LeftHand,
}

/// The road or junction at an end of a road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Link {
    /// A road, by its index, and the end of it that is met.
    Road(usize, End),
    /// A junction, by its index.
    Junction(usize),
}

/// An end of a road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum End {
    /// The end where the reference line begins.
    Start,
    /// The end where the reference line ends.
    End,
}

/// A section of a road with a constant number of lanes.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The place at which the section begins, in metres along the road.
    pub s: f64,
    /// The place at which the section ends, in metres along the road.
    pub end: f64,
    /// The lanes from left to right: their numbers fall by 1 from lane to lane, and lane 0 is always there.
    pub lanes: Vec<Lane>,
}

/// A lane of a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// The number of the lane: positive to the left of lane 0, negative to the right. Lane 0 has no width.
    pub number: i32,
    /// The type of the lane.
    pub kind: LaneType,
    /// The direction of the traffic, if it is not the direction of the lane's side.
    pub direction: Direction,
    /// The lateral extent of the lane.
    pub extent: Extent,
    /// The numbers of the lanes before the lane, in the section or road before.
    pub predecessors: Vec<i32>,
    /// The numbers of the lanes after the lane, in the section or road after.
    pub successors: Vec<i32>,
    /// The marks on the outer border of the lane, in the order of their places.
    pub marks: Vec<RoadMark>,
    /// The speed limits of the lane: the place in metres along the road from which a limit holds, and the limit in m/s;
    /// `None` where there is no limit.
    pub limits: Vec<(f64, Option<f64>)>,
}

/// The lateral extent of a lane.
#[derive(Debug, Clone, PartialEq)]
pub enum Extent {
    /// The width in metres, by the place along the road.
    Width(Cubics),
    /// The distance of the outer border from lane 0 in metres to the left, by the place along the road.
    Border(Cubics),
}

impl Extent {
    /// Returns the function of the place along the road.
    pub(super) fn cubics(&self) -> &Cubics {
        match self {
            Self::Width(cubics) | Self::Border(cubics) => cubics,
        }
    }
}

/// The direction of the traffic on a lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// The direction that follows from the side of the lane and the side on which the traffic drives.
    Standard,
    /// The opposite direction.
    Reversed,
    /// Both directions.
    Both,
}

/// A mark on the outer border of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadMark {
    /// The place from which the mark holds, in metres along the road.
    pub s: f64,
    /// The type of the mark.
    pub kind: MarkType,
    /// The width of the mark in metres; `None` if the file does not say.
    pub width: Option<f64>,
    /// The lane changes that the mark allows.
    pub change: LaneChange,
}

/// The lane changes over a mark that are allowed. Numbers of lanes increase to the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LaneChange {
    /// Changes to lanes with greater numbers are allowed.
    Increase,
    /// Changes to lanes with smaller numbers are allowed.
    Decrease,
    /// Changes both ways are allowed.
    Both,
    /// No change is allowed.
    None,
}

impl Road {
    /// Returns the index of the section at a place, in metres along the road.
    pub fn section_at(&self, s: f64) -> usize {
        self.sections.partition_point(|section| section.s <= s).saturating_sub(1)
    }

    /// Returns the distance of the outer border of a lane from the reference line, in metres to the left. The border of
    /// lane 0 is its line. `None` if the section has no such lane.
    pub fn border(&self, section: usize, lane: i32, s: f64) -> Option<f64> {
        self.sums(section, lane, |cubics| Vector1::new(cubics.at(s))).map(|[outer, _]| outer.x)
    }

    /// Returns the heading of the outer border of a lane in the direction of the road, in radians in (-π, π]. `None` if the
    /// section has no such lane.
    pub fn border_heading(&self, section: usize, lane: i32, s: f64) -> Option<f64> {
        Some(self.heading_beside(s, self.border(section, lane, s)?, self.slope(section, lane, s)?))
    }

    /// Returns the heading of the middle of a lane in the direction of the road, in radians in (-π, π]. `None` if the section
    /// has no such lane.
    pub fn lane_heading(&self, section: usize, lane: i32, s: f64) -> Option<f64> {
        self.lane_pose(section, lane, s, 0.0).map(|pose| pose.heading)
    }

    /// Returns the point `offset` metres to the left of the middle of a lane, with [`Road::lane_heading`]. `None` if the section has no
    /// such lane.
    pub(crate) fn lane_pose(&self, section: usize, lane: i32, s: f64, offset: f64) -> Option<Pose> {
        let [outer, inner] = self.sums(section, lane, |cubics| Vector2::from(cubics.at_with_slope(s)))?;
        let [middle, slope] = (0.5 * (outer + inner)).into();
        let here = self.line.at(s);
        let position = here.position + here.left() * (middle + offset);
        Some(Pose { position, heading: wrapped(here.heading + self.drift(s, middle, slope)) })
    }

    /// Returns the heading of a line `t` metres to the left of the reference line whose distance grows by `slope`.
    pub(super) fn heading_beside(&self, s: f64, t: f64, slope: f64) -> f64 {
        wrapped(self.line.at(s).heading + self.drift(s, t, slope))
    }

    /// Returns the angle from the reference line to the line of [`Road::heading_beside`], in radians.
    fn drift(&self, s: f64, t: f64, slope: f64) -> f64 {
        let along = self.line.rate(s) * (1.0 - self.line.curvature(s) * t);
        // Most lines go along the reference line, and an arc tangent is slow.
        if slope == 0.0 && along > 0.0 { 0.0 } else { libm::atan2(slope, along) }
    }

    /// Returns the derivative of [`Road::border`].
    fn slope(&self, section: usize, lane: i32, s: f64) -> Option<f64> {
        self.sums(section, lane, |cubics| Vector1::new(cubics.slope(s))).map(|[outer, _]| outer.x)
    }

    /// Returns the width of a lane in metres; 0 if the section has no such lane.
    pub fn width(&self, section: usize, lane: i32, s: f64) -> f64 {
        let [outer, inner] = self.borders_of(section, lane, s);
        (outer - inner).abs()
    }

    /// Returns the distance of the middle of a lane from the reference line, in metres to the left.
    pub fn middle(&self, section: usize, lane: i32, s: f64) -> f64 {
        let [outer, inner] = self.borders_of(section, lane, s);
        0.5 * (outer + inner)
    }

    fn borders_of(&self, section: usize, lane: i32, s: f64) -> [f64; 2] {
        self.sums(section, lane, |cubics| Vector1::new(cubics.at(s))).unwrap_or_default().map(|sum| sum.x)
    }

    /// Returns the sums of the offset of the road and of the widths up to the outer and to the inner border of a lane. `of` gives the
    /// numbers that are summed up: values, derivatives, or both.
    fn sums<const N: usize>(
        &self,
        section: usize,
        lane: i32,
        of: impl Fn(&Cubics) -> SVector<f64, N>,
    ) -> Option<[SVector<f64, N>; 2]> {
        let section = self.sections.get(section)?;
        let (outermost, mut index) = (section.index(lane)?, section.index(0)?);
        let (mut outer, mut inner) = (SVector::zeros(), SVector::zeros());
        while index != outermost {
            index = if outermost < index { index - 1 } else { index + 1 };
            let lane = &section.lanes[index];
            inner = outer;
            outer = match &lane.extent {
                Extent::Width(width) => outer + of(width) * f64::from(lane.number.signum()),
                Extent::Border(border) => of(border),
            };
        }
        let offset = of(&self.offset);
        Some([offset + outer, offset + inner])
    }

    /// Returns the point `t` metres to the left of the reference line, `s` metres along the road. The world is flat: the
    /// elevation and the superelevation of the road do not move the point.
    pub fn point(&self, s: f64, t: f64) -> Vector2<f64> {
        let here = self.line.at(s);
        here.position + here.left() * t
    }

    /// Returns the height that the file gives to a point, in metres.
    pub fn height(&self, s: f64, t: f64) -> f64 {
        self.elevation.at(s) + libm::sin(self.superelevation.at(s)) * t
    }
}

impl Section {
    /// Returns the lane with a number.
    pub fn lane(&self, number: i32) -> Option<&Lane> {
        self.index(number).map(|index| &self.lanes[index])
    }

    /// Returns the index of the lane with a number.
    fn index(&self, number: i32) -> Option<usize> {
        let leftmost = self.lanes.first()?.number;
        let index = usize::try_from(leftmost.checked_sub(number)?).ok()?;
        (index < self.lanes.len()).then_some(index)
    }
}

/// Describes the names of the values of an attribute: a list of pairs, and the type.
macro_rules! names {
    ($(#[$doc:meta])* $type:ident, $list:ident: $($(#[$of:meta])* $value:ident = $name:literal,)+) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum $type {
            $($(#[$of])* $value,)+
        }

        impl $type {
            /// Returns the name of the value in files.
            pub fn name(self) -> &'static str {
                match self { $(Self::$value => $name,)+ }
            }
        }

        pub(super) const $list: &[(&str, $type)] = &[$(($name, $type::$value),)+];
    };
}

names! {
    /// The type of a lane, with the names of OpenDRIVE.
    LaneType, LANE_TYPES:
    /// A lane for bicycles.
    Biking = "biking",
    /// A hard border at the edge of the road.
    Border = "border",
    /// A lane that both directions use.
    Bidirectional = "bidirectional",
    /// A lane for buses.
    Bus = "bus",
    /// A lane between the ramps of two motorways.
    ConnectingRamp = "connectingRamp",
    /// A kerb stone.
    Curb = "curb",
    /// A normal lane for driving.
    Driving = "driving",
    /// A lane for acceleration beside a motorway.
    Entry = "entry",
    /// A lane for deceleration beside a motorway.
    Exit = "exit",
    /// A lane for vehicles with several occupants.
    Hov = "HOV",
    /// A strip between the directions.
    Median = "median",
    /// A lane that leads to a motorway (OpenDRIVE 1.4).
    MotorwayEntry = "mwyEntry",
    /// A lane that leads from a motorway (OpenDRIVE 1.4).
    MotorwayExit = "mwyExit",
    /// A strip without a use.
    None = "none",
    /// A ramp that leads from a motorway.
    OffRamp = "offRamp",
    /// A ramp that leads to a motorway.
    OnRamp = "onRamp",
    /// A lane with parking spaces.
    Parking = "parking",
    /// A lane for trains.
    Rail = "rail",
    /// A strip that nobody may drive on, for example between two lanes.
    Restricted = "restricted",
    /// A lane with roadworks (OpenDRIVE 1.4).
    RoadWorks = "roadWorks",
    /// A lane that people on foot, bicycles and vehicles share.
    Shared = "shared",
    /// A soft border at the edge of the road.
    Shoulder = "shoulder",
    /// A sidewalk (OpenDRIVE 1.4 to 1.7).
    Sidewalk = "sidewalk",
    /// A lane that leads around a corner without passing the intersection.
    SlipLane = "slipLane",
    /// A lane with a use that the file defines.
    Special1 = "special1",
    /// A lane with a use that the file defines.
    Special2 = "special2",
    /// A lane with a use that the file defines.
    Special3 = "special3",
    /// A hard shoulder for emergencies.
    Stop = "stop",
    /// A lane for taxis.
    Taxi = "taxi",
    /// A lane for trams.
    Tram = "tram",
    /// A lane for people on foot.
    Walking = "walking",
}

impl LaneType {
    /// Returns `true` if cars drive on lanes of this type.
    pub fn is_driven(self) -> bool {
        use LaneType as T;
        matches!(
            self,
            T::Driving
                | T::Bidirectional
                | T::Bus
                | T::ConnectingRamp
                | T::Entry
                | T::Exit
                | T::Hov
                | T::MotorwayEntry
                | T::MotorwayExit
                | T::OffRamp
                | T::OnRamp
                | T::RoadWorks
                | T::Shared
                | T::SlipLane
                | T::Taxi
        )
    }
}

names! {
    /// The type of a road mark, with the names of OpenDRIVE. The first of two lines is the inner line.
    MarkType, MARK_TYPES:
    /// No mark.
    None = "none",
    /// A continuous line.
    Solid = "solid",
    /// A broken line.
    Broken = "broken",
    /// Two continuous lines.
    SolidSolid = "solid solid",
    /// A continuous line beside a broken line.
    SolidBroken = "solid broken",
    /// A broken line beside a continuous line.
    BrokenSolid = "broken solid",
    /// Two broken lines.
    BrokenBroken = "broken broken",
    /// Round studs.
    BottsDots = "botts dots",
    /// The edge of the grass.
    Grass = "grass",
    /// A kerb stone.
    Curb = "curb",
    /// Marks that the file describes in detail.
    Custom = "custom",
    /// The edge of the paving.
    Edge = "edge",
}
