//! Paths over a network as a single line. An object that moves along a path needs no lanes.

use super::centreline::{Chain, chained};
use super::curve::Curve;
use super::lane::LaneId;
use super::network::RoadNetwork;
use super::route::Route;
use crate::geometry::Pose;
use nalgebra::Vector2;
use std::sync::Arc;

/// A path as a sequence of connected curves, cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The curves, each with the place where it begins, in metres along the path.
    pieces: Chain,
    /// The lane of each piece, if the path was made from lanes.
    lanes: Option<Arc<[LaneId]>>,
    length: f64,
    /// The poses at the start and at the end, with the directions in which the path continues there.
    ends: [End; 2],
}

/// An end of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
struct End {
    pose: Pose,
    forward: Vector2<f64>,
}

impl End {
    fn of(pose: Pose) -> Self {
        Self { pose, forward: pose.forward() }
    }

    /// Returns the distance in metres from the end to a position, along the direction of the path at the end.
    fn beyond(&self, position: Vector2<f64>) -> f64 {
        self.forward.dot(&(position - self.pose.position))
    }
}

impl Path {
    /// Makes the path along the given curves. Each curve has to begin where the previous curve ends.
    ///
    /// # Panics
    /// There are no curves.
    pub fn new(curves: impl IntoIterator<Item = Curve>) -> Self {
        let (pieces, length) = chained(curves);
        assert!(!pieces.is_empty(), "a path has at least one curve");
        let ends = [0.0, length].map(|s| {
            let (from, curve) = &pieces[index(&pieces, s)];
            End::of(curve.at(s - from))
        });
        Self { pieces, lanes: None, length, ends }
    }

    /// Makes the path along the given curves of lanes.
    fn of_lanes(pieces: impl IntoIterator<Item = (Curve, LaneId)>) -> Self {
        let (curves, lanes): (Vec<_>, Vec<_>) = pieces.into_iter().unzip();
        Self::new(curves).on(lanes)
    }

    /// Sets the lane of each piece.
    fn on(self, lanes: impl IntoIterator<Item = LaneId>) -> Self {
        Self { lanes: Some(lanes.into_iter().collect()), ..self }
    }

    /// Returns the length in metres of the first piece whose length is no number from 0 on or whose end is not finite.
    pub fn wrong_piece(&self) -> Option<f64> {
        let broken = |(_, curve): &&(f64, Curve)| !(curve.length() >= 0.0 && curve.end().is_finite());
        self.pieces.iter().find(broken).map(|(_, curve)| curve.length())
    }

    /// Returns `true` if the path was made from lanes.
    #[inline]
    pub fn is_on_lanes(&self) -> bool {
        self.lanes.is_some()
    }

    /// Returns the lanes between two distances along the path, in order; nothing if the path was not made from lanes.
    pub fn lanes(&self, from: f64, to: f64) -> impl Iterator<Item = LaneId> + use<> {
        let first = self.index(from);
        let range = if self.is_on_lanes() { first..self.index(to) + 1 } else { 0..0 };
        let lanes = self.lanes.clone();
        range.filter_map(move |index| {
            let lanes = lanes.as_ref()?;
            // A lane can have several pieces.
            (index == first || lanes[index - 1] != lanes[index]).then(|| lanes[index])
        })
    }

    /// Returns the lanes of the path in order, each with the place where the path meets the lane, in metres along the path;
    /// nothing if the path was not made from lanes.
    pub fn lane_pieces(&self) -> impl Iterator<Item = (f64, LaneId)> {
        let lanes: &[LaneId] = self.lanes.as_deref().unwrap_or_default();
        let is_first = |index: &usize| *index == 0 || lanes[index - 1] != lanes[*index];
        (0..lanes.len()).filter(move |index| is_first(index)).map(|index| (self.pieces[index].0, lanes[index]))
    }

    /// Makes the straight path from one place to another place. If both places are equal, the path faces along x.
    pub fn straight(from: Vector2<f64>, to: Vector2<f64>) -> Self {
        let way = to - from;
        let start = Pose { position: from, heading: libm::atan2(way.y, way.x) };
        Self::new([Curve::new(start, 0.0, way.norm())])
    }

    /// Returns the length of the path in metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the curves of the path.
    pub fn curves(&self) -> impl ExactSizeIterator<Item = &Curve> {
        self.pieces.iter().map(|(_, curve)| curve)
    }

    /// Returns the piece of the path from `from` to `to` metres along the path; `from` is not greater than `to`. The
    /// piece ends where the path ends.
    pub fn piece(&self, from: f64, to: f64) -> Self {
        let [from, to] = [from, to].map(|s| s.max(0.0).min(self.length));
        // If the piece is only a point, it belongs to the curve that begins at the point, or to the last curve.
        let last = self.pieces.partition_point(|(begin, _)| *begin < to).max(1) - 1;
        let first = (self.pieces.partition_point(|(begin, _)| *begin <= from).max(1) - 1).min(last);
        let piece = |(begin, curve): &(f64, Curve)| {
            // Lengths are sums, so rounding can put an end slightly beyond the end of the curve.
            let from = (from - begin).max(0.0).min(curve.length());
            curve.piece(from, (to - begin).min(curve.length()).max(from))
        };
        let path = Self::new(self.pieces[first..=last].iter().map(piece));
        match &self.lanes {
            Some(lanes) => path.on(lanes[first..=last].iter().copied()),
            None => path,
        }
    }

