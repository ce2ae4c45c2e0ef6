//! The boxes in the plane, as regions of boxes whose left and right sides are in two strips.
//!
//! For a fixed left and right side, the best bottom and top of a box follow from one pass over the points in the order
//! of y. A box is then a part of the sequence of points and of gaps between their y, and its difference is the sum of
//! weights of these points and gaps. For closed boxes, a point weighs 1, and a gap weighs minus its height times the
//! width of the box times the number `n` of all points. For open boxes all signs are reversed.
//!
//! A point in neither strip is inside all boxes of a region along x, or outside of all. The region therefore keeps only
//! the points in the strips one by one, and a run of points and gaps between them. So regions with narrow strips are
//! cheap, and most of them need not be cut, because they hold no large difference.
//!
//! Strips are cut until they hold fewer points than a part of the largest difference. There are O(n^2) pairs of sides,
//! and a pair that is looked at alone takes O(n). For evenly spread points few pairs are: twice as many Halton points
//! take some five times as long.

use super::plane::Plane;
use super::run::{LargestSum, NODES, Parts, Run, Weights, Width};
use crate::ordered::{greatest, least};
use crate::star::{BoxKind, Region, Relaxed};
use std::ops::Range;

/// The boxes of one kind whose left side is in one strip, and whose right side is in another strip.
pub(super) struct Strips {
    kind: BoxKind,
    ends: Ends,
    /// The least and the greatest width of a box.
    widths: [f64; 2],
    /// The points of the strips in the order of y, by the places of their x, with the run above each point. The first
    /// run has no point; its place is [`NO_POINT`].
    runs: Vec<(u32, Run)>,
    bound: f64,
}

/// The place of a point that does not exist, which is in no strip.
const NO_POINT: u32 = u32::MAX;

/// The places of the positions that the left sides and the right sides of boxes may take. The two ranges are the same
/// or have no place in common.
struct Ends {
    left: Range<u32>,
    right: Range<u32>,
}

/// A point of the strips of a region, relative to a part of the region.
struct Relative {
    /// `true` if some boxes of the part hold the point along x, and others do not.
    is_undecided: bool,
    /// The weight of the point in the most favourable case.
    weight: f64,
    /// The price of the point, which is 0 if the point is decided.
    price: f64,
}

impl Ends {
    /// Returns the parts: each range with more than one place is cut into halves.
    fn parts(&self) -> impl Iterator<Item = Self> + use<> {
        let halves = |range: &Range<u32>| {
            let middle = range.start.midpoint(range.end);
            [range.start..middle, middle..range.end]
        };
        let [lefts, rights] = [halves(&self.left), halves(&self.right)];
        let pairs =
            lefts.into_iter().flat_map(move |left| rights.clone().map(|right| Self { left: left.clone(), right }));
        pairs.filter(|ends| !ends.left.is_empty() && !ends.right.is_empty() && ends.left.start <= ends.right.start)
    }

    /// Returns `true` if the two ranges have no place in common.
    fn are_apart(&self) -> bool {
        self.left != self.right
    }

    /// Returns the least and the greatest width of a box.
    fn widths(&self, plane: &Plane) -> [f64; 2] {
        [plane.width(self.left.end - 1, self.right.start), plane.width(self.left.start, self.right.end - 1)]
    }

    /// Returns the places of the points that are inside all boxes along x, and the places of the points that are
    /// inside some boxes.
    fn inside(&self, kind: BoxKind) -> [Range<u32>; 2] {
        // Open boxes leave out the points on their faces.
        let face = u32::from(kind == BoxKind::Open);
        [
            self.left.end - 1 + face..(self.right.start + 1).saturating_sub(face),
            self.left.start + face..self.right.end.saturating_sub(face),
        ]
    }
}

impl Strips {
    /// Returns a width as its share of the way from the least to the greatest width of a box.
    fn width(&self, width: f64) -> Width {
        let [narrowest, widest] = self.widths;
        let share = if widest > narrowest { (width - narrowest) / (widest - narrowest) } else { 0.0 };
        Width::at(share.clamp(0.0, 1.0))
    }

