//! Cells of boxes, and upper bounds on the value of their boxes.

use super::region::{BoxKind, Region, Relaxed};
use super::sides::Sides;
use crate::ordered::{greatest, least};

/// A point that is inside part of the boxes of a cell, and outside the remaining boxes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Undecided {
    point: u32,
    /// The number of sides along which the point is undecided.
    sides: u32,
    /// The sum of the numbers of these sides, modulo 2^32. If there is only one side, the sum is its number.
    sum: u32,
}

/// A cell of boxes, which are all boxes whose sides are between `lower` and `upper`. That is `lower < position <=
/// upper` for open boxes and `lower <= position < upper` for closed boxes. In both, a point is inside along a side if
/// its coordinate is `<= lower`, and outside if it is `>= upper`.
#[derive(Debug, Clone)]
pub(crate) struct Cell {
    kind: BoxKind,
    lower: Vec<f64>,
    upper: Vec<f64>,
    inside: usize,
    undecided: Vec<Undecided>,
    /// An upper bound on the difference of every box of the cell.
    bound: f64,
}

/// The result of filling the profiles with the undecided points.
struct Profiled {
    /// `true` if some points are undecided along several sides.
    several: bool,
    /// The number of times that a point was counted again along another side.
    again: usize,
}

/// The greatest number of steps of a relaxation, some hundredths of a second. Beyond that it is better to cut the
/// cell.
const MOST_STEPS: usize = 1 << 26;

/// The greatest number of repeated counts, as a multiple of the number of points that matters.
const AGAIN_PER_BUDGET: usize = 3;

/// Working memory of the relaxation of a cell.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// For each side: the positions that take in (open) or leave out (closed) 0, 1, 2, .. of its points.
    profiles: Vec<Vec<f64>>,
    /// For each number of points, the most extreme volume over the axes so far.
    volumes: Vec<f64>,
    widths: Vec<f64>,
    next: Vec<f64>,
    /// The coordinates among which a cut is chosen.
    coordinates: Vec<f64>,
}

impl Region for Cell {
    type Points<'a> = Sides<'a>;
    type Scratch = Scratch;
    const TIME_TO_THE_END: f64 = 0.2;

    fn all(sides: &Sides) -> Vec<Self> {
        BoxKind::BOTH.map(|kind| Self::root(sides, kind)).into()
    }

    fn bound(&self) -> f64 {
        self.bound
    }

    fn size(&self) -> usize {
        self.undecided.len() + self.lower.len()
    }

    /// Shrinks the cell and lowers the upper bound of the cell by its relaxation. In the relaxation the sides are
    /// independent: only the number of points that each side takes in (or leaves out) counts. A point that is undecided
    /// along one side counts along this side. A point that is undecided along several sides counts
    ///
    /// - for closed boxes: along the side where it costs most, because it is inside only if all sides take it in;
    /// - for open boxes: along all these sides, less the repeated counts, if no box above the threshold leaves it out
    ///   along two sides; otherwise it does not count. The point is certainly outside if exactly one side leaves it
    ///   out.
    ///
    /// The best choice of positions for each number of points follows by dynamic programming over the axes (Dobkin,
    /// Eppstein, Mitchell, Computing the discrepancy with applications to supersampling patterns, ACM Trans. Graphics
    /// 15, 1996, who subdivide until no point is undecided along several sides). If there are no points that are
    /// undecided along several sides, the bound is exact.
    fn relax(&mut self, sides: &Sides, threshold: f64, scratch: &mut Scratch) -> Relaxed {
        self.shrink(sides, threshold);
        if self.bound <= threshold {
            return Relaxed::Nothing;
        }
        let room = (self.simple_bound(sides) - threshold) * sides.points() as f64;
        let budget = (room as usize).saturating_add(2).min(self.undecided.len());
        if budget.saturating_mul(budget).saturating_mul(sides.count()) > MOST_STEPS {
            return Relaxed::Bounded;
        }
        let Profiled { several, again } = self.profile(sides, budget, threshold, scratch);
        match self.kind {
            BoxKind::Open => self.combine(sides, budget + again, scratch, f64::NEG_INFINITY, greatest),
            BoxKind::Closed => self.combine(sides, budget, scratch, f64::INFINITY, least),
        }
        let (inside, all) = (self.inside, self.inside + self.undecided.len());
        let values = scratch.volumes.iter().enumerate().map(|(count, volume)| match self.kind {
            // A box that takes in fewer points than the repeated counts would be below the threshold anyway.
            BoxKind::Open => volume - sides.share((inside + count).saturating_sub(again)),
            BoxKind::Closed => sides.share(all - count) - volume,
        });
        let value = values.fold(f64::NEG_INFINITY, f64::max);
        if value <= threshold {
            return Relaxed::Nothing;
        }
        self.bound = self.bound.min(value);
        if several { Relaxed::Bounded } else { Relaxed::Solved(value) }
    }

