//! The reference line of a road: lines, arcs, spirals and polynomials in the plane, parametrised by arc length.

use super::cubics::{bend, slope, value};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use std::f64::consts::{PI, TAU};

/// The reference line of a road.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanView {
    pieces: Vec<Geometry>,
}

/// A piece of a reference line.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// The place at which the piece begins, in metres along the road.
    pub s: f64,
    /// The length of the piece in metres.
    pub length: f64,
    /// The position and the heading of the road at the beginning of the piece.
    pub start: Pose,
    /// The shape of the piece.
    pub shape: Shape,
}

/// The shape of a piece of a reference line. Curvatures are in 1/m and positive to the left.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A straight line.
    Line,
    /// A circular arc.
    Arc {
        /// The curvature of the arc.
        curvature: f64,
    },
    /// A clothoid: the curvature changes linearly along the piece.
    Spiral(Spiral),
    /// A pair of cubic polynomials.
    Polynomials(Polynomials),
}

impl PlanView {
    /// Makes a reference line from at least one piece, in the order of their places.
    pub(super) fn new(pieces: Vec<Geometry>) -> Self {
        debug_assert!(!pieces.is_empty() && pieces.is_sorted_by_key(|piece| piece.s));
        Self { pieces }
    }

    /// Returns all pieces in their order.
    pub fn pieces(&self) -> &[Geometry] {
        &self.pieces
    }

    /// Returns the position and the heading at a place, in metres along the road. Beyond both ends, the last shapes
    /// continue.
    pub fn at(&self, s: f64) -> Pose {
        let piece = self.piece(s);
        piece.at(s - piece.s)
    }

    /// Returns the curvature at a place, in 1/m, positive to the left.
    pub fn curvature(&self, s: f64) -> f64 {
        let piece = self.piece(s);
        piece.curvature(s - piece.s)
    }

    /// Returns the metres of the line for each metre of the road at a place: 1, unless a `paramPoly3` has another length than
    /// its piece.
    pub fn rate(&self, s: f64) -> f64 {
        match &self.piece(s).shape {
            Shape::Polynomials(pair) => pair.scale,
            Shape::Line | Shape::Arc { .. } | Shape::Spiral(_) => 1.0,
        }
    }

    /// Returns a bound on the angle in radians by which the line turns between two places of one piece. A piece of polynomials
    /// may turn by 2 π more: the direction of a cubic is a parabola, which does not go around the origin twice.
    pub(super) fn turns_at_most(&self, from: f64, to: f64) -> f64 {
        let piece = self.piece(from);
        match &piece.shape {
            Shape::Line | Shape::Polynomials(_) => 0.0,
            Shape::Arc { curvature } => curvature.abs() * (to - from),
            Shape::Spiral(_) => {
                let [start, end] = [from, to].map(|s| piece.curvature(s - piece.s).abs());
                start.max(end) * (to - from)
            }
        }
    }

    fn piece(&self, s: f64) -> &Geometry {
        let after = self.pieces.partition_point(|piece| piece.s <= s);
        &self.pieces[after.saturating_sub(1)]
    }
}

impl Geometry {
    /// Returns the position and the heading, `ds` metres after the beginning of the piece.
    pub fn at(&self, ds: f64) -> Pose {
        let (local, turn) = self.local(ds);
        let forward = self.start.forward();
        let left = Vector2::new(-forward.y, forward.x);
        let position = self.start.position + forward * local.x + left * local.y;
        Pose { position, heading: wrapped(self.start.heading + turn) }
    }

    /// Returns the curvature, `ds` metres after the beginning of the piece, in 1/m, positive to the left.
    pub fn curvature(&self, ds: f64) -> f64 {
        match &self.shape {
            Shape::Line => 0.0,
            Shape::Arc { curvature } => *curvature,
            Shape::Spiral(spiral) => spiral.curvature + spiral.rate * ds,
            Shape::Polynomials(pair) => {
                let p = pair.parameter(ds);
                let first = pair.derivative(p);
                let second = Vector2::new(bend(&pair.u, p), bend(&pair.v, p));
                first.perp(&second) / libm::pow(first.norm_squared(), 1.5)
            }
        }
    }

    /// Returns the position and the heading in the coordinates of the start.
    fn local(&self, ds: f64) -> (Vector2<f64>, f64) {
        match &self.shape {
            Shape::Line => (Vector2::new(ds, 0.0), 0.0),
            Shape::Arc { curvature } => (arc(*curvature, ds), curvature * ds),
            Shape::Spiral(spiral) => (spiral.point(ds), spiral.turn(ds)),
            Shape::Polynomials(pair) => {
                let p = pair.parameter(ds);
                let direction = pair.derivative(p);
                (Vector2::new(value(&pair.u, p), value(&pair.v, p)), libm::atan2(direction.y, direction.x))
            }
        }
    }
}

