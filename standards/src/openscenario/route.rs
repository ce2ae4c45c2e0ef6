//! Routes on a map: the roads of the shortest way through waypoints.

use crate::opendrive::{End, Link, Map};
use std::collections::VecDeque;

/// The roads of a route, in their order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Legs(Vec<Leg>);

/// The part of a road that a route takes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Leg {
    /// The index of the road.
    road: usize,
    /// The first and the last place along the road in metres.
    from: f64,
    to: f64,
    /// `true` if the route goes in the direction of the road.
    forward: bool,
}

/// A place that a route leads through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stop {
    /// The index of the road.
    pub road: usize,
    /// The place along the road in metres.
    pub s: f64,
    /// `true` if the traffic at the place goes in the direction of the road.
    pub forward: bool,
}

impl Legs {
    /// Returns the shortest way through stops. The route begins in the direction of the traffic, or else in the other direction.
    ///
    /// # Errors
    /// No way leads from one stop to the next: the indices of their roads.
    pub fn through(stops: &[Stop], map: &Map) -> Result<Self, [usize; 2]> {
        let mut legs: Vec<Leg> = Vec::new();
        for pair in stops.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let forward = legs.last().map_or(from.forward, |leg| leg.forward);
            let next = shortest(Stop { forward, ..from }, to, map);
            let next = next.or_else(|| shortest(Stop { forward: !forward, ..from }, to, map));
            let next = next.ok_or([from.road, to.road])?;
            let goes_on = |last: &Leg| (last.road, last.forward) == (next[0].road, next[0].forward);
            if legs.last().is_some_and(goes_on) {
                let from = legs.pop().map_or(next[0].from, |last| last.from);
                legs.push(Leg { from, ..next[0] });
                legs.extend(&next[1..]);
            } else {
                legs.extend(next);
            }
        }
        Ok(Self(legs))
    }

    /// Returns the road and the place along it after `metres` metres on the route. Beyond the end this is the end.
    pub fn at(&self, metres: f64) -> (usize, f64) {
        let mut rest = metres;
        for (index, Leg { road, from, to, .. }) in self.0.iter().enumerate() {
            let length = (to - from).abs();
            if rest <= length || index + 1 == self.0.len() {
                return (*road, from + (to - from).signum() * rest.min(length));
            }
            rest -= length;
        }
        unreachable!("a route has a road")
    }

    /// Returns `true` if the route goes from a road to another road next.
    pub fn goes(&self, from: usize, to: usize) -> bool {
        self.0.windows(2).any(|pair| (pair[0].road, pair[1].road) == (from, to))
    }
}

/// Returns the shortest way between two stops, which begins in the direction of the first one (the algorithm of Bellman and
/// Ford).
fn shortest(from: Stop, to: Stop, map: &Map) -> Option<Vec<Leg>> {
    if from.road == to.road && if from.forward { to.s >= from.s } else { to.s <= from.s } {
        return Some(vec![Leg { road: from.road, from: from.s, to: to.s, forward: from.forward }]);
    }
    // A state is a road with a direction: its entry. The queue has the entries that have become nearer.
    let state = |(road, forward): (usize, bool)| 2 * road + usize::from(forward);
    let length = |road: usize| map.roads[road].length;
    let mut metres = vec![f64::INFINITY; 2 * map.roads.len()];
    let mut before: Vec<Option<(usize, bool)>> = vec![None; 2 * map.roads.len()];
    let rest = if from.forward { length(from.road) - from.s } else { from.s };
    let mut queue = VecDeque::new();
    for entry in exits(from.road, from.forward, map) {
        metres[state(entry)] = rest;
        queue.push_back(entry);
    }
    while let Some(entry) = queue.pop_front() {
        let cost = metres[state(entry)] + length(entry.0);
        for next in exits(entry.0, entry.1, map) {
            if cost < metres[state(next)] {
                (metres[state(next)], before[state(next)]) = (cost, Some(entry));
                queue.push_back(next);
            }
        }
    }
    let total = |forward: bool| {
        let last = if forward { to.s } else { length(to.road) - to.s };
        metres[state((to.road, forward))] + last
    };
    let forward = total(true) <= total(false);
    if !total(forward).is_finite() {
        return None;
    }
    let (mut entry, mut ways) = ((to.road, forward), vec![(to.road, forward)]);
    while let Some(by) = before[state(entry)] {
        ways.push(by);
        entry = by;
    }
    let ends = |road: usize, forward: bool| if forward { (0.0, length(road)) } else { (length(road), 0.0) };
    let first = Leg { road: from.road, from: from.s, to: ends(from.road, from.forward).1, forward: from.forward };
    let mut legs = vec![first];
    legs.extend(ways.into_iter().rev().map(|(road, forward)| {
        let (from, to) = ends(road, forward);
        Leg { road, from, to, forward }
    }));
    legs.last_mut()?.to = to.s;
    Some(legs)
}

/// Returns the roads after a road, each with `true` if it is entered at its beginning.
fn exits(road: usize, forward: bool, map: &Map) -> Vec<(usize, bool)> {
    let end = if forward { End::End } else { End::Start };
    match map.roads[road].link(end) {
        None => Vec::new(),
        Some(Link::Road(to, at)) => vec![(to, at == End::Start)],
        Some(Link::Junction(junction)) => {
            let connections = map.junctions[junction].connections.iter();
            connections.filter(|way| way.from == road).map(|way| (way.to, way.at == End::Start)).collect()
        }
    }
}