    /// Cuts the cell into two cells, below and above a coordinate.
    fn split(mut self, sides: &Sides, _: f64, scratch: &mut Scratch, parts: &mut Vec<Self>) {
        let (side, at) = self.cut(sides, scratch);
        // Below the cut, points at the cut and beyond are outside. The other points stay as undecided as they were.
        let below_it = |undecided: &&Undecided| sides.coordinate(undecided.point as usize, side) < at;
        let mut below = Self {
            kind: self.kind,
            lower: self.lower.clone(),
            upper: self.upper.clone(),
            inside: self.inside,
            undecided: self.undecided.iter().filter(below_it).copied().collect(),
            bound: self.bound,
        };
        below.upper[side] = at;
        // Above the cut, points up to it are inside along this side, and then perhaps along all sides.
        let (from, inside) = (self.lower[side], &mut self.inside);
        self.undecided.retain_mut(|undecided| {
            let coordinate = sides.coordinate(undecided.point as usize, side);
            if from < coordinate && coordinate <= at {
                undecided.sides -= 1;
                undecided.sum = undecided.sum.wrapping_sub(side as u32);
                *inside += usize::from(undecided.sides == 0);
            }
            undecided.sides > 0
        });
        self.lower[side] = at;
        for cell in [&mut below, &mut self] {
            cell.bound = cell.bound.min(cell.simple_bound(sides));
        }
        parts.extend([below, self]);
    }
}

impl Cell {
    /// Makes the cell of all boxes that can have the largest difference.
    fn root(sides: &Sides, kind: BoxKind) -> Self {
        let all = 0..sides.points();
        let least = |side| all.clone().map(|point| sides.coordinate(point, side)).fold(f64::INFINITY, f64::min);
        let (lower, upper) = match kind {
            BoxKind::Open => {
                (vec![f64::NEG_INFINITY; sides.count()], (0..sides.count()).map(|side| sides.end(side)).collect())
            }
            // If no point supports a side of a closed box, the box can be shrunk there.
            BoxKind::Closed => ((0..sides.count()).map(least).collect(), vec![f64::INFINITY; sides.count()]),
        };
        let mut cell = Self { kind, lower, upper, inside: 0, undecided: Vec::new(), bound: 1.0 };
        let every = all.map(|point| Undecided { point: point as u32, sides: 0, sum: 0 });
        cell.undecided.extend(every);
        cell.sort_out(sides);
        cell.bound = cell.simple_bound(sides);
        cell
    }

    /// Decides again which of the undecided points are inside or outside.
    fn sort_out(&mut self, sides: &Sides) {
        let (lower, upper, inside) = (&self.lower, &self.upper, &mut self.inside);
        self.undecided.retain_mut(|undecided| {
            (undecided.sides, undecided.sum) = (0, 0);
            for side in 0..lower.len() {
                let at = sides.coordinate(undecided.point as usize, side);
                if at >= upper[side] {
                    return false;
                }
                if at > lower[side] {
                    undecided.sides += 1;
                    undecided.sum = undecided.sum.wrapping_add(side as u32);
                }
            }
            *inside += usize::from(undecided.sides == 0);
            undecided.sides > 0
        });
    }

