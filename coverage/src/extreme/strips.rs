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
//! take some four times as long.

use super::bounds::bounds;
use super::ends::{Ends, NO_POINT};
use super::lanes::Lanes;
use super::plane::Plane;
use super::run::{Interpolation, NODES, Parts, Run, gap_weight, point_weight};
use crate::star::{BoxKind, Region, Relaxed};

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

impl Strips {
    /// Adds the parts with a bound above the threshold.
    #[inline(always)]
    fn split_into(self, parts: &mut Vec<Self>, plane: &Plane, threshold: f64) {
        let ends: Vec<Ends> = self.ends.parts().collect();
        let bounds = bounds(self.kind, self.widths, &self.runs, &ends, plane);
        for (ends, bound) in ends.into_iter().zip(bounds) {
            let bound = bound.min(self.bound);
            if bound > threshold {
                parts.push(self.part(ends, bound, plane));
            }
        }
    }

    /// Returns a part of the region.
    #[inline(always)]
    fn part(&self, ends: Ends, bound: f64, plane: &Plane) -> Self {
        let widths = ends.widths(plane);
        let at = Interpolation::between(self.widths, nodes(widths));
        let point = point_weight(self.kind);
        let [all, some] = ends.inside(self.kind);
        let (first, rest) = self.runs.split_first().expect("a region has a first run");
        let (mut place, mut current) = (first.0, first.1.at(&at));
        // About half of the points stay undecided.
        let mut runs = Vec::with_capacity(self.runs.len() / 2 + 1);
        for (point_place, run) in rest {
            let is_inside = all.contains(point_place);
            let run = run.at(&at);
            // A point with weight 0 does not change the sums. So the code is the same for points inside and outside.
            let decided = Parts::of(Lanes::all(if is_inside { point } else { 0.0 }));
            let joined = current.parts.followed_by(decided.followed_by(run.parts));
            if is_inside || !some.contains(point_place) {
                current = Run { height: current.height + run.height, parts: joined };
            } else {
                runs.push((place, current));
                (place, current) = (*point_place, run);
            }
        }
        runs.push((place, current));
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
                let weights = nodes(widths).map(|width| gap_weight(kind, plane.n, width));
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
        // A run takes 144 bytes, as much memory as 12 numbers.
        12 * self.runs.len()
    }

    fn relax(&mut self, plane: &Plane, threshold: f64, ys: &mut Vec<f64>) -> Relaxed {
        if self.ends.left.len() > 1 || self.ends.right.len() > 1 {
            return Relaxed::Bounded;
        }
        let sides = [self.ends.left.start, self.ends.right.start];
        plane.largest(self.kind, sides, threshold, ys).map_or(Relaxed::Nothing, Relaxed::Solved)
    }

    fn split(self, plane: &Plane, threshold: f64, _: &mut Vec<f64>, parts: &mut Vec<Self>) {
        // The loops use AVX2 if the processor has it. Each number is rounded the same way without AVX2.
        pulp::Arch::new().dispatch(|| self.split_into(parts, plane, threshold));
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

        #[test]
        fn no_box_of_a_region_has_a_difference_above_the_bound(points in points_in_the_plane(15)) {
            let (plane, mut ys) = (Plane::of(&points), Vec::new());
            let mut open = Strips::all(&plane);
            while let Some(region) = open.pop() {
                for left in region.ends.left.clone() {
                    for right in region.ends.right.clone().filter(|right| left <= *right) {
                        let most = plane.largest(region.kind, [left, right], 0.0, &mut ys).unwrap_or(0.0);
                        prop_assert!(region.bound() >= most, "{} {most}", region.bound());
                    }
                }
                if region.ends.left.len() > 1 || region.ends.right.len() > 1 {
                    region.split(&plane, -1.0, &mut ys, &mut open);
                }
            }
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
