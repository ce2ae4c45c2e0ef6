//! Points in the plane, and the boxes with a given left and right side.

use crate::PointSet;
use crate::star::BoxKind;
use std::ops::Range;

/// The points in the plane in the order of y, and the positions at which sides of boxes may be.
pub(super) struct Plane {
    /// The positions of left and right sides, in ascending order: the x of all points, 0 and 1.
    pub(super) positions: Vec<f64>,
    pub(super) points: Vec<Placed>,
    /// For each position, the price of its points if they pay for the gap below the position, and if they pay for the
    /// gap above the position: the number of points that the gap would hold if all points were evenly spread, per
    /// point at the position; 1 at most.
    prices: Vec<[f64; 2]>,
    /// For each position and for the end, the sums of the prices of all points below.
    prices_below: Vec<[f64; 2]>,
    /// The number of points.
    pub(super) n: f64,
    /// A bound on the rounding of a sum of weights, in points.
    rounding: f64,
}

/// A point by its y, and the place of its x among the positions.
pub(super) struct Placed {
    pub(super) y: f64,
    pub(super) place: u32,
}

impl Plane {
    /// # Panics
    /// The points are not in the plane.
    pub(super) fn of(set: &PointSet) -> Self {
        assert_eq!(set.dims(), 2, "points in the plane");
        let mut positions: Vec<f64> = set.iter().map(|point| point[0]).chain([0.0, 1.0]).collect();
        positions.sort_unstable_by(f64::total_cmp);
        positions.dedup();
        let place = |x: f64| positions.partition_point(|position| *position < x) as u32;
        let mut points: Vec<Placed> = set.iter().map(|point| Placed { y: point[1], place: place(point[0]) }).collect();
        points.sort_unstable_by(|a, b| a.y.total_cmp(&b.y));
        let n = set.len() as f64;
        let mut counts = vec![0.0; positions.len()];
        points.iter().for_each(|point| counts[point.place as usize] += 1.0);
        let prices = prices(&positions, &counts, n);
        let mut prices_below = vec![[0.0; 2]];
        for (prices, count) in prices.iter().zip(&counts) {
            let [below, above] = prices_below[prices_below.len() - 1];
            prices_below.push([below + prices[0] * count, above + prices[1] * count]);
        }
        // A sum adds each point and each gap once or twice. Each of these additions is rounded by half an ulp of n at
        // most, because no number is beyond n. At each cut and for each bound, a run is weighed between values at other
        // widths. The rounding of these weighted means is relative to the run, and all runs together are 2 n at most. The
        // rounding of the widths moves a sum by n times half an ulp of 1. The number of cuts on the way to a region is the
        // logarithm of n.
        let rounding = 8.0 * (n + 100.0) * n * f64::EPSILON;
        Self { positions, points, prices, prices_below, n, rounding }
    }

    /// Returns the width of a box between two positions; 0 if the sides of the box have passed each other.
    pub(super) fn width(&self, left: u32, right: u32) -> f64 {
        (self.positions[right as usize] - self.positions[left as usize]).max(0.0)
    }

    /// Returns the prices of a point for the gap below and for the gap above the position at `place`.
    pub(super) fn prices_at(&self, place: u32) -> [f64; 2] {
        self.prices[place as usize]
    }

    /// Returns the sum of the prices of the points at a range of places.
    pub(super) fn prices(&self, places: Range<u32>, is_above: bool) -> f64 {
        let below = |place: u32| self.prices_below[place as usize][usize::from(is_above)];
        if places.is_empty() { 0.0 } else { below(places.end) - below(places.start) }
    }

    /// Returns an upper bound on a difference, for a sum of weights.
    pub(super) fn difference(&self, weights: f64) -> f64 {
        (weights + self.rounding) / self.n
    }

    /// Returns the largest difference of a box with a left side and a right side at the given places; `None` if no
    /// difference is above the threshold.
    pub(super) fn largest(&self, kind: BoxKind, sides: [u32; 2], threshold: f64, ys: &mut Vec<f64>) -> Option<f64> {
        let [left, right] = sides;
        let width = self.width(left, right);
        let face = u32::from(kind == BoxKind::Open);
        let along = left + face..(right + 1).saturating_sub(face);
        ys.clear();
        ys.extend(self.points.iter().filter(|point| along.contains(&point.place)).map(|point| point.y));
        match kind {
            BoxKind::Open => {
                ys.insert(0, 0.0);
                ys.push(1.0);
                self.largest_open(width, ys, threshold)
            }
            BoxKind::Closed => self.largest_closed(width, ys, threshold),
        }
    }

    /// The largest difference of closed boxes with these points along x.
    fn largest_closed(&self, width: f64, ys: &[f64], threshold: f64) -> Option<f64> {
        let (mut sum, mut first, mut most) = (0.0, 0, None);
        for top in 0..ys.len() {
            if top > 0 {
                sum -= self.n * width * (ys[top] - ys[top - 1]);
            }
            if sum < -self.rounding {
                // A box that reaches below this gap has a smaller difference than without the part below the gap.
                first = top;
            }
            sum = f64::max(sum, 0.0) + 1.0;
            if self.difference(sum) <= most.unwrap_or(threshold) {
                continue;
            }
            for bottom in first..=top {
                let value = (top + 1 - bottom) as f64 / self.n - width * (ys[top] - ys[bottom]);
                if value > most.unwrap_or(threshold) {
                    most = Some(value);
                }
            }
        }
        most
    }

    /// The largest difference of open boxes with these points along x, between 0 and 1.
    fn largest_open(&self, width: f64, ys: &[f64], threshold: f64) -> Option<f64> {
        let (mut sum, mut first, mut most) = (0.0, 0, None);
        for top in 1..ys.len() {
            if top > 1 {
                sum -= 1.0;
            }
            if sum < -self.rounding {
                // A box that takes in the point below has a smaller difference than without the part up to the point.
                first = top - 1;
            }
            sum = f64::max(sum, 0.0) + self.n * width * (ys[top] - ys[top - 1]);
            if self.difference(sum) <= most.unwrap_or(threshold) {
                continue;
            }
            for bottom in first..top {
                let value = width * (ys[top] - ys[bottom]) - (top - 1 - bottom) as f64 / self.n;
                if value > most.unwrap_or(threshold) {
                    most = Some(value);
                }
            }
        }
        most
    }
}

/// The prices of the points at each position.
fn prices(positions: &[f64], counts: &[f64], n: f64) -> Vec<[f64; 2]> {
    let gaps = positions.windows(2).map(|pair| pair[1] - pair[0]);
    let (below, above) = ([0.0].into_iter().chain(gaps.clone()), gaps.chain([0.0]));
    let price = |gap: f64, count: f64| f64::min(n * gap / count, 1.0);
    below.zip(above).zip(counts).map(|((below, above), count)| [price(below, *count), price(above, *count)]).collect()
}