/// Returns the point of an arc that begins at the origin along x.
fn arc(curvature: f64, ds: f64) -> Vector2<f64> {
    if curvature == 0.0 {
        return Vector2::new(ds, 0.0);
    }
    // 1 - cos, in a form that keeps its digits on an arc that is nearly straight.
    let half = libm::sin(0.5 * curvature * ds);
    Vector2::new(libm::sin(curvature * ds), 2.0 * half * half) / curvature
}

/// A clothoid that begins at the origin along x.
#[derive(Debug, Clone, PartialEq)]
pub struct Spiral {
    /// The curvature at the beginning in 1/m, and its increase in 1/m².
    curvature: f64,
    rate: f64,
    /// The distance in metres between two knots, and the points of the clothoid at the knots.
    step: f64,
    knots: Vec<Vector2<f64>>,
}

/// The greatest turn in radians between two knots of a clothoid. The quadrature between two knots is exact to about 1e-15 of
/// the distance.
const TURN: f64 = 0.5;

impl Spiral {
    /// Makes a clothoid of `length` metres from its curvatures at both ends, in 1/m.
    pub(super) fn new(from: f64, to: f64, length: f64) -> Self {
        let rate = if length > 0.0 { (to - from) / length } else { 0.0 };
        let count = (from.abs().max(to.abs()) * length / TURN).ceil().clamp(1.0, 1e6);
        let mut spiral = Self { curvature: from, rate, step: length / count, knots: vec![Vector2::zeros()] };
        for i in 1..count as usize {
            let next = spiral.point(i as f64 * spiral.step);
            spiral.knots.push(next);
        }
        spiral
    }

    /// Returns the curvatures at the beginning and `length` metres after it, in 1/m.
    pub fn curvatures(&self, length: f64) -> [f64; 2] {
        [self.curvature, self.curvature + self.rate * length]
    }

    fn turn(&self, ds: f64) -> f64 {
        ds * (self.curvature + 0.5 * self.rate * ds)
    }

    fn point(&self, ds: f64) -> Vector2<f64> {
        let last = self.knots.len() - 1;
        let knot = if ds > 0.0 && self.step > 0.0 { ((ds / self.step) as usize).min(last) } else { 0 };
        let direction = |at: f64| {
            let (sin, cos) = libm::sincos(self.turn(at));
            Vector2::new(cos, sin)
        };
        self.knots[knot] + quadrature(knot as f64 * self.step, ds, direction)
    }
}

/// A curve of two cubic polynomials u(p) and v(p), with u along the heading at the start, parametrised by arc length.
///
/// The standard measures s along the reference line. The parameter p of a file is close to the arc length, but it is not the
/// arc length.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomials {
    u: [f64; 4],
    v: [f64; 4],
    /// The increase of p between two knots, and the arc lengths at the knots.
    step: f64,
    knots: Vec<f64>,
    /// The metres of the curve for each metre of the road.
    scale: f64,
}

const KNOTS: usize = 64;

impl Polynomials {
    /// Makes the graph of the polynomial v(u), `length` metres long.
    pub(super) fn graph(v: [f64; 4], length: f64) -> Self {
        // The graph is at least as long as u, so that its end lies before u = length.
        Self { scale: 1.0, ..Self::new([0.0, 1.0, 0.0, 0.0], v, [length, length]) }
    }

    /// Makes the curve of u(p) and v(p) with p from 0 to `end`. The road is `length` metres long; if the curve has another
    /// length, the places along the road are distributed evenly over the curve.
    pub(super) fn new(u: [f64; 4], v: [f64; 4], [end, length]: [f64; 2]) -> Self {
        let mut pair = Self { u, v, step: end / KNOTS as f64, knots: vec![0.0], scale: 1.0 };
        for i in 0..KNOTS {
            pair.knots.push(pair.knots[i] + pair.arc_length(i as f64 * pair.step, (i + 1) as f64 * pair.step));
        }
        if length > 0.0 && pair.knots[KNOTS] > 0.0 {
            pair.scale = pair.knots[KNOTS] / length;
        }
        pair
    }

    /// Returns the length of the curve in metres, which need not be finite.
    pub(super) fn length(&self) -> f64 {
        self.knots[KNOTS]
    }

    /// Returns the coefficients a, b, c and d of u(p) and of v(p).
    pub fn coefficients(&self) -> [[f64; 4]; 2] {
        [self.u, self.v]
    }

    fn derivative(&self, p: f64) -> Vector2<f64> {
        Vector2::new(slope(&self.u, p), slope(&self.v, p))
    }

    fn arc_length(&self, from: f64, to: f64) -> f64 {
        quadrature(from, to, |p| Vector2::new(self.derivative(p).norm(), 0.0)).x
    }

