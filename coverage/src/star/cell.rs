//! Cells of boxes, and what no box of a cell exceeds.

use super::sides::{Sides, above_0};

/// Which of the two differences is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BoxKind {
    /// Volume less the share of points inside, of open boxes.
    Open,
    /// Share of points, with those on the faces, less volume, of closed boxes.
    Closed,
}

/// A point that is in some boxes of a cell and not in others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Undecided {
    point: u32,
    /// Along how many sides.
    sides: u32,
    /// The sum of these sides, modulo 2^32: where there is but one, it is that one.
    sum: u32,
}

/// The boxes whose sides are between `lower` and `upper`: `lower < position <= upper` for open boxes and
/// `lower <= position < upper` for closed ones. In both, a point is inside along a side where its coordinate is
/// `<= lower`, and outside where it is `>= upper`.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    lower: Vec<f64>,
    upper: Vec<f64>,
    inside: usize,
    undecided: Vec<Undecided>,
    /// No box of the cell has more.
    pub(super) bound: f64,
}

/// What the relaxation says of a cell.
pub(super) enum Relaxed {
    /// It has no box above the threshold.
    Nothing,
    /// This is the largest value of its boxes.
    Solved(f64),
    /// No box has more than the cell's bound, which is now this low.
    Bounded,
}

/// How the undecided points went into the profiles.
struct Profiled {
    /// Whether some are undecided along several sides.
    several: bool,
    /// How many times points were counted that had been counted along another side.
    again: usize,
}

/// More steps than this, some hundredths of a second, are not spent on one relaxation: cutting the cell gets further.
const MOST_STEPS: usize = 1 << 26;

/// How many times points may be counted again, as a multiple of the number of points that matters.
const AGAIN_PER_BUDGET: usize = 3;

/// Room for the relaxation.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Per side: the positions that take in (open) or leave out (closed) 0, 1, 2, .. of its points.
    profiles: Vec<Vec<f64>>,
    /// Per number of points, the most extreme volume over the axes so far.
    volumes: Vec<f64>,
    widths: Vec<f64>,
    next: Vec<f64>,
    /// Coordinates among which a cut is chosen.
    coordinates: Vec<f64>,
}

impl Cell {
    /// The cell of all boxes that matter.
    pub(super) fn root(sides: &Sides, kind: BoxKind) -> Self {
        let all = 0..sides.points();
        let least = |side| all.clone().map(|point| sides.coordinate(point, side)).fold(f64::INFINITY, f64::min);
        let (lower, upper) = match kind {
            BoxKind::Open => {
                (vec![f64::NEG_INFINITY; sides.count()], (0..sides.count()).map(|side| sides.end(side)).collect())
            }
            // A closed box that no point supports on a side can be shrunk there.
            BoxKind::Closed => ((0..sides.count()).map(least).collect(), vec![f64::INFINITY; sides.count()]),
        };
        let mut cell = Self { lower, upper, inside: 0, undecided: Vec::new(), bound: 1.0 };
        let every = all.map(|point| Undecided { point: point as u32, sides: 0, sum: 0 });
        cell.undecided.extend(every);
        cell.sort_out(sides);
        cell.bound = cell.simple_bound(sides, kind);
        cell
    }

    /// How many numbers the cell consists of.
    pub(super) fn size(&self) -> usize {
        self.undecided.len() + self.lower.len()
    }

    /// Decides the undecided points anew.
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

    /// What follows from the cell's largest and smallest box alone.
    fn simple_bound(&self, sides: &Sides, kind: BoxKind) -> f64 {
        match kind {
            BoxKind::Open => sides.volume(&self.upper) - sides.share(self.inside),
            BoxKind::Closed => sides.share(self.inside + self.undecided.len()) - sides.volume(&self.lower),
        }
    }

