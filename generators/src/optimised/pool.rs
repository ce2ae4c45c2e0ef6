//! The boxes that have been bad, with their differences, so that a move can be judged without a search.

use super::spots::{Corner, Spots};
use std::collections::HashSet;

/// The most boxes that are kept: when there are more, those with small differences go.
const MOST: usize = 6000;

/// A set of boxes, each with its difference. The faces of the boxes move with their points.
#[derive(Debug, Clone)]
pub(super) struct Pool {
    corners: Vec<Corner>,
    counts: Vec<u32>,
    differences: Vec<f64>,
    /// The position of the face of each box, by axis.
    positions: Vec<Vec<f64>>,
    known: HashSet<Corner>,
    /// Boxes that are added once it is clear whether the last move counts.
    later: Vec<Corner>,
    /// The boxes that the last move has changed, each with its count and its difference before.
    changed: Vec<(usize, u32, f64)>,
}

impl Pool {
    pub fn new(dims: usize) -> Self {
        Self {
            corners: Vec::new(),
            counts: Vec::new(),
            differences: Vec::new(),
            positions: vec![Vec::new(); dims],
            known: HashSet::new(),
            later: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// Returns the same boxes for other points.
    pub fn moved_to(self, spots: &Spots) -> Self {
        let mut moved = Self::new(spots.dims());
        self.corners.into_iter().chain(self.later).for_each(|corner| moved.add(spots, corner));
        moved.sort();
        moved
    }

    /// Adds a box, unless it is there.
    pub fn add(&mut self, spots: &Spots, corner: Corner) {
        if self.known.contains(&corner) {
            return;
        }
        self.known.insert(corner.clone());
        self.push(spots, corner);
    }

    fn push(&mut self, spots: &Spots, corner: Corner) {
        let count = spots.count(&corner);
        let share = count as f64 / spots.len() as f64;
        self.counts.push(count as u32);
        self.differences.push(corner.kind.difference(spots.volume(&corner), share));
        for (axis, positions) in self.positions.iter_mut().enumerate() {
            positions.push(spots.at(axis, corner.faces[axis]));
        }
        self.corners.push(corner);
    }

    /// Returns the box with the largest difference.
    pub fn worst(&self) -> Option<&Corner> {
        let level = self.level();
        let worst = self.differences.iter().position(|&difference| difference >= level)?;
        Some(&self.corners[worst])
    }

    /// Returns the largest difference of a box; 0 without boxes.
    pub fn level(&self) -> f64 {
        self.differences.iter().fold(0.0, |level, &difference| if difference > level { difference } else { level })
    }

    /// Returns the boxes with the largest differences.
    pub fn worst_ones(&self, number: usize) -> Vec<Corner> {
        let mut order: Vec<usize> = (0..self.corners.len()).collect();
        let by_difference = |i: &usize, k: &usize| self.differences[*k].total_cmp(&self.differences[*i]);
        if number < order.len() {
            order.select_nth_unstable_by(number, by_difference);
            order.truncate(number);
        }
        order.into_iter().map(|at| self.corners[at].clone()).collect()
    }

    /// Follows the move of a point along an axis, which `spots` has already made. Returns false as soon as a difference is above the limit.
    pub fn follow(&mut self, spots: &Spots, axis: usize, point: u32, before: f64, limit: f64) -> bool {
        self.changed.clear();
        let after = spots.at(axis, point);
        let (low, high) = if before < after { (before, after) } else { (after, before) };
        let points = spots.len() as f64;
        for at in 0..self.corners.len() {
            let position = self.positions[axis][at];
            if position < low || position > high {
                continue;
            }
            let corner = &self.corners[at];
            let count = if corner.faces[axis] == point {
                self.positions[axis][at] = after;
                let passed = spots.count_between(corner, axis, (low, high), point);
                if after > before { self.counts[at] as usize + passed } else { self.counts[at] as usize - passed }
            } else {
                let was_in = !corner.kind.is_beyond(before, position);
                let is_in = !corner.kind.is_beyond(after, position);
                let is_beside = |other: usize| {
                    other == axis || !corner.kind.is_beyond(spots.at(other, point), self.positions[other][at])
                };
                if was_in == is_in || !(0..spots.dims()).all(is_beside) {
                    continue;
                }
                self.counts[at] as usize + usize::from(is_in) - usize::from(was_in)
            };
            self.changed.push((at, self.counts[at], self.differences[at]));
            self.counts[at] = count as u32;
            let volume: f64 = self.positions.iter().map(|positions| positions[at]).product();
            self.differences[at] = corner.kind.difference(volume, count as f64 / points);
            if self.differences[at] > limit {
                return false;
            }
        }
        true
    }

    /// Adds a box at the next call of `settle`.
    pub fn add_later(&mut self, corner: Corner) {
        if !self.known.contains(&corner) {
            self.later.push(corner);
        }
    }

    /// Adds the boxes that waited, and lets boxes with small differences go if there are too many.
    pub fn settle(&mut self, spots: &Spots) {
        for corner in std::mem::take(&mut self.later) {
            self.add(spots, corner);
        }
        if self.corners.len() > MOST {
            self.sort();
        }
    }

    /// Takes the last move back, which `spots` has already taken back.
    pub fn undo(&mut self, spots: &Spots, axis: usize) {
        for (at, count, difference) in self.changed.drain(..) {
            self.counts[at] = count;
            self.differences[at] = difference;
            self.positions[axis][at] = spots.at(axis, self.corners[at].faces[axis]);
        }
    }

    /// Puts the worst boxes first, and lets boxes with small differences go if there are too many.
    pub fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.corners.len()).collect();
        order.sort_unstable_by(|&i, &k| self.differences[k].total_cmp(&self.differences[i]));
        if order.len() > MOST {
            order.drain(MOST / 2..).for_each(|at| {
                self.known.remove(&self.corners[at]);
            });
        }
        let taken = |numbers: &[f64]| order.iter().map(|&at| numbers[at]).collect::<Vec<f64>>();
        self.differences = taken(&self.differences);
        self.positions = self.positions.iter().map(|positions| taken(positions)).collect();
        self.counts = order.iter().map(|&at| self.counts[at]).collect();
        self.corners = order.iter().map(|&at| self.corners[at].clone()).collect();
        self.changed.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};
    use rand::Rng;

