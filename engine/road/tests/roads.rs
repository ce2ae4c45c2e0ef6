//! Road networks as programs build them: what is connected to what, what is refused, and the way over the lanes.

use nalgebra::Vector2;
use paracosm_road::{
    Composite, CrossIntersection, LaneKind, RoadError, RoadNetwork, RoadSegment, Roundabout, RoutePosition, Strip,
    Surface, TIntersection, grid_city,
};
use paracosm_road::{Pose, Side};
use std::f64::consts::{FRAC_PI_2, PI};

fn refusal(composite: Composite) -> String {
    composite.build().expect_err("it was accepted").to_string()
}

#[test]
fn the_papers_example_has_its_roads_where_their_connections_put_them() {
    let road = |length, name: &str| RoadSegment::new(length).lanes(4).named(name);
    let net = TIntersection::new()
        .lanes(4)
        .connect("one", road(50.0, "e"), "two")
        .connect("two", road(50.0, "s"), "one")
        .connect("three", road(20.0, "w"), "one")
        .build()
        .unwrap();
    assert_eq!(net.elements().collect::<Vec<_>>(), ["t-intersection", "e", "s", "w"]);
    // Two lanes of 3.5 m and a corner of 6 m: the arms end 13 m from the middle.
    let at = |element, lane, at| net.on_lane(element, lane, at).unwrap();
    let near = |pose: Pose, x: f64, y: f64, heading: f64| {
        let apart = (pose.position - Vector2::new(x, y)).norm();
        assert!(apart < 1e-9 && (pose.heading - heading).abs() < 1e-9, "{pose:?}");
    };
    near(at("e", 1, 0.0), 63.0, 1.75, PI);
    near(at("e", -2, 0.0), 63.0, -5.25, 0.0);
    near(at("s", 2, 50.0), -5.25, -63.0, -FRAC_PI_2);
    near(at("w", 1, 20.0), -33.0, 1.75, PI);
    let sidewalk = net.on_sidewalk("w", Side::Left, 20.0).unwrap();
    near(sidewalk, -33.0, -8.0, FRAC_PI_2);
}

#[test]
fn different_lane_counts_and_widths_are_refused_with_both_points() {
    let net = RoadSegment::new(50.0).named("a").connect("two", RoadSegment::new(50.0).lanes(6).named("b"), "one");
    assert_eq!(
        refusal(net),
        "`a.two` with 2 lanes cannot be connected to `b.one` with 6 lanes, expected equal numbers"
    );
    let net =
        RoadSegment::new(50.0).named("a").connect("two", RoadSegment::new(50.0).lane_width(3.0).named("b"), "one");
    assert_eq!(refusal(net), "`a.two` with lanes of 3.5 m cannot be connected to `b.one` with lanes of 3 m");
}

#[test]
fn a_point_connected_twice_is_refused_with_all_three_points() {
    let road = || RoadSegment::new(50.0);
    let net = road().connect("two", road(), "one").connect("two", road(), "one");
    assert_eq!(refusal(net), "`road.two` cannot be connected to `road-3.one`: it is connected to `road-2.one` already");
    let net = road().connect("two", road(), "one").connect("road-2.two", road(), "one").close("road-2.one", "one");
    assert_eq!(refusal(net), "`road-2.one` cannot be connected to `road.one`: it is connected to `road.two` already");
    let itself = Composite::from(road()).close("one", "one");
    assert_eq!(refusal(itself), "`road.one` cannot be connected to `road.one`: it is connected to `road.one` already");
}

