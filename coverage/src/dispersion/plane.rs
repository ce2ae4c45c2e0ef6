//! Finds the largest empty rectangle in the plane, with bounded time and memory for every set of points.
//!
//! The search for many dimensions is quick if points are spread out. But on a circle or a hyperbola nearly every pair
//! of points spans a rectangle as large as any other. This module divides and conquers the square (Chazelle,
//! Drysdale, Lee, Computing the largest empty rectangle, SIAM J. Comput. 15, 1986). A rectangle lies to the left of a
//! vertical line, to the right of it, or across it. A rectangle across it is above a horizontal line, below it, or
//! across, and then holds the point where both lines meet. Around that point the points form one staircase upward and
//! one downward, and a rectangle joins a step of each:
//!
//! * If both sides of the rectangle come from one staircase, the best step of the other staircase is the farthest
//!   step that does not make the rectangle narrower.
//! * If each staircase gives one side, the areas form an inverse Monge matrix, in which the best column moves one way
//!   from row to row (Aggarwal, Suri, Fast algorithms for computing the largest empty rectangle, SoCG 1987). The
//!   pairs of steps for which this holds are a band, which is cut into whole matrices as in a segment tree.
//!
//! Parts no larger than the best rectangle so far are passed over. Areas are products of differences, which rounding
//! keeps monotone, so that this is exact. The matrices are not inverse Monge to the last bit: columns that rounding
//! may have misplaced are kept.
//!
//! `n` points take at most `O(n log n)` memory and `O(n log^4 n)` time. Two of these logarithms occur only for points
//! that are arranged to cause them.

use super::search::Bar;
use super::{Dispersion, LargestEmptyBox};
use crate::deadline::Watch;
use crate::{Bracket, Deadline, PointSet};
use std::ops::Range;

/// The number of points from which on a part of the work is shared with other cores.
const SHARED: usize = 2_000;

/// A search for the largest empty rectangle among points of the unit square, on all cores.
pub(super) struct Plane {
    /// The points in the order of their second coordinate.
    points: Vec<[f64; 2]>,
    /// The first coordinates of the points, in ascending order.
    columns: Vec<f64>,
    /// The area of the largest rectangle, for all threads to see.
    bar: Bar,
    witness: LargestEmptyBox,
}

impl Plane {
    /// Makes a search for empty rectangles that are larger than the rectangle `witness` and larger than the area
    /// `above`.
    ///
    /// # Panics
    /// The points do not have two coordinates.
    pub fn new(points: &PointSet, witness: LargestEmptyBox, above: f64) -> Self {
        let inside = |x: f64| 0.0 < x && x < 1.0;
        let points = points.iter().map(|point| [point[0], point[1]]);
        let mut points: Vec<[f64; 2]> = points.filter(|[x, y]| inside(*x) && inside(*y)).collect();
        points.sort_unstable_by(|a, b| a[1].total_cmp(&b[1]));
        let mut columns: Vec<f64> = points.iter().map(|point| point[0]).collect();
        columns.sort_unstable_by(f64::total_cmp);
        let bar = Bar::new(witness.volume().max(above));
        Self { points, columns, bar, witness }
    }

    /// Searches for the largest empty rectangle, until the result is exact or the deadline passes.
    pub fn run(self, deadline: Deadline) -> Dispersion {
        let (found, left) = self.search(deadline, f64::INFINITY);
        let witness = found.map_or(self.witness, Rectangle::into_box);
        let lower = witness.volume();
        // Each factor and each product may have lost half an ulp.
        let left = left.map(|left| (left * (1.0 + 4.0 * f64::EPSILON)).min(1.0));
        Dispersion { volume: Bracket { lower, upper: left.map_or(lower, |left| left.max(lower)) }, witness }
    }

