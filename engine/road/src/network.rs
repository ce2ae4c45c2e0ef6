//! A finished road network: lanes with their neighbours and their surroundings, built once and shared.

use super::bounds::{Bounds, Tree};
use super::centreline::Centreline;
use super::composite::Composite;
use super::curve::Curve;
use super::element::{Element, ElementShape, Profile, Segment};
use super::error::RoadError;
use super::lane::{Lane, LaneConflict, LaneId, LaneKind};
use super::layout::{ConflictPlan, Layout, Mouth, Plan, ZEBRA};
use super::overlap;
use super::strip::Strip;
use crate::geometry::wrapped;
use crate::geometry::{Pose, Side};
use std::collections::{BTreeSet, HashMap};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;
use std::sync::Arc;

/// A network of connected roads, constant once it is built. It is made of elements ([`Composite::build`]) or of the lanes of a
/// file ([`Survey::build`](super::Survey::build)).
#[derive(Debug)]
pub struct RoadNetwork {
    pub(super) elements: Vec<Placed>,
    /// The index of the element with each name. Names are only looked up, so that their order does not matter.
    names: HashMap<String, usize>,
    lanes: Vec<Lane>,
    crossings: Vec<Crossing>,
    /// The visible surfaces; each strip comes after the strips that it covers.
    strips: Vec<Strip>,
    pub(super) tree: Tree,
    bounds: Bounds,
    /// The text of the file that describes the network.
    pub(super) source: Option<Arc<str>>,
}

/// An element at its place.
#[derive(Debug)]
pub(super) struct Placed {
    pub name: String,
    /// The names of the element's points.
    pub points: Vec<&'static str>,
    /// The indices of the element's lanes.
    pub lanes: Range<usize>,
    /// The points at which each lane enters and leaves the element.
    pub mouths: Vec<[Option<Mouth>; 2]>,
    /// The course of the road; `None` for an intersection.
    pub course: Option<Course>,
}

/// The course of a road.
#[derive(Debug)]
pub(super) enum Course {
    /// A road with the same cross-section everywhere.
    Even { centre: Curve, profile: Profile },
    /// A road whose lanes begin, end and change their widths. Each lane has its beginning and its end along the road.
    Surveyed { centre: Centreline, length: f64, spans: Vec<[f64; 2]> },
}

/// A road with the same cross-section everywhere, as [`RoadSegment`](super::RoadSegment) describes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvenRoad {
    /// The index of the road in [`RoadNetwork::elements`].
    pub element: usize,
    /// The line in the middle of the road.
    pub centre: Curve,
    /// The number of lanes in each direction.
    pub each_way: i32,
    /// The width of a lane in metres.
    pub lane_width: f64,
    /// The width of a sidewalk on each side in metres; 0 if the road has none.
    pub sidewalk: f64,
}

/// A zebra crossing over a road.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// The index of the crossing's road in [`RoadNetwork::elements`].
    pub element: usize,
    /// The middle line of the crossing, from the right kerb of the road to the left kerb.
    pub path: Curve,
    /// The width of the crossing in metres.
    pub width: f64,
    /// The lanes under the crossing, from right to left, each with the place of the crossing in metres along the lane.
    pub lanes: Vec<(LaneId, f64)>,
}

impl<S: Into<ElementShape>> Element<S> {
    /// Builds the road network of this single element, as [`Composite::build`] does for a composite.
    ///
    /// # Errors
    /// The description of the element is not valid.
    pub fn build(self) -> Result<Arc<RoadNetwork>, RoadError> {
        Composite::from(self).build()
    }
}

impl Composite {
    /// Builds the road network of all elements of the composite.
    ///
    /// # Errors
    /// A connection was not valid (the first such mistake is reported), or two elements overlap.
    pub fn build(self) -> Result<Arc<RoadNetwork>, RoadError> {
        match &self.mistake {
            Some(mistake) => Err(mistake.clone()),
            None => RoadNetwork::new(&self).map(Arc::new),
        }
    }
}

