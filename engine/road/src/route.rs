//! Shortest routes over the lanes (Dijkstra 1959).
//!
//! A route follows lanes to their ends. It changes to a neighbouring lane only at the beginning of a lane or at its own
//! start. The caller says how many metres a lane change costs.

use super::lane::LaneId;
use super::network::RoadNetwork;
use crate::geometry::wrapped;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A place on a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoutePosition {
    /// The lane that contains the place.
    pub lane: LaneId,
    /// The distance in metres along the lane from the start of the lane to the place.
    pub s: f64,
}

/// A route over lanes from one place to another place.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// The lanes of the route in order. Each is a successor of the previous lane, or a neighbour after a lane change.
    pub lanes: Vec<LaneId>,
    /// The start of the route, in metres along the first lane.
    pub start: f64,
    /// The end of the route, in metres along the last lane.
    pub end: f64,
    /// The length of the route in metres, without its lane changes.
    pub length: f64,
    /// The number of lane changes on the route.
    pub changes: usize,
}

/// A lane and the place where the search reaches it: its beginning, or the place beside the start of the route.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Node(u32);

impl Node {
    fn new(lane: LaneId, beside_start: bool) -> Self {
        Self(2 * lane.0 + u32::from(beside_start))
    }

    fn lane(self) -> LaneId {
        LaneId(self.0 / 2)
    }

    fn beside_start(self) -> bool {
        self.0 % 2 == 1
    }
}

/// A candidate of the search; the cheapest candidate is on top.
struct Open {
    cost: f64,
    /// The node to visit; `None` for the goal.
    node: Option<Node>,
    from: Option<Node>,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.node.cmp(&self.node)).then(other.from.cmp(&self.from))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl RoadNetwork {
    /// Returns the shortest route between two places if a lane change costs as much as `change` metres; `None` if there
    /// is no route. A place beyond the ends of a lane counts as the lane's end.
    ///
    /// # Panics
    /// A lane belongs to another network, which has more lanes, or `change` is not a number from 0 on.
    pub fn route(&self, from: RoutePosition, to: RoutePosition, change: f64) -> Option<Route> {
        assert!(change >= 0.0, "a lane change costs {change} m, expected a number from 0 on");
        // A share of the lane, so that it means the same place on the neighbouring lanes.
        let begun = (from.s / self.lane(from.lane).length()).clamp(0.0, 1.0);
        let end = to.s.clamp(0.0, self.lane(to.lane).length());
        let mut reached: Vec<Option<Option<Node>>> = vec![None; 2 * self.lanes().len()];
        let mut open = BinaryHeap::from([Open { cost: 0.0, node: Some(Node::new(from.lane, true)), from: None }]);
        while let Some(Open { cost, node, from: before }) = open.pop() {
            let Some(node) = node else {
                return before.map(|last| self.unwound(last, &reached, [begun, end]));
            };
            let at = &mut reached[node.0 as usize];
            if at.is_some() {
                continue;
            }
            *at = Some(before);
            let lane = self.lane(node.lane());
            let entered = if node.beside_start() { begun * lane.length() } else { 0.0 };
            let mut offer = |to, metres: f64| open.push(Open { cost: cost + metres, node: to, from: Some(node) });
            if node.lane() == to.lane && end >= entered {
                offer(None, end - entered);
            }
            for successor in &lane.successors {
                offer(Some(Node::new(*successor, false)), lane.length() - entered);
            }
            for beside in lane.beside() {
                offer(Some(Node::new(beside, node.beside_start())), change);
            }
        }
        None
    }

    /// Returns a lane and the lanes straight on from its end, for at least `metres` metres beyond the lane. At a fork, the way goes
    /// on along the lane that turns least. It ends where no lane follows, or where it would meet itself.
    ///
    /// # Panics
    /// The lane belongs to another network, which has more lanes.
    pub fn onward(&self, lane: LaneId, metres: f64) -> Vec<LaneId> {
        let turn = |id: &LaneId| {
            let line = &self.lane(*id).curve;
            wrapped(line.end().heading - line.start().heading).abs()
        };
        let mut lanes = vec![lane];
        let mut length = 0.0;
        while length < metres {
            let last = self.lane(lanes[lanes.len() - 1]);
            let next = last.successors.iter().min_by(|a, b| turn(a).total_cmp(&turn(b)));
            let Some(next) = next.filter(|next| !lanes.contains(next)) else { break };
            length += self.lane(*next).length();
            lanes.push(*next);
        }
        lanes
    }

    /// Returns the rest of a route after `metres` metres, or the end of the route if the route is shorter.
    ///
    /// # Panics
    /// The route has no lanes, or they belong to another network, which has more lanes.
    pub fn rest_of(&self, route: &Route, metres: f64) -> Route {
        let (mut start, mut driven, mut lanes, mut changes) =
            (route.start, metres.max(0.0), &route.lanes[..], route.changes);
        while let &[lane, next, ..] = lanes {
            let length = self.lane(lane).length();
            if self.lane(lane).beside().any(|beside| beside == next) {
                if driven == 0.0 {
                    break;
                }
                start *= self.lane(next).length() / length;
                changes -= 1;
            } else if start + driven < length {
                break;
            } else {
                driven -= length - start;
                start = 0.0;
            }
            lanes = &lanes[1..];
        }
        let most = if lanes.len() == 1 { route.end } else { self.lane(lanes[0]).length() };
        let (start, length) = ((start + driven).min(most), (route.length - metres.max(0.0)).max(0.0));
        Route { lanes: lanes.to_vec(), start, end: route.end, length, changes }
    }

    /// Builds the route that led to `last`, from the predecessor of each node.
    fn unwound(&self, last: Node, reached: &[Option<Option<Node>>], [begun, end]: [f64; 2]) -> Route {
        let mut nodes = vec![last];
        while let Some(before) = reached[nodes[nodes.len() - 1].0 as usize].flatten() {
            nodes.push(before);
        }
        nodes.reverse();
        let (mut length, mut changes) = (0.0, 0);
        for pair in nodes.windows(2) {
            let lane = self.lane(pair[0].lane());
            let entered = if pair[0].beside_start() { begun * lane.length() } else { 0.0 };
            if lane.beside().any(|beside| beside == pair[1].lane()) {
                changes += 1;
            } else {
                length += lane.length() - entered;
            }
        }
        let entered = if last.beside_start() { begun * self.lane(last.lane()).length() } else { 0.0 };
        let start = begun * self.lane(nodes[0].lane()).length();
        let lanes = nodes.into_iter().map(Node::lane).collect();
        Route { lanes, start, end, length: length + end - entered, changes }
    }
}
