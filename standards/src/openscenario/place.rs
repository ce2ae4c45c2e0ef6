//! Places on the lanes of a map, and the way along them.

use super::route::Legs;
use crate::opendrive::{End, GAP, Lane, LaneType, Link, Map, Road, Section, just_before};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::wrapped;
use std::f64::consts::{FRAC_PI_2, PI};

/// A place beside the middle of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The index of the road.
    pub road: usize,
    /// The place along the road in metres.
    pub s: f64,
    /// The number of the lane.
    pub lane: i32,
    /// The distance from the middle of the lane in metres, to the left of the direction of the road.
    pub offset: f64,
    /// The angle from the direction of the lane along the road, in radians.
    pub turn: f64,
}

/// The distance in metres that a look along the road covers.
const SIGHT: f64 = 2000.0;

impl Place {
    /// Returns the distance from the reference line in metres to the left.
    pub fn t(&self, map: &Map) -> f64 {
        let road = &map.roads[self.road];
        road.middle(road.section_at(self.s), self.lane, self.s) + self.offset
    }

    /// Returns the position and the heading of the place.
    pub fn pose(&self, map: &Map) -> Pose {
        let road = &map.roads[self.road];
        let section = road.section_at(self.s);
        let Pose { position, heading } = road.lane_pose(section, self.lane, self.s, self.offset).unwrap_or_else(|| {
            // A place beside all lanes goes along the reference line.
            let here = road.line.at(self.s);
            Pose { position: here.position + here.left() * self.offset, ..here }
        });
        Pose { position, heading: wrapped(heading + self.turn) }
    }

    /// Returns the direction along the road in which the place faces, in radians.
    pub fn heading(&self, map: &Map) -> f64 {
        let along = map.roads[self.road].line.at(self.s).heading;
        if self.is_against() { along + PI } else { along }
    }

    /// Returns `true` if the traffic on a lane at the place goes in the direction of the road.
    pub fn leads_along(&self, lane: i32, map: &Map) -> bool {
        let road = &map.roads[self.road];
        driving_turn(road, road.section_at(self.s), lane) == 0.0
    }

