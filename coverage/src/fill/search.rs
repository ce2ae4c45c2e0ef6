//! The search of a box, and the climb from a place.

use super::relaxation::{Relaxation, Side};
use super::tree::Tree;
use crate::Deadline;
use crate::deadline::Watch;

/// The share by which a distance may be longer than another one and still counts as no longer.
const SAME: f64 = 1e-12;
/// A box is relaxed again while a relaxation takes away more than this share of it, up to this number of times in
/// all.
const WORTHWHILE: f64 = 0.2;
const MOST_RELAXATIONS: usize = 4;
/// The least share of a side that a cut through the solution leaves to either part.
const LEAST_SHARE: f64 = 0.1;
/// The factor for the step of a climb that got no further, and the share of the distance at which the climb ends.
const SHORTER: f64 = 0.3;
const SHORTEST_STEP: f64 = 0.02;

/// A place in the cube and the square of its distance from the nearest point.
#[derive(Debug, Clone)]
pub(super) struct Centre {
    pub squared: f64,
    pub place: Vec<f64>,
}

impl Centre {
    pub fn at(place: Vec<f64>, tree: &Tree) -> Self {
        let squared = tree.nearest(&place, &mut vec![0.0; place.len()]).squared;
        Self { squared, place }
    }
}

/// A box that waits to be explored, because a place in the box may be further from all points than the best known
/// place.
#[derive(Debug, Clone)]
pub(super) struct Open {
    /// An upper bound on the squared distance between a place of the box and its nearest point.
    pub bound: f64,
    pub sides: Box<[Side]>,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// The result of a search for the place that is furthest from all points.
#[derive(Debug)]
pub(super) struct Outcome {
    /// The place that the search found; `None` if no place is better than the best place known before the search.
    pub found: Option<Centre>,
    /// The boxes that the search has not explored.
    pub open: Vec<Open>,
}

/// Returns the largest squared distance that counts as no larger than `squared`. This distance allows for a small share
/// of the distance, and for the difference between two places that round to neighbouring floating-point numbers along
/// every axis.
pub(super) fn same_as(squared: f64, dims: usize) -> f64 {
    let rounding = 2.0 * f64::EPSILON * (dims as f64).sqrt();
    let distance = squared.sqrt() * (1.0 + SAME) + rounding;
    distance * distance
}

/// A search on one thread for the place that is furthest from all points.
#[derive(Debug)]
pub(super) struct BallSearch<'a> {
    dims: usize,
    /// The relaxation of the box at hand.
    relaxation: Relaxation<'a>,
    /// The relaxation of the box around the place from which a climb goes on.
    climbing: Relaxation<'a>,
    watch: Watch,
    /// The square of the largest distance that is known.
    best: f64,
    found: Option<Centre>,
}

impl<'a> BallSearch<'a> {
    pub fn new(tree: &'a Tree, deadline: Deadline) -> Self {
        let [relaxation, climbing] = [Relaxation::new(tree), Relaxation::new(tree)];
        Self { dims: tree.dims(), relaxation, climbing, watch: Watch::new(deadline), best: 0.0, found: None }
    }

    /// Searches the box `root` for places with a large distance, and explores at most `most` boxes, depth first. The
    /// search leaves out boxes that hold no place above `goal` and `best`, both squared.
    pub fn explore(&mut self, root: Open, best: f64, goal: f64, most: usize) -> Outcome {
        self.best = best;
        let mut open = vec![root];
        for _ in 0..most {
            let Some(cell) = open.pop() else { break };
            if cell.bound > self.bar(goal) {
                self.branch(cell, goal, &mut open);
            }
            if self.watch.passed_after(0) {
                break;
            }
        }
        let bar = self.bar(goal);
        open.retain(|cell| cell.bound > bar);
        Outcome { found: self.found.take(), open }
    }

    /// Returns an upper bound on the squared distance between a place in a box and the point nearest to the place, as
    /// good as the time allows.
    pub fn bound(&mut self, sides: &[Side]) -> f64 {
        self.relaxation.solve(sides, 0.0, &mut self.watch)
    }

