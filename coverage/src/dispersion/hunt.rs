//! The search of the whole cube, on all cores and against the clock or a limit of work.
//!
//! A small search ends on one thread. A larger search is split into parts that cores take from each other. The parts
//! share a bar, the volume of the largest box found, but walk one and the same tree. Volume and witness of an exact
//! result therefore do not depend on the number of threads.
//!
//! If the time is limited and the exact search does not end in a share of it, two things follow. A large
//! neighbourhood search raises the lower bound: it finds larger boxes than a depth-first search, which stays in one
//! corner of the tree. Then iterative deepening lowers the upper bound (after Korf, Depth-first iterative-deepening,
//! Artificial Intelligence 27, 1985): a search that forgets everything below a goal proves that nothing is above it.
//! It takes almost no memory, whereas a best-first search of the same tree fills gigabytes.

use super::search::{Bar, BoxSearch, Found, MOST_LISTED, Open};
use super::side::{Side, Weight, inside};
use super::{Dispersion, LargestEmptyBox};
use crate::deadline::Watch;
use crate::{Bracket, Deadline, PointSet};
use rayon::prelude::*;

/// The number of boxes that are explored on one thread before the rest is shared out: a small search is done by then.
const ALONE: usize = 2_000;
/// The number of parts in which the rest is shared out: enough to keep all cores busy until the end.
const PARTS: usize = 256;
/// The share of a time limit after which the search gives up being exact and works on the upper bound.
const HOPE: f64 = 0.2;
/// The share of the remaining time that then goes into a better lower bound.
const IMPROVEMENT: f64 = 0.2;
/// The least number of dimensions for which it pays to improve the lower bound before anything else.
const EARLY_IMPROVEMENT: usize = 4;
/// The number of attempts to improve the lower bound between two looks at the clock.
const ROUND: u64 = 64;
/// The greatest number of dimensions of a search: in more, the children of one box take gigabytes. The widest slab is
/// then the result.
const MOST_DIMS: usize = 1_500;
/// The number of boxes that one attempt explores.
const ATTEMPT: usize = 500;

/// A search for the heaviest empty box among points, on all cores.
pub(super) struct Hunt<'a, W> {
    points: &'a PointSet,
    weight: W,
    /// The weight of the witness, for all threads to see.
    bar: Bar,
    witness: LargestEmptyBox,
    /// The boxes that have not been explored to the end, the largest first.
    open: Vec<Open>,
    /// An upper bound on the volume of the boxes that are left.
    upper: f64,
    /// The number of attempts so far to find a better witness.
    attempts: u64,
    /// `true` if some part could not be explored for lack of memory.
    full: bool,
}

impl<'a, W: Weight> Hunt<'a, W> {
    /// Makes a search for empty boxes that are heavier than the box `witness` and heavier than `above`.
    pub fn new(points: &'a PointSet, weight: W, witness: LargestEmptyBox, above: f64) -> Self {
        let bar = Bar::new(weight.of(&sides(&witness)).max(above));
        let cube = Open::cube(points, weight);
        Self { points, weight, bar, witness, upper: cube.weight, open: vec![cube], attempts: 0, full: false }
    }

    fn size(&self, found: &LargestEmptyBox) -> f64 {
        self.weight.of(&sides(found))
    }

    /// Searches for the largest empty box, until the result is exact or the deadline passes. `watch` receives the
    /// bracket while it narrows.
    pub fn run(mut self, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) -> Dispersion {
        if self.points.dims() > MOST_DIMS {
            return Dispersion { volume: self.bracket(), witness: self.witness };
        }
        self.begin(deadline);
        if self.points.dims() >= EARLY_IMPROVEMENT {
            while !self.open.is_empty() && !deadline.passed() && self.attempt(deadline) {
                watch(self.bracket());
            }
        }
        watch(self.bracket());
        self.explore(0.0, deadline.part(HOPE));
        if self.full && deadline.left().is_none() {
            // There is no deadline to wait for.
            return Dispersion { volume: self.bracket(), witness: self.witness };
        }
        self.improve(deadline.part(IMPROVEMENT), watch);
        self.deepen(deadline, watch);
        Dispersion { volume: self.bracket(), witness: self.witness }
    }

