//! Finds large differences by local search: from a random box, one side after the other moves to its best position,
//! until no side can do better. Threshold accepting (Gnewuch, Wahlstrom, Winzen, A new randomized algorithm to
//! approximate the star discrepancy based on threshold accepting, SIAM J. Numer. Anal. 50, 2012) tries a few
//! neighbours. This search looks at all positions of a side at once, which takes no longer than counting the points
//! of one box.

use super::region::BoxKind;
use super::sides::Sides;
use crate::Deadline;

/// A local search for the box with the largest difference between volume and share of points.
pub(super) struct Ascent<'a> {
    sides: &'a Sides<'a>,
    /// For each side, the points in the order of their coordinates.
    orders: Vec<Vec<u32>>,
    /// The current box, and for each point the number of sides along which it is outside the box.
    positions: Vec<f64>,
    outside: Vec<u32>,
}

impl<'a> Ascent<'a> {
    /// The greatest number of coordinates for ascents: to sort more takes too much memory, so the other search works
    /// alone.
    const MOST_COORDINATES: usize = 1 << 26;
    /// The number of coordinates up to which an ascent takes almost no time. It is then made even if no time is left.
    const FEW_COORDINATES: usize = 1 << 16;

    pub(super) fn new(sides: &'a Sides<'a>) -> Self {
        Self { sides, orders: Vec::new(), positions: vec![0.0; sides.count()], outside: vec![0; sides.points()] }
    }

    /// Returns the largest difference that the ascents with the given numbers find until the deadline.
    pub(super) fn run(&mut self, ascents: std::ops::Range<usize>, deadline: Deadline) -> f64 {
        let coordinates = self.sides.points() * self.sides.count();
        if coordinates > Self::MOST_COORDINATES {
            return 0.0;
        }
        for side in self.orders.len()..self.sides.count() {
            if coordinates > Self::FEW_COORDINATES && deadline.passed() {
                return 0.0;
            }
            self.orders.push(self.order(side));
        }
        let mut best = 0.0f64;
        for ascent in ascents {
            let mut random = SplitMix(ascent as u64);
            let kind = if ascent % 2 == 0 { BoxKind::Open } else { BoxKind::Closed };
            self.start(&mut random, kind);
            best = best.max(self.climb(kind, deadline));
            if deadline.passed() {
                break;
            }
        }
        best
    }

    fn order(&self, side: usize) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.sides.points() as u32).collect();
        let coordinate = |point: &u32| self.sides.coordinate(*point as usize, side);
        order.sort_by(|a, b| coordinate(a).total_cmp(&coordinate(b)));
        order
    }

    /// Takes a random box whose volume is roughly evenly distributed.
    fn start(&mut self, random: &mut SplitMix, kind: BoxKind) {
        let dims = self.sides.count() / self.sides.per_axis();
        for axis in 0..dims {
            let width = libm::pow(random.next(), 1.0 / dims as f64);
            if self.sides.per_axis() == 1 {
                self.positions[axis] = width;
            } else {
                let lower = random.next() * (1.0 - width);
                (self.positions[2 * axis], self.positions[2 * axis + 1]) = (-lower, lower + width);
            }
        }
        for (point, outside) in self.outside.iter_mut().enumerate() {
            let is_outside = |&side: &usize| beyond(self.sides.coordinate(point, side), self.positions[side], kind);
            *outside = (0..self.sides.count()).filter(is_outside).count() as u32;
        }
    }

    /// Moves sides until each is at its best position or the deadline has passed. Returns the difference.
    fn climb(&mut self, kind: BoxKind, deadline: Deadline) -> f64 {
        let mut best = f64::NEG_INFINITY;
        let mut unmoved = 0;
        for side in (0..self.sides.count()).cycle() {
            let (value, position) = self.best_position(side, kind);
            if value > best {
                best = value;
                unmoved = 0;
                self.place(side, position, kind);
            } else {
                unmoved += 1;
            }
            if unmoved >= self.sides.count() || deadline.passed_after(self.sides.points() * self.sides.count()) {
                break;
            }
        }
        best
    }

    /// The best position of a side while the others stay, and the difference at this position.
    fn best_position(&self, side: usize, kind: BoxKind) -> (f64, f64) {
        let sides = self.sides;
        let mut positions = self.positions.clone();
        let mut best = (f64::NEG_INFINITY, positions[side]);
        let mut consider = |position: f64, count: usize| {
            positions[side] = position;
            // In the order of the axes, as everywhere.
            let volume = sides.volume(&positions);
            let value = match kind {
                BoxKind::Open => volume - sides.share(count),
                BoxKind::Closed => sides.share(count) - volume,
            };
            if value > best.0 {
                best = (value, position);
            }
        };
        let mut count = 0;
        for &point in &self.orders[side] {
            let coordinate = sides.coordinate(point as usize, side);
            let here = u32::from(beyond(coordinate, self.positions[side], kind));
            if self.outside[point as usize] > here {
                continue;
            }
            match kind {
                BoxKind::Open => {
                    consider(coordinate.min(sides.end(side)), count);
                    count += 1;
                }
                BoxKind::Closed => {
                    count += 1;
                    consider(coordinate, count);
                }
            }
        }
        if kind == BoxKind::Open {
            // A point at the end of the cube is in no open box.
            let at_end = |point: &&u32| sides.coordinate(**point as usize, side) >= sides.end(side);
            let ending = self.orders[side].iter().rev().take_while(at_end);
            let inside = |point: &&u32| {
                let here = u32::from(beyond(sides.coordinate(**point as usize, side), self.positions[side], kind));
                self.outside[**point as usize] <= here
            };
            consider(sides.end(side), count - ending.filter(inside).count());
        }
        best
    }

    /// Moves a side.
    fn place(&mut self, side: usize, position: f64, kind: BoxKind) {
        let from = std::mem::replace(&mut self.positions[side], position);
        for (point, outside) in self.outside.iter_mut().enumerate() {
            let coordinate = self.sides.coordinate(point, side);
            *outside -= u32::from(beyond(coordinate, from, kind));
            *outside += u32::from(beyond(coordinate, position, kind));
        }
    }
}

/// Returns `true` if a coordinate is outside a box along a side.
fn beyond(coordinate: f64, position: f64, kind: BoxKind) -> bool {
    match kind {
        BoxKind::Open => coordinate >= position,
        BoxKind::Closed => coordinate > position,
    }
}

/// Random numbers in `[0, 1)` (Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64) / (1u64 << 53) as f64
    }
}
