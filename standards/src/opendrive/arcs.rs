//! Approximates lines on a road, such as the middle of a lane, by chains of arcs.

use super::plan_view::wrapped;
use super::road::Road;
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::Curve;
use std::f64::consts::PI;

/// The greatest distance in metres between a line and its arcs.
const EXACT: f64 = 0.0005;
/// The length in metres of a piece that is not divided further.
const SHORTEST: f64 = 0.05;
/// The length in metres up to which an arc is a point and left out.
const POINT: f64 = 1e-9;
/// The number of arcs of one line from which on pieces are not divided further.
const MOST: usize = 100_000;
/// The greatest turn in radians of one arc.
const TURN: f64 = 1.0;

/// A line on a road, `offset` metres to the left of the reference line as a function of the place along the road.
pub(super) struct Beside<'a, F> {
    pub road: &'a Road,
    pub offset: F,
}

impl<F: Fn(f64) -> f64> Beside<'_, F> {
    fn point(&self, s: f64) -> Vector2<f64> {
        self.road.point(s, (self.offset)(s))
    }

    /// Returns the heading of the line in the direction of the road.
    fn heading(&self, s: f64, toward: f64) -> f64 {
        // A difference within the piece: functions of files may jump between pieces.
        let step = 1e-4 * (toward - s).signum() * (toward - s).abs().min(1.0);
        let slope = ((self.offset)(s + step) - (self.offset)(s)) / step;
        self.road.heading_beside(s, (self.offset)(s), slope)
    }

    /// Returns arcs along the line between two places, and the place along the road at which each arc ends. `cuts` are places
    /// at which arcs have to end. `is_fine` returns `true` if the piece between two places needs no further division for
    /// another reason.
    pub fn arcs(&self, [from, to]: [f64; 2], cuts: &[f64], is_fine: impl Fn(f64, f64) -> bool) -> Vec<(f64, Curve)> {
        let inner = cuts.iter().copied().filter(|s| from < *s && *s < to);
        let mut ends: Vec<f64> = inner.chain([to]).collect();
        ends.reverse();
        let mut arcs = Vec::new();
        let mut start = from;
        while let Some(&end) = ends.last() {
            let arc = self.arc(start, end);
            let may_divide = end - start > SHORTEST && arcs.len() < MOST;
            if may_divide && !(self.follows(&arc, start, end) && is_fine(start, end)) {
                ends.push(0.5 * (start + end));
                continue;
            }
            if arc.length() > POINT {
                arcs.push((end, arc));
            }
            start = end;
            ends.pop();
        }
        arcs
    }

    /// Returns the arc through the points at two places that turns as much as the line.
    fn arc(&self, from: f64, to: f64) -> Curve {
        let to = just_before(to, from);
        let [start, end] = [from, to].map(|s| self.point(s));
        let chord = end - start;
        let turn = wrapped(self.heading(to, from) - self.heading(from, to));
        let direction = libm::atan2(chord.y, chord.x);
        let curvature = 2.0 * libm::sin(0.5 * turn) / chord.norm();
        if turn.abs() < 1e-9 || !curvature.is_finite() {
            return Curve::new(Pose { position: start, heading: direction }, 0.0, chord.norm());
        }
        Curve::new(Pose { position: start, heading: wrapped(direction - 0.5 * turn) }, curvature, turn / curvature)
    }

    fn follows(&self, arc: &Curve, from: f64, to: f64) -> bool {
        // A piece that turns by more than half a circle looks like a piece that turns less.
        self.road.line.turns_at_most(from, to) <= PI
            && (arc.curvature() * arc.length()).abs() <= TURN
            && [0.25, 0.5, 0.75].into_iter().all(|share| {
                let point = self.point(from + share * (to - from));
                (arc.point(arc.nearest(point)) - point).norm() <= EXACT
            })
    }
}

/// Returns a place just before the end of a piece: functions of files may jump at the end.
pub(crate) fn just_before(end: f64, start: f64) -> f64 {
    end - 1e-9 * (end - start)
}

/// Returns an arc in the opposite direction.
pub(super) fn reversed(arc: &Curve) -> Curve {
    let end = arc.end();
    let start = Pose { position: end.position, heading: wrapped(end.heading + PI) };
    Curve::new(start, -arc.curvature(), arc.length())
}