    /// Returns the pose `s` metres along the path. Before its start and beyond its end the path continues straight.
    #[inline]
    pub fn at(&self, s: f64) -> Pose {
        self.beside(s, 0.0)
    }

    /// Returns the pose `offset` metres to the left of the pose `s` metres along the path.
    #[inline]
    pub fn beside(&self, s: f64, offset: f64) -> Pose {
        // Beyond both ends the path continues straight.
        let inside = s.max(0.0).min(self.length);
        let (from, curve) = &self.pieces[self.index(inside)];
        let at = inside - from;
        if s == inside {
            return Pose { position: curve.beside(at, offset), heading: curve.heading(at) };
        }
        let End { pose, forward } = self.ends[usize::from(s > 0.0)];
        let position = if offset == 0.0 { pose.position } else { curve.beside(at, offset) };
        Pose { position: position + forward * (s - inside), heading: pose.heading }
    }

    /// Returns the points and the curvatures of the path at the given distances along the path, which ascend. They are
    /// the positions of [`Path::at`] and the curvatures of [`Path::curvature`], at a lower cost.
    #[inline]
    pub fn points<const N: usize>(&self, places: [f64; N]) -> [(Vector2<f64>, f64); N] {
        let mut piece = self.index(places[0]);
        places.map(|s| {
            if s > self.length {
                let End { pose, forward } = self.ends[1];
                return (pose.position + forward * (s - self.length), 0.0);
            }
            if s.is_nan() || s < 0.0 {
                return (self.at(s).position, 0.0);
            }
            while self.pieces.get(piece + 1).is_some_and(|(from, _)| *from <= s) {
                piece += 1;
            }
            let (from, curve) = &self.pieces[piece];
            (curve.point(s - from), curve.curvature())
        })
    }

    /// Returns the curvature of the path at the place `s`, in 1/m, positive to the left; 0 beyond the ends of the path.
    #[inline]
    pub fn curvature(&self, s: f64) -> f64 {
        let inside = (0.0..=self.length).contains(&s);
        if inside { self.pieces[self.index(s)].1.curvature() } else { 0.0 }
    }

    /// Returns the distance in metres along the path to the path's point that is nearest to `position`. Only the curve
    /// at `s` and its two neighbours are searched: a path may cross itself, and an object on it must not jump from one
    /// branch to the other. Before its start and beyond its end the path continues straight.
    pub fn nearest(&self, position: Vector2<f64>, s: f64) -> f64 {
        let nearest = match &*self.pieces {
            // Without neighbours, no distances need to be compared.
            [(from, curve)] => from + curve.nearest(position),
            _ => self.nearest_of_three(position, s),
        };
        if nearest >= self.length {
            nearest + self.ends[1].beyond(position).max(0.0)
        } else if nearest <= 0.0 {
            nearest + self.ends[0].beyond(position).min(0.0)
        } else {
            nearest
        }
    }

    /// Returns the distance along the path to the nearest point of the curve at `s` and its two neighbours.
    fn nearest_of_three(&self, position: Vector2<f64>, s: f64) -> f64 {
        let here = self.index(s);
        let mut best = (f64::INFINITY, s);
        for piece in here.saturating_sub(1)..(here + 2).min(self.pieces.len()) {
            let (from, curve) = &self.pieces[piece];
            let at = curve.nearest(position);
            let distance = (curve.point(at) - position).norm_squared();
            if distance < best.0 {
                best = (distance, from + at);
            }
        }
        best.1
    }

    /// Returns the index of the curve that contains the point `s` metres along the path.
    #[inline]
    fn index(&self, s: f64) -> usize {
        index(&self.pieces, s)
    }

    /// Returns the path in the opposite direction, without lanes.
    pub fn reversed(&self) -> Self {
        Self::new(self.pieces.iter().rev().map(|(_, curve)| curve.reversed()))
    }

    /// Returns the path shifted to the left by `left` metres, for example from a lane to the shoulder beside it.
    pub fn shifted(&self, left: f64) -> Self {
        Self::new(self.pieces.iter().map(|(_, curve)| curve.offset(left)))
    }
}

/// Returns the index of the last piece that begins at most `s` metres along the path.
#[inline]
fn index(pieces: &[(f64, Curve)], s: f64) -> usize {
    pieces.partition_point(|(from, _)| *from <= s).max(1) - 1
}

impl RoadNetwork {
    /// Returns the path along the middles of the given lanes. Each lane has to be a successor of the previous lane.
    ///
    /// # Panics
    /// `lanes` is empty, or a lane belongs to another network, which has more lanes.
    pub fn path(&self, lanes: &[LaneId]) -> Path {
        Path::of_lanes(lanes.iter().flat_map(|lane| self.lane(*lane).curve.curves().map(|curve| (*curve, *lane))))
    }

    /// Returns the path along a route, from the start to the end of the route. `None` if the route changes lanes: a
    /// lane change takes time, and the driver decides how long.
    pub fn path_along(&self, route: &Route) -> Option<Path> {
        let last = route.lanes.len() - 1;
        let pieces = |(i, lane): (usize, &LaneId)| {
            let lane = *lane;
            let line = &self.lane(lane).curve;
            let from = if i == 0 { route.start } else { 0.0 };
            let to = if i == last { route.end } else { line.length() };
            line.pieces(from, to).into_iter().map(move |curve| (curve, lane))
        };
        (route.changes == 0).then(|| Path::of_lanes(route.lanes.iter().enumerate().flat_map(pieces)))
    }
}
