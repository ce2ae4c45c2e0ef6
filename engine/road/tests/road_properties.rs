//! What must hold of any road network, against definitions evaluated by brute force that shares nothing with it.

use nalgebra::Vector2;
use paracosm_road::Pose;
use paracosm_road::{
    Composite, CrossIntersection, Curve, Lane, LaneId, RoadNetwork, RoadSegment, Roundabout, RoutePosition,
    TIntersection,
};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// Something to connect, to the free point and by its own point that these numbers stand for.
#[derive(Debug, Clone)]
struct Addition {
    kind: u8,
    size: f64,
    turn: f64,
    at: usize,
    by: usize,
}

impl Addition {
    fn element(&self, lanes: i32) -> Composite {
        let corner = 3.0 + 6.0 * self.size;
        match self.kind {
            0 | 1 => RoadSegment::new(5.0 + 80.0 * self.size).lanes(lanes).into(),
            2 | 3 => RoadSegment::arc(20.0 + 60.0 * self.size, self.turn).lanes(lanes).into(),
            4 => TIntersection::new().lanes(lanes).corner(corner).into(),
            5 => CrossIntersection::new().lanes(lanes).corner(corner).into(),
            _ => Roundabout::new().lanes(lanes).arms(3 + self.by as i32 % 3).island(16.0 + 20.0 * self.size).into(),
        }
    }
}

fn additions(most: usize) -> impl Strategy<Value = Vec<Addition>> {
    let turn = prop_oneof![-3.0..-0.01, 0.01..3.0];
    let addition = (0..7u8, 0.0..1.0f64, turn, 0..1000usize, 0..1000usize);
    let addition = addition.prop_map(|(kind, size, turn, at, by)| Addition { kind, size, turn, at, by });
    prop::collection::vec(addition, 1..=most)
}

/// A network of those of the additions that find room.
fn grown(additions: &[Addition], lanes: i32, place: Pose) -> Arc<RoadNetwork> {
    let mut all = additions[0].element(lanes).at(place);
    for addition in &additions[1..] {
        let free = all.free_points();
        let child = addition.element(lanes);
        let ends = child.free_points();
        if free.is_empty() {
            break;
        }
        let larger = all.clone().connect(&free[addition.at % free.len()], child, &ends[addition.by % ends.len()]);
        if larger.clone().build().is_ok() {
            all = larger;
        }
    }
    all.build().unwrap()
}

/// A network that prints as what it has grown from.
struct Grown {
    net: Arc<RoadNetwork>,
    from: String,
}

impl std::fmt::Debug for Grown {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.from)
    }
}

impl std::ops::Deref for Grown {
    type Target = RoadNetwork;

    fn deref(&self) -> &RoadNetwork {
        &self.net
    }
}

fn networks(most: usize) -> impl Strategy<Value = Grown> {
    let place = (-500.0..500.0, -500.0..500.0, -4.0..4.0);
    (additions(most), 1..=3i32, place).prop_map(|(additions, each_way, (x, y, heading))| {
        let place = Pose { position: Vector2::new(x, y), heading };
        let net = grown(&additions, 2 * each_way, place);
        Grown { net, from: format!("{each_way} lanes each way at {place:?}: {additions:?}") }
    })
}

/// Points along a curve, `step` metres apart or less, computed turn by turn rather than by the curve's own formula.
fn polyline(curve: &Curve, step: f64) -> Vec<Vector2<f64>> {
    let pieces = (curve.length() / step).ceil() as usize;
    let length = curve.length() / pieces as f64;
    let Pose { mut position, mut heading } = curve.start();
    let mut points = vec![position];
    for _ in 0..pieces {
        let turn = curve.curvature() * length;
        // The chord of an arc points along the mean of the headings at its ends.
        let chord = if turn == 0.0 { length } else { length * libm::sin(0.5 * turn) / (0.5 * turn) };
        let (sin, cos) = libm::sincos(heading + 0.5 * turn);
        position += Vector2::new(cos, sin) * chord;
        heading += turn;
        points.push(position);
    }
    points
}