    /// Returns true if no empty box is larger than `above`; `None` if the answer is not known at the deadline. The
    /// search must have been made for the same `above`.
    pub fn finds_none(mut self, above: f64, deadline: Deadline) -> Option<bool> {
        if self.points.dims() > MOST_DIMS {
            return (self.size(&self.witness) > above).then_some(false);
        }
        self.begin(deadline);
        let (bar, dims) = (Bar::new(self.bar.get()), self.points.dims());
        let explore = |search: &mut BoxSearch<W>, part: &Open| {
            let mut watch = Watch::new(deadline);
            let mut over = deadline.passed();
            search.explore(part, &bar, above, |work| {
                // A single larger box answers the question.
                over |= watch.passed_after(work * dims) || bar.get() > above;
                !over
            })
        };
        let new_search = || BoxSearch::new(self.points, self.weight, above);
        let parts = self.open.par_iter().with_max_len(1);
        let done: Vec<bool> = parts.map_init(new_search, |search, part| explore(search, part).is_done()).collect();
        if self.size(&self.witness).max(bar.get()) > above {
            return Some(false);
        }
        done.into_iter().all(|done| done).then_some(true)
    }

    /// The bracket that is known by now.
    fn bracket(&self) -> Bracket {
        let lower = self.size(&self.witness);
        if self.open.is_empty() {
            return Bracket::exact(lower);
        }
        // Each factor and each product may have lost half an ulp.
        let upper = (self.upper * (1.0 + 2.0 * self.points.dims() as f64 * f64::EPSILON)).min(1.0);
        Bracket { lower, upper }
    }

    /// Explores a little on one thread: a small search is done by then.
    fn begin(&mut self, deadline: Deadline) {
        let mut nodes = 0;
        let mut watch = Watch::new(deadline);
        let dims = self.points.dims();
        self.step(|work| {
            nodes += 1;
            nodes <= ALONE && !watch.passed_after(work * dims)
        });
        self.split(0.0, deadline);
    }

    /// Branches the largest open boxes until there are enough boxes above a volume to share out, the largest first.
    fn split(&mut self, above: f64, deadline: Deadline) {
        self.open.sort_by(|a, b| a.weight.total_cmp(&b.weight));
        while let Some(largest) = self.open.last()
            && largest.weight > above
            && !deadline.passed()
            && self.open.iter().map(|open| open.inside.len()).sum::<usize>() <= MOST_LISTED
            && self.open.iter().rev().take(PARTS).filter(|open| open.weight > above).count() < PARTS
        {
            let mut first = true;
            if !self.step(|_| std::mem::take(&mut first)) {
                break;
            }
            // The children are fewer than 2 d, and smaller than most boxes: the sort runs on a nearly sorted list.
            self.open.sort_by(|a, b| a.weight.total_cmp(&b.weight));
        }
        self.open.reverse();
        self.close(1.0);
    }

    /// Explores the last open box while `go_on` returns `true`. Returns `false` if memory ran out.
    fn step(&mut self, go_on: impl FnMut(usize) -> bool) -> bool {
        let Some(root) = self.open.pop() else { return true };
        let best = self.bar.get();
        let found = BoxSearch::new(self.points, self.weight, best).explore(&root, &self.bar, best, go_on);
        if found.lost {
            self.open.push(root);
        } else {
            self.open.extend(found.open);
        }
        self.witness = found.witness.unwrap_or_else(|| self.witness.clone());
        !found.lost
    }

    /// Explores all open boxes on all cores, down to a volume. Returns `true` if that was done before the deadline.
    /// Boxes that are done are closed, if nothing was left out that could be larger than the witness.
    fn explore(&mut self, down_to: f64, deadline: Deadline) -> bool {
        let (floor, dims) = (self.bar.get(), self.points.dims());
        let bar = Bar::new(floor.max(down_to));
        let lowered = down_to > floor;
        let explore = |search: &mut BoxSearch<W>, part: &Open| {
            let mut watch = Watch::new(deadline);
            let mut late = deadline.passed();
            search.explore(part, &bar, floor.max(down_to), |work| {
                late |= watch.passed_after(work * dims);
                !late
            })
        };
        let found: Vec<Found> = self
            .open
            .par_iter()
            .with_max_len(1)
            .map_init(|| BoxSearch::new(self.points, self.weight, floor), |search, part| explore(search, part))
            .collect();
        let done = found.iter().all(Found::is_done);
        self.full |= found.iter().any(|found| found.lost);
        let mut left = Vec::new();
        let mut listed = 0;
        for (found, part) in found.into_iter().zip(&self.open) {
            listed += found.open.iter().map(|open| open.inside.len()).sum::<usize>();
            // The rest of a part may take more memory than the part.
            if found.lost || listed > MOST_LISTED {
                left.push(part.clone());
            } else {
                left.extend(found.open);
            }
            if let Some(witness) = found.witness
                && self.size(&witness) > self.size(&self.witness)
            {
                self.witness = witness;
            }
        }
        self.bar.raise(self.size(&self.witness));
        if !lowered {
            self.open = left;
            self.open.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        }
        self.close(if done { down_to } else { 1.0 });
        done
    }

