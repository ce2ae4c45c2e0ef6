//! Branch and bound over the orders of points, and over the bounds on differences of their coordinates.

use super::differences::{Differences, UNIT};
use super::order::{Gap, Order};
use super::step::{Split, Step};
use crate::{Deadline, PointSet};
use rayon::prelude::*;
use std::iter;

/// A bound that falls by a smaller share than this does not start another round.
const LEAST_FALL: i64 = 1 << 10;

/// A difference that is known to this many units is not cut any more.
const FINEST: i64 = 1 << 10;

/// The reason why there is no proof.
#[derive(Debug)]
pub(super) enum Stop {
    Time,
    /// These points have a dispersion of about the level or below, to the precision of the search.
    Found(PointSet),
}

/// A search for a proof that no points have a dispersion below a level.
pub(super) struct Search<'a> {
    /// For each number of points: the most volume, in units, of a box that has at most so many points inside.
    pub volumes: &'a [i64],
    pub deadline: Deadline,
}

/// The bounds along all axes.
type Bounds = Vec<Differences>;

impl Search<'_> {
    /// Proves that no points in this order have a dispersion below the level.
    pub fn order(&self, order: &Order, mut bounds: Bounds) -> Result<Vec<Step>, Stop> {
        if self.deadline.passed() {
            return Err(Stop::Time);
        }
        let gaps = order.gaps();
        if !self.narrow(&gaps, &mut bounds) {
            return Ok(vec![Step::Impossible]);
        }
        if order.is_complete() {
            let mut steps = Vec::new();
            return self.places(&gaps, bounds, &mut steps).map(|()| steps);
        }
        let of_child = |(child, beside): &(Order, Vec<(usize, usize)>)| {
            let mut bounds = bounds.clone();
            let placed = beside.iter().zip(&mut bounds[1..]).all(|(&(before, after), bounds)| {
                bounds.demand(child.decided, before, 0) && bounds.demand(after, child.decided, 0)
            });
            if placed { self.order(child, bounds) } else { Ok(vec![Step::Impossible]) }
        };
        let of_children: Vec<Vec<Step>> = order.children().par_iter().map(of_child).collect::<Result<_, Stop>>()?;
        Ok(iter::once(Step::NextPoint).chain(of_children.into_iter().flatten()).collect())
    }

    /// Proves that no points with these bounds have a dispersion below the level. The bounds are narrow already.
    fn places(&self, gaps: &[Gap], bounds: Bounds, steps: &mut Vec<Step>) -> Result<(), Stop> {
        if self.deadline.passed() {
            return Err(Stop::Time);
        }
        let Some(split) = self.split(gaps, &bounds) else { return Err(Stop::Found(middle(&bounds))) };
        steps.push(Step::Split(split));
        let Split { axis, from, to, at } = split;
        for (from, to, bound) in [(from, to, at), (to, from, -at)] {
            let mut part = bounds.clone();
            if part[axis].demand(from, to, bound) && self.narrow(gaps, &mut part) {
                self.places(gaps, part, steps)?;
            } else {
                steps.push(Step::Impossible);
            }
        }
        Ok(())
    }

    /// Narrows the bounds by the volumes of boxes until nothing falls much. Returns false if no points keep the bounds.
    fn narrow(&self, gaps: &[Gap], bounds: &mut Bounds) -> bool {
        loop {
            let mut falls = false;
            for gap in gaps {
                for axis in 0..bounds.len() {
                    let Some(most) = self.most(gap, bounds, axis) else { continue };
                    let (from, to) = gap.ends[axis];
                    let before = bounds[axis].most(from, to);
                    if most < before {
                        if !bounds[axis].demand(from, to, most) {
                            return false;
                        }
                        falls |= before - most > before / LEAST_FALL;
                    }
                }
            }
            if !falls {
                return true;
            }
        }
    }

    /// Returns the greatest length of a box along an axis, by the least lengths along the others.
    fn most(&self, gap: &Gap, bounds: &Bounds, axis: usize) -> Option<i64> {
        let mut most = i128::from(self.volumes[gap.inside]);
        for (other, &(from, to)) in gap.ends.iter().enumerate().filter(|(other, _)| *other != axis) {
            let least = i128::from(bounds[other].least(from, to));
            // A length is at most a unit, so a larger bound says nothing.
            if least <= 0 || most >= i128::from(UNIT) {
                return None;
            }
            most = (most * i128::from(UNIT) + least - 1) / least;
        }
        i64::try_from(most).ok()
    }

    /// Chooses the difference to cut: the least known side of the box that may be the largest above its volume.
    fn split(&self, gaps: &[Gap], bounds: &Bounds) -> Option<Split> {
        let excess = |gap: &Gap| {
            let ends = gap.ends.iter().zip(bounds);
            let volume: f64 = ends.map(|(&(from, to), bounds)| bounds.most(from, to) as f64 / UNIT as f64).product();
            volume * UNIT as f64 / self.volumes[gap.inside] as f64
        };
        let gap = gaps.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)))?;
        let width = |axis: usize| {
            let ((from, to), bounds) = (gap.ends[axis], &bounds[axis]);
            (bounds.most(from, to) - bounds.least(from, to)) as f64 / bounds.most(from, to).max(1) as f64
        };
        let axis = (0..bounds.len()).max_by(|&a, &b| width(a).total_cmp(&width(b)))?;
        let (from, to) = gap.ends[axis];
        let (least, most) = (bounds[axis].least(from, to), bounds[axis].most(from, to));
        (most - least > FINEST).then(|| Split { axis, from, to, at: i64::midpoint(least, most) })
    }
}

/// Returns the points in the middle of narrow bounds.
fn middle(bounds: &Bounds) -> PointSet {
    let along = |bounds: &Differences, point: usize| {
        (bounds.least(0, point) + bounds.most(0, point)) as f64 / (2 * UNIT) as f64
    };
    let points = 1..bounds[0].nodes() - 1;
    let points = points.map(|point| bounds.iter().map(|bounds| along(bounds, point)).collect::<Vec<f64>>());
    PointSet::new(bounds.len(), points).expect("the bounds are those of the cube")
}
