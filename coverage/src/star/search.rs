//! Branch and bound over regions of boxes.
//!
//! Regions are cut until their relaxation is exact or shows that they hold nothing above the best value. Tasks explore
//! regions depth first. Each task has its own stack, and gives half of it away while a thread is idle. The result does
//! not depend on the order: bounds and values are computed by monotone operations, so that the result is the largest
//! computed value of all boxes, wherever it is found.
//!
//! Depth first alone narrows a bracket badly, because it leaves large regions for last. With a deadline the search
//! therefore proves one upper bound after the other: a pass drops all regions whose bound is at most a target, and a
//! pass that ends has proved its target. Only the open regions on the way to one region are kept.

use super::ascent::Ascent;
use super::region::{Region, Relaxed};
use super::sides::Sides;
use crate::deadline::Watch;
use crate::{Bracket, Deadline};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// The number of ascents before the search; more cost more time than they save.
const ASCENTS: usize = 64;
/// The share of the remaining time in which ascents then raise the lower bound.
const TIME_FOR_ASCENTS: f64 = 0.15;
/// The target of the next pass, as a share of the way from the best value to the bound. With the first share a pass
/// takes some two or three times as long as the last pass. If that would take too long, the second share is used.
const NEXT_TARGET: [f64; 2] = [0.76, 0.9];
/// The number of times that a relaxation looks at a number of its region for each side, about: it sorts the numbers.
const LOOKS: usize = 4;
/// The number of numbers that the stack of a task may hold: some 200 MiB.
const MOST_NUMBERS: usize = 1 << 24;

/// Finds the largest difference between volume and share of points, over the boxes that `sides` describes. The search
/// cuts regions of the type `R`, which read the points in the form `points`.
pub(crate) fn largest_difference<R: Region>(points: &R::Points<'_>, sides: &Sides, deadline: Deadline) -> Bracket {
    let best = Ascent::new(sides).run(0..ASCENTS, deadline.part(TIME_FOR_ASCENTS));
    let first = Pass::<R>::over(points, sides.count(), best, best, deadline.part(R::TIME_TO_THE_END));
    if first.left <= first.best {
        return Bracket::exact(first.best);
    }
    // Without a time limit, it was memory that ended the pass.
    let ascents = ASCENTS..if deadline.left().is_some() { usize::MAX } else { 16 * ASCENTS };
    let mut best = Ascent::new(sides).run(ascents, deadline.part(TIME_FOR_ASCENTS)).max(first.best);
    let mut upper = first.left;
    let mut last = 0.0;
    while upper > best && !deadline.passed() {
        let lap = deadline.lap();
        let is_short = deadline.left().is_some_and(|left| left < 4.0 * last);
        let target = best + NEXT_TARGET[usize::from(is_short)] * (upper - best);
        let pass = Pass::<R>::over(points, sides.count(), best, target, deadline);
        let got_no_further = pass.left >= upper;
        (best, upper) = (pass.best, pass.left.min(upper));
        last = lap.taken();
        if got_no_further {
            break;
        }
    }
    if upper <= best {
        return Bracket::exact(best);
    }
    // Rounding may have lost half an ulp of 1 in every product and difference.
    let rounding = (sides.count() + 2) as f64 * f64::EPSILON;
    Bracket { lower: best, upper: (upper + rounding).min(1.0) }
}

/// A pass over all boxes.
struct Pass<'a, 'p, R: Region> {
    points: &'a R::Points<'p>,
    /// The number of sides of a box that are not fixed.
    sides: usize,
    /// The value above which a region must hold boxes; other regions are dropped.
    target: f64,
    deadline: Deadline,
    stopped: AtomicBool,
    /// The number of tasks at work.
    tasks: AtomicUsize,
    /// The largest value of a box so far.
    best: Most,
    /// The largest bound of a region that was left unexplored.
    left: Most,
}

/// The result of a pass.
struct Outcome {
    best: f64,
    /// An upper bound on the values of all boxes.
    left: f64,
}

impl<'a, 'p, R: Region> Pass<'a, 'p, R> {
    fn over(points: &'a R::Points<'p>, sides: usize, best: f64, target: f64, deadline: Deadline) -> Outcome {
        let pass = Self {
            points,
            sides,
            target,
            deadline,
            stopped: AtomicBool::new(false),
            tasks: AtomicUsize::new(1),
            best: Most::new(best),
            left: Most::new(target),
        };
        rayon::scope(|scope| pass.explore(scope, R::all(points)));
        Outcome { best: pass.best.get(), left: pass.left.get().max(pass.best.get()) }
    }

    /// Explores the regions of a stack.
    fn explore<'s>(&'s self, scope: &rayon::Scope<'s>, mut stack: Vec<R>) {
        let (mut scratch, mut watch) = (R::Scratch::default(), Watch::new(self.deadline));
        let mut numbers: usize = stack.iter().map(R::size).sum();
        let mut parts = Vec::new();
        while let Some(mut region) = stack.pop() {
            numbers -= region.size();
            let threshold = self.best.get().max(self.target);
            if region.bound() <= threshold {
                continue;
            }
            // Most work is in the relaxations, also of regions that need no split.
            let is_over = watch.passed_after(LOOKS * self.sides * region.size());
            match region.relax(self.points, threshold, &mut scratch) {
                Relaxed::Nothing => continue,
                Relaxed::Solved(value) => {
                    self.best.raise(value);
                    continue;
                }
                Relaxed::Bounded => {}
            }
            if is_over || self.stopped.load(Ordering::Relaxed) {
                self.stopped.store(true, Ordering::Relaxed);
                self.left.raise(region.bound());
                stack.iter().for_each(|region| self.left.raise(region.bound()));
                break;
            }
            if numbers + 2 * region.size() > MOST_NUMBERS {
                self.left.raise(region.bound());
                continue;
            }
            region.split(self.points, threshold, &mut scratch, &mut parts);
            numbers += parts.iter().map(R::size).sum::<usize>();
            // The region with the highest bound is explored first.
            parts.sort_by(|a, b| a.bound().total_cmp(&b.bound()));
            stack.append(&mut parts);
            if self.tasks.load(Ordering::Relaxed) < rayon::current_num_threads() {
                // The bottom of the stack has the largest regions.
                let given: Vec<_> = stack.drain(..stack.len() / 2).collect();
                numbers -= given.iter().map(R::size).sum::<usize>();
                self.tasks.fetch_add(1, Ordering::Relaxed);
                scope.spawn(|scope| self.explore(scope, given));
            }
        }
        self.tasks.fetch_sub(1, Ordering::Relaxed);
    }
}

/// A number that threads raise together. Non-negative numbers have the same order as their bits.
struct Most(AtomicU64);

impl Most {
    fn new(number: f64) -> Self {
        Self(AtomicU64::new(number.max(0.0).to_bits()))
    }

    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    fn raise(&self, number: f64) {
        self.0.fetch_max(number.max(0.0).to_bits(), Ordering::Relaxed);
    }
}
