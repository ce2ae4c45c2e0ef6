//! A finished road network: lanes with their neighbours and their surroundings, built once and shared.

use super::bounds::{Bounds, Tree};
use super::composite::Composite;
use super::curve::Curve;
use super::element::{Element, ElementShape, Profile};
use super::error::RoadError;
use super::lane::{Lane, LaneConflict, LaneId, LaneKind};
use super::layout::{ConflictPlan, LanePlan, Layout, Plan, ZEBRA};
use super::overlap;
use super::strip::Strip;
use crate::geometry::wrapped;
use crate::geometry::{Pose, Side};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// A network of connected roads, made by [`Composite::build`] and constant afterwards. Traffic keeps to the right.
#[derive(Debug)]
pub struct RoadNetwork {
    elements: Vec<Placed>,
    /// The index of the element with each name. Names are only looked up, so that their order does not matter.
    names: HashMap<String, usize>,
    lanes: Vec<Lane>,
    crossings: Vec<Crossing>,
    pub(super) tree: Tree,
    bounds: Bounds,
}

/// An element at its place.
#[derive(Debug)]
struct Placed {
    name: String,
    plan: Plan,
    pose: Pose,
    layout: Arc<Layout>,
    /// The names of the element's points.
    points: Vec<&'static str>,
    /// The index of the element's first lane.
    first: usize,
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
                    curve: plan.curve.moved(&part.pose),
                    width: part.plan.profile.lane_width,
                    left: plan.left.as_ref().map(id),
                    right: plan.right.as_ref().map(id),
                    successors: plan.successors.iter().map(id).collect(),
                    predecessors: Vec::new(),
                    conflicts: plan.conflicts.iter().map(conflict).collect(),
                }
            }));
            let points = part.plan.ports().iter().map(|port| port.name).collect();
            let (name, plan, pose) = (part.name.clone(), part.plan.clone(), part.pose);
            elements.push(Placed { name, plan, pose, layout, points, first });
        }
        for &[a, b] in &composite.links {
            for (from, to) in [(a, b), (b, a)] {
                link(&mut lanes, &elements[from.part], from.port, &elements[to.part], to.port);
            }
        }
        for index in 0..lanes.len() {
            for successor in lanes[index].successors.clone() {
                lanes[successor.index()].predecessors.push(LaneId::new(index));
            }
        }
        let boxes: Vec<Bounds> = lanes.iter().map(|lane| lane.curve.bounds()).collect();
        let bounds = boxes.iter().fold(Bounds::empty(), |all, next| all.union(next));
        let names = elements.iter().enumerate().map(|(index, placed)| (placed.name.clone(), index)).collect();
        let crossings = elements.iter().enumerate().flat_map(|(index, placed)| placed.crossings(index)).collect();
        Ok(Self { elements, names, lanes, crossings, tree: Tree::new(&boxes), bounds })
    }

    /// Returns the names of all road elements of the network.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = &str> {
        self.elements.iter().map(|placed| &*placed.name)
    }

    /// Returns all lanes of the network.
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
    pub fn lane(&self, id: LaneId) -> &Lane {
        &self.lanes[id.index()]
    }

    /// Returns the identifier of the lane with a given number on a road. The numbers are 1, 2, ... to the right of the
    /// centre line, and -1, -2, ... for the opposite direction.
    ///
    /// # Errors
    /// The network has no such element, or the element has no such lane.
    pub fn lane_of(&self, element: &str, number: i32) -> Result<LaneId, RoadError> {
        let placed = self.find(element)?;
        let wanted = |lane: &LaneId| self.lane(*lane).kind == LaneKind::Road && self.lane(*lane).number == number;
        placed.lanes().find(wanted).ok_or_else(|| {
            let n = placed.plan.profile.each_way();
            let has = match placed.plan.shape {
                ElementShape::Segment(_) => format!("1 to {n} and -1 to -{n}"),
                _ => format!("only lanes from one of its points to another: {}", placed.points.join(", ")),
            };
            RoadError::UnknownLane { element: element.to_owned(), lane: number, between: None, has }
        })
    }

    /// Returns the identifier of the lane from one point of an element to another point of the element, over an
    /// intersection or along a road. `number` is the number of the joined lanes, counted from the centre line.
    ///
    /// # Errors
    /// The network has no such element, the element has no such point, or no such lane leads from `from` to `to`.
    pub fn lane_between(&self, element: &str, from: &str, to: &str, number: i32) -> Result<LaneId, RoadError> {
        let placed = self.find(element)?;
        let (from, to) = (placed.port(from)?, placed.port(to)?);
        let leads = |plan: &&LanePlan| {
            plan.from.is_some_and(|mouth| mouth.port == from) && plan.to.is_some_and(|mouth| mouth.port == to)
        };
        let index = placed.layout.lanes.iter().position(|plan| leads(&plan) && plan.number.abs() == number);
        let index = index.ok_or_else(|| {
            let numbers = placed.layout.lanes.iter().filter(leads).map(|plan| plan.number.abs().to_string());
            let numbers: Vec<String> = numbers.collect();
            RoadError::UnknownLane {
                element: element.to_owned(),
                lane: number,
                between: Some((placed.points[from].to_owned(), placed.points[to].to_owned())),
                has: if numbers.is_empty() { "none".to_owned() } else { numbers.join(", ") },
            }
        })?;
        Ok(LaneId::new(placed.first + index))
    }

    /// Returns the pose on the middle of a lane, `at` metres along the road, in the direction of the lane's traffic.
    ///
    /// # Errors
    /// The network has no such element, the element has no such lane, or the road is shorter than `at`.
    pub fn on_lane(&self, element: &str, lane: i32, at: f64) -> Result<Pose, RoadError> {
        self.lane_of(element, lane)?;
        let (centre, profile) = self.road(element, at)?;
        Ok(lane_pose(&centre, profile, lane, at))
    }

    /// Returns the pose on the centre line of a road, `at` metres along the road, in the road's direction.
    ///
    /// # Errors
    /// The network has no such road, or the road is shorter than `at`.
    pub fn on_centre_line(&self, road: &str, at: f64) -> Result<Pose, RoadError> {
        Ok(self.road(road, at)?.0.at(at))
    }

    /// Returns the pose on the middle of a sidewalk, `at` metres along the road, that faces the road.
    ///
    /// # Errors
    /// The network has no such road, or the road is shorter than `at`.
    pub fn on_sidewalk(&self, element: &str, side: Side, at: f64) -> Result<Pose, RoadError> {
        let (centre, profile) = self.road(element, at)?;
        Ok(sidewalk_pose(&centre, profile, side, at))
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
        let of =
            |placed: &Placed| placed.layout.strips.iter().map(|strip| strip.moved(&placed.pose)).collect::<Vec<_>>();
        let mut strips: Vec<Strip> = self.elements.iter().flat_map(of).collect();
        strips.sort_by_key(|strip| strip.surface);
        strips
    }

    fn find(&self, name: &str) -> Result<&Placed, RoadError> {
        let index = self.names.get(name).ok_or_else(|| RoadError::unknown_element(name, self.elements()))?;
        Ok(&self.elements[*index])
    }

    /// Returns the centre line and the cross-section of a road, if the place `at` metres along it exists.
    fn road(&self, element: &str, at: f64) -> Result<(Curve, &Profile), RoadError> {
        let placed = self.find(element)?;
        let centre = placed.centre_line().ok_or_else(|| RoadError::Element {
            element: element.to_owned(),
            problem: "is an intersection or a roundabout, expected a road".to_owned(),
        })?;
        if !(0.0..=centre.length()).contains(&at) {
            return Err(RoadError::Beyond { element: element.to_owned(), at, length: centre.length() });
        }
        Ok((centre, &placed.plan.profile))
    }
}