    /// The bound that follows from the cell's largest and smallest box alone.
    fn simple_bound(&self, sides: &Sides) -> f64 {
        match self.kind {
            BoxKind::Open => sides.volume(&self.upper) - sides.share(self.inside),
            BoxKind::Closed => sides.share(self.inside + self.undecided.len()) - sides.volume(&self.lower),
        }
    }

    /// Takes away the ends of the cell that hold no box above the threshold, as long as that decides points.
    fn shrink(&mut self, sides: &Sides, threshold: f64) {
        // The margin is far more than the rounding of a product and two quotients.
        let margin = (sides.count() + 8) as f64 * 4.0 * f64::EPSILON;
        loop {
            self.bound = self.bound.min(self.simple_bound(sides));
            if self.bound <= threshold || self.undecided.is_empty() {
                return;
            }
            let mut moved = false;
            for side in 0..sides.count() {
                let axis = side / sides.per_axis();
                match self.kind {
                    BoxKind::Open => {
                        let across = sides.volume_across(axis, &self.upper);
                        let width = (threshold + sides.share(self.inside)) / across;
                        let least = sides.position(side, width * (1.0 - margin), &self.upper) - margin;
                        if least > self.lower[side] {
                            self.lower[side] = least;
                            moved = true;
                        }
                    }
                    BoxKind::Closed => {
                        let across = sides.volume_across(axis, &self.lower);
                        let width = (sides.share(self.inside + self.undecided.len()) - threshold) / across;
                        let most = sides.position(side, width * (1.0 + margin), &self.lower) + margin;
                        if most < self.upper[side] {
                            self.upper[side] = most;
                            moved = true;
                        }
                    }
                }
            }
            let (inside, undecided) = (self.inside, self.undecided.len());
            if moved {
                self.sort_out(sides);
            }
            if (inside, undecided) == (self.inside, self.undecided.len()) {
                return;
            }
        }
    }

    /// Fills the profiles with the undecided points.
    fn profile(&self, sides: &Sides, budget: usize, threshold: f64, scratch: &mut Scratch) -> Profiled {
        scratch.profiles.resize_with(sides.count(), Vec::new);
        scratch.profiles.iter_mut().for_each(Vec::clear);
        let mut profiled = Profiled { several: false, again: 0 };
        // The ratio of volumes at or below which an open box is not above the threshold.
        let margin = (sides.count() + 8) as f64 * 4.0 * f64::EPSILON;
        let least = (threshold + sides.share(self.inside)) / sides.volume(&self.upper) * (1.0 - margin);
        for undecided in &self.undecided {
            let point = undecided.point as usize;
            if undecided.sides == 1 {
                let side = undecided.sum as usize;
                scratch.profiles[side].push(sides.coordinate(point, side));
                continue;
            }
            profiled.several = true;
            match self.kind {
                BoxKind::Closed => {
                    let side = self.costliest(sides, point);
                    scratch.profiles[side].push(sides.coordinate(point, side));
                }
                BoxKind::Open
                    if profiled.again < AGAIN_PER_BUDGET * budget && self.is_cut_away_once(sides, point, least) =>
                {
                    for side in 0..sides.count() {
                        let coordinate = sides.coordinate(point, side);
                        if coordinate > self.lower[side] {
                            scratch.profiles[side].push(coordinate);
                        }
                    }
                    profiled.again += undecided.sides as usize - 1;
                }
                BoxKind::Open => {}
            }
        }
        let budget = budget + profiled.again;
        for (side, profile) in scratch.profiles.iter_mut().enumerate() {
            match self.kind {
                BoxKind::Open => {
                    profile.sort_unstable_by(f64::total_cmp);
                    profile.push(self.upper[side]);
                }
                BoxKind::Closed => {
                    profile.sort_unstable_by(|a, b| b.total_cmp(a));
                    profile.push(self.lower[side]);
                }
            }
            profile.truncate(budget + 1);
        }
        profiled
    }