impl RoadNetwork {
    /// Builds the network of a composite without a mistake.
    fn new(composite: &Composite) -> Result<Self, RoadError> {
        let layouts = layouts(composite);
        overlap::check(composite, &layouts)?;
        let mut elements = Vec::with_capacity(layouts.len());
        let mut lanes = Vec::new();
        let mut crossings = Vec::new();
        let mut strips = Vec::new();
        for (part, layout) in composite.parts.iter().zip(layouts) {
            let first = lanes.len();
            lanes.extend(layout.lanes.iter().map(|plan| {
                let id = |index: &usize| LaneId::new(first + index);
                let conflict = |plan: &ConflictPlan| LaneConflict {
                    with: id(&plan.with),
                    from: plan.span.0,
                    to: plan.span.1,
                    gives_way: plan.gives_way,
                };
                Lane {
                    element: elements.len(),
                    kind: plan.kind,
                    number: plan.number,
                    curve: plan.curve.moved(&part.pose).into(),
                    width: part.plan.profile.lane_width,
                    widths: Vec::new(),
                    left: plan.left.as_ref().map(id),
                    right: plan.right.as_ref().map(id),
                    successors: plan.successors.iter().map(id).collect(),
                    predecessors: Vec::new(),
                    conflicts: plan.conflicts.iter().map(conflict).collect(),
                    limits: Vec::new(),
                }
            }));
            strips.extend(layout.strips.iter().map(|strip| strip.moved(&part.pose)));
            let profile = part.plan.profile;
            let course = if let ElementShape::Segment(road) = &part.plan.shape {
                let centre = road.centre_line().moved(&part.pose);
                crossings.extend(crossings_of(road, [elements.len(), first], &centre, &layout, &profile));
                Some(Course::Even { centre, profile })
            } else {
                None
            };
            elements.push(Placed {
                name: part.name.clone(),
                points: part.plan.ports().iter().map(|port| port.name).collect(),
                lanes: first..lanes.len(),
                mouths: layout.lanes.iter().map(|plan| [plan.from, plan.to]).collect(),
                course,
            });
        }
        for &[a, b] in &composite.links {
            for (from, to) in [(a, b), (b, a)] {
                link(&mut lanes, &elements[from.part], from.port, &elements[to.part], to.port);
            }
        }
        Ok(Self::of(elements, lanes, crossings, strips))
    }

    /// Makes the network of lanes that know their successors.
    pub(super) fn of(
        elements: Vec<Placed>,
        mut lanes: Vec<Lane>,
        crossings: Vec<Crossing>,
        mut strips: Vec<Strip>,
    ) -> Self {
        for index in 0..lanes.len() {
            for successor in lanes[index].successors.clone() {
                lanes[successor.index()].predecessors.push(LaneId::new(index));
            }
        }
        let boxes: Vec<Bounds> = lanes.iter().map(|lane| lane.curve.bounds()).collect();
        let bounds = boxes.iter().fold(Bounds::empty(), |all, next| all.union(next));
        let names = elements.iter().enumerate().map(|(index, placed)| (placed.name.clone(), index)).collect();
        strips.sort_by_key(|strip| strip.surface);
        Self { elements, names, lanes, crossings, strips, tree: Tree::new(&boxes), bounds, source: None }
    }

    /// Returns the text of the file that describes the network; `None` if no file describes it.
    pub fn source(&self) -> Option<&str> {
        self.source.as_deref()
    }

