//! The search of one box, and the climb from one place.

use super::relaxation::{Relaxation, Side};
use super::tree::Tree;
use crate::Deadline;
use crate::bracket::Watch;

/// How much larger a square may be than another one and count as equal: far more than rounding, and far less than
/// anybody asks.
const SAME: f64 = 1.0 + 1e-12;
/// A box is relaxed again where that takes away more than this share of it, but no more often than that.
const WORTHWHILE: f64 = 0.2;
const MOST_RELAXATIONS: usize = 4;
/// A cut through the solution leaves no less than this share of the side to both.
const LEAST_SHARE: f64 = 0.1;
/// A climb ends when its steps are shorter than this share of the distance.
const SHORTEST_STEP: f64 = 0.02;

/// A place in the cube and the square of its distance from the nearest point.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub squared: f64,
    pub place: Vec<f64>,
}

/// A box that may hold a place further from all points than any that was found.
#[derive(Debug, Clone)]
pub(super) struct Open {
    /// The squared distance that none of its places exceeds.
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

/// What a search came to.
#[derive(Debug)]
pub(super) struct Outcome {
    /// The best place, if it is better than the one that was known.
    pub found: Option<Found>,
    /// What is left to explore.
    pub open: Vec<Open>,
}

/// The squared distance that is as good as a squared distance.
pub(super) fn same_as(squared: f64) -> f64 {
    squared * SAME
}

#[derive(Debug)]
pub(super) struct Search<'a> {
    relaxation: Relaxation<'a>,
    watch: Watch,
    /// The square of the largest distance that is known.
    best: f64,
    found: Option<Found>,
}

impl<'a> Search<'a> {
    pub fn new(tree: &'a Tree, deadline: Deadline) -> Self {
        Self { relaxation: Relaxation::new(tree), watch: Watch::new(deadline), best: 0.0, found: None }
    }

    /// Explores boxes depth first, no more than `most` of them, as far as they may hold something larger than `goal` and
    /// than `best`, both squared.
    pub fn explore(&mut self, root: Open, best: f64, goal: f64, most: usize) -> Outcome {
        self.best = best;
        let mut open = vec![root];
        for _ in 0..most {
            let Some(cell) = open.pop() else { break };
            let bar = same_as(self.best).max(goal);
            if cell.bound > bar {
                self.branch(cell, bar, &mut open);
            }
            if self.watch.passed_after(0) {
                break;
            }
        }
        let bar = same_as(self.best).max(goal);
        open.retain(|cell| cell.bound > bar);
        Outcome { found: self.found.take(), open }
    }

    /// A place.
    pub fn look_at(&mut self, place: Vec<f64>) -> Found {
        Found { squared: self.relaxation.squared_distance_of(&place), place }
    }

    /// What the squared distance of no place in a box exceeds, as far as there is time to say.
    pub fn bound(&mut self, sides: &[Side]) -> f64 {
        self.relaxation.solve(sides, 0.0, &mut self.watch)
    }

    /// Climbs from a place.
    pub fn climb(&mut self, place: Vec<f64>) -> Found {
        let mut at = self.look_at(place);
        let mut step = at.squared.sqrt();
        while step > SHORTEST_STEP * at.squared.sqrt() && !self.watch.passed_after(0) {
            let around = |&x: &f64| Side { lower: (x - step).max(0.0), upper: (x + step).min(1.0) };
            let sides: Vec<Side> = at.place.iter().map(around).collect();
            self.relaxation.solve(&sides, at.squared, &mut self.watch);
            let squared = self.relaxation.squared_distance();
            if squared > at.squared {
                at.squared = squared;
                at.place.copy_from_slice(&self.relaxation.place);
            } else {
                step *= 0.3;
            }
        }
        at
    }

    /// Bounds a box, and puts what is left of it on the stack in two parts, the more promising one on top.
    fn branch(&mut self, mut cell: Open, bar: f64, open: &mut Vec<Open>) {
        let mut bar = bar;
        for _ in 0..MOST_RELAXATIONS {
            cell.bound = cell.bound.min(self.relaxation.solve(&cell.sides, bar, &mut self.watch));
            if cell.bound <= bar {
                return;
            }
            bar = bar.max(self.look_at_solution(&cell.sides));
            if cell.bound <= bar || !self.shrink(&mut cell, bar) {
                break;
            }
        }
        if cell.bound > bar {
            let [lower, upper] = self.cut(cell, bar);
            open.extend([lower, upper]);
        }
    }

    /// Whether the place of the solution is better than all that are known: then climbs from there. The squared distance
    /// that need not be looked for any more.
    fn look_at_solution(&mut self, sides: &[Side]) -> f64 {
        if self.relaxation.squared_distance() > self.best {
            let place = self.relaxation.place.clone();
            let found = self.climb(place);
            self.best = found.squared;
            self.found = Some(found);
            // The climb has used the relaxation.
            self.relaxation.solve(sides, same_as(self.best), &mut self.watch);
        }
        same_as(self.best)
    }

    /// Takes away ends of the box that are too near to points; whether that was worthwhile.
    fn shrink(&mut self, cell: &mut Open, bar: f64) -> bool {
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

    /// Cuts the box along the axis where the relaxation is most off, through the solution, more or less. What of that
    /// axis is too near to points is left out.
    fn cut(&mut self, cell: Open, bar: f64) -> [Open; 2] {
        let place = &self.relaxation.place;
        let off = |axis: usize| {
            let side = cell.sides[axis];
            let x = place[axis].clamp(side.lower, side.upper);
            (x - side.lower) * (side.upper - x)
        };
        let width = |axis: usize| cell.sides[axis].width();
        let worse = |&a: &usize, &b: &usize| off(a).total_cmp(&off(b)).then(width(a).total_cmp(&width(b)));
        let axis = (0..cell.sides.len()).max_by(worse).expect("there is an axis");
        let side = cell.sides[axis];
        let least = LEAST_SHARE * side.width();
        let through = place[axis].clamp(side.lower + least, side.upper - least);
        let hole = self.relaxation.hole(axis, side, bar).unwrap_or(Side { lower: through, upper: through });
        let [mut lower, mut upper] = [cell.clone(), cell];
        (lower.sides[axis].upper, upper.sides[axis].lower) = (hole.lower, hole.upper);
        [lower, upper]
    }
}
