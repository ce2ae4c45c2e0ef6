//! How far from all points a place in a box can be, at most.
//!
//! For weights of some points that sum to 1, no place is further from its nearest point than the root of the weighted
//! mean of its squared distances. That mean is a sum over the axes of convex functions of one coordinate, so that its
//! largest value in a box is the sum of the larger of the two values at the ends, axis by axis. Everything in it is a
//! sum of squares: rounding costs a relative few ulps, and the bound is certain whatever the weights.
//!
//! The best weights are the solution of a linear program. Between the ends of the box each squared distance is replaced
//! by its linear interpolation, `h_i(z)` with `z` in `[0,1]^d`; all of them lie above the squared distances by the
//! same `sum (width_k)^2 z_k (1 - z_k)`. The best bound is the maximum of `min h_i`, and its multipliers are the weights.
//! The dual simplex method finds it: whichever point is nearest to the place at hand has the most violated row, so that
//! rows come from the tree and are never listed. Because the interpolations are off by the same, a solution that no end
//! of the box holds is a vertex of the Voronoi diagram, and so is one that is held by faces of the cube alone, on the face.

use super::tree::{Nearest, Tree};
use crate::bracket::Watch;

/// An interval along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Side {
    pub lower: f64,
    pub upper: f64,
}

impl Side {
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

/// A row of the linear program that holds with equality.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Row {
    /// A point.
    Point(u32),
    /// An end of the box.
    End { axis: usize, upper: bool },
}

/// The relaxation of one box after the other, with room for it.
#[derive(Debug)]
pub(super) struct Relaxation<'a> {
    tree: &'a Tree,
    /// The rows that hold with equality, one per axis and one more.
    rows: Vec<Row>,
    /// The inverse of their matrix, column by column. The last variable is the height, the others are `z`.
    inverse: Vec<f64>,
    /// The place where they meet.
    solution: Vec<f64>,
    /// The row that enters, and its products with the columns.
    entering: Vec<f64>,
    products: Vec<f64>,
    /// Heights are relative to this and in units of `unit`.
    zero: f64,
    unit: f64,
    /// The points with a weight.
    weights: Vec<(u32, f64)>,
    /// Per axis, the larger of the two ends' weighted means.
    tops: Vec<f64>,
    /// The place of the solution, in the box.
    pub place: Vec<f64>,
    beyond: Vec<f64>,
}

impl<'a> Relaxation<'a> {
    pub fn new(tree: &'a Tree) -> Self {
        let size = tree.dims() + 1;
        Self {
            tree,
            rows: Vec::with_capacity(size),
            inverse: vec![0.0; size * size],
            solution: vec![0.0; size],
            entering: vec![0.0; size],
            products: vec![0.0; size],
            zero: 0.0,
            unit: 1.0,
            weights: Vec::with_capacity(size),
            tops: vec![0.0; size - 1],
            place: vec![0.0; size - 1],
            beyond: vec![0.0; size - 1],
        }
    }

    /// What the squared distance of places in the box from their nearest points does not exceed. Ends as soon as that is
    /// no more than `bar`, or when the time is over.
    pub fn solve(&mut self, sides: &[Side], bar: f64, watch: &mut Watch) -> f64 {
        self.start(sides);
        for _ in 0..20 + 10 * sides.len() {
            if self.height() <= bar {
                let bound = self.bound(sides);
                if bound <= bar {
                    return bound;
                }
            }
            let entering = match self.violated_end() {
                Some(end) => end,
                None => {
                    self.go_to_solution(sides);
                    let Nearest { point, looked_at, .. } = self.tree.nearest(&self.place, &mut self.beyond);
                    if watch.passed_after(looked_at) || self.rows.contains(&Row::Point(point)) {
                        break;
                    }
                    Row::Point(point)
                }
            };
            if !self.enter(entering, sides) {
                break;
            }
        }
        self.go_to_solution(sides);
        self.bound(sides)
    }

    /// The squared distance of the solution's place, once in the box, from the point nearest to it.
    pub fn squared_distance(&mut self) -> f64 {
        self.tree.nearest(&self.place, &mut self.beyond).squared
    }

    /// The squared distance of any place from the point nearest to it.
    pub fn squared_distance_of(&mut self, place: &[f64]) -> f64 {
        self.tree.nearest(place, &mut self.beyond).squared
    }

    /// The part of an axis where nothing of the box is further than the root of `bar`, as the weights have it.
    pub fn hole(&self, axis: usize, side: Side, bar: f64) -> Option<Side> {
        let others: f64 = (0..self.tops.len()).filter(|other| *other != axis).map(|other| self.tops[other]).sum();
        let at = |x: f64| self.mean_square(axis, x);
        let centre: f64 = self.weights.iter().map(|&(point, weight)| weight * self.tree.point(point)[axis]).sum();
        let room = bar * (1.0 - 2.0 * self.margin()) - others - at(centre);
        if room <= 0.0 {
            return None;
        }
        let reach = room.sqrt();
        let hole = Side { lower: (centre - reach).max(side.lower), upper: (centre + reach).min(side.upper) };
        // The mean is convex: what holds at both ends holds between them.
        let is_below = |x: f64| (others + at(x)) * (1.0 + self.margin()) <= bar;
        (hole.lower < hole.upper && is_below(hole.lower) && is_below(hole.upper)).then_some(hole)
    }

