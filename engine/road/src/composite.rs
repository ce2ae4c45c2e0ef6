//! Road elements that are connected to one another. Their positions follow from the connections.
//!
//! A composite keeps its first mistake and reports it when the network is built, so that programs need no `?` on every
//! line. It ignores all connections after the first mistake, because they would only lead to further messages.

use super::element::{Element, ElementShape};
use super::error::{ANGLE, GAP, RoadError};
use super::layout::{Plan, Port};
use crate::geometry::Pose;
use crate::geometry::wrapped;
use nalgebra::Vector2;
use std::collections::HashMap;
use std::f64::consts::PI;

/// A group of connected road elements. A composite is itself a road element.
///
/// The first element is the root: the positions of all others follow from it, directly or through other elements. A
/// point is named `element.point`. For the points of the root, `point` is enough.
#[derive(Debug, Clone)]
pub struct Composite {
    pub(super) parts: Vec<Part>,
    pub(super) links: Vec<[End; 2]>,
    /// The index of the part with each name. Only looked up, so that the order does not matter.
    names: HashMap<String, usize>,
    /// The number of elements without a name, for each kind. Only looked up, so that the order does not matter.
    unnamed: HashMap<&'static str, usize>,
    pub(super) mistake: Option<RoadError>,
}

/// An element at its place.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub name: String,
    /// `true` if the program named the element.
    named: bool,
    pub plan: Plan,
    pub pose: Pose,
    /// The points of the element, each with the point that it is connected to.
    ports: Vec<(Port, Option<End>)>,
}

/// A point of a composite: the index of the part and the index of the port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct End {
    pub part: usize,
    pub port: usize,
}

impl<S: Into<ElementShape>> From<Element<S>> for Composite {
    fn from(element: Element<S>) -> Self {
        let plan = Plan { shape: element.shape.into(), profile: element.profile };
        let named = element.name.is_some();
        let name = element.name.unwrap_or_else(|| plan.kind().to_owned());
        let mistake = plan.problem().map(|problem| RoadError::Element { element: name.clone(), problem });
        // An element that is not valid cannot be asked for its points.
        let ports = if mistake.is_some() { Vec::new() } else { plan.ports() };
        let ports = ports.into_iter().map(|port| (port, None)).collect();
        let pose = Pose { position: Vector2::zeros(), heading: 0.0 };
        let unnamed = if named { HashMap::new() } else { HashMap::from([(plan.kind(), 1)]) };
        let names = HashMap::from([(name.clone(), 0)]);
        Self { parts: vec![Part { name, named, plan, pose, ports }], links: Vec::new(), names, unnamed, mistake }
    }
}

impl<S: Into<ElementShape>> Element<S> {
    /// Joins `child_point` of another element or composite to `point` of this element by [`Composite::connect`].
    pub fn connect(self, point: &str, child: impl Into<Composite>, child_point: &str) -> Composite {
        Composite::from(self).connect(point, child, child_point)
    }

    /// Puts the origin of the element at a pose, as [`Composite::at`] does.
    pub fn at(self, pose: Pose) -> Composite {
        Composite::from(self).at(pose)
    }
}

impl Composite {
    /// Joins the point `child_point` of another element or composite to the point `point` of this composite. This gives
    /// all elements of the child their places. Elements of the child that have no name of their own are numbered again.
    pub fn connect(self, point: &str, child: impl Into<Composite>, child_point: &str) -> Self {
        let child = child.into();
        self.unless_mistaken(|all| {
            let at = all.resolve(point)?;
            if let Some(mistake) = child.mistake {
                return Err(mistake);
            }
            let end = child.resolve(child_point)?;
            // The two points get the same position and opposite headings.
            let target = all.pose_of(at);
            let facing = Pose { heading: wrapped(target.heading + PI), ..target };
            let frame = facing.then(&inverse(&child.pose_of(end)));
            let first = all.parts.len();
            all.take_in(child, &frame)?;
            all.link(at, End { part: first + end.part, ..end })
        })
    }

    /// Closes a loop by a connection between two points of this composite. The points must meet to 1 cm and 0.1
    /// degrees. No element is moved, so that the lanes at the two points meet only as exactly as the points do.
    pub fn close(self, a: &str, b: &str) -> Self {
        self.unless_mistaken(|all| {
            let (a, b) = (all.resolve(a)?, all.resolve(b)?);
            let (pose_a, pose_b) = (all.pose_of(a), all.pose_of(b));
            let gap = (pose_a.position - pose_b.position).norm();
            let angle = wrapped(pose_a.heading + PI - pose_b.heading).abs().to_degrees();
            all.link(a, b)?;
            if gap > GAP || angle > ANGLE {
                return Err(RoadError::OpenLoop { a: all.label(a), b: all.label(b), gap, angle });
            }
            Ok(())
        })
    }