    /// Returns the names of all road elements of the network.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = &str> {
        self.elements.iter().map(|placed| &*placed.name)
    }

    /// Returns all lanes of the network.
    #[inline]
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// Returns the identifiers of all lanes, in the order of [`RoadNetwork::lanes`].
    pub fn ids(&self) -> impl ExactSizeIterator<Item = LaneId> {
        (0..self.lanes.len()).map(LaneId::new)
    }

    /// Returns the lane with the given identifier.
    ///
    /// # Panics
    /// The lane belongs to another network, which has more lanes.
    #[inline]
    pub fn lane(&self, id: LaneId) -> &Lane {
        &self.lanes[id.index()]
    }

    /// Returns the roads with the same cross-section everywhere; `None` if the network has a road of a file.
    pub fn even_roads(&self) -> Option<Vec<EvenRoad>> {
        let courses =
            self.elements.iter().enumerate().filter_map(|(index, placed)| Some((index, placed.course.as_ref()?)));
        let even = |(element, course): (usize, &Course)| match course {
            Course::Even { centre, profile } => Some(EvenRoad {
                element,
                centre: *centre,
                each_way: profile.each_way(),
                lane_width: profile.lane_width,
                sidewalk: profile.sidewalk,
            }),
            Course::Surveyed { .. } => None,
        };
        courses.map(even).collect()
    }

    /// Returns the identifier of the lane with a given number on a road; the first one along the road, if lanes with the number
    /// follow one another. The numbers are 1, 2, ... to the right of the centre line, and -1, -2, ... for the opposite
    /// direction.
    ///
    /// # Errors
    /// The network has no such element, or the element has no such lane.
    pub fn lane_of(&self, element: &str, number: i32) -> Result<LaneId, RoadError> {
        let placed = self.find(element)?;
        let has_roads_only = matches!(placed.course, Some(Course::Surveyed { .. }));
        let is_road = |lane: &LaneId| has_roads_only || self.lane(*lane).kind == LaneKind::Road;
        let wanted = |lane: &LaneId| is_road(lane) && self.lane(*lane).number == number;
        placed.ids().find(wanted).ok_or_else(|| self.no_lane(placed, number))
    }

    /// Makes the error that an element has no lane with a number.
    fn no_lane(&self, placed: &Placed, number: i32) -> RoadError {
        let has = match &placed.course {
            Some(Course::Even { profile, .. }) => {
                let n = profile.each_way();
                format!("1 to {n} and -1 to -{n}")
            }
            Some(Course::Surveyed { .. }) => {
                let numbers: BTreeSet<i32> = placed.ids().map(|lane| self.lane(lane).number).collect();
                numbers.iter().map(i32::to_string).collect::<Vec<_>>().join(", ")
            }
            None => format!("only lanes from one of its points to another: {}", placed.points.join(", ")),
        };
        RoadError::UnknownLane { element: placed.name.clone(), lane: number, between: None, has }
    }

    /// Returns the identifier of the lane from one point of an element to another point of the element, over an
    /// intersection or along a road. `number` is the number of the joined lanes, counted from the centre line.
    ///
    /// # Errors
    /// The network has no such element, the element has no such point, or no such lane leads from `from` to `to`.
    pub fn lane_between(&self, element: &str, from: &str, to: &str, number: i32) -> Result<LaneId, RoadError> {
        let placed = self.find(element)?;
        let (from, to) = (placed.port(from)?, placed.port(to)?);
        let leads = |lane: &LaneId| {
            let [enters, leaves] = placed.mouths[lane.index() - placed.lanes.start];
            enters.is_some_and(|mouth| mouth.port == from) && leaves.is_some_and(|mouth| mouth.port == to)
        };
        let number_of = |lane: &LaneId| self.lane(*lane).number.abs();
        placed.ids().find(|lane| leads(lane) && number_of(lane) == number).ok_or_else(|| {
            let numbers: Vec<String> = placed.ids().filter(leads).map(|lane| number_of(&lane).to_string()).collect();
            RoadError::UnknownLane {
                element: element.to_owned(),
                lane: number,
                between: Some((placed.points[from].to_owned(), placed.points[to].to_owned())),
                has: if numbers.is_empty() { "none".to_owned() } else { numbers.join(", ") },
            }
        })
    }

    /// Returns the pose on the middle of a lane, `at` metres along the road, in the direction of the lane's traffic.
    ///
    /// # Errors
    /// The network has no such element, the element has no such lane there, or the road is shorter than `at`.
    pub fn on_lane(&self, element: &str, lane: i32, at: f64) -> Result<Pose, RoadError> {
        self.lane_of(element, lane)?;
        let placed = self.find(element)?;
        match placed.course_at(at)? {
            Course::Even { centre, profile } => Ok(lane_pose(centre, profile, lane, at)),
            Course::Surveyed { spans, .. } => {
                let mut lanes = placed.ids().zip(spans).filter(|(id, _)| self.lane(*id).number == lane);
                let (id, [from, to]) = lanes
                    .find(|(_, [from, to])| from.min(*to) <= at && at <= from.max(*to))
                    .ok_or_else(|| self.no_lane(placed, lane))?;
                let line = &self.lane(id).curve;
                Ok(line.at((at - from) / (to - from) * line.length()))
            }
        }
    }

    /// Returns the pose on the centre line of a road, `at` metres along the road, in the road's direction.
    ///
    /// # Errors
    /// The network has no such road, or the road is shorter than `at`.
    pub fn on_centre_line(&self, road: &str, at: f64) -> Result<Pose, RoadError> {
        Ok(match self.find(road)?.course_at(at)? {
            Course::Even { centre, .. } => centre.at(at),
            Course::Surveyed { centre, length, .. } => centre.at(at / length * centre.length()),
        })
    }

    /// Returns the pose on the middle of a sidewalk, `at` metres along the road, that faces the road.
    ///
    /// # Errors
    /// The network has no such road, or the road is shorter than `at`.
    pub fn on_sidewalk(&self, element: &str, side: Side, at: f64) -> Result<Pose, RoadError> {
        match self.find(element)?.course_at(at)? {
            Course::Even { centre, profile } => Ok(sidewalk_pose(centre, profile, side, at)),
            Course::Surveyed { .. } => Err(RoadError::Element {
                element: element.to_owned(),
                problem: "is a road of a file, expected a road with sidewalks on both sides".to_owned(),
            }),
        }
    }

    /// Returns all zebra crossings of the network.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// Returns the smallest box that contains the middle lines of all lanes.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the visible surfaces of the network as strips; each strip comes after the strips that it covers.
    pub fn strips(&self) -> Vec<Strip> {
        self.strips.clone()
    }

    fn find(&self, name: &str) -> Result<&Placed, RoadError> {
        let index = self.names.get(name).ok_or_else(|| RoadError::unknown_element(name, self.elements()))?;
        Ok(&self.elements[*index])
    }
}