    /// Returns `true` if no open box with at least the share `least` of the largest box's volume leaves a point out
    /// along two sides.
    fn is_cut_away_once(&self, sides: &Sides, point: usize, least: f64) -> bool {
        let (mut first, mut second) = (0.0, 0.0);
        for side in 0..sides.count() {
            let coordinate = sides.coordinate(point, side);
            if coordinate > self.lower[side] {
                let width = sides.width(side / sides.per_axis(), &self.upper);
                let kept = 1.0 - (self.upper[side] - coordinate) / width;
                if kept > first {
                    (first, second) = (kept, first);
                } else if kept > second {
                    second = kept;
                }
            }
        }
        first * second <= least
    }

    /// The undecided side along which the smallest box must widen most to take in a point.
    fn costliest(&self, sides: &Sides, point: usize) -> usize {
        let (mut most, mut costliest) = (f64::NEG_INFINITY, 0);
        for side in 0..sides.count() {
            let wider = sides.coordinate(point, side) - self.lower[side];
            if wider > 0.0 {
                let width = sides.width(side / sides.per_axis(), &self.lower);
                let cost = wider / (width + f64::MIN_POSITIVE);
                if cost > most {
                    (most, costliest) = (cost, side);
                }
            }
        }
        costliest
    }

    /// Computes the volumes from the profiles of the sides.
    fn combine(
        &self,
        sides: &Sides,
        budget: usize,
        scratch: &mut Scratch,
        worst: f64,
        better: impl Fn(f64, f64) -> f64 + Copy,
    ) {
        let Scratch { profiles, volumes, widths, next, .. } = scratch;
        for (axis, profiles) in profiles.chunks_exact(sides.per_axis()).enumerate() {
            let widths: &[f64] = match profiles {
                [below, above] => {
                    convolve(below, above, budget, widths, worst, better, |a, b| a + b);
                    widths.iter_mut().for_each(|width| *width = greatest(*width, 0.0));
                    widths
                }
                _ => &profiles[0],
            };
            if axis == 0 {
                volumes.clear();
                volumes.extend_from_slice(widths);
            } else {
                convolve(volumes, widths, budget, next, worst, better, |a, b| a * b);
                std::mem::swap(volumes, next);
            }
        }
    }

    /// The side and the coordinate of a cut: the side with the most points that are undecided along several sides, at
    /// the median of these points. If there are no such points, but too many points for a relaxation, all undecided
    /// points count.
    fn cut(&self, sides: &Sides, scratch: &mut Scratch) -> (usize, f64) {
        let least = if self.undecided.iter().any(|undecided| undecided.sides > 1) { 2 } else { 1 };
        let several = || self.undecided.iter().filter(|undecided| undecided.sides >= least);
        let coordinate = |undecided: &Undecided, side| sides.coordinate(undecided.point as usize, side);
        let count =
            |&side: &usize| several().filter(|undecided| coordinate(undecided, side) > self.lower[side]).count();
        let side = (0..sides.count()).max_by_key(count).expect("a side");
        let coordinates = &mut scratch.coordinates;
        coordinates.clear();
        coordinates.extend(several().map(|undecided| coordinate(undecided, side)).filter(|x| *x > self.lower[side]));
        let middle = coordinates.len() / 2;
        let (_, &mut at, _) = coordinates.select_nth_unstable_by(middle, f64::total_cmp);
        (side, at)
    }
}

/// Sets `result[i + j] = join(a[i], b[j])` for sums up to `budget`. If several pairs have the same sum, the best
/// counts.
fn convolve(
    a: &[f64],
    b: &[f64],
    budget: usize,
    result: &mut Vec<f64>,
    worst: f64,
    better: impl Fn(f64, f64) -> f64,
    join: impl Fn(f64, f64) -> f64,
) {
    result.clear();
    result.resize((a.len() + b.len() - 1).min(budget + 1), worst);
    for (j, &b) in b.iter().enumerate() {
        for (result, &a) in result[j..].iter_mut().zip(a) {
            *result = better(join(a, b), *result);
        }
    }
}