/// Returns the middle of a lane `at` metres along a road, facing the direction of the lane's traffic.
pub(crate) fn lane_pose(centre: &Curve, profile: &Profile, lane: i32, at: f64) -> Pose {
    let offset = profile.lane_offset(lane.abs());
    if lane > 0 {
        Pose { position: centre.beside(at, -offset), heading: centre.heading(at) }
    } else {
        Pose { position: centre.beside(at, offset), heading: wrapped(centre.heading(at) + PI) }
    }
}

/// Returns the middle of a sidewalk `at` metres along a road, facing the road.
pub(crate) fn sidewalk_pose(centre: &Curve, profile: &Profile, side: Side, at: f64) -> Pose {
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
    for (i, ending) in from.layout.lanes.iter().enumerate() {
        for (j, beginning) in to.layout.lanes.iter().enumerate() {
            if let (Some(out), Some(into)) = (ending.to, beginning.from)
                && (out.port, into.port) == (from_port, to_port)
                && out.number == into.number
            {
                lanes[from.first + i].successors.push(LaneId::new(to.first + j));
            }
        }
    }
}

impl Placed {
    fn lanes(&self) -> impl Iterator<Item = LaneId> {
        (self.first..self.first + self.layout.lanes.len()).map(LaneId::new)
    }

    fn port(&self, name: &str) -> Result<usize, RoadError> {
        let port = self.points.iter().position(|point| *point == name);
        port.ok_or_else(|| RoadError::unknown_point(&self.name, name, self.points.clone()))
    }

    /// Returns the centre line if the element is a road.
    fn centre_line(&self) -> Option<Curve> {
        match &self.plan.shape {
            ElementShape::Segment(road) => Some(road.centre_line().moved(&self.pose)),
            _ => None,
        }
    }

    fn crossings(&self, element: usize) -> Vec<Crossing> {
        let (ElementShape::Segment(road), Some(centre)) = (&self.plan.shape, self.centre_line()) else {
            return Vec::new();
        };
        let profile = &self.plan.profile;
        let half = profile.half_width();
        let crossing = |at: f64| {
            let start = Pose { position: centre.beside(at, -half), heading: wrapped(centre.heading(at) + FRAC_PI_2) };
            // The lanes of an arc are longer or shorter than the road in proportion to their radii.
            let share = at / centre.length();
            let n = profile.each_way() as usize;
            let forward = (0..n).rev().map(|i| (i, share));
            let lanes = forward.chain((n..2 * n).map(|i| (i, 1.0 - share)));
            let lanes = lanes.map(|(i, share)| (i, share * self.layout.lanes[i].curve.length()));
            let lanes = lanes.map(|(i, s)| (LaneId::new(self.first + i), s)).collect();
            Crossing { element, path: Curve::new(start, 0.0, 2.0 * half), width: ZEBRA, lanes }
        };
        road.zebras().into_iter().map(crossing).collect()
    }
}