/// Returns the middle of a lane `at` metres along a road, facing the direction of the lane's traffic.
fn lane_pose(centre: &Curve, profile: &Profile, lane: i32, at: f64) -> Pose {
    let offset = profile.lane_offset(lane.abs());
    if lane > 0 {
        Pose { position: centre.beside(at, -offset), heading: centre.heading(at) }
    } else {
        Pose { position: centre.beside(at, offset), heading: wrapped(centre.heading(at) + PI) }
    }
}

/// Returns the middle of a sidewalk `at` metres along a road, facing the road.
fn sidewalk_pose(centre: &Curve, profile: &Profile, side: Side, at: f64) -> Pose {
    let (offset, turn) = match side {
        Side::Left => (profile.sidewalk_offset(), -FRAC_PI_2),
        Side::Right => (-profile.sidewalk_offset(), FRAC_PI_2),
    };
    Pose { position: centre.beside(at, offset), heading: wrapped(centre.heading(at) + turn) }
}

/// Computes the layout of every part. Intersections are costly, and most are alike, so equal intersections share a
/// layout.
fn layouts(composite: &Composite) -> Vec<Arc<Layout>> {
    let mut intersections: Vec<(&Plan, Arc<Layout>)> = Vec::new();
    let mut layouts = Vec::with_capacity(composite.parts.len());
    for plan in composite.parts.iter().map(|part| &part.plan) {
        let known = intersections.iter().find(|(known, _)| *known == plan);
        let layout = known.map_or_else(|| Arc::new(plan.layout()), |(_, layout)| layout.clone());
        if known.is_none() && !matches!(plan.shape, ElementShape::Segment(_)) {
            intersections.push((plan, layout.clone()));
        }
        layouts.push(layout);
    }
    layouts
}

/// Makes the lanes that begin at a port of `to` successors of the lanes that end at the connected port of `from`.
fn link(lanes: &mut [Lane], from: &Placed, from_port: usize, to: &Placed, to_port: usize) {
    for (ending, [_, out]) in from.ids().zip(&from.mouths) {
        for (beginning, [into, _]) in to.ids().zip(&to.mouths) {
            if let (Some(out), Some(into)) = (out, into)
                && (out.port, into.port) == (from_port, to_port)
                && out.number == into.number
            {
                lanes[ending.index()].successors.push(beginning);
            }
        }
    }
}

impl Placed {
    fn ids(&self) -> impl Iterator<Item = LaneId> + use<> {
        self.lanes.clone().map(LaneId::new)
    }

    fn port(&self, name: &str) -> Result<usize, RoadError> {
        let port = self.points.iter().position(|point| *point == name);
        port.ok_or_else(|| RoadError::unknown_point(&self.name, name, self.points.clone()))
    }

    /// Returns the course of a road, if the place `at` metres along it exists.
    fn course_at(&self, at: f64) -> Result<&Course, RoadError> {
        let course = self.course.as_ref().ok_or_else(|| RoadError::Element {
            element: self.name.clone(),
            problem: "is an intersection or a roundabout, expected a road".to_owned(),
        })?;
        let length = match course {
            Course::Even { centre, .. } => centre.length(),
            Course::Surveyed { length, .. } => *length,
        };
        if (0.0..=length).contains(&at) {
            Ok(course)
        } else {
            Err(RoadError::Beyond { element: self.name.clone(), at, length })
        }
    }
}

/// Returns the zebra crossings of a road, by the indices of the road and of its first lane.
fn crossings_of(
    road: &Segment,
    [element, first]: [usize; 2],
    centre: &Curve,
    layout: &Layout,
    profile: &Profile,
) -> Vec<Crossing> {
    let half = profile.half_width();
    let crossing = |at: f64| {
        let start = Pose { position: centre.beside(at, -half), heading: wrapped(centre.heading(at) + FRAC_PI_2) };
        // The lanes of an arc are longer or shorter than the road in proportion to their radii.
        let share = at / centre.length();
        let n = profile.each_way() as usize;
        let forward = (0..n).rev().map(|i| (i, share));
        let lanes = forward.chain((n..2 * n).map(|i| (i, 1.0 - share)));
        let lanes = lanes.map(|(i, share)| (i, share * layout.lanes[i].curve.length()));
        let lanes = lanes.map(|(i, s)| (LaneId::new(first + i), s)).collect();
        Crossing { element, path: Curve::new(start, 0.0, 2.0 * half), width: ZEBRA, lanes }
    };
    road.zebras().into_iter().map(crossing).collect()
}
