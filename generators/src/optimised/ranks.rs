//! The order of points in the plane along both axes, without their coordinates.

use rand::Rng;
use std::ops::Range;

/// The order of n points along both axes. Point i is the i-th point from the left, and its rank is its position from below.
#[derive(Debug, Clone)]
pub(super) struct Ranks {
    rank: Vec<usize>,
    /// The point with each rank.
    at: Vec<usize>,
    /// For i and j from 0 to n, at `i * (n + 1) + j`: the number of points left of point i with a rank below j. Such
    /// numbers are exact, and take half the memory of wider ones.
    counts: Vec<f32>,
}

impl Ranks {
    /// Makes the order of points. Points with equal coordinates are in the order of their positions.
    pub fn of(points: &[[f64; 2]]) -> Self {
        let order = |axis: usize| {
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&i, &k| points[i][axis].total_cmp(&points[k][axis]));
            order
        };
        let mut height = vec![0; points.len()];
        order(1).into_iter().enumerate().for_each(|(rank, point)| height[point] = rank);
        Self::new(order(0).into_iter().map(|point| height[point]).collect())
    }

    /// Makes the order of n points from the rank of each point.
    fn new(rank: Vec<usize>) -> Self {
        let width = rank.len() + 1;
        let mut at = vec![0; rank.len()];
        let mut counts = vec![0.0; width];
        for (point, &own) in rank.iter().enumerate() {
            at[own] = point;
            counts.extend_from_within(point * width..);
            counts[(point + 1) * width..][own + 1..].iter_mut().for_each(|count| *count += 1.0);
        }
        Self { rank, at, counts }
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.rank.len()
    }

    /// Returns the rank of a point.
    pub fn rank(&self, point: usize) -> usize {
        self.rank[point]
    }

    /// Returns, for each j from 0 to n, the number of points left of point `i` with a rank below j.
    pub fn counts(&self, i: usize) -> &[f32] {
        let width = self.rank.len() + 1;
        &self.counts[i * width..][..width]
    }

    /// Exchanges the ranks of two points.
    pub fn exchange(&mut self, one: usize, other: usize) {
        let (left, right) = (one.min(other), one.max(other));
        let (before, after) = (self.rank[left], self.rank[right]);
        let (low, high, more) = if before < after { (before, after, -1.0) } else { (after, before, 1.0) };
        let width = self.rank.len() + 1;
        for i in left + 1..=right {
            self.counts[i * width..][low + 1..=high].iter_mut().for_each(|count| *count += more);
        }
        self.rank.swap(left, right);
        self.at.swap(before, after);
    }

    /// Changes the order a little at random: two points that are near each other along an axis exchange their places along the other axis, or a
    /// point moves past some neighbours. Returns the exchanges, of which the last is the first to be undone.
    pub fn change(&mut self, rng: &mut impl Rng) -> Vec<(usize, usize)> {
        let n = self.rank.len();
        let reach = if rng.random() { 1 } else { rng.random_range(1..=FARTHEST.min(n - 1)) };
        let first = rng.random_range(0..n - reach);
        let by_rank: bool = rng.random();
        let mut done = Vec::new();
        let mut exchange = |ranks: &mut Self, one: usize, other: usize| {
            let pair = if by_rank { (ranks.at[one], ranks.at[other]) } else { (one, other) };
            ranks.exchange(pair.0, pair.1);
            done.push(pair);
        };
        let between: Range<usize> = first..first + reach;
        match rng.random_range(0..4) {
            0 | 1 => exchange(self, first, first + reach),
            2 => between.for_each(|i| exchange(self, i, i + 1)),
            _ => between.rev().for_each(|i| exchange(self, i, i + 1)),
        }
        done
    }

    /// Undoes exchanges.
    pub fn undo(&mut self, done: Vec<(usize, usize)>) {
        done.into_iter().rev().for_each(|(one, other)| self.exchange(one, other));
    }
}

/// The largest distance between two points that exchange their places, in points.
const FARTHEST: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};

    #[test]
    fn the_counts_stay_those_of_the_order() {
        let mut rng = seeded(1, Purpose::Search, 0);
        for n in [2, 3, 7, 20] {
            let points: Vec<[f64; 2]> = (0..n).map(|_| [rng.random(), rng.random()]).collect();
            let mut ranks = Ranks::of(&points);
            let begun = ranks.clone();
            let mut all = Vec::new();
            for _ in 0..50 {
                all.extend(ranks.change(&mut rng));
                let anew = Ranks::new(ranks.rank.clone());
                assert!(anew.counts == ranks.counts && anew.at == ranks.at);
                let (i, j) = (rng.random_range(0..=n), rng.random_range(0..=n));
                let naive = (0..i).filter(|&point| ranks.rank(point) < j).count();
                assert_eq!(ranks.counts(i)[j], naive as f32);
            }
            ranks.undo(all);
            assert!(ranks.rank == begun.rank && ranks.counts == begun.counts);
        }
    }
}
