//! The search of the whole cube, on all cores and against the clock.
//!
//! Each round takes the open boxes with the largest bounds and explores each a little, all with the same best place.
//! The results are put together in the order of the boxes, so that they do not depend on the number of threads. If
//! the open boxes take too much memory, the rounds go on depth first: each of the boxes with the largest bounds is
//! explored down to a goal and forgets what is below it (iterative deepening after Korf, Artificial Intelligence 27,
//! 1985). That lowers the box's bound to the goal and takes almost no memory.

use super::search::{BallSearch, Centre, Open, Outcome, same_as};
use super::tree::{Tree, squared_distance};
use super::{Fill, relaxation::Side};
use crate::{Bracket, Deadline, PointSet};
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// The number of climbs before the search, and the share of the time that they may take.
const CLIMBS: u32 = 128;
const TIME_FOR_CLIMBS: f64 = 0.1;
/// The number of boxes that a round explores, and how many boxes each of them may become.
const ROUND: usize = 128;
const BOXES: usize = 8;
/// The number of bytes that the open boxes may take, and the allocator's overhead for each.
const MOST_BYTES: usize = 80 << 20;
const ALLOCATION: usize = 16;
/// The next goal as a share of the largest bound. If two such steps reach the end, the goal is the end.
const GOAL: f64 = 0.99;

/// A search for the largest empty ball with its centre in the unit cube, on all cores.
pub(super) struct Hunt<'a> {
    points: &'a PointSet,
    tree: Tree,
    best: Centre,
    /// The boxes that may hold a better place.
    open: BinaryHeap<Open>,
    /// The greatest number of open boxes before the search goes on depth first.
    most_open: usize,
    deadline: Deadline,
}

impl<'a> Hunt<'a> {
    /// Makes a search for the largest empty ball among `points`. The search begins with the best of the middle and two
    /// corners of the cube. There must be a point.
    pub fn new(points: &'a PointSet, deadline: Deadline) -> Self {
        let tree = Tree::new(points);
        let sides: Box<[Side]> = vec![Side { lower: 0.0, upper: 1.0 }; points.dims()].into();
        let places = [0.5, 0.0, 1.0].map(|x| Centre::at(vec![x; points.dims()], &tree));
        let best = places.into_iter().max_by(|a, b| a.squared.total_cmp(&b.squared)).expect("there are three");
        let bound = BallSearch::new(&tree, deadline).bound(&sides);
        let most_open = MOST_BYTES / (size_of::<Open>() + size_of_val(&*sides) + ALLOCATION);
        Self { points, tree, best, open: BinaryHeap::from([Open { bound, sides }]), most_open, deadline }
    }

    /// Searches for the largest empty ball, until the result is exact or the deadline passes.
    pub fn run(mut self) -> Fill {
        self.climb();
        while let Some(largest) = self.open.peek()
            && largest.bound > self.bar()
            && !self.deadline.passed()
        {
            if self.open.len() < self.most_open { self.widen() } else { self.deepen() }
        }
        self.result()
    }

    /// Climbs from places in the cube and on its faces.
    fn climb(&mut self) {
        let deadline = self.deadline.part(TIME_FOR_CLIMBS);
        let dims = self.points.dims();
        let climb = |search: &mut BallSearch, number: u32| {
            (!deadline.passed()).then(|| search.climb(Centre::at(start(dims, number), &self.tree)))
        };
        let new_search = || BallSearch::new(&self.tree, deadline);
        let found: Vec<_> = (0..CLIMBS).into_par_iter().with_max_len(1).map_init(new_search, climb).collect();
        found.into_iter().flatten().for_each(|found| self.consider(found));
    }

    /// Explores the boxes with the largest bounds a little.
    fn widen(&mut self) {
        let largest = self.take_above(self.bar());
        for outcome in self.explore(largest, 0.0, BOXES) {
            outcome.found.into_iter().for_each(|found| self.consider(found));
            self.open.extend(outcome.open);
        }
    }

    /// Explores the boxes with the largest bounds down to a goal, and puts them back with the goal as their bound.
    fn deepen(&mut self) {
        let end = self.bar();
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

    /// Takes some open boxes with the largest bounds, all above a squared distance.
    fn take_above(&mut self, bar: f64) -> Vec<Open> {
        let above =
            std::iter::from_fn(|| self.open.peek().is_some_and(|open| open.bound > bar).then(|| self.open.pop()));
        above.flatten().take(ROUND).collect()
    }

    /// Explores boxes, each as if it were alone.
    fn explore(&self, open: Vec<Open>, goal: f64, most: usize) -> Vec<Outcome> {
        let explore = |search: &mut BallSearch, open| search.explore(open, self.best.squared, goal, most);
        let new_search = || BallSearch::new(&self.tree, self.deadline);
        open.into_par_iter().with_max_len(1).map_init(new_search, explore).collect()
    }

    /// The squared distance up to which a box need not be searched.
    fn bar(&self) -> f64 {
        same_as(self.best.squared, self.points.dims())
    }

    fn consider(&mut self, found: Centre) {
        if found.squared > self.best.squared {
            self.best = found;
        }
    }

    fn result(self) -> Fill {
        let squared = self.points.iter().map(|point| squared_distance(&self.best.place, point));
        let lower = squared.fold(f64::INFINITY, f64::min).sqrt();
        let open = self.open.peek().map_or(0.0, |open| open.bound);
        if open <= self.bar() {
            return Fill { radius: Bracket::exact(lower), centre: self.best.place };
        }
        Fill { radius: Bracket { lower, upper: open.sqrt().next_up() }, centre: self.best.place }
    }
}

/// The place where a climb starts: on average, one coordinate in five is at an end of its axis.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_that_goes_on_depth_first_finds_the_same() {
        // Multiples of irrational numbers, and few enough that the largest ball is not the only large one.
        let spread = |i: u32| [0.8191725, 0.6710436, 0.5497005].map(|step: f64| (f64::from(i) * step).fract());
        let points = PointSet::new(3, (1..=60).map(spread)).unwrap();
        let wide = Hunt::new(&points, Deadline::never()).run();
        let deep = Hunt { most_open: 1, ..Hunt::new(&points, Deadline::never()) }.run();
        assert!(wide.radius.is_exact() && deep.radius.is_exact());
        assert!((wide.radius.lower - deep.radius.lower).abs() <= 1e-12);
    }
}