    /// Puts the origin of the first element at a pose, and moves all other elements with the first element.
    pub fn at(self, pose: Pose) -> Self {
        self.unless_mistaken(|all| {
            let Pose { position, heading } = pose;
            if ![position.x, position.y, heading].into_iter().all(f64::is_finite) {
                let problem =
                    format!("is put at ({}, {}), heading {heading}, expected finite numbers", position.x, position.y);
                return Err(RoadError::Element { element: all.parts[0].name.clone(), problem });
            }
            let frame = pose.then(&inverse(&all.parts[0].pose));
            for part in &mut all.parts {
                part.pose = frame.then(&part.pose);
            }
            Ok(())
        })
    }

    /// Returns the names of all points of the composite that are not connected to another point.
    pub fn free_points(&self) -> Vec<String> {
        let ends = |(part, of): (usize, &Part)| (0..of.ports.len()).map(move |port| End { part, port });
        let ends = self.parts.iter().enumerate().flat_map(ends);
        let free = ends.filter(|end| self.parts[end.part].ports[end.port].1.is_none());
        free.map(|end| self.label(end)).collect()
    }

    fn unless_mistaken(mut self, change: impl FnOnce(&mut Self) -> Result<(), RoadError>) -> Self {
        if self.mistake.is_none() {
            self.mistake = change(&mut self).err();
        }
        self
    }

    /// Returns the point with this name.
    fn resolve(&self, point: &str) -> Result<End, RoadError> {
        let (part, name) = match point.rsplit_once('.') {
            None => (0, point),
            Some((element, name)) => (self.find(element)?, name),
        };
        let ports = &self.parts[part].ports;
        let port = ports.iter().position(|(port, _)| port.name == name).ok_or_else(|| {
            let points = ports.iter().map(|(port, _)| port.name).collect();
            RoadError::unknown_point(&self.parts[part].name, name, points)
        })?;
        Ok(End { part, port })
    }

    fn find(&self, name: &str) -> Result<usize, RoadError> {
        let names = self.parts.iter().map(|part| &*part.name);
        self.names.get(name).copied().ok_or_else(|| RoadError::unknown_element(name, names))
    }

    /// Returns the name of a point.
    pub(super) fn label(&self, end: End) -> String {
        let part = &self.parts[end.part];
        format!("{}.{}", part.name, part.ports[end.port].0.name)
    }

    /// Returns the position of a point; the heading points outward.
    fn pose_of(&self, end: End) -> Pose {
        let part = &self.parts[end.part];
        part.pose.then(&part.ports[end.port].0.pose)
    }

    /// Adds the parts and links of a child. `frame` moves the child to its place.
    fn take_in(&mut self, child: Composite, frame: &Pose) -> Result<(), RoadError> {
        let first = self.parts.len();
        let moved = |end: End| End { part: first + end.part, ..end };
        for mut part in child.parts {
            if !part.named {
                part.name = self.new_name(part.plan.kind());
            }
            if self.names.insert(part.name.clone(), self.parts.len()).is_some() {
                return Err(RoadError::NameTaken { name: part.name });
            }
            part.pose = frame.then(&part.pose);
            part.ports.iter_mut().for_each(|(_, to)| *to = to.map(moved));
            self.parts.push(part);
        }
        self.links.extend(child.links.into_iter().map(|ends| ends.map(moved)));
        Ok(())
    }

    fn new_name(&mut self, kind: &'static str) -> String {
        let count = self.unnamed.entry(kind).or_default();
        loop {
            *count += 1;
            let name = if *count == 1 { kind.to_owned() } else { format!("{kind}-{count}") };
            if !self.names.contains_key(&name) {
                return name;
            }
        }
    }

    fn link(&mut self, a: End, b: End) -> Result<(), RoadError> {
        let to = |end: End| self.parts[end.part].ports[end.port].1;
        for (end, other) in [(a, b), (b, a)] {
            // If a point is connected to itself, the same connection takes the point twice.
            if let Some(taken) = to(end).or((a == b).then_some(b)) {
                return Err(RoadError::PointTaken {
                    point: self.label(end),
                    taken_by: self.label(taken),
                    to: self.label(other),
                });
            }
        }
        let profile = |end: End| self.parts[end.part].plan.profile;
        let (one, other) = (profile(a), profile(b));
        let labels = || (self.label(a), self.label(b));
        if one.lanes != other.lanes {
            let (a, b) = labels();
            return Err(RoadError::DifferentLanes { a, b, lanes: (one.lanes, other.lanes) });
        }
        if one.lane_width != other.lane_width {
            let (a, b) = labels();
            return Err(RoadError::DifferentWidths { a, b, widths: (one.lane_width, other.lane_width) });
        }
        self.parts[a.part].ports[a.port].1 = Some(b);
        self.parts[b.part].ports[b.port].1 = Some(a);
        self.links.push([a, b]);
        Ok(())
    }
}

/// Returns the pose of the origin as seen from `pose`.
fn inverse(pose: &Pose) -> Pose {
    Pose { position: pose.to_local(Vector2::zeros()), heading: wrapped(-pose.heading) }
}
