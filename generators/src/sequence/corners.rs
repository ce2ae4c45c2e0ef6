//! Random corners: the baseline that a search for failures should beat.
//!
//! Many benchmarks fail if every input is at one of its ends. A search that finds failures only because it goes to
//! the ends is no better than this strategy, which puts every coordinate independently at a random end.

use super::Sequence;
use super::uniform::Uniform;
use crate::strategy::{ANY, Descriptor, Endless, Look, MarkShape, Method, MethodKind, Strategy};

impl Strategy {
    /// The strategy "random-corners", which takes random corners of the cube as a baseline for searches. Corners
    /// repeat.
    pub const RANDOM_CORNERS: Self = Self::of(&Descriptor {
        name: "random-corners",
        about: "every parameter at a random end: the baseline that a search for failures should beat",
        dims: ANY,
        look: Look::hollow(0x99_9999, MarkShape::Triangle),
        method: Method(MethodKind::Sequence(Endless {
            first: None,
            plain: false,
            fills: false,
            build: |dims, seed| Box::new(RandomCorners::new(dims, seed.unwrap_or(0))),
        })),
    });
}

/// A sequence of random corners, which are the corners nearest to uniformly random points.
pub(crate) struct RandomCorners(Uniform);

impl RandomCorners {
    pub(crate) fn new(dims: usize, seed: u64) -> Self {
        Self(Uniform::new(dims, seed))
    }
}

impl Sequence for RandomCorners {
    fn len(&self) -> u64 {
        self.0.len()
    }

    fn point(&self, index: u64) -> Vec<f64> {
        self.0.point(index).into_iter().map(|u| if u < 0.5 { 0.0 } else { 1.0_f64.next_down() }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_coordinate_is_by_itself_at_one_of_its_ends() {
        let corners = RandomCorners::new(3, 1);
        let seen: BTreeSet<Vec<bool>> =
            (0..100).map(|index| corners.point(index).into_iter().map(|u| u > 0.5).collect()).collect();
        assert_eq!(seen.len(), 8);
        assert!((0..100).flat_map(|index| corners.point(index)).all(|u| u == 0.0 || (u < 1.0 && u > 0.999)));
    }
}