#[test]
fn unknown_points_and_elements_are_named_with_the_nearest() {
    let (main, side) = (RoadSegment::new(50.0).named("main"), RoadSegment::new(50.0).named("side"));
    let refused = |at: &str, end: &str| refusal(main.clone().connect(at, side.clone(), end));
    assert_eq!(refused("tow", "one"), "`main` has no point `tow` (did you mean `two`?); its points are one, two");
    assert_eq!(refused("three", "one"), "`main` has no point `three`; its points are one, two");
    assert_eq!(refused("two", "side.oen"), "`side` has no point `oen` (did you mean `one`?); its points are one, two");
    assert_eq!(refused("maim.two", "one"), "no road element is called `maim` (did you mean `main`?)");
    let net = main.connect("two", side, "one").build().unwrap();
    let message = |error: RoadError| error.to_string();
    assert_eq!(
        net.on_lane("sude", 1, 0.0).map_err(message).unwrap_err(),
        "no road element is called `sude` (did you mean `side`?)"
    );
    assert_eq!(
        net.on_lane("side", 2, 0.0).map_err(message).unwrap_err(),
        "`side` has no lane 2; it has 1 to 1 and -1 to -1"
    );
    assert_eq!(
        net.on_lane("side", 1, 50.5).map_err(message).unwrap_err(),
        "there is no place 50.5 m along `side`, which is 50 m long"
    );
}

#[test]
fn two_elements_of_one_name_are_refused_and_those_without_a_name_are_numbered() {
    let road = |name: &str| RoadSegment::new(50.0).named(name);
    assert_eq!(
        refusal(road("a").connect("two", road("a"), "one")),
        "two road elements are called `a`: give each element a name of its own"
    );
    let pair = || RoadSegment::new(20.0).connect("two", RoadSegment::new(20.0), "one");
    let net = pair().connect("road-2.two", pair(), "one").connect("road-4.two", road("road-5"), "one");
    let net = net.connect("road-5.two", RoadSegment::new(20.0), "one").build().unwrap();
    assert_eq!(net.elements().collect::<Vec<_>>(), ["road", "road-2", "road-3", "road-4", "road-5", "road-6"]);
}

#[test]
fn the_first_mistake_is_the_one_that_is_reported() {
    let net = RoadSegment::new(50.0).connect("tow", RoadSegment::new(-1.0), "one").close("a.one", "b.one");
    assert!(refusal(net).contains("`tow`"));
}