    /// Returns `true` if no empty rectangle is larger than `above`; `None` if the answer is not known at the deadline.
    /// The search must have been made for the same `above`.
    pub fn finds_none(self, above: f64, deadline: Deadline) -> Option<bool> {
        if self.witness.volume() > above {
            return Some(false);
        }
        let (found, left) = self.search(deadline, above);
        if found.is_some() {
            return Some(false);
        }
        left.is_none().then_some(true)
    }

    /// Returns the largest rectangle, if it is larger than the witness, and the area of the largest part that was left.
    /// The search may end as soon as it finds a rectangle larger than `enough`.
    fn search(&self, deadline: Deadline, enough: f64) -> (Option<Rectangle>, Option<f64>) {
        let mut search = PlaneSearch::new(&self.bar, self.bar.get(), enough, deadline);
        search.strip(Rectangle { left: 0.0, right: 1.0, bottom: 0.0, top: 1.0 }, &self.columns, &self.points);
        (search.witness, search.left)
    }
}

/// An open rectangle.
#[derive(Debug, Clone, Copy)]
struct Rectangle {
    left: f64,
    right: f64,
    bottom: f64,
    top: f64,
}

impl Rectangle {
    fn area(&self) -> f64 {
        (self.right - self.left) * (self.top - self.bottom)
    }

    fn into_box(self) -> LargestEmptyBox {
        LargestEmptyBox { lower: vec![self.left, self.bottom], upper: vec![self.right, self.top] }
    }
}

/// One end of rectangles that hold a point: the coordinate of the end, and the limits of these rectangles to the left
/// and to the right, past the points on the way to this end. From step to step a staircase gets higher and no wider.
#[derive(Debug, Clone, Copy)]
struct Step {
    y: f64,
    left: f64,
    right: f64,
}

impl Step {
    /// Returns the rectangle from this end to another end on the other side of the point.
    fn to(&self, other: &Self) -> Rectangle {
        Rectangle {
            left: self.left.max(other.left),
            right: self.right.min(other.right),
            bottom: self.y.min(other.y),
            top: self.y.max(other.y),
        }
    }

    /// Returns the rectangle from the left side of this step to the right side of another step.
    fn across(&self, other: &Self) -> Rectangle {
        Rectangle { left: self.left, right: other.right, ..self.to(other) }
    }
}

/// The search of a part, on one thread until it is large enough to be shared.
struct PlaneSearch<'a> {
    /// The shared bar: parts with a smaller area do not matter any more.
    bar: &'a Bar,
    /// The area of the witness, or the area that it must exceed: parts with no larger area do not matter.
    best: f64,
    /// The area beyond which a rectangle ends the search.
    enough: f64,
    /// The first of the largest rectangles, in an order that does not depend on threads.
    witness: Option<Rectangle>,
    /// The area of the largest part that was left for lack of time.
    left: Option<f64>,
    deadline: Deadline,
    watch: Watch,
    late: bool,
}

impl<'a> PlaneSearch<'a> {
    fn new(bar: &'a Bar, best: f64, enough: f64, deadline: Deadline) -> Self {
        let watch = Watch::new(deadline);
        Self { bar, best, enough, witness: None, left: None, deadline, watch, late: deadline.passed() }
    }

    /// Returns `true` if a part no larger than `bound` must be searched. The search looks at `work` points.
    fn enters(&mut self, bound: f64, work: usize) -> bool {
        let bar = self.bar.get();
        if bound <= self.best || bound < bar {
            return false;
        }
        self.late |= self.watch.passed_after(work) || bar > self.enough;
        if self.late {
            self.left = Some(self.left.map_or(bound, |left| left.max(bound)));
        }
        !self.late
    }

    fn offer(&mut self, rectangle: Rectangle) {
        let area = rectangle.area();
        if area > self.best {
            self.best = area;
            self.witness = Some(rectangle);
            self.bar.raise(area);
        }
    }