    /// Returns the points relative to a part of the region, as a function of their places.
    fn relative_to<'a>(&self, part: &Ends, plane: &'a Plane) -> impl Fn(u32) -> Relative + use<'a> {
        let [all, some] = part.inside(self.kind);
        // For points outside, inside and undecided.
        let weights = match self.kind {
            BoxKind::Open => [0.0, -1.0, 0.0],
            BoxKind::Closed => [0.0, 1.0, 1.0],
        };
        let (are_apart, is_closed) = (part.are_apart(), self.kind == BoxKind::Closed);
        let middle = part.left.end;
        move |place| {
            let is_inside = all.contains(&place);
            let is_undecided = some.contains(&place) & !is_inside;
            let weight = weights[usize::from(is_inside) + 2 * usize::from(is_undecided)];
            // A closed box pays for the gap between the point and the other side.
            let is_above = (place < middle) == is_closed;
            let price = if is_undecided & are_apart { plane.price(place, is_above) } else { 0.0 };
            Relative { is_undecided, weight, price }
        }
    }

    /// Returns an upper bound on the difference of every box of a part of the region.
    ///
    /// The bound takes the narrowest closed boxes, or the widest open boxes, with the most favourable weight of each
    /// undecided point. But a closed box is wider by a gap between positions for each position whose points it takes
    /// in, and an open box is narrower by a gap for each position whose points it leaves out. The price of a point is
    /// the number of points that this gap would hold in a set of evenly spread points. A box of height `h` pays `h G`
    /// at least, where `G` is the sum of the prices of undecided points between bottom and top.
    ///
    /// This product is bounded from below by a sum. Let `M` be the sum of all prices, and `E` the largest of `|G - M
    /// h|` over all bottoms and tops. Then `(h - 1/2) (G - M/2) >= -E^2 / (4 M)`, and thus `h G >= G/2 + M h/2 - M/4 -
    /// E^2 / (4 M)`: the box pays half a price for each undecided point, and `M/2` for its height. This holds for any
    /// `M`, and therefore for a rounded sum, too.
    fn bound_of(&self, part: &Ends, plane: &Plane) -> f64 {
        let relative = self.relative_to(part, plane);
        let total = self.total_price(part, plane);
        let [narrowest, widest] = part.widths(plane);
        let paid = total / 2.0 / plane.n;
        let width = self.width(match self.kind {
            BoxKind::Open => widest - paid,
            BoxKind::Closed => narrowest + paid,
        });
        let mut sum = LargestSum::default();
        // `G - M h` from 0 up to the current y, and its extremes, whose difference is `E`.
        let (mut excess, mut lowest, mut highest) = (0.0, 0.0, 0.0);
        for (place, run) in &self.runs {
            let point = relative(*place);
            sum.add(point.weight - point.price / 2.0);
            sum.add_run(run, width);
            excess += point.price;
            highest = greatest(highest, excess);
            excess -= total * run.height;
            lowest = least(lowest, excess);
        }
        let range = highest - lowest;
        let unpaid = if total > 0.0 { total / 4.0 + range * range / (4.0 * total) } else { 0.0 };
        plane.difference(sum.any + unpaid)
    }

    /// Returns the sum of the prices of all undecided points of a part of the region.
    fn total_price(&self, part: &Ends, plane: &Plane) -> f64 {
        if !part.are_apart() {
            return 0.0;
        }
        let [all, some] = part.inside(self.kind);
        let is_closed = self.kind == BoxKind::Closed;
        plane.prices(some.start..all.start, is_closed) + plane.prices(all.end..some.end, !is_closed)
    }

    /// Returns a part of the region.
    fn part(&self, ends: Ends, bound: f64, plane: &Plane) -> Self {
        let widths = ends.widths(plane);
        let nodes = nodes(widths).map(|width| self.width(width));
        let inside = Some(Parts::of(Weights::of(self.kind, plane.n, 0.0).point));
        let relative = self.relative_to(&ends, plane);
        // About half of the points stay undecided.
        let mut runs: Vec<(u32, Run)> = Vec::with_capacity(self.runs.len() / 2 + 1);
        for (place, run) in &self.runs {
            let point = relative(*place);
            match runs.last_mut() {
                Some((_, last)) if !point.is_undecided => {
                    last.append(if point.weight == 0.0 { None } else { inside }, run, &nodes);
                }
                _ => runs.push((*place, run.at_all(&nodes))),
            }
        }
        Self { kind: self.kind, ends, widths, runs, bound }
    }
}