#[test]
fn elements_that_cannot_be_are_refused() {
    let refused = |element: Composite| refusal(element);
    assert_eq!(
        refused(RoadSegment::new(50.0).lanes(3).into()),
        "`road` has 3 lanes, expected an even number from 2 to 16"
    );
    assert!(refused(RoadSegment::new(f64::NAN).into()).contains("NaN"));
    assert!(refused(RoadSegment::arc(4.0, 1.0).named("bend").into()).contains("`bend` bends with a radius of 4 m"));
    assert!(refused(RoadSegment::arc(50.0, 6.0).into()).contains("turns by 343.8 degrees"));
    assert!(refused(RoadSegment::new(50.0).zebra(49.0).into()).contains("zebra crossing at 49 m"));
    assert!(refused(RoadSegment::new(50.0).zebra(20.0).zebra(17.0).into()).contains("zebra crossing at 20 m"));
    assert!(refused(CrossIntersection::new().corner(1.5).into()).contains("radius of 1.5 m, expected more than 2 m"));
    assert!(refused(Roundabout::new().arms(2).into()).contains("has 2 arms, expected 3 to 8"));
    assert!(refused(Roundabout::new().arms(i32::MAX).into()).contains("arms"));
    let nowhere = Pose { position: Vector2::new(f64::NAN, 0.0), heading: 0.0 };
    assert_eq!(
        refused(RoadSegment::new(50.0).at(nowhere)),
        "`road` is put at (NaN, 0), heading 0, expected finite numbers"
    );
    let narrow = refused(Roundabout::new().arms(8).into());
    assert!(narrow.contains("at least"), "{narrow}");
    // What is said to be enough is.
    let least: f64 = narrow.split("at least ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    Roundabout::new().arms(8).island(least + 0.01).build().unwrap();
}

#[test]
fn a_road_over_another_is_refused_with_both_and_the_place() {
    // Three left bends of a quarter with 20 m between lead back over the first road.
    let bend = || RoadSegment::arc(10.0, FRAC_PI_2);
    let net = RoadSegment::new(60.0)
        .named("first")
        .connect("two", bend(), "one")
        .connect("road.two", bend(), "one")
        .connect("road-2.two", bend(), "one")
        .connect("road-3.two", RoadSegment::new(60.0).named("last"), "one");
    let Err(RoadError::Overlap { a, b, at }) = net.build() else { panic!("it was accepted") };
    assert_eq!((a.as_str(), b.as_str()), ("first", "last"));
    // The last road comes down at x = 50, where the first lies along y = 0.
    assert!((at.0 - 50.0).abs() < 6.0 && at.1.abs() < 6.0, "{at:?}");
}

#[test]
fn roads_of_11_m_have_room_11_m_apart_and_not_nearer() {
    // Out, around a half circle, and back beside the way out, shifted towards it by two bends.
    let back = |apart: f64| {
        let angle = libm::acos(1.0 - (30.0 - apart) / 30.0);
        RoadSegment::new(100.0)
            .connect("two", RoadSegment::arc(15.0, PI), "one")
            .connect("road-2.two", RoadSegment::arc(15.0, angle), "one")
            .connect("road-3.two", RoadSegment::arc(15.0, -angle), "one")
            .connect("road-4.two", RoadSegment::new(60.0), "one")
    };
    let net = back(11.1).build().unwrap();
    let gap = net.on_lane("road-5", 1, 30.0).unwrap().position.y - net.on_lane("road", -1, 30.0).unwrap().position.y;
    assert!((gap - 11.1).abs() < 1e-9, "{gap}");
    back(11.0).build().unwrap();
    let refused = refusal(back(10.9));
    assert!(refused.starts_with("the road elements `road` and `road-"), "{refused}");
}

/// A square of straight roads and bends, its last road too long by `excess` and the last bend too wide by `turn`.
fn square(excess: f64, turn: f64) -> Composite {
    let bend = |turn: f64| RoadSegment::arc(15.0, FRAC_PI_2 + turn);
    let road = |excess: f64| RoadSegment::new(40.0 + excess);
    let mut loop_road = Composite::from(road(0.0));
    for corner in 1..=3 {
        let number = |index: usize| if index == 1 { "road.two".to_owned() } else { format!("road-{index}.two") };
        loop_road = loop_road.connect(&number(2 * corner - 1), bend(0.0), "one");
        loop_road = loop_road.connect(&number(2 * corner), road(if corner == 3 { excess } else { 0.0 }), "one");
    }
    loop_road.connect("road-7.two", bend(turn), "one").close("road-8.two", "one")
}

#[test]
fn a_loop_closes_to_a_centimetre_and_a_tenth_of_a_degree() {
    square(0.0, 0.0).build().unwrap();
    square(0.009, 0.0).build().unwrap();
    assert_eq!(
        refusal(square(0.02, 0.0)),
        "the loop does not close: `road-8.two` and `road.one` are 0.020 m and 0.00 degrees apart, at most 0.01 m and \
         0.1 degrees are allowed"
    );
    let Err(RoadError::OpenLoop { a, b, angle, .. }) = square(0.0, 0.2_f64.to_radians()).build() else {
        panic!("it was accepted")
    };
    assert_eq!((a.as_str(), b.as_str()), ("road-8.two", "road.one"));
    assert!((angle - 0.2).abs() < 1e-6, "{angle}");
}

#[test]
fn the_papers_loop_of_straight_roads_and_t_intersections_closes_and_leads_round_to_the_right() {
    // Each T is entered along its stem and left to the right.
    let names = ["north", "east", "south", "west"];
    let road = |name: &str| RoadSegment::new(40.0).named(format!("{name} road"));
    let tee = |name: &str| TIntersection::new().named(name);
    let mut ring = tee(names[0]).connect("one", road(names[0]), "one");
    for pair in names.windows(2) {
        ring = ring.connect(&format!("{} road.two", pair[0]), tee(pair[1]), "two");
        ring = ring.connect(&format!("{}.one", pair[1]), road(pair[1]), "one");
    }
    let net = ring.close("west road.two", "north.two").build().unwrap();
    let start = RoutePosition { lane: net.lane_of("north road", 1).unwrap(), s: 20.0 };
    let round = net.route(start, RoutePosition { s: 10.0, ..start }, 20.0).unwrap();
    let kinds = round.lanes.iter().map(|lane| net.lane(*lane).kind);
    let expected = [LaneKind::Road, LaneKind::Right].into_iter().cycle().take(9);
    assert!(kinds.eq(expected), "{round:?}");
    // Four roads and four quarters of a circle of 6 m and half a lane, but for the last 10 m.
    assert!((round.length - (4.0 * 40.0 + 2.0 * PI * 7.75 - 10.0)).abs() < 1e-9, "{}", round.length);
}

#[test]
fn a_composite_stands_where_its_root_is_put() {
    let pose = Pose { position: Vector2::new(100.0, -40.0), heading: FRAC_PI_2 };
    let net = RoadSegment::new(50.0).connect("two", RoadSegment::new(30.0), "one").at(pose).build().unwrap();
    let end = net.on_lane("road-2", 1, 30.0).unwrap();
    assert!((end.position - Vector2::new(101.75, 40.0)).norm() < 1e-9, "{end:?}");
}

#[test]
fn every_lane_of_a_grid_city_leads_on_and_reaches_every_other() {
    for (rows, columns, lanes) in [(2, 3, 2), (3, 4, 2), (3, 3, 4)] {
        let city = grid_city(rows, columns, 60.0, lanes);
        assert_eq!(city.free_points(), [""; 0]);
        let city = city.build().unwrap();
        for lane in city.lanes() {
            assert!(!lane.successors.is_empty(), "{lane:?}");
        }
        let place = |index: usize| RoutePosition { lane: city.ids().nth(index).unwrap(), s: 0.0 };
        for index in (0..city.lanes().len()).step_by(7) {
            assert!(city.route(place(0), place(index), 20.0).is_some(), "{index}");
            assert!(city.route(place(index), place(0), 20.0).is_some(), "{index}");
        }
    }
}

#[test]
fn an_intersection_of_two_lane_roads_has_twelve_ways_and_the_stem_of_a_t_none_ahead() {
    let net = CrossIntersection::new().build().unwrap();
    let count = |kind| net.lanes().iter().filter(|lane| lane.kind == kind).count();
    assert_eq!([LaneKind::Straight, LaneKind::Left, LaneKind::Right].map(count), [4, 4, 4]);
    let tee = TIntersection::new().named("tee").build().unwrap();
    assert_eq!(tee.lanes().len(), 6);
    let kind = |from, to| tee.lane_between("tee", from, to, 1).map(|lane| tee.lane(lane).kind);
    assert_eq!(kind("two", "one"), Ok(LaneKind::Right));
    assert_eq!(kind("two", "three"), Ok(LaneKind::Left));
    assert_eq!(kind("three", "one"), Ok(LaneKind::Straight));
    assert_eq!(kind("one", "one").unwrap_err().to_string(), "`tee` has no lane 1 from `one` to `one`; it has none");
}

#[test]
fn the_stem_of_a_t_and_who_enters_a_roundabout_give_way_and_where_roads_cross_right_goes_before_left() {
    let tee = TIntersection::new().named("it").build().unwrap();
    let cross = CrossIntersection::new().named("it").build().unwrap();
    let gives_way = |net: &RoadNetwork, (from, to): (&str, &str), (other_from, other_to): (&str, &str)| {
        let lane = net.lane_between("it", from, to, 1).unwrap();
        let other = net.lane_between("it", other_from, other_to, 1).unwrap();
        net.lane(lane).conflicts.iter().find(|conflict| conflict.with == other).map(|conflict| conflict.gives_way)
    };
    let both = |net: &RoadNetwork, way, other| (gives_way(net, way, other), gives_way(net, other, way));
    let (first, second, none) = ((Some(false), Some(true)), (Some(true), Some(false)), (None, None));
    // East, south, west, north are one, two, three, four.
    assert_eq!(both(&tee, ("two", "three"), ("three", "one")), second);
    assert_eq!(both(&tee, ("two", "one"), ("three", "one")), second);
    assert_eq!(both(&tee, ("one", "two"), ("three", "one")), second);
    assert_eq!(both(&cross, ("one", "three"), ("two", "four")), first, "from the south, the east is at the right");
    assert_eq!(both(&cross, ("one", "three"), ("four", "two")), second);
    assert_eq!(both(&cross, ("one", "two"), ("three", "one")), second);
    assert_eq!(both(&cross, ("one", "two"), ("three", "four")), none);
    assert_eq!(both(&cross, ("one", "three"), ("three", "one")), none);

    let ring = Roundabout::new().lanes(4).build().unwrap();
    for lane in ring.lanes() {
        for conflict in &lane.conflicts {
            let other = ring.lane(conflict.with).kind;
            let enters = lane.kind == LaneKind::Entry;
            let leaves = lane.kind == LaneKind::Exit && other != LaneKind::Entry;
            assert_eq!(conflict.gives_way, enters || leaves, "{lane:?} {other:?}");
        }
    }
}

#[test]
fn traffic_keeps_to_the_right_and_goes_round_a_roundabout_counter_clockwise() {
    let net =
        Roundabout::new().named("ring").connect("one", RoadSegment::new(30.0).named("east"), "one").build().unwrap();
    for lane in net.lanes().iter().filter(|lane| matches!(lane.kind, LaneKind::Ring | LaneKind::RingAtArm)) {
        let middle = lane.curve.at(0.5 * lane.length());
        // Left of the way is the middle of the ring, at the origin.
        assert!(middle.to_local(Vector2::zeros()).y > 5.0, "{lane:?}");
    }
    // A car that comes in from the east is north of the centre line.
    assert!(net.on_lane("east", -1, 10.0).unwrap().position.y > 0.0);
    // Once around from the first arm to itself: in, past the four arms and the ways between them, and out.
    let lane = |number| net.lane_of("east", number).unwrap();
    let route =
        net.route(RoutePosition { lane: lane(-1), s: 0.0 }, RoutePosition { lane: lane(1), s: 30.0 }, 20.0).unwrap();
    let kinds: Vec<LaneKind> = route.lanes.iter().map(|lane| net.lane(*lane).kind).collect();
    use LaneKind::{Entry, Exit, Ring, RingAtArm, Road};
    assert_eq!(kinds, [Road, Entry, Ring, RingAtArm, Ring, RingAtArm, Ring, RingAtArm, Ring, Exit, Road]);
}

#[test]
fn a_way_changes_lanes_only_where_that_is_cheaper() {
    // From the right lane one can only go straight on or turn right; to turn left it takes the left one.
    let road = |name: &str| RoadSegment::new(100.0).lanes(4).named(name);
    let net = CrossIntersection::new()
        .lanes(4)
        .connect("one", road("east"), "one")
        .connect("two", road("south"), "one")
        .connect("three", road("west"), "one")
        .build()
        .unwrap();
    let place = |element: &str, lane| RoutePosition { lane: net.lane_of(element, lane).unwrap(), s: 10.0 };
    let route = net.route(place("east", -2), place("south", 1), 20.0).unwrap();
    assert_eq!(route.changes, 1);
    let lanes = [net.lane_of("east", -2), net.lane_of("east", -1)].map(Result::unwrap);
    assert_eq!(route.lanes[..2], lanes);
    let straight = net.route(place("east", -2), place("west", 2), 20.0).unwrap();
    assert_eq!(straight.changes, 0);
    assert!((straight.length - (90.0 + 26.0 + 10.0)).abs() < 1e-9, "{}", straight.length);
    // Behind the car, on a road that does not come back, lies nothing that it could reach.
    let behind = RoutePosition { s: 5.0, ..place("east", -2) };
    assert_eq!(net.route(place("east", -2), behind, 20.0), None);
}

#[test]
fn a_zebra_crossing_says_which_lanes_it_crosses_and_where() {
    let net = RoadSegment::arc(40.0, 1.0).lanes(4).named("bend").zebra(10.0).build().unwrap();
    let [crossing] = net.crossings() else { panic!("{:?}", net.crossings()) };
    assert_eq!(crossing.lanes.len(), 4);
    for ((lane, s), i) in crossing.lanes.iter().zip(0..) {
        let met = net.lane(*lane).curve.point(*s);
        let expected = crossing.path.point(1.75 + 3.5 * f64::from(i));
        assert!((met - expected).norm() < 1e-9, "lane {i}: {met} {expected}");
    }
}

#[test]
fn a_sidewalk_is_walked_along_its_middle_and_a_broken_line_painted_dash_by_dash() {
    let net = RoadSegment::new(90.0).build().unwrap();
    let strips = net.strips();
    let of = |surface| strips.iter().filter(move |strip| strip.surface == surface);
    let ends: Vec<_> = of(Surface::Sidewalk).map(|strip| (strip.middle().start(), strip.middle().end())).collect();
    assert_eq!(ends.len(), 2);
    for ((start, end), (y, from, to)) in ends.into_iter().zip([(-4.5, 0.0, 90.0), (4.5, 90.0, 0.0)]) {
        assert!((start.position - Vector2::new(from, y)).norm() < 1e-9, "{start:?}");
        assert!((end.position - Vector2::new(to, y)).norm() < 1e-9, "{end:?}");
    }
    // Ten dashes of 3 m and ten gaps of 6 m, half a gap at either end.
    let dashes: Vec<_> = of(Surface::CentreLine).flat_map(Strip::solid_parts).collect();
    assert_eq!(dashes.len(), 10);
    for (dash, i) in dashes.iter().zip(0..) {
        assert_eq!((dash.curve.start().position.x, dash.curve.length()), (3.0 + 9.0 * f64::from(i), 3.0));
        let outline = dash.outline(0.01);
        let turning: f64 = (0..4).map(|i| outline[i].perp(&outline[(i + 1) % 4])).sum();
        assert!((0.5 * turning - 3.0 * 0.12).abs() < 1e-9, "counter-clockwise, of a dash's area: {turning}");
    }
}

#[test]
fn a_way_goes_straight_on_over_crossings_and_ends_where_the_roads_end() {
    let arm = |name: &str| RoadSegment::new(40.0).named(name);
    let crossing = CrossIntersection::new().connect("one", arm("east"), "one").connect("two", arm("south"), "one");
    let net = crossing.connect("three", arm("west"), "one").connect("four", arm("north"), "one").build().unwrap();
    let begin = net.lane_of("west", -1).unwrap();
    let way = net.onward(begin, 1000.0);
    assert_eq!((way.len(), way[0], way[2]), (3, begin, net.lane_of("east", 1).unwrap()));
    assert_eq!(net.onward(begin, 1.0).len(), 2);
    assert_eq!(net.onward(begin, 0.0), [begin]);
    let ring = grid_city(2, 2, 50.0, 2).build().unwrap();
    let round = ring.onward(ring.ids().next().unwrap(), 1e6);
    assert!(round.len() >= 8 && round.len() <= ring.lanes().len(), "{} lanes", round.len());
}
