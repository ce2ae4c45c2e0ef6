//! Networks of our elements are written as files, and reading the files gives the same lanes.

use paracosm_engine::Pose;
use paracosm_engine::road::{
    Composite, CrossIntersection, Lane, RoadNetwork, RoadSegment, Roundabout, TIntersection, grid_city,
};
use paracosm_standards::opendrive::{Map, write};
use std::sync::Arc;

/// Networks of all kinds of elements.
pub fn networks() -> Vec<(&'static str, Arc<RoadNetwork>)> {
    let road = |length: f64, name: &str| RoadSegment::new(length).lanes(4).named(name);
    let tee =
        TIntersection::new().lanes(4).connect("one", road(50.0, "e"), "two").connect("two", road(50.0, "s"), "one");
    let tee = tee.connect("three", road(20.0, "w"), "one");
    let bend = RoadSegment::arc(80.0, 1.2).lanes(2).named("bend");
    let bent = RoadSegment::new(60.0).lanes(2).named("straight").connect("two", bend, "one");
    let arm = |name: &str| RoadSegment::new(40.0).lanes(4).named(name);
    let ring =
        Roundabout::new().lanes(4).arms(5).island(15.0).connect("one", arm("a"), "one").connect("two", arm("b"), "two");
    let ring = ring.connect("three", arm("c"), "one").connect("four", arm("d"), "one").connect("five", arm("e"), "one");
    let built = |composite: Composite| composite.build().expect("it is sound");
    vec![
        ("alone", RoadSegment::new(200.0).lanes(6).build().expect("it is sound")),
        ("tee", built(tee)),
        ("bent", built(bent)),
        ("roundabout", built(ring)),
        ("crossing", built(CrossIntersection::new().lanes(4).connect("one", arm("a"), "one"))),
        ("city", built(grid_city(3, 4, 60.0, 4))),
    ]
}

/// The greatest distance in metres of the lanes of a network from the lanes of another network that match best.
fn difference(network: &RoadNetwork, other: &RoadNetwork) -> f64 {
    let points =
        |lane: &Lane| (0..=20).map(|i| lane.curve.at(lane.length() * f64::from(i) / 20.0)).collect::<Vec<Pose>>();
    let samples: Vec<Vec<Pose>> = other.lanes().iter().map(points).collect();
    let apart = |a: &[Pose], b: &[Pose]| {
        let distances = a.iter().zip(b).map(|(a, b)| (a.position - b.position).norm());
        distances.fold(0.0, f64::max)
    };
    let nearest = |lane: &Lane| {
        let lane = points(lane);
        samples.iter().map(|other| apart(&lane, other)).fold(f64::INFINITY, f64::min)
    };
    network.lanes().iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_network_that_is_written_and_read_has_the_same_lanes_links_and_rules() {
    for (name, network) in networks() {
        let text = write(&network, name).expect("it is of our elements");
        let map = Map::parse(name.as_ref(), text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(map.notes, [], "{name}");
        let again = map.network().expect("it has lanes");
        let difference = difference(&network, &again).max(self::difference(&again, &network));
        println!("{name}: {} lanes, {difference:e} m", network.lanes().len());
        assert!(difference < 1e-6, "{name}: {difference} m");
        let count = |of: &dyn Fn(&Lane) -> usize| {
            [&network, &again].map(|network| network.lanes().iter().map(of).sum::<usize>())
        };
        for (what, [before, after]) in [
            ("lanes", count(&|_| 1)),
            ("links", count(&|lane| lane.successors.len())),
            ("neighbours", count(&|lane| lane.beside().count())),
            ("conflicts", count(&|lane| lane.conflicts.len())),
            ("rules", count(&|lane| lane.conflicts.iter().filter(|conflict| conflict.gives_way).count())),
        ] {
            assert_eq!(before, after, "{what} of {name}");
        }
    }
}

#[test]
fn names_with_characters_of_xml_are_written_so_that_they_can_be_read() {
    let network = RoadSegment::new(20.0).named("a<b & \"c\"").build().expect("it is sound");
    let map = Map::parse("names".as_ref(), write(&network, "x").expect("it is ours"))
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(map.roads[0].name, "a<b & \"c\"");
}

#[test]
fn a_network_of_a_file_is_written_as_the_text_of_the_file() {
    let network = networks().remove(0).1;
    let text = write(&network, "x").expect("it is ours");
    let map = Map::parse("road".as_ref(), text.clone()).expect("it is sound");
    assert_eq!(write(&map.network().expect("it has lanes"), "another name"), Ok(text));
}
