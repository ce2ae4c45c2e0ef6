//! Ways over a network as one line: what moves along a path needs no lanes.

use super::curve::Curve;
use super::lane::LaneId;
use super::network::RoadNetwork;
use super::route::Route;
use crate::geometry::Pose;
use nalgebra::Vector2;
use std::sync::Arc;

/// Curves one after the other, cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Each with how many metres along the path it begins.
    pieces: Arc<[(f64, Curve)]>,
    /// The lanes that the pieces are of, where they are of any.
    lanes: Option<Arc<[LaneId]>>,
    length: f64,
}

impl Path {
    /// The path along these curves, of which each is to begin where the one before it ends.
    ///
    /// # Panics
    /// There are none.
    pub fn new(curves: impl IntoIterator<Item = Curve>) -> Self {
        let mut length = 0.0;
        let begun = |curve: Curve| {
            let from = length;
            length += curve.length();
            (from, curve)
        };
        let pieces: Arc<[_]> = curves.into_iter().map(begun).collect();
        assert!(!pieces.is_empty(), "a path has at least one curve");
        Self { pieces, lanes: None, length }
    }

    /// The same path, of which each piece is of one of these lanes.
    fn on(self, lanes: impl IntoIterator<Item = LaneId>) -> Self {
        Self { lanes: Some(lanes.into_iter().collect()), ..self }
    }

    /// The length of a piece that cannot be, in metres.
    pub(crate) fn wrong_piece(&self) -> Option<f64> {
        let broken = |(_, curve): &&(f64, Curve)| !(curve.length() >= 0.0 && curve.end().is_finite());
        self.pieces.iter().find(broken).map(|(_, curve)| curve.length())
    }

    /// The lanes that it leads over between two distances along it, in order; none where it is of no lanes.
    pub(crate) fn lanes(&self, from: f64, to: f64) -> impl ExactSizeIterator<Item = LaneId> + use<> {
        let range = match &self.lanes {
            Some(_) => self.index(from)..self.index(to) + 1,
            None => 0..0,
        };
        let lanes = self.lanes.clone();
        range.map(move |index| lanes.as_ref().expect("it is of lanes")[index])
    }

    /// The straight path from one place to another. Where both are one, it faces along x.
    pub fn straight(from: Vector2<f64>, to: Vector2<f64>) -> Self {
        let way = to - from;
        let start = Pose { position: from, heading: libm::atan2(way.y, way.x) };
        Self::new([Curve::new(start, 0.0, way.norm())])
    }

    /// Its length in metres.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The curves that it consists of.
    pub fn curves(&self) -> impl ExactSizeIterator<Item = &Curve> {
        self.pieces.iter().map(|(_, curve)| curve)
    }

    /// The piece of it between two distances along it, of which the first is not beyond the second. What would be beyond
    /// its ends is left out.
    pub fn piece(&self, from: f64, to: f64) -> Self {
        let [from, to] = [from, to].map(|s| s.max(0.0).min(self.length));
        // Where the piece is but a point, it is one of the curve that goes on from there, or of the last.
        let last = self.pieces.partition_point(|(begin, _)| *begin < to).max(1) - 1;
        let first = (self.pieces.partition_point(|(begin, _)| *begin <= from).max(1) - 1).min(last);
        let piece = |(begin, curve): &(f64, Curve)| {
            // Lengths are sums, so that an end may be a rounding beyond the curve's.
            let from = (from - begin).max(0.0).min(curve.length());
            curve.piece(from, (to - begin).min(curve.length()).max(from))
        };
        let path = Self::new(self.pieces[first..=last].iter().map(piece));
        match &self.lanes {
            Some(lanes) => path.on(lanes[first..=last].iter().copied()),
            None => path,
        }
    }

    /// The pose `s` metres along it; before its start and beyond its end it goes on straight.
    pub fn at(&self, s: f64) -> Pose {
        self.beside(s, 0.0)
    }

    /// The pose `offset` metres to the left of the one `s` metres along it.
    pub fn beside(&self, s: f64, offset: f64) -> Pose {
        // Beyond both ends it goes on straight.
        let inside = s.max(0.0).min(self.length);
        let (from, curve) = &self.pieces[self.index(inside)];
        let at = inside - from;
        let ahead = curve.at(at).forward() * (s - inside);
        Pose { position: curve.beside(at, offset) + ahead, heading: curve.heading(at) }
    }

    /// How the path bends `s` metres along it, in 1/m, positive to the left.
    pub fn curvature(&self, s: f64) -> f64 {
        let inside = (0.0..=self.length).contains(&s);
        if inside { self.pieces[self.index(s)].1.curvature() } else { 0.0 }
    }

    /// How many metres along the path the point lies that is nearest to `position`, among those near the point `s` metres
    /// along it: on the curve that `s` is on and those beside it. A path may cross itself; who goes along it does not
    /// jump from one branch to the other. Before its start and beyond its end the path goes on straight.
    pub fn nearest(&self, position: Vector2<f64>, s: f64) -> f64 {
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
        let [start, end] = [0.0, self.length].map(|end| (self.at(end), end));
        if best.1 >= self.length {
            best.1 += end.0.to_local(position).x.max(0.0);
        } else if best.1 <= 0.0 {
            best.1 += start.0.to_local(position).x.min(0.0);
        }
        best.1
    }

    /// The curve that the point `s` metres along it is on.
    fn index(&self, s: f64) -> usize {
        self.pieces.partition_point(|(from, _)| *from <= s).max(1) - 1
    }

    /// The same path the other way.
    pub fn reversed(&self) -> Self {
        Self::new(self.pieces.iter().rev().map(|(_, curve)| curve.reversed()))
    }

    /// The path shifted to the left by these metres, for example from a lane to the shoulder beside it.
    pub fn shifted(&self, left: f64) -> Self {
        Self::new(self.pieces.iter().map(|(_, curve)| curve.offset(left)))
    }
}

impl RoadNetwork {
    /// The path along the middles of lanes, of which each is to be a successor of the one before.
    ///
    /// # Panics
    /// There are none, or they are of another network.
    pub fn path(&self, lanes: &[LaneId]) -> Path {
        Path::new(lanes.iter().map(|lane| self.lane(*lane).curve)).on(lanes.iter().copied())
    }

    /// The path along a route, from its start to its end. None where the route changes lanes: that takes a while, and
    /// how long is a driver's to say.
    pub fn path_along(&self, route: &Route) -> Option<Path> {
        let last = route.lanes.len() - 1;
        let piece = |(i, lane): (usize, &LaneId)| {
            let curve = self.lane(*lane).curve;
            let from = if i == 0 { route.start } else { 0.0 };
            let to = if i == last { route.end } else { curve.length() };
            curve.piece(from, to)
        };
        let path = || Path::new(route.lanes.iter().enumerate().map(piece)).on(route.lanes.iter().copied());
        (route.changes == 0).then(path)
    }
}