    /// Starts with the point nearest to the middle, and the ends of the box that are furthest from it.
    fn start(&mut self, sides: &[Side]) {
        let dims = sides.len();
        for (x, side) in self.place.iter_mut().zip(sides) {
            *x = 0.5 * (side.lower + side.upper);
        }
        let first = self.tree.nearest(&self.place, &mut self.beyond);
        let widest = sides.iter().map(Side::width).fold(0.0, f64::max);
        // A box may be a single place.
        self.unit = (widest * (first.squared.sqrt() + widest)).max(f64::MIN_POSITIVE);
        self.zero = first.squared;
        self.rows.clear();
        self.inverse.fill(0.0);
        let size = dims + 1;
        let above = self.row_of_point(first.point, sides);
        self.solution[dims] = above;
        for axis in 0..dims {
            let slope = -self.entering[axis];
            let upper = slope > 0.0;
            self.rows.push(Row::End { axis, upper });
            let sign = if upper { 1.0 } else { -1.0 };
            let column = &mut self.inverse[axis * size..][..size];
            (column[axis], column[dims]) = (sign, sign * slope);
            self.solution[axis] = if upper { 1.0 } else { 0.0 };
            self.solution[dims] += if upper { slope } else { 0.0 };
        }
        self.rows.push(Row::Point(first.point));
        self.inverse[dims * size + dims] = 1.0;
    }

    /// Puts the row of a point in `entering`; its right side.
    fn row_of_point(&mut self, point: u32, sides: &[Side]) -> f64 {
        let point = self.tree.point(point);
        let mut at_lower = 0.0;
        for ((entry, side), x) in self.entering.iter_mut().zip(sides).zip(point) {
            let (to_lower, to_upper) = (side.lower - x, side.upper - x);
            at_lower += to_lower * to_lower;
            *entry = -side.width() * (to_lower + to_upper) / self.unit;
        }
        self.entering[sides.len()] = 1.0;
        (at_lower - self.zero) / self.unit
    }

    /// The height of the solution, as a squared distance.
    fn height(&self) -> f64 {
        self.zero + self.unit * self.solution[self.solution.len() - 1]
    }

    /// The end of the box that the solution is furthest beyond.
    fn violated_end(&self) -> Option<Row> {
        let (mut most, mut violated) = (1e-12, None);
        for (axis, &z) in self.solution[..self.tops.len()].iter().enumerate() {
            let by = f64::max(-z, z - 1.0);
            if by > most {
                (most, violated) = (by, Some(Row::End { axis, upper: z > 1.0 }));
            }
        }
        violated
    }

    fn go_to_solution(&mut self, sides: &[Side]) {
        for ((x, side), &z) in self.place.iter_mut().zip(sides).zip(&self.solution) {
            *x = if z >= 1.0 { side.upper } else { (side.lower + z.max(0.0) * side.width()).min(side.upper) };
        }
    }

    /// Makes a row hold with equality in place of the one that keeps the multipliers from being negative; whether the
    /// row was violated.
    fn enter(&mut self, row: Row, sides: &[Side]) -> bool {
        let size = self.solution.len();
        let right = match row {
            Row::Point(point) => self.row_of_point(point, sides),
            Row::End { axis, upper } => {
                self.entering.fill(0.0);
                self.entering[axis] = if upper { 1.0 } else { -1.0 };
                if upper { 1.0 } else { 0.0 }
            }
        };
        let violation = dot(&self.entering, &self.solution) - right;
        if violation <= 1e-15 {
            return false;
        }
        let (mut least, mut leaving) = (f64::INFINITY, None);
        for (j, column) in self.inverse.chunks_exact(size).enumerate() {
            let product = dot(&self.entering, column);
            self.products[j] = product;
            if product > 1e-11 {
                let ratio = column[size - 1].max(0.0) / product;
                let is_larger = |other: usize| product > self.products[other];
                if ratio < least || (ratio == least && leaving.is_some_and(is_larger)) {
                    (least, leaving) = (ratio, Some(j));
                }
            }
        }
        let Some(leaving) = leaving else { return false };
        let by = 1.0 / self.products[leaving];
        for i in 0..size {
            let pivot = self.inverse[leaving * size + i] * by;
            self.solution[i] -= pivot * violation;
            for (j, product) in self.products.iter().enumerate() {
                self.inverse[j * size + i] -= product * pivot;
            }
            self.inverse[leaving * size + i] = pivot;
        }
        self.rows[leaving] = row;
        true
    }

    /// The bound that follows from the multipliers.
    fn bound(&mut self, sides: &[Side]) -> f64 {
        let size = self.solution.len();
        self.weights.clear();
        for (row, column) in self.rows.iter().zip(self.inverse.chunks_exact(size)) {
            if let Row::Point(point) = *row
                && column[size - 1] > 0.0
            {
                self.weights.push((point, column[size - 1]));
            }
        }
        let sum: f64 = self.weights.iter().map(|(_, weight)| weight).sum();
        self.weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
        for (axis, side) in sides.iter().enumerate() {
            self.tops[axis] = self.mean_square(axis, side.lower).max(self.mean_square(axis, side.upper));
        }
        self.tops.iter().sum::<f64>() * (1.0 + self.margin())
    }

    /// The weighted mean of the squared distances along an axis.
    fn mean_square(&self, axis: usize, x: f64) -> f64 {
        let square = |&(point, weight): &(u32, f64)| {
            let distance = x - self.tree.point(point)[axis];
            weight * (distance * distance)
        };
        self.weights.iter().map(square).sum()
    }

    /// More than rounding takes away from a bound, relatively: a few ulps for each square, and one for each term of the
    /// two sums and of that of the weights.
    fn margin(&self) -> f64 {
        (3 * self.solution.len() + 16) as f64 * f64::EPSILON
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