    #[test]
    fn a_pool_that_follows_moves_has_the_differences_of_its_boxes() {
        let mut rng = seeded(5, Purpose::Search, 0);
        for dims in [2, 3, 5] {
            let n = 12;
            let points: Vec<Vec<f64>> = (0..n).map(|_| (0..dims).map(|_| rng.random()).collect()).collect();
            let mut spots = Spots::new(&points, dims);
            let mut pool = Pool::new(dims);
            for _ in 0..60 {
                let corner = spots.random_corner(&mut rng);
                pool.add(&spots, corner);
            }
            for step in 0..400 {
                let (axis, point) = (rng.random_range(0..dims), rng.random_range(0..n as u32));
                let before = spots.at(axis, point);
                // Coordinates that other points have are the hard ones.
                let to = if step % 3 == 0 { spots.at(axis, rng.random_range(0..n as u32)) } else { rng.random() };
                spots.place(axis, point, to);
                let limit = if step % 4 == 0 { 0.2 } else { 2.0 };
                if !pool.follow(&spots, axis, point, before, limit) {
                    spots.place(axis, point, before);
                    pool.undo(&spots, axis);
                }
                if step % 50 == 0 {
                    pool.sort();
                }
                for (corner, difference) in pool.corners.iter().zip(&pool.differences) {
                    let share = spots.count(corner) as f64 / n as f64;
                    let known = corner.kind.difference(spots.volume(corner), share);
                    assert!((known - difference).abs() < 1e-12, "{corner:?} after {step} moves");
                }
            }
        }
    }
}