    /// Moves from a place to places that are further from all points, and returns the last place. The relaxation of a
    /// box around a place gives the next place.
    pub fn climb(&mut self, mut from: Centre) -> Centre {
        let mut step = from.squared.sqrt();
        while step > SHORTEST_STEP * from.squared.sqrt() && !self.watch.passed_after(0) {
            let around = |&x: &f64| Side { lower: (x - step).max(0.0), upper: (x + step).min(1.0) };
            let sides: Vec<Side> = from.place.iter().map(around).collect();
            self.climbing.solve(&sides, from.squared, &mut self.watch);
            let squared = self.climbing.squared_distance();
            if squared > from.squared {
                from.squared = squared;
                from.place.copy_from_slice(&self.climbing.place);
            } else {
                step *= SHORTER;
            }
        }
        from
    }

    /// Returns the squared distance up to which a box need not be searched.
    fn bar(&self, goal: f64) -> f64 {
        same_as(self.best, self.dims).max(goal)
    }

    /// Bounds a box, and puts the rest of it on the stack in two parts.
    fn branch(&mut self, mut cell: Open, goal: f64, open: &mut Vec<Open>) {
        let mut bar = self.bar(goal);
        for _ in 0..MOST_RELAXATIONS {
            cell.bound = cell.bound.min(self.relaxation.solve(&cell.sides, bar, &mut self.watch));
            if cell.bound <= bar {
                return;
            }
            let squared = self.relaxation.squared_distance();
            if squared > self.best {
                let found = self.climb(Centre { squared, place: self.relaxation.place.clone() });
                self.best = found.squared;
                self.found = Some(found);
                bar = self.bar(goal);
            }
            if !self.shrink(&mut cell, bar) {
                break;
            }
        }
        open.extend(self.cut(cell, bar));
    }

    /// Takes away ends of the box that hold nothing above the bar (range reduction: Ryoo, Sahinidis, A
    /// branch-and-reduce approach to global optimization, J. Global Optimization 8, 1996). Returns `true` if that was
    /// worthwhile.
    fn shrink(&self, cell: &mut Open, bar: f64) -> bool {
        let mut left = 1.0;
        for (axis, side) in cell.sides.iter_mut().enumerate() {
            let Some(hole) = self.relaxation.hole(axis, *side, bar) else { continue };
            let before = side.width();
            if hole.lower == side.lower {
                side.lower = hole.upper;
            } else if hole.upper == side.upper {
                side.upper = hole.lower;
            }
            left *= side.width() / before;
        }
        left < 1.0 - WORTHWHILE
    }

    /// Cuts the box in two near the solution, along the axis where the relaxation is most inexact there. An interval
    /// of that axis where nothing is above the bar is left out.
    ///
    /// There is always something to cut: a box whose sides are neighbouring numbers is not above the bar, because
    /// `same_as` allows for them.
    fn cut(&self, cell: Open, bar: f64) -> [Open; 2] {
        let place = &self.relaxation.place;
        let off = |axis: usize| {
            let side = cell.sides[axis];
            let x = place[axis].clamp(side.lower, side.upper);
            (x - side.lower) * (side.upper - x)
        };
        let width = |axis: usize| cell.sides[axis].width();
        let less = |&a: &usize, &b: &usize| off(a).total_cmp(&off(b)).then(width(a).total_cmp(&width(b)));
        let axis = (0..cell.sides.len()).max_by(less).expect("there is an axis");
        let side = cell.sides[axis];
        let least = LEAST_SHARE * side.width();
        let mut through = place[axis].clamp(side.lower + least, side.upper - least);
        if through == side.lower || through == side.upper {
            through = 0.5 * (side.lower + side.upper);
        }
        let hole = self.relaxation.hole(axis, side, bar).unwrap_or(Side { lower: through, upper: through });
        let [mut lower, mut upper] = [cell.clone(), cell];
        (lower.sides[axis].upper, upper.sides[axis].lower) = (hole.lower, hole.upper);
        [lower, upper]
    }
}