    /// Does two things, one after the other or at the same time, with the same result.
    fn both(&mut self, size: usize, one: impl FnOnce(&mut Self) + Send, other: impl FnOnce(&mut Self) + Send) {
        if size < SHARED {
            one(self);
            other(self);
            return;
        }
        let part = || Self::new(self.bar, self.best, self.enough, self.deadline);
        let (mut first, mut second) = (part(), part());
        rayon::join(|| one(&mut first), || other(&mut second));
        for part in [first, second] {
            if let Some(witness) = part.witness {
                self.offer(witness);
            }
            self.left = self.left.into_iter().chain(part.left).reduce(f64::max);
            self.late |= part.late;
        }
    }

    /// Searches a part of full height. `points` are the points inside in the order of their second coordinates, and
    /// `columns` are their first coordinates in ascending order.
    fn strip(&mut self, whole: Rectangle, columns: &[f64], points: &[[f64; 2]]) {
        if !self.enters(whole.area(), points.len()) {
            return;
        }
        let Some(&middle) = columns.get(columns.len() / 2) else { return self.offer(whole) };
        let before = &columns[..columns.partition_point(|x| *x < middle)];
        let after = &columns[columns.partition_point(|x| *x <= middle)..];
        let of = |side: &dyn Fn(f64) -> bool| points.iter().filter(|[x, _]| side(*x)).copied().collect::<Vec<_>>();
        self.both(
            points.len(),
            |search| search.across(whole, middle, points),
            |search| {
                let left = |search: &mut Self| {
                    search.strip(Rectangle { right: middle, ..whole }, before, &of(&|x| x < middle));
                };
                let right = |search: &mut Self| {
                    search.strip(Rectangle { left: middle, ..whole }, after, &of(&|x| x > middle));
                };
                search.both(points.len(), left, right);
            },
        );
    }

    /// Searches the rectangles across a vertical line. `points` are the points inside `whole` in the order of their
    /// second coordinates.
    fn across(&mut self, whole: Rectangle, x: f64, points: &[[f64; 2]]) {
        if !self.enters(whole.area(), 1) {
            return;
        }
        let Some(&[_, y]) = points.get(points.len() / 2) else { return self.offer(whole) };
        let below = points.partition_point(|point| point[1] < y);
        let above = points.partition_point(|point| point[1] <= y);
        self.both(
            points.len(),
            |search| {
                let up = search.staircase(whole, [x, y], whole.top, points[below..].iter());
                let down = search.staircase(whole, [x, y], whole.bottom, points[..below].iter().rev());
                search.around(&up, &down);
            },
            |search| {
                let upper = |search: &mut Self| search.across(Rectangle { bottom: y, ..whole }, x, &points[above..]);
                let lower = |search: &mut Self| search.across(Rectangle { top: y, ..whole }, x, &points[..below]);
                search.both(points.len(), upper, lower);
            },
        );
    }

