//! The lanes ahead of a car: a list that loses lanes at its beginning and gains lanes at its end.
//!
//! Cars read their lanes at every tick, so the lanes are a slice. Lanes that the car has left stay at the beginning for
//! a while.

use crate::road::LaneId;
use std::ops::Deref;

/// The number of lanes that a car may have left before the lanes are removed from memory.
const LEFT_BEHIND: usize = 32;

/// The lane of a car and the next lanes of its way. Each is a successor of the previous lane, or its neighbour.
#[derive(Debug)]
pub(super) struct LanesAhead {
    lanes: Vec<LaneId>,
    /// The number of lanes at the beginning of `lanes` that the car has left.
    left: usize,
}

impl LanesAhead {
    pub fn new(lane: LaneId) -> Self {
        let mut lanes = Vec::with_capacity(2 * LEFT_BEHIND);
        lanes.push(lane);
        Self { lanes, left: 0 }
    }

    /// Adds a lane at the end.
    pub fn push(&mut self, lane: LaneId) {
        self.lanes.push(lane);
    }

    /// Removes the first lanes: `count` lanes, or all lanes if there are fewer.
    pub fn leave(&mut self, count: usize) {
        self.left = self.lanes.len().min(self.left + count);
        if self.left > LEFT_BEHIND {
            self.lanes.drain(..self.left);
            self.left = 0;
        }
    }

    /// Puts lanes before the first lane.
    pub fn put_first(&mut self, lanes: &[LaneId]) {
        self.lanes.splice(..self.left, lanes.iter().copied());
        self.left = 0;
    }

    /// Keeps only the first `count` lanes.
    pub fn truncate(&mut self, count: usize) {
        self.lanes.truncate(self.left + count);
    }
}

impl Deref for LanesAhead {
    type Target = [LaneId];

    fn deref(&self) -> &[LaneId] {
        &self.lanes[self.left..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::road::grid_city;
    use proptest::prelude::*;
    use std::collections::VecDeque;

    proptest! {
        #[test]
        fn lanes_ahead_are_a_queue_with_two_ends(changes in prop::collection::vec((0..4, 0..40_usize), 1..200)) {
            let city = grid_city(2, 2, 80.0, 2).build().unwrap();
            let ids: Vec<LaneId> = city.ids().collect();
            let (mut lanes, mut naive) = (LanesAhead::new(ids[0]), VecDeque::from([ids[0]]));
            for (kind, number) in changes {
                let lane = ids[number % ids.len()];
                match kind {
                    0 => {
                        lanes.push(lane);
                        naive.push_back(lane);
                    }
                    1 => {
                        lanes.leave(number);
                        naive.drain(..number.min(naive.len()));
                    }
                    2 => {
                        let more = &ids[..number % ids.len()];
                        lanes.put_first(more);
                        more.iter().rev().for_each(|lane| naive.push_front(*lane));
                    }
                    _ => {
                        lanes.truncate(number);
                        naive.truncate(number);
                    }
                }
                prop_assert_eq!(&*lanes, naive.make_contiguous());
            }
        }
    }
}
