//! The bodies on every lane, in order.
//!
//! Bodies are distributed to their lanes in the order of the previous tick, in which they are almost sorted. An
//! insertion sort of each lane then takes linear time. Nothing is allocated once the lists have grown to their sizes.

use crate::road::LaneId;

/// A body on a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Body {
    pub lane: LaneId,
    /// The place of the body's rear in metres along the lane, which may lie beyond the lane's ends; `front` likewise.
    pub rear: f64,
    pub front: f64,
    /// The speed of the body along the lane, in m/s.
    pub speed: f64,
    pub who: Who,
}

/// The kind of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Who {
    /// A car of the traffic on its own lane, by the index of the car.
    Car(u32),
    /// A car of the traffic on the lane that it is leaving, by the index of the car.
    Leaving(u32),
    /// A body that is not part of the traffic and will be on the lane in `soon` seconds.
    Foreign { soon: f64 },
    /// A zebra crossing that a person is walking over.
    Zebra,
}

impl Body {
    pub fn middle(&self) -> f64 {
        0.5 * (self.rear + self.front)
    }

    /// Returns the index of the car in the traffic; `None` if the body is not a car of the traffic.
    pub fn car(&self) -> Option<usize> {
        match self.who {
            Who::Car(car) | Who::Leaving(car) => Some(car as usize),
            _ => None,
        }
    }
}

/// The bodies on all lanes.
#[derive(Debug)]
pub(super) struct Occupancy {
    /// The bodies, lane by lane, sorted by their middles within a lane.
    bodies: Vec<Body>,
    /// The range in `bodies` of each lane.
    ranges: Vec<(u32, u32)>,
    /// The lanes with bodies.
    used: Vec<LaneId>,
    /// The index in `bodies` of each car.
    ranks: Vec<u32>,
    /// The index in `bodies` of the second body of each car that changes lanes.
    old_ranks: Vec<u32>,
    /// The order of cars in `bodies`.
    order: Vec<u32>,
    /// The bodies that have to be sorted.
    unsorted: Vec<Body>,
}

impl Occupancy {
    pub fn new(lanes: usize, cars: usize) -> Self {
        Self {
            bodies: Vec::with_capacity(3 * cars),
            ranges: vec![(0, 0); lanes],
            used: Vec::with_capacity(3 * cars),
            ranks: vec![u32::MAX; cars],
            old_ranks: vec![u32::MAX; cars],
            order: (0..cars as u32).collect(),
            unsorted: Vec::with_capacity(3 * cars),
        }
    }

    /// Empties the list of bodies to sort and fills it again by `place`, which adds the bodies of a car.
    pub fn clear(&mut self, mut place: impl FnMut(u32, &mut Vec<Body>)) {
        self.unsorted.clear();
        for car in &self.order {
            place(*car, &mut self.unsorted);
        }
    }

    /// Returns the list of bodies to sort, to which a caller can add further bodies.
    pub fn added(&mut self) -> &mut Vec<Body> {
        &mut self.unsorted
    }

    /// Sorts the added bodies by lane, and along each lane.
    pub fn sort(&mut self) {
        for lane in self.used.drain(..) {
            self.ranges[lane.index()] = (0, 0);
        }
        for body in &self.unsorted {
            let (_, count) = &mut self.ranges[body.lane.index()];
            if *count == 0 {
                self.used.push(body.lane);
            }
            *count += 1;
        }
        let mut begin = 0;
        for lane in &self.used {
            let range = &mut self.ranges[lane.index()];
            let count = range.1;
            *range = (begin, begin);
            begin += count;
        }
        match self.unsorted.first() {
            // Every body is overwritten.
            Some(any) => self.bodies.resize(self.unsorted.len(), *any),
            None => self.bodies.clear(),
        }
        for body in &self.unsorted {
            let (begin, end) = &mut self.ranges[body.lane.index()];
            let mut at = *end as usize;
            let key = body.middle();
            while at > *begin as usize && self.bodies[at - 1].middle() > key {
                self.bodies[at] = self.bodies[at - 1];
                at -= 1;
            }
            self.bodies[at] = *body;
            *end += 1;
        }
        self.order.clear();
        self.old_ranks.fill(u32::MAX);
        for (rank, body) in self.bodies.iter().enumerate() {
            match body.who {
                Who::Car(car) => {
                    self.ranks[car as usize] = rank as u32;
                    self.order.push(car);
                }
                Who::Leaving(car) => self.old_ranks[car as usize] = rank as u32,
                Who::Foreign { .. } | Who::Zebra => {}
            }
        }
    }

    /// Returns the bodies on a lane, in their order along the lane.
    pub fn on(&self, lane: LaneId) -> &[Body] {
        let (begin, end) = self.ranges[lane.index()];
        &self.bodies[begin as usize..end as usize]
    }

    /// Returns the bodies ahead of a car on its lane.
    #[inline]
    pub fn ahead_of(&self, car: usize) -> &[Body] {
        self.beyond(self.ranks[car])
    }

    /// Returns the bodies behind a car on its lane; the last body is next to the car.
    pub fn behind(&self, car: usize) -> &[Body] {
        let rank = self.ranks[car] as usize;
        let (begin, _) = self.ranges[self.bodies[rank].lane.index()];
        &self.bodies[begin as usize..rank]
    }

    /// Returns the bodies ahead of a car on the lane that it is leaving.
    pub fn ahead_on_old_lane(&self, car: usize) -> &[Body] {
        match self.old_ranks[car] {
            u32::MAX => &[],
            rank => self.beyond(rank),
        }
    }

    fn beyond(&self, rank: u32) -> &[Body] {
        let (_, end) = self.ranges[self.bodies[rank as usize].lane.index()];
        &self.bodies[rank as usize + 1..end as usize]
    }
}