    /// Returns the steps from a point to an end of `whole`, past points in their order. Steps that are too narrow to
    /// matter are left out.
    fn staircase<'p>(
        &mut self,
        whole: Rectangle,
        from: [f64; 2],
        end: f64,
        points: impl Iterator<Item = &'p [f64; 2]>,
    ) -> Vec<Step> {
        let mut steps: Vec<Step> = Vec::new();
        let Rectangle { mut left, mut right, bottom, top } = whole;
        for &[x, y] in points {
            if x <= left || right <= x {
                continue;
            }
            if y != from[1] && steps.last().is_none_or(|last| last.y != y) {
                steps.push(Step { y, left, right });
            }
            if x <= from[0] {
                left = x;
            }
            if x >= from[0] {
                right = x;
            }
            let widest = Rectangle { left, right, bottom, top };
            if !self.enters(widest.area(), 1) {
                return steps;
            }
        }
        steps.push(Step { y: end, left, right });
        steps
    }

    /// Searches the rectangles from one staircase to the other.
    fn around(&mut self, up: &[Step], down: &[Step]) {
        self.within(up, down);
        self.within(down, up);
        self.band(down, up, 0..0);
        self.band(up, down, 0..0);
    }

    /// Searches the rectangles with both sides from the staircase `inner`.
    fn within(&mut self, inner: &[Step], outer: &[Step]) {
        let mut reach = 0;
        for step in inner {
            while outer.get(reach).is_some_and(|other| other.left <= step.left && step.right <= other.right) {
                reach += 1;
            }
            if reach > 0 {
                self.offer(step.to(&outer[reach - 1]));
            }
        }
    }

    /// Searches the rectangles with the left side from a row and the right side from a column. The columns in `done`,
    /// which belong to all rows, have already been searched.
    fn band(&mut self, rows: &[Step], columns: &[Step], done: Range<usize>) {
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return };
        let begin = |row: &Step| columns.partition_point(|column| column.right > row.right);
        let end = |row: &Step| columns.partition_point(|column| column.left <= row.left);
        // Both ends only grow from row to row.
        let some = begin(first)..end(last);
        if some.is_empty() || !self.enters(largest(rows, &columns[some]), 1) {
            return;
        }
        let all = begin(last)..end(first);
        if done.is_empty() {
            self.matrix(rows, columns.get(all.clone()).unwrap_or_default());
        } else {
            self.matrix(rows, &columns[all.start..done.start]);
            self.matrix(rows, &columns[done.end..all.end]);
        }
        if rows.len() > 1 {
            let (upper, lower) = rows.split_at(rows.len() / 2);
            self.band(upper, columns, all.clone());
            self.band(lower, columns, all);
        }
    }

    /// Searches the rectangles of a band in which every row has every column, so that from row to row the best column
    /// only moves back.
    fn matrix(&mut self, rows: &[Step], columns: &[Step]) {
        if rows.is_empty() || columns.is_empty() {
            return;
        }
        let bound = largest(rows, columns);
        if !self.enters(bound, columns.len()) {
            return;
        }
        let middle = rows.len() / 2;
        let area = |column: &Step| rows[middle].across(column).area();
        let most = columns.iter().map(area).fold(0.0, f64::max);
        // Four areas of three roundings each can have lost one and a half epsilons, as shares of at most the bound.
        let least = most - 8.0 * f64::EPSILON * bound;
        let first = columns.iter().position(|column| area(column) >= least).unwrap_or(0);
        let last = columns.iter().rposition(|column| area(column) >= least).unwrap_or(columns.len() - 1);
        if let Some(column) = columns[first..=last].iter().find(|column| area(column) == most) {
            self.offer(rows[middle].to(column));
        }
        self.matrix(&rows[..middle], &columns[first..]);
        self.matrix(&rows[middle + 1..], &columns[..=last]);
    }
}

/// Returns an upper bound on the area of a rectangle with its left side from a row and its right side from a column.
fn largest(rows: &[Step], columns: &[Step]) -> f64 {
    let widest = rows[0].across(&columns[0]);
    let highest = rows[rows.len() - 1].to(&columns[columns.len() - 1]);
    Rectangle { bottom: highest.bottom, top: highest.top, ..widest }.area()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dispersion::hunt::Hunt;
    use crate::dispersion::widest_slab;
    use proptest::prelude::*;

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![0.0..=1.0f64, (0..=16u8).prop_map(|i| f64::from(i) / 16.0)]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn the_search_of_many_dimensions_finds_the_same_area(
            points in prop::collection::vec([coordinate(), coordinate()], 0..600),
        ) {
            let points = PointSet::new(2, &points).unwrap();
            let slab = || widest_slab(&points);
            let plane = Plane::new(&points, slab(), 0.0).run(Deadline::never());
            let hunt = Hunt::new(&points, crate::dispersion::side::Volume, slab(), 0.0).run(Deadline::never(), &mut |_| ());
            prop_assert_eq!(plane.volume, hunt.volume);
        }
    }
}