    /// Looks for larger boxes near the witness: moves some of its ends back to the walls of the cube, and cuts the
    /// points that come in away again in the best way (a large neighbourhood search).
    fn improve(&mut self, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) {
        while !self.open.is_empty() && !deadline.passed() {
            self.attempt(deadline);
            watch(self.bracket());
        }
    }

    /// Makes a round of such attempts. Returns `true` if it found a larger box. Each attempt has its own bar, so that
    /// its result does not depend on the others.
    fn attempt(&mut self, deadline: Deadline) -> bool {
        let (best, dims) = (self.bar.get(), self.points.dims());
        let attempt = |search: &mut BoxSearch<W>, seed: u64| {
            if deadline.passed() {
                return None;
            }
            // An attempt is made to its end, but its work counts.
            let (mut nodes, mut watch) = (0, Watch::new(deadline));
            watch.passed_after(self.points.len() * dims);
            let few = |work| {
                nodes += 1;
                watch.passed_after(work * dims);
                nodes <= ATTEMPT
            };
            search.explore(&self.relaxed(seed), &Bar::new(best), best, few).witness
        };
        let seeds: Vec<u64> = (self.attempts..self.attempts + ROUND).collect();
        let new_search = || BoxSearch::new(self.points, self.weight, best);
        let found: Vec<_> =
            seeds.into_par_iter().with_max_len(1).map_init(new_search, |search, seed| attempt(search, seed)).collect();
        self.attempts += ROUND;
        for witness in found.into_iter().flatten() {
            if self.size(&witness) > self.size(&self.witness) {
                self.witness = witness;
            }
        }
        self.bar.raise(self.size(&self.witness));
        self.close(1.0);
        self.bar.get() > best
    }

    /// The witness with some of its ends moved to the walls.
    fn relaxed(&self, seed: u64) -> Open {
        // A multiplicative hash is random enough to choose ends by.
        let mut state = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut below = |n: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 32) as usize % n
        };
        let ends = 2 * self.points.dims();
        let freed = 2 + below(ends.clamp(2, 16) - 1);
        let mut sides = sides(&self.witness);
        for _ in 0..freed {
            let end = below(ends);
            let side = &mut sides[end / 2];
            *side = if end % 2 == 0 { Side::between(0.0, side.upper) } else { Side::between(side.lower, 1.0) };
        }
        let points = 0..self.points.len() as u32;
        let inside = points.filter(|&point| inside(self.points.point(point as usize), &sides)).collect();
        Open { weight: self.weight.of(&sides), sides, inside }
    }

    /// Forgets open boxes that are not larger than the witness. Lowers the upper bound to the largest of the other
    /// boxes and to the bound that has been proved.
    fn close(&mut self, proved: f64) {
        let best = self.bar.get();
        self.open.retain(|open| open.weight > best);
        let largest = self.open.iter().map(|open| open.weight).fold(best, f64::max);
        self.upper = self.upper.min(largest).min(proved.max(best)).max(best);
    }

    /// Proves lower and lower upper bounds. Each pass is a search down to its goal that forgets everything below the
    /// goal, so that it takes almost no memory. A pass repeats the work of the earlier passes, but each takes a few
    /// times as long as the one before, so that the repetition costs little.
    fn deepen(&mut self, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) {
        let mut passes: Vec<(f64, f64)> = Vec::new();
        while !self.open.is_empty() && !deadline.passed() {
            let (best, upper) = (self.bar.get(), self.upper);
            let next = next_goal(best, upper, &passes, deadline.left().unwrap_or(f64::INFINITY));
            let lap = deadline.lap();
            self.split(next, deadline);
            if self.explore(next, deadline) {
                passes.push((libm::log(next), libm::log(lap.taken().max(1e-6))));
            }
            watch(self.bracket());
        }
    }
}

fn sides(found: &LargestEmptyBox) -> Vec<Side> {
    found.lower.iter().zip(&found.upper).map(|(&lower, &upper)| Side::between(lower, upper)).collect()
}

/// The upper bound that the next pass should try to prove in the remaining time or work.
///
/// The time grows as a power of the goal. The last two passes give the exponent. The next pass should take four times
/// as long as the last, or the remaining time if no further pass would fit in.
fn next_goal(best: f64, upper: f64, passes: &[(f64, f64)], left: f64) -> f64 {
    let (low, high) = (libm::log(best), libm::log(upper));
    let goal = match passes {
        [.., (goal_before, time_before), (goal, time)] if goal < goal_before && time > time_before => {
            let slope = (time - time_before) / (goal_before - goal);
            let wanted = if left < 20.0 * libm::exp(*time) { libm::log(0.8 * left) } else { time + libm::log(4.0) };
            (goal - (wanted - time).max(0.05) / slope).max(high - 0.5 * (high - low))
        }
        _ => high - 0.2 * (high - low),
    };
    libm::exp(goal.max(low)).max(best)
}