    /// Takes away the ends of the cell where no box is above the threshold, as long as that decides points.
    fn shrink(&mut self, sides: &Sides, kind: BoxKind, threshold: f64) {
        // Far more than the rounding of a product and two quotients.
        let margin = (sides.count() + 8) as f64 * 4.0 * f64::EPSILON;
        loop {
            self.bound = self.bound.min(self.simple_bound(sides, kind));
            if self.bound <= threshold || self.undecided.is_empty() {
                return;
            }
            let mut moved = false;
            for side in 0..sides.count() {
                let axis = side / sides.per_axis();
                match kind {
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

    /// Shrinks the cell and bounds it by its relaxation, in which the sides have nothing to do with each other:
    /// what counts is how many points each takes in. A point that is undecided along one side counts there. One
    /// that is so along several counts
    /// * for closed boxes along the side that it would cost most: it is inside only if all take it in;
    /// * for open boxes along all, less the times it is counted again, if no box above the threshold leaves it
    ///   out twice, and else not at all: it is outside at least where exactly one side leaves it out.
    ///
    /// The best choice of positions for each number of points follows by dynamic programming over the axes
    /// (Dobkin, Eppstein, Mitchell, Computing the discrepancy with applications to supersampling patterns, ACM
    /// Trans. Graphics 15, 1996, who subdivide until no point is undecided along several sides). Without such
    /// points it is no relaxation.
    pub(super) fn relax(&mut self, sides: &Sides, kind: BoxKind, threshold: f64, scratch: &mut Scratch) -> Relaxed {
        self.shrink(sides, kind, threshold);
        if self.bound <= threshold {
            return Relaxed::Nothing;
        }
        let room = (self.simple_bound(sides, kind) - threshold) * sides.points() as f64;
        let budget = (room as usize).saturating_add(2).min(self.undecided.len());
        if budget.saturating_mul(budget).saturating_mul(sides.count()) > MOST_STEPS {
            return Relaxed::Bounded;
        }
        let Profiled { several, again } = self.profile(sides, kind, budget, threshold, scratch);
        let (largest, least) = (|a, b| if a > b { a } else { b }, |a, b| if a < b { a } else { b });
        match kind {
            BoxKind::Open => self.combine(sides, budget + again, scratch, f64::NEG_INFINITY, largest),
            BoxKind::Closed => self.combine(sides, budget, scratch, f64::INFINITY, least),
        }
        let (inside, all) = (self.inside, self.inside + self.undecided.len());
        let values = scratch.volumes.iter().enumerate().map(|(count, volume)| match kind {
            // A box that takes in fewer than were counted again would be below the threshold anyway.
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

    /// Fills the profiles.
    fn profile(&self, sides: &Sides, kind: BoxKind, budget: usize, threshold: f64, scratch: &mut Scratch) -> Profiled {
        scratch.profiles.resize_with(sides.count(), Vec::new);
        scratch.profiles.iter_mut().for_each(Vec::clear);
        let mut profiled = Profiled { several: false, again: 0 };
        // The ratio of volumes below which an open box is not above the threshold.
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
            match kind {
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
            match kind {
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

    /// Whether no open box that keeps the share `least` of the largest one's volume leaves a point out along two
    /// sides.
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

    /// The undecided side along which taking in a point widens the smallest box most.
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

    /// From the profiles of the sides to the volumes.
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
                    widths.iter_mut().for_each(|width| *width = above_0(*width));
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

    /// Cuts the cell in two, below and above a coordinate.
    pub(super) fn split(mut self, sides: &Sides, kind: BoxKind, scratch: &mut Scratch) -> [Self; 2] {
        let (side, at) = self.cut(sides, scratch);
        // Below the cut, points at it and beyond are outside; the others stay as undecided as they were.
        let below_it = |undecided: &&Undecided| sides.coordinate(undecided.point as usize, side) < at;
        let mut below = Self {
            lower: self.lower.clone(),
            upper: self.upper.clone(),
            inside: self.inside,
            undecided: self.undecided.iter().filter(below_it).copied().collect(),
            bound: self.bound,
        };
        below.upper[side] = at;
        // Above it, points up to it are inside along this side, and then perhaps along all.
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
            cell.bound = cell.bound.min(cell.simple_bound(sides, kind));
        }
        [below, self]
    }

    /// Where to cut: the side along which most points are undecided that are so along several, at their median. Where
    /// there are none such, but too many for a relaxation, all undecided ones count.
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

/// `result[i + j] = join(a[i], b[j])`, the best where there are several, for sums up to `budget`.
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