fn nearest_by_sampling(lane: &Lane, position: Vector2<f64>) -> f64 {
    let distances = polyline(only(lane), 0.1).into_iter().map(|point| (point - position).norm());
    distances.fold(f64::INFINITY, f64::min)
}

/// The only curve of a lane of our elements.
fn only(lane: &Lane) -> &Curve {
    let mut curves = lane.curve.curves();
    let only = curves.next().expect("a lane has a curve");
    assert_eq!(curves.count(), 0);
    only
}

/// A size, often one that nothing can have.
fn any_size() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..500.0f64, Just(f64::NAN), Just(f64::INFINITY), Just(0.0)]
}

/// The name of a point, often of one that is not there.
fn any_point() -> impl Strategy<Value = &'static str> {
    let bare = vec!["one", "two", "three", "four", "five"];
    let full = vec!["road.one", "road-2.two", "roundabout.three", "road.", ".one", ".", ""];
    prop::sample::select([bare, full].concat())
}

fn angle_between(a: f64, b: f64) -> f64 {
    let (sin, cos) = libm::sincos(a - b);
    libm::atan2(sin, cos).abs()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_place_beside_a_lane_is_projected_back_to_where_it_is(
        (net, lane, share, offset) in (networks(8), any::<prop::sample::Index>(), 0.0..=1.0f64, -3.0..3.0f64)
    ) {
        let index = lane.index(net.lanes().len());
        let lane = &net.lanes()[index];
        prop_assume!(offset * only(lane).curvature() < 0.9);
        let s = share * lane.length();
        let here = lane.curve.at(s);
        let position = here.position + Vector2::new(-libm::sin(here.heading), libm::cos(here.heading)) * offset;
        let onto = net.project_onto(net.ids().nth(index).unwrap(), position);
        let exact = (onto.s - s).abs() < 1e-8 && (onto.offset - offset).abs() < 1e-8;
        prop_assert!(exact, "{onto:?}, expected {s} {offset}");
        prop_assert!(angle_between(onto.heading, here.heading) < 1e-9);
        // Another lane may be nearer still.
        let nearest = net.project(position);
        prop_assert!(nearest.distance <= offset.abs() + 1e-9);
        let along = net.project_along(&here).unwrap();
        prop_assert!(along.distance < 1e-9 && angle_between(along.heading, here.heading) < 0.5 * PI);
    }

    #[test]
    fn any_position_is_projected_onto_the_lane_that_sampling_finds_nearest(
        (net, x, y) in (networks(8), -700.0..700.0f64, -700.0..700.0f64)
    ) {
        let position = Vector2::new(x, y);
        let found = net.project(position);
        let sampled = net.lanes().iter().map(|lane| nearest_by_sampling(lane, position)).fold(f64::INFINITY, f64::min);
        // Half of the sampling step aside.
        prop_assert!((found.distance - sampled).abs() < 0.06, "{found:?}, by sampling {sampled}");
        let there = net.lane(found.lane).curve.point(found.s);
        prop_assert!(((there - position).norm() - found.distance).abs() < 1e-9);
    }

    #[test]
    fn a_lane_begins_where_those_before_it_end_and_heads_the_same_way(net in networks(12)) {
        for (id, lane) in net.ids().zip(net.lanes()) {
            for successor in &lane.successors {
                let next = net.lane(*successor);
                let (end, start) = (lane.curve.end(), next.curve.start());
                prop_assert!((end.position - start.position).norm() < 1e-9, "{lane:?} {next:?}");
                prop_assert!(angle_between(end.heading, start.heading) < 1e-9, "{lane:?} {next:?}");
                prop_assert!(next.predecessors.contains(&id));
            }
            for predecessor in &lane.predecessors {
                prop_assert!(net.lane(*predecessor).successors.contains(&id));
            }
        }
    }

    #[test]
    fn lanes_beside_one_another_run_a_lane_width_apart(net in networks(12)) {
        for (id, lane) in net.ids().zip(net.lanes()) {
            for (beside, sign) in [(lane.left, 1.0), (lane.right, -1.0)] {
                let Some(beside) = beside else { continue };
                let other = net.lane(beside);
                prop_assert_eq!(if sign > 0.0 { other.right } else { other.left }, Some(id));
                for share in [0.0, 0.3, 1.0] {
                    let here = lane.curve.at(share * lane.length());
                    let there = here.to_local(other.curve.point(share * other.length()));
                    prop_assert!(there.x.abs() < 1e-9 && (there.y - sign * lane.width).abs() < 1e-9, "{there}");
                }
            }
        }
    }

    #[test]
    fn lanes_are_in_conflict_exactly_where_sampling_finds_them_close(net in networks(3)) {
        for (id, lane) in net.ids().zip(net.lanes()) {
            let points = polyline(only(lane), 0.1);
            let step = lane.length() / (points.len() - 1) as f64;
            for (other_id, other) in net.ids().zip(net.lanes()).filter(|(other, _)| *other != id) {
                let parted = lane.predecessors.iter().any(|before| other.predecessors.contains(before));
                let begin_together = (lane.curve.start().position - other.curve.start().position).norm() < 1e-9;
                let follow = lane.successors.contains(&other_id) || other.successors.contains(&id);
                let conflict = lane.conflicts.iter().find(|conflict| conflict.with == other_id);
                if other.element != lane.element || parted || begin_together || follow {
                    prop_assert_eq!(conflict, None);
                    continue;
                }
                let others = polyline(only(other), 0.1);
                let distance = |point: &Vector2<f64>| {
                    others.iter().map(|other| (other - point).norm()).fold(f64::INFINITY, f64::min)
                };
                let close = 0.7 * lane.width;
                for (i, point) in points.iter().enumerate() {
                    let (s, distance) = ((i as f64 * step).min(lane.length()), distance(point));
                    let within = conflict.is_some_and(|conflict| (conflict.from..=conflict.to).contains(&s));
                    // Where sampling, or a conflict that it takes for none because it is so short, cannot tell.
                    prop_assert!(within || distance > close - 0.03, "{lane:?} {other:?} {s} {distance}");
                }
                if let Some(conflict) = conflict {
                    let back = other.conflicts.iter().find(|back| back.with == id);
                    prop_assert!(back.is_some_and(|back| !(back.gives_way && conflict.gives_way)));
                    let places = [conflict.from, conflict.to];
                    for s in places.into_iter().filter(|s| *s > 0.0 && *s < lane.length()) {
                        let distance = distance(&lane.curve.point(s));
                        prop_assert!((distance - close).abs() < 0.03, "{distance} at an end, expected {close}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_way_is_as_short_as_floyd_and_warshall_find_it(
        (net, from, to, begin, end, change) in (
            networks(6), any::<prop::sample::Index>(), any::<prop::sample::Index>(),
            0.0..=1.0f64, 0.0..=1.0f64, 0.0..50.0f64,
        )
    ) {
        let lanes = net.lanes();
        let n = lanes.len();
        let (from, to) = (from.index(n), to.index(n));
        // Between the beginnings of lanes.
        let mut costs = vec![vec![f64::INFINITY; n]; n];
        for (i, lane) in lanes.iter().enumerate() {
            costs[i][i] = 0.0;
            lane.successors.iter().for_each(|next| costs[i][next.index()] = lane.length());
            lane.left.iter().chain(&lane.right).for_each(|beside| costs[i][beside.index()] = change);
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    costs[i][j] = costs[i][j].min(costs[i][k] + costs[k][j]);
                }
            }
        }
        // One starts on a lane, or on one further aside.
        let target = end * lanes[to].length();
        let mut best = f64::INFINITY;
        for side in [|lane: &Lane| lane.left, |lane: &Lane| lane.right] {
            let (mut here, mut cost) = (from, 0.0);
            loop {
                let entered = begin * lanes[here].length();
                if here == to && target >= entered {
                    best = best.min(cost + target - entered);
                }
                for next in &lanes[here].successors {
                    best = best.min(cost + lanes[here].length() - entered + costs[next.index()][to] + target);
                }
                let Some(beside) = side(&lanes[here]) else { break };
                (here, cost) = (beside.index(), cost + change);
            }
        }
        let id = |index: usize| net.ids().nth(index).unwrap();
        let place = |index: usize, share: f64| RoutePosition { lane: id(index), s: share * lanes[index].length() };
        let route = net.route(place(from, begin), place(to, end), change);
        prop_assert_eq!(route.is_some(), best.is_finite());
        let Some(route) = route else { return Ok(()) };
        let cost = route.length + route.changes as f64 * change;
        prop_assert!((cost - best).abs() < 1e-6, "{route:?} costs {cost}, by brute force {best}");
        prop_assert_eq!((route.lanes[0], route.lanes[route.lanes.len() - 1]), (id(from), id(to)));
        let mut changes = 0;
        for pair in route.lanes.windows(2) {
            let before = net.lane(pair[0]);
            let changed = before.left == Some(pair[1]) || before.right == Some(pair[1]);
            prop_assert!(changed || before.successors.contains(&pair[1]));
            changes += usize::from(changed);
        }
        prop_assert_eq!(route.changes, changes);
    }

    #[test]
    fn no_lane_lies_on_the_ground_of_another_element(net in networks(10)) {
        for lane in net.lanes() {
            let others = net.lanes().iter().filter(|other| other.element != lane.element);
            for (other, samples) in others.map(|other| (other, polyline(only(other), 0.25))) {
                for point in polyline(only(lane), 2.0) {
                    let distance = |i: &usize| (samples[*i] - point).norm();
                    let nearest = (0..samples.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
                    // Nearest to an end, the point lies before or behind the lane.
                    let beside = nearest > 0 && nearest + 1 < samples.len();
                    prop_assert!(!beside || distance(&nearest) > 0.5 * other.width - 0.2, "{lane:?} {other:?} {point}");
                }
            }
        }
    }

    #[test]
    fn whatever_is_connected_there_is_a_network_or_a_message_and_never_a_panic(
        (additions, sizes, points) in (
            additions(6),
            prop::collection::vec((any_size(), -1..20i32), 6),
            prop::collection::vec(any_point(), 24),
        )
    ) {
        let mut all = additions[0].element(sizes[0].1);
        for (i, addition) in additions.iter().enumerate().skip(1) {
            let (size, lanes) = sizes[i];
            let child = match addition.kind {
                0 => RoadSegment::new(size).lanes(lanes).zebra(0.5 * size).into(),
                1 => RoadSegment::arc(size, addition.turn).lanes(lanes).lane_width(size).into(),
                2 => CrossIntersection::new().corner(size).sidewalk(0.1 * size).into(),
                3 => Roundabout::new().island(size).arms(lanes).entry(size).into(),
                _ => addition.element(2),
            };
            all = all.connect(points[4 * i - 4], child, points[4 * i - 3]).close(points[4 * i - 2], points[4 * i - 1]);
            match all.clone().build() {
                Ok(net) => {
                    let found = net.project(Vector2::new(size.clamp(-1e9, 1e9), 0.0));
                    prop_assert!(found.distance >= 0.0 || size.is_nan());
                    let strips = net.strips();
                    let mut corners = strips.iter().flat_map(|strip| strip.outline(0.01));
                    prop_assert!(corners.all(|corner| corner.iter().all(|number| number.is_finite())));
                }
                Err(error) => prop_assert!(!error.to_string().is_empty()),
            }
        }
    }
}

#[test]
fn networks_are_shared_between_threads() {
    fn shared<T: Send + Sync>(_: &T) {}
    let net = CrossIntersection::new().build().unwrap();
    shared(&net);
    let lane: LaneId = net.ids().next().unwrap();
    assert_eq!(lane.index(), 0);
}