    /// Returns the parameter at a place, in metres along the road.
    fn parameter(&self, ds: f64) -> f64 {
        let wanted = ds * self.scale;
        let knot = self.knots.partition_point(|length| *length <= wanted).saturating_sub(1);
        let start = knot as f64 * self.step;
        // A step must not leave the piece between two knots: where the curve nearly stops, a step would be too long.
        let inside =
            if ds >= 0.0 && knot < KNOTS { start..=start + self.step } else { f64::NEG_INFINITY..=f64::INFINITY };
        let mut p = start;
        // Newton's method; a few steps suffice, because the speed changes little between two knots.
        for _ in 0..8 {
            let speed = self.derivative(p).norm();
            let wrong = self.knots[knot] + self.arc_length(start, p) - wanted;
            if speed == 0.0 || wrong.abs() < 1e-13 {
                break;
            }
            p = (p - wrong / speed).clamp(*inside.start(), *inside.end());
        }
        p
    }
}

/// The nodes and weights of Gauss-Legendre quadrature with eight points (Abramowitz and Stegun, table 25.4).
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_3),
];

/// Returns the integral of a function.
fn quadrature(from: f64, to: f64, function: impl Fn(f64) -> Vector2<f64>) -> Vector2<f64> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pairs = NODES.map(|(node, weight)| (function(middle - half * node) + function(middle + half * node)) * weight);
    pairs.into_iter().sum::<Vector2<f64>>() * half
}

/// Returns an angle in (-π, π].
pub(super) fn wrapped(angle: f64) -> f64 {
    if angle > -PI && angle <= PI { angle } else { PI - (PI - angle).rem_euclid(TAU) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shapes(length: f64) -> impl Strategy<Value = Shape> {
        let few = || prop::array::uniform4(-0.3..0.3);
        prop_oneof![
            Just(Shape::Line),
            (-0.2..0.2).prop_map(|curvature| Shape::Arc { curvature }),
            (-0.2..0.2, -0.2..0.2).prop_map(move |(from, to)| Shape::Spiral(Spiral::new(from, to, length))),
            few().prop_map(move |v| {
                let v = [0.0, v[1], v[2] / length, v[3] / length / length];
                Shape::Polynomials(Polynomials::graph(v, length))
            }),
            (few(), few()).prop_map(move |(u, v)| {
                let scaled = |c: [f64; 4]| c.map(|part| part * length);
                let [u, v] = [[0.0, 1.0, u[2], u[3]], [0.0, 0.0, v[2], v[3]]].map(scaled);
                Shape::Polynomials(Polynomials::new(u, v, [1.0, length]))
            }),
        ]
    }

    fn geometry(shape: Shape, length: f64) -> Geometry {
        Geometry { s: 0.0, length, start: Pose { position: Vector2::new(3.0, -4.0), heading: 2.5 }, shape }
    }

    const LENGTH: f64 = 40.0;

    proptest! {
        #[test]
        fn the_heading_is_the_direction_of_the_points(shape in shapes(LENGTH), s in 0.1..39.9) {
            let piece = geometry(shape, LENGTH);
            let [before, here, after] = [s - 1e-4, s, s + 1e-4].map(|s| piece.at(s));
            let chord = after.position - before.position;
            prop_assert!(here.forward().perp(&chord).abs() < 1e-6 * chord.norm(), "{here:?}");
            prop_assert!(here.forward().dot(&chord) > 0.0);
        }

        #[test]
        fn the_curvature_is_the_change_of_the_heading(shape in shapes(LENGTH), s in 0.1..39.9) {
            let piece = geometry(shape, LENGTH);
            let [before, after] = [s - 1e-4, s + 1e-4].map(|s| piece.at(s));
            let way = (after.position - before.position).norm();
            let turn = wrapped(after.heading - before.heading);
            prop_assert!((turn / way - piece.curvature(s)).abs() < 1e-4, "{} {}", turn / way, piece.curvature(s));
        }

        #[test]
        fn a_metre_of_the_road_is_a_metre_of_the_plane(shape in shapes(LENGTH), s in 0.1..39.9) {
            let piece = geometry(shape, LENGTH);
            let way = (piece.at(s + 1e-4).position - piece.at(s - 1e-4).position).norm() / 2e-4;
            let scale = if let Shape::Polynomials(pair) = &piece.shape { pair.scale } else { 1.0 };
            prop_assert!((way - scale).abs() < 1e-6, "{way}");
        }
    }

    #[test]
    fn a_spiral_ends_where_a_fine_sum_of_short_lines_ends() {
        let spiral = Spiral::new(0.2, -0.15, 200.0);
        let steps = 2_000_000;
        let h = 200.0 / f64::from(steps);
        let sum = (0..steps).map(|i| libm::sincos(spiral.turn((f64::from(i) + 0.5) * h)));
        let sum = sum.fold(Vector2::zeros(), |sum, (sin, cos)| sum + Vector2::new(cos, sin) * h);
        assert!((spiral.point(200.0) - sum).norm() < 1e-8, "{} {sum}", spiral.point(200.0));
    }

    #[test]
    fn a_spiral_of_one_curvature_is_an_arc() {
        let spiral = Spiral::new(0.05, 0.05, 90.0);
        assert!((spiral.point(90.0) - arc(0.05, 90.0)).norm() < 1e-12);
    }
}
