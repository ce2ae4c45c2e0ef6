//! Bounds the distance between a place in a box and its nearest point.
//!
//! For weights of some points that sum to 1, the squared distance of a place from its nearest point is at most the
//! weighted mean of its squared distances from all these points. That mean is a sum over the axes of convex functions
//! of one coordinate. Its largest value in a box is therefore the sum, axis by axis, of the larger of its two values
//! at the ends. All terms are squares: rounding takes away a few ulps relatively, and the bound is certain for any
//! weights.
//!
//! The best weights are the solution of a linear program. Between the ends of the box the squares are replaced by
//! their secants (Falk, Soland, An algorithm for separable nonconvex programming problems, Management Science 15,
//! 1969). In coordinates `z` of `[0,1]^d` relative to the box, the squared distance from point i is then a linear
//! function `h_i(z)`. The largest `min h_i(z)` over the box is the best bound, and the multipliers of the `h_i` are
//! the weights. The secants of all points lie above the squares by the same `sum (width_k)^2 z_k (1 - z_k)`. Two
//! things follow:
//!
//! * The dual simplex method (Lemke, The dual method of solving the linear programming problem, Naval Research
//!   Logistics Quarterly 1, 1954) needs the most violated row. It is the row of the point nearest to the current
//!   place. The tree finds it, so that the rows need not be listed.
//! * A solution that is held only by points and faces of the cube is a vertex of the Voronoi diagram in the cube, to
//!   the last digits.

use super::tree::{Nearest, Tree};
use crate::deadline::Watch;

/// The numbers of a matrix or of points that are looked at in the time of one other number: they lie side by side.
const QUICK: usize = 4;
/// The method ends after this number of pivots per row. It ends on its own earlier, unless rounding makes it go in
/// circles.
const MOST_PIVOTS_PER_ROW: usize = 16;
/// The distance that the solution may be beyond an end of the box, as a share of the box's width.
const BEYOND_END: f64 = 1e-12;
/// The least violation of a row that counts, and the least pivot. The entries of a row are about 1.
const VIOLATION: f64 = 1e-15;
const PIVOT: f64 = 1e-11;

/// The interval of a box along one axis.
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

/// The working memory for the relaxations of boxes, with the last solved relaxation.
#[derive(Debug)]
pub(super) struct Relaxation<'a> {
    tree: &'a Tree,
    /// The rows that hold with equality: one per axis, and one more.
    rows: Vec<Row>,
    /// The inverse of the matrix of `rows`, column by column. The last variable is the height, the others are `z`.
    inverse: Vec<f64>,
    /// The place where the rows meet.
    solution: Vec<f64>,
    /// The row that enters, and its products with the columns.
    entering: Vec<f64>,
    products: Vec<f64>,
    /// Heights are relative to `zero` and in units of `unit`.
    zero: f64,
    unit: f64,
    /// The points with a positive weight, and their weights.
    weights: Vec<(u32, f64)>,
    /// For each axis, the larger of the weighted means at the two ends.
    tops: Vec<f64>,
    /// The place in the box at which the relaxation has its solution.
    pub place: Vec<f64>,
    /// Working memory for the tree.
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

    /// Computes an upper bound on the squared distance between a place in the box and its nearest point. The method
    /// ends as soon as the bound is at most `bar`, or when the time is over.
    pub fn solve(&mut self, sides: &[Side], bar: f64, watch: &mut Watch) -> f64 {
        self.start(sides);
        watch.passed_after(self.inverse.len() / QUICK);
        let first = self.bound(sides);
        if first <= bar {
            return first;
        }
        for _ in 0..MOST_PIVOTS_PER_ROW * self.rows.len() {
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
                    if self.rows.contains(&Row::Point(point)) {
                        break;
                    }
                    watch.passed_after(looked_at * sides.len() / QUICK);
                    Row::Point(point)
                }
            };
            // A pivot goes through a square matrix.
            if !self.enter(entering, sides) || watch.passed_after(self.inverse.len() / QUICK) {
                break;
            }
        }
        self.go_to_solution(sides);
        // In a tiny box the first bound is certain to be close, whatever rounding does to the others.
        self.bound(sides).min(first)
    }

    /// Returns the squared distance between the solution's place and the point nearest to that place.
    pub fn squared_distance(&mut self) -> f64 {
        self.tree.nearest(&self.place, &mut self.beyond).squared
    }

    /// Returns an interval along an axis in which no place of the last solved box has a squared distance above `bar`,
    /// as the weights prove. `side` is the side of that box, or a part of that side.
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
        // The mean is convex: if a bound holds at both ends, it holds between them.
        let is_below = |x: f64| (others + at(x)) * (1.0 + self.margin()) <= bar;
        (hole.lower < hole.upper && is_below(hole.lower) && is_below(hole.upper)).then_some(hole)
    }

    /// Starts with the point nearest to the middle, and with the ends of the box that are furthest from it.
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

    /// Puts the row of a point in `entering`, and returns its right side.
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

    /// The end of the box that the solution violates most.
    fn violated_end(&self) -> Option<Row> {
        let (mut most, mut violated) = (BEYOND_END, None);
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

    /// Makes a violated row hold with equality, in place of the first row whose multiplier would become negative.
    /// Returns `false` if there was nothing to do.
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
        if violation <= VIOLATION {
            return false;
        }
        let (mut least, mut leaving) = (f64::INFINITY, None);
        for (j, column) in self.inverse.chunks_exact(size).enumerate() {
            let product = dot(&self.entering, column);
            self.products[j] = product;
            if product > PIVOT {
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

    /// A relative margin above the loss of a bound by rounding: a few ulps for each square, one for each term of the
    /// two sums, and one for each term of the sum of the weights.
    fn margin(&self) -> f64 {
        (3 * self.solution.len() + 16) as f64 * f64::EPSILON
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
