//! The star discrepancy: how far the share of points in a box anchored at 0 is from the box's volume, at worst.
//!
//! Boxes `[0, y)` are searched by branch and bound on their free corner `y`. A cell `lower, upper` of corners
//! knows three kinds of points: those that are in every box of the cell, those that are in none, and the
//! undecided rest, on which the two bounds differ:
//!
//! ```text
//! volume - share of open boxes    <=  vol(upper) - inside / n
//! share of closed boxes - volume  <=  (inside + undecided) / n - vol(lower)
//! ```
//!
//! Boxes change what they hold only at coordinates of points, so cells are cut at the coordinates of their
//! undecided points, and a cell without such points is solved: no grid is needed. The trick that lets one
//! cell serve both lines is to read it as `lower < y <= upper` for open boxes and as `lower <= y < upper` for
//! closed ones: in both, a point is inside along an axis where `x <= lower`, outside where `x >= upper`.
//! A cut at the median halves the points that are undecided along its axis: recursion is no deeper than
//! `d (1 + log2 n)`.

use crate::bracket::Watch;
use crate::{Bracket, Deadline, PointSet};
use std::ops::Range;

/// The star discrepancy: the largest of `vol [0,y) - #{x < y} / n` and `#{x <= y} / n - vol [0,y)` over all `y`
/// in the unit cube (Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, 1992, section 2.1).
///
/// Exact, in any dimension, unless `deadline` cuts the search short. A set without points leaves the whole
/// cube uncovered: 1.
pub fn star_discrepancy(points: &PointSet, deadline: Deadline) -> Bracket {
    if points.is_empty() {
        return Bracket::exact(1.0);
    }
    let mut search = Search {
        points,
        watch: Watch::new(deadline),
        lower: vec![0.0; points.dims()],
        upper: vec![f64::INFINITY; points.dims()],
        lists: Vec::new(),
        coordinates: Vec::new(),
        best: 0.0,
        left: 0.0,
    };
    search.lists = (0..points.len() as u32).filter(|&point| !search.is_inside(point as usize)).collect();
    let undecided = search.lists.len();
    search.explore(points.len() - undecided, 0..undecided);
    if search.left <= search.best {
        return Bracket::exact(search.best);
    }
    Bracket { lower: search.best, upper: search.left }
}

struct Search<'a> {
    points: &'a PointSet,
    watch: Watch,
    /// The cell that is being explored.
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// The undecided points of the cell and of those around it, as a stack.
    lists: Vec<u32>,
    /// Room for the coordinates among which a cut is chosen.
    coordinates: Vec<f64>,
    /// The largest value that some box has.
    best: f64,
    /// The largest bound of a cell that was left unexplored.
    left: f64,
}

impl Search<'_> {
    /// Explores the cell that `lower` and `upper` span, with `inside` points in all of its boxes and the
    /// undecided ones listed.
    fn explore(&mut self, inside: usize, undecided: Range<usize>) {
        self.evaluate(inside, undecided.len());
        let bound = self.bound(inside, undecided.len());
        if undecided.is_empty() || bound <= self.best {
            return;
        }
        if self.watch.passed_after(undecided.len()) {
            // Rounding of the volume and of the difference may have lost half an ulp each time.
            self.left = self.left.max((bound + (1 + self.points.dims()) as f64 * f64::EPSILON).min(1.0));
            return;
        }
        let (axis, at) = self.cut(undecided.clone());
        let (lower, upper) = (self.lower[axis], self.upper[axis]);
        let end = self.lists.len();

        // Below the cut, points at it and beyond are outside; the others stay as undecided as they were.
        self.upper[axis] = at;
        self.sift(undecided.clone(), |search, point| search.points.point(point)[axis] < at);
        let below = end..self.lists.len();
        let bound_below = self.bound(inside, below.len());
        self.upper[axis] = upper;

        // Above it, points up to it are inside along this axis, and then perhaps along all.
        self.lower[axis] = at;
        self.sift(undecided.clone(), |search, point| !search.is_inside(point));
        let above = below.end..self.lists.len();
        let inside_above = inside + undecided.len() - above.len();
        let bound_above = self.bound(inside_above, above.len());
        self.lower[axis] = lower;

        let above_first = bound_above > bound_below;
        for above_now in [above_first, !above_first] {
            if above_now {
                self.lower[axis] = at;
                self.explore(inside_above, above.clone());
                self.lower[axis] = lower;
            } else {
                self.upper[axis] = at;
                self.explore(inside, below.clone());
                self.upper[axis] = upper;
            }
        }
        self.lists.truncate(end);
    }

    /// Appends the listed points that `keep` keeps.
    fn sift(&mut self, list: Range<usize>, keep: impl Fn(&Self, usize) -> bool) {
        for i in list {
            let point = self.lists[i];
            if keep(self, point as usize) {
                self.lists.push(point);
            }
        }
    }

    fn is_inside(&self, point: usize) -> bool {
        self.points.point(point).iter().zip(&self.lower).all(|(x, lower)| x <= lower)
    }

    /// Takes note of the cell's largest open and smallest closed box.
    fn evaluate(&mut self, inside: usize, undecided: usize) {
        let open = volume(&self.upper) - self.share(inside + undecided);
        let closed = self.share(inside) - volume(&self.lower);
        self.best = self.best.max(open).max(closed);
    }

    /// What no box of the cell exceeds.
    fn bound(&self, inside: usize, undecided: usize) -> f64 {
        let open = volume(&self.upper) - self.share(inside);
        let closed = self.share(inside + undecided) - volume(&self.lower);
        open.max(closed)
    }

    fn share(&self, count: usize) -> f64 {
        count as f64 / self.points.len() as f64
    }

    /// Where to cut the cell: the axis along which most points are undecided, at their median.
    fn cut(&mut self, undecided: Range<usize>) -> (usize, f64) {
        let count = |&axis: &usize| self.between(undecided.clone(), axis).count();
        let axis = (0..self.points.dims()).max_by_key(count).expect("a dimension");
        let mut coordinates = std::mem::take(&mut self.coordinates);
        coordinates.clear();
        coordinates.extend(self.between(undecided, axis));
        let middle = coordinates.len() / 2;
        let (_, &mut at, _) = coordinates.select_nth_unstable_by(middle, f64::total_cmp);
        self.coordinates = coordinates;
        (axis, at)
    }

    /// The coordinates of the listed points between the cell's ends along an axis.
    fn between(&self, list: Range<usize>, axis: usize) -> impl Iterator<Item = f64> {
        let (lower, upper) = (self.lower[axis], self.upper[axis]);
        let coordinates = self.lists[list].iter().map(move |&point| self.points.point(point as usize)[axis]);
        coordinates.filter(move |x| lower < *x && *x < upper)
    }
}

/// The volume of `[0, corner)`, or of what of it lies in the unit cube.
fn volume(corner: &[f64]) -> f64 {
    corner.iter().map(|x| x.min(1.0)).product()
}