/// Returns the widths at which runs know their parts.
fn nodes([narrowest, widest]: [f64; 2]) -> [f64; NODES] {
    std::array::from_fn(|node| narrowest + (widest - narrowest) * (node as f64 / (NODES - 1) as f64))
}

impl Region for Strips {
    type Points<'a> = Plane;
    type Scratch = Vec<f64>;
    const TIME_TO_THE_END: f64 = 0.6;

    fn all(plane: &Plane) -> Vec<Self> {
        let all = 0..plane.positions.len() as u32;
        BoxKind::BOTH
            .map(|kind| {
                let ends = Ends { left: all.clone(), right: all.clone() };
                let widths = ends.widths(plane);
                let weights = nodes(widths).map(|width| Weights::of(kind, plane.n, width));
                let bottoms = [(NO_POINT, 0.0)].into_iter().chain(plane.points.iter().map(|p| (p.place, p.y)));
                let tops = plane.points.iter().map(|point| point.y).chain([1.0]);
                let runs = bottoms.zip(tops).map(|((place, y), top)| (place, Run::gap(top - y, weights))).collect();
                Self { kind, ends, widths, runs, bound: 1.0 }
            })
            .into()
    }

    fn bound(&self) -> f64 {
        self.bound
    }

    fn size(&self) -> usize {
        // A run takes as much memory as nine numbers.
        9 * self.runs.len()
    }

    fn relax(&mut self, plane: &Plane, threshold: f64, ys: &mut Vec<f64>) -> Relaxed {
        if self.ends.left.len() > 1 || self.ends.right.len() > 1 {
            return Relaxed::Bounded;
        }
        let sides = [self.ends.left.start, self.ends.right.start];
        plane.largest(self.kind, sides, threshold, ys).map_or(Relaxed::Nothing, Relaxed::Solved)
    }

    fn split(self, plane: &Plane, threshold: f64, _: &mut Vec<f64>, parts: &mut Vec<Self>) {
        for ends in self.ends.parts() {
            let bound = self.bound_of(&ends, plane).min(self.bound);
            if bound > threshold {
                parts.push(self.part(ends, bound, plane));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::points_in_the_plane;
    use crate::star::{Cell, Sides, largest_difference};
    use crate::{Bracket, Deadline, PointSet};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn strips_find_what_the_general_search_finds(points in points_in_the_plane(60)) {
            let sides = Sides::of_all_boxes(&points);
            let searched = largest_difference::<Cell>(&sides, &sides, Deadline::never());
            prop_assert!(searched.is_exact());
            let found = largest_difference::<Strips>(&Plane::of(&points), &sides, Deadline::never());
            prop_assert_eq!(found, Bracket::exact(searched.lower));
        }
    }

    #[test]
    fn strips_find_what_the_general_search_finds_in_a_lattice_with_many_equal_differences() {
        for n in [256, 500] {
            let points: Vec<[f64; 2]> = (0..n)
                .map(|i: u32| [f64::from(i) / f64::from(n), f64::from(i.reverse_bits() >> 16) / 65_536.0])
                .collect();
            let points = PointSet::new(2, &points).unwrap();
            let sides = Sides::of_all_boxes(&points);
            let searched = largest_difference::<Cell>(&sides, &sides, Deadline::never());
            let found = largest_difference::<Strips>(&Plane::of(&points), &sides, Deadline::never());
            assert_eq!(found, Bracket::exact(searched.lower));
        }
    }
}