    /// Returns the numbers of the lanes at the place on which cars drive.
    pub fn driven_lanes<'m>(&self, map: &'m Map) -> impl Iterator<Item = i32> + use<'m> {
        let road = &map.roads[self.road];
        let lanes = road.sections[road.section_at(self.s)].lanes.iter();
        lanes.filter(|lane| lane.number != 0 && lane.kind.is_driven()).map(|lane| lane.number)
    }

    /// Returns `true` if the place is beside all lanes of its road. The outermost lanes may be of the type `none`, which is no road.
    pub fn is_offroad(&self, map: &Map) -> bool {
        let road = &map.roads[self.road];
        let section = road.section_at(self.s);
        let t = self.t(map);
        let is_below = |lane: &&Lane| {
            let (middle, half) =
                (road.middle(section, lane.number, self.s), 0.5 * road.width(section, lane.number, self.s));
            (t - middle).abs() <= half
        };
        let mut below = road.sections[section].lanes.iter().filter(|lane| lane.kind != LaneType::None).filter(is_below);
        below.next().is_none()
    }

    /// Returns `true` if the place faces against the direction of the road.
    pub fn is_against(&self) -> bool {
        wrapped(self.turn).abs() > FRAC_PI_2
    }

    /// Moves the place to another lane without moving it in the world.
    pub fn enter(&mut self, lane: i32, map: &Map) {
        let t = self.t(map);
        self.lane = lane;
        self.offset = 0.0;
        self.offset = t - self.t(map);
    }

    /// Returns the number of the lane under the place.
    pub fn lane_below(&self, map: &Map) -> i32 {
        let road = &map.roads[self.road];
        let section = road.section_at(self.s);
        let t = self.t(map);
        let lanes = road.sections[section].lanes.iter().filter(|lane| lane.number != 0);
        let distance = |number: i32| {
            let (middle, half) = (road.middle(section, number, self.s), 0.5 * road.width(section, number, self.s));
            (t - middle).abs() - half
        };
        let nearest = lanes.map(|lane| (lane.number, distance(lane.number))).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map_or(self.lane, |(number, _)| number)
    }

    /// Moves the place along its lane by `metres` metres in the direction that it faces. Returns `false` at the end of the road.
    pub fn advance(&mut self, metres: f64, map: &Map) -> bool {
        self.follow(metres, None, map)
    }

    /// Moves the place like [`Self::advance`]. At junctions it takes the roads of a route.
    pub fn follow(&mut self, metres: f64, route: Option<&Legs>, map: &Map) -> bool {
        let mut rest = if self.is_against() { -metres } else { metres };
        loop {
            let road = &map.roads[self.road];
            let section = road.section_at(self.s);
            let wanted = self.s + self.along(rest, map);
            let (start, end) = (road.sections[section].s, road.sections[section].end);
            if (start..end).contains(&wanted) || wanted == end && section + 1 == road.sections.len() {
                self.s = wanted;
                return true;
            }
            let border = if wanted < start { start } else { end };
            rest -= (border - self.s) * rest / (wanted - self.s);
            if !self.cross(section, border == end, &mut rest, route, map) {
                self.s = border;
                return false;
            }
        }
    }

    /// Returns the metres along the reference line that belong to `metres` metres along the place's own line.
    fn along(&self, metres: f64, map: &Map) -> f64 {
        let road = &map.roads[self.road];
        let rate = |s: f64| {
            let curvature = road.line.curvature(s);
            // On a straight line the place beside the line does not matter.
            let bend = if curvature == 0.0 { 0.0 } else { curvature * Self { s, ..*self }.t(map) };
            road.line.rate(s) * (1.0 - bend).max(0.01)
        };
        let first = metres / rate(self.s);
        metres / rate((self.s + 0.5 * first).clamp(0.0, road.length))
    }

    /// Moves the place over a border of a section to the next section. Returns `false` if there is none that meets the place.
    fn cross(&mut self, section: usize, at_end: bool, rest: &mut f64, route: Option<&Legs>, map: &Map) -> bool {
        let road = &map.roads[self.road];
        let Section { s, end, .. } = road.sections[section];
        let border = if at_end { just_before(end, s) } else { s };
        let t = road.middle(section, self.lane, border) + self.offset;
        let lane = road.sections[section].lane(self.lane);
        let next = lane.and_then(|lane| if at_end { lane.successors.first() } else { lane.predecessors.first() });
        let neighbour = if at_end { section + 1 } else { section.wrapping_sub(1) };
        let (to, at, next) = if neighbour < road.sections.len() {
            let s = if at_end { end } else { s - f64::EPSILON * s };
            (Self { s, ..*self }, None, next.copied())
        } else {
            let link = road.link(if at_end { End::End } else { End::Start });
            let Some((to, at, lane)) = link.and_then(|link| self.beyond(link, next.copied(), route, map)) else {
                return false;
            };
            let length = map.roads[to].length;
            let s = if at == End::Start { 0.0 } else { length - f64::EPSILON * length };
            (Self { road: to, s, ..*self }, Some(at), lane)
        };
        let turns = at.is_some_and(|at| (at == End::End) == at_end);
        let to = if turns { Self { turn: wrapped(to.turn + PI), offset: -to.offset, ..to } } else { to };
        let Some(entered) = to.met(road.point(border, t), next, if turns { -t } else { t }, map) else { return false };
        *self = entered;
        if turns {
            *rest = -*rest;
        }
        true
    }

    /// Returns the place on the linked lane, or on the lane with the same number, if the lane goes on at a point. Otherwise it returns the
    /// place `t` metres beside the reference line, where no lane goes on. Returns `None` if the road does not meet the point.
    fn met(self, point: Vector2<f64>, next: Option<i32>, t: f64, map: &Map) -> Option<Self> {
        let road = &map.roads[self.road];
        let section = road.section_at(self.s);
        let meets = |place: &Self| (road.point(self.s, place.t(map)) - point).norm() <= GAP;
        let number = next.unwrap_or(self.lane);
        let linked = Self { lane: number, ..self };
        if road.sections[section].lane(number).is_some() && meets(&linked) {
            return Some(linked);
        }
        let mut beside = Self { lane: 0, offset: t - road.middle(section, 0, self.s), ..self };
        if !meets(&beside) {
            return None;
        }
        beside.enter(beside.lane_below(map), map);
        Some(beside)
    }

    /// Returns the road, the end and the linked lane that are entered over a link. At a junction this is the road of the route, or the
    /// straightest way.
    fn beyond(
        &self,
        link: Link,
        next: Option<i32>,
        route: Option<&Legs>,
        map: &Map,
    ) -> Option<(usize, End, Option<i32>)> {
        match link {
            Link::Road(to, at) => Some((to, at, next)),
            Link::Junction(junction) => {
                let heading = self.pose(map).heading;
                let connections =
                    map.junctions[junction].connections.iter().filter(|connection| connection.from == self.road);
                let ways = connections.filter_map(|connection| {
                    let lane = connection.next(self.lane).first().copied()?;
                    let road = &map.roads[connection.to];
                    let (far, back) = match connection.at {
                        End::Start => (road.length, 0.0),
                        End::End => (0.0, PI),
                    };
                    let bend = wrapped(road.line.at(far).heading + back - heading).abs();
                    let is_beside = !route.is_some_and(|route| route.goes(self.road, connection.to));
                    Some((is_beside, bend, (connection.to, connection.at, Some(lane))))
                });
                ways.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|(_, _, way)| way)
            }
        }
    }

    /// Returns the distance along the road to another place in metres; negative if the other place is behind. `None` if no road
    /// leads there within 2 km.
    pub fn distance_to(&self, other: &Self, map: &Map) -> Option<f64> {
        self.distance_along(other, None, map)
    }

    /// Returns the distance like [`Self::distance_to`], along the roads of a route.
    pub fn distance_along(&self, other: &Self, route: Option<&Legs>, map: &Map) -> Option<f64> {
        self.way_to(other, route, map).map(|way| way.metres)
    }

    /// Returns another place as seen from this one: beside which line, in which direction. If no road leads there, the roads count as if
    /// they had the same direction.
    pub fn seen(&self, other: &Self, map: &Map) -> Seen {
        let turns = self.way_to(other, None, map).is_some_and(|way| way.turns);
        let t = other.t(map);
        Seen { t: if turns { -t } else { t }, is_against: other.is_against() != turns }
    }

    /// Returns the way along the road to another place, or back to it. `None` if no road leads there within 2 km.
    fn way_to(&self, other: &Self, route: Option<&Legs>, map: &Map) -> Option<Stretch> {
        if self.road == other.road {
            let ahead = other.s - self.s;
            return Some(Stretch { metres: if self.is_against() { -ahead } else { ahead }, turns: false });
        }
        self.ahead_to(other, route, map).or_else(|| {
            let back = Self { turn: wrapped(self.turn + PI), ..*self };
            back.ahead_to(other, route, map).map(|way| Stretch { metres: -way.metres, ..way })
        })
    }

    fn ahead_to(&self, other: &Self, route: Option<&Legs>, map: &Map) -> Option<Stretch> {
        let (mut here, mut metres) = (*self, 0.0);
        while metres < SIGHT {
            let road = &map.roads[here.road];
            let rest = if here.is_against() { here.s } else { road.length - here.s };
            metres += rest;
            here.s = if here.is_against() { 0.0 } else { road.length };
            let section = road.section_at(here.s);
            let mut none = 0.0;
            let at_end = !here.is_against();
            if !here.cross(section, at_end, &mut none, route, map) {
                return None;
            }
            if here.road == other.road {
                let turns = here.is_against() != self.is_against();
                return Some(Stretch { metres: metres + (other.s - here.s).abs(), turns });
            }
        }
        None
    }
}

/// A place as another place sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    /// The distance to the left of the reference line in metres, as the reference line of the other place goes on.
    pub t: f64,
    /// `true` if the place faces against the direction in which the reference line of the other place goes on.
    pub is_against: bool,
}

/// A way along roads.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    metres: f64,
    /// `true` if the last road has the opposite direction of the first one.
    turns: bool,
}

/// Returns the angle from the direction of a road to the direction of the traffic on one of its lanes.
pub(super) fn driving_turn(road: &Road, section: usize, lane: i32) -> f64 {
    let lane = road.sections[section].lane(lane).filter(|lane| lane.number != 0);
    if road.leads_along(lane) { 0.0 } else { PI }
}
