//! The search of the whole cube, on all cores and against the clock.
//!
//! Rounds take the open boxes with the largest bounds and explore each a little, all with the same best place; what
//! they find is put together in their order. What is computed therefore does not depend on the number of threads. When
//! the open boxes take too much memory, the rounds go on depth first: each of the largest is explored down to a goal,
//! and forgets what is below (iterative deepening after Korf, Artificial Intelligence 27, 1985). That brings its bound
//! to the goal and takes no memory to speak of.

use super::search::{Found, Open, Outcome, Search, same_as};
use super::tree::{Tree, squared_distance};
use super::{Fill, relaxation::Side};
use crate::{Bracket, Deadline, PointSet};
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// How many climbs precede the search, and the share of the time they may take.
const CLIMBS: u32 = 128;
const TIME_FOR_CLIMBS: f64 = 0.1;
/// How many boxes are explored in a round, and how far each.
const ROUND: usize = 128;
const BOXES: usize = 8;
/// How many bytes the open boxes may take, with what the allocator and a growing heap add.
const MOST_BYTES: usize = 80 << 20;
/// What a goal leaves of the largest bound; with less than twice that to go, the goal is the end.
const GOAL: f64 = 0.99;

pub(super) struct Hunt<'a> {
    points: &'a PointSet,
    tree: Tree,
    best: Found,
    open: BinaryHeap<Open>,
    deadline: Deadline,
}

impl<'a> Hunt<'a> {
    /// A search that has looked at the middle and at two corners of the cube.
    pub fn new(points: &'a PointSet, deadline: Deadline) -> Self {
        let tree = Tree::new(points);
        let mut search = Search::new(&tree, deadline);
        let places = [0.5, 0.0, 1.0].map(|x| search.look_at(vec![x; points.dims()]));
        let best = places.into_iter().reduce(|best, other| if other.squared > best.squared { other } else { best });
        let best = best.expect("there are three");
        let sides: Box<[Side]> = vec![Side { lower: 0.0, upper: 1.0 }; points.dims()].into();
        let open = BinaryHeap::from([Open { bound: search.bound(&sides), sides }]);
        Self { points, tree, best, open, deadline }
    }

    pub fn run(mut self) -> Fill {
        self.climb();
        let size = size_of::<Open>() + self.points.dims() * size_of::<Side>() + 16;
        while let Some(largest) = self.open.peek()
            && largest.bound > same_as(self.best.squared)
            && !self.deadline.passed()
        {
            if self.open.len() < MOST_BYTES / size { self.widen() } else { self.deepen() }
        }
        self.result()
    }

    /// Climbs from places in the cube and on its faces.
    fn climb(&mut self) {
        let deadline = self.deadline.part(TIME_FOR_CLIMBS);
        let dims = self.points.dims();
        let climb = |search: &mut Search, number: u32| {
            (!deadline.passed()).then(|| search.climb(start(dims, number)))
        };
        let new_search = || Search::new(&self.tree, deadline);
        let found: Vec<_> = (0..CLIMBS).into_par_iter().with_max_len(1).map_init(new_search, climb).collect();
        found.into_iter().flatten().for_each(|found| self.consider(found));
    }

    /// Explores the boxes with the largest bounds a little.
    fn widen(&mut self) {
        let largest = self.take_above(same_as(self.best.squared));
        for outcome in self.explore(largest, 0.0, BOXES) {
            outcome.found.into_iter().for_each(|found| self.consider(found));
            self.open.extend(outcome.open);
        }
    }

    /// Explores the boxes with the largest bounds as far as they are above a goal, and puts them back as no larger than
    /// that.
    fn deepen(&mut self) {
        let end = same_as(self.best.squared);
        let bound = self.open.peek().map_or(end, |open| open.bound);
        let goal = if bound * GOAL * GOAL > end { bound * GOAL } else { end };
        let largest = self.take_above(goal);
        for (mut open, outcome) in largest.clone().into_iter().zip(self.explore(largest, goal, usize::MAX)) {
            outcome.found.into_iter().for_each(|found| self.consider(found));
            if outcome.open.is_empty() {
                open.bound = goal;
            }
            self.open.push(open);
        }
    }

    /// Some open boxes with the largest bounds, above a squared distance.
    fn take_above(&mut self, bar: f64) -> Vec<Open> {
        let above = std::iter::from_fn(|| self.open.peek().is_some_and(|open| open.bound > bar).then(|| self.open.pop()));
        above.flatten().take(ROUND).collect()
    }

    /// Explores boxes, each as if it were alone.
    fn explore(&self, open: Vec<Open>, goal: f64, most: usize) -> Vec<Outcome> {
        let explore = |search: &mut Search, open| search.explore(open, self.best.squared, goal, most);
        let new_search = || Search::new(&self.tree, self.deadline);
        open.into_par_iter().with_max_len(1).map_init(new_search, explore).collect()
    }

    fn consider(&mut self, found: Found) {
        if found.squared > self.best.squared {
            self.best = found;
        }
    }

    fn result(self) -> Fill {
        let squared = self.points.iter().map(|point| squared_distance(&self.best.place, point));
        let lower = squared.fold(f64::INFINITY, f64::min).sqrt();
        let open = self.open.peek().map_or(0.0, |open| open.bound);
        if open <= same_as(self.best.squared) {
            return Fill { radius: Bracket::exact(lower), centre: self.best.place };
        }
        Fill { radius: Bracket { lower, upper: open.sqrt().next_up() }, centre: self.best.place }
    }
}

/// The place where a climb starts: one coordinate in four is an end, on average.
fn start(dims: usize, number: u32) -> Vec<f64> {
    // The mixing of splitmix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
    let mut state = u64::from(number);
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..dims).map(|_| (1.25 * random() - 0.125).clamp(0.0, 1.0)).collect()
}
