//! Objects and signals of files: their bodies, and what is refused.

use paracosm_engine::object::{Class, Outline};
use paracosm_standards::opendrive::{Map, Object};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

fn text() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/roads/files/objects.xodr");
    std::fs::read_to_string(file).expect("it is there")
}

fn objects() -> Vec<Object> {
    Map::parse("objects.xodr".as_ref(), text()).unwrap_or_else(|error| panic!("{error}")).roads.remove(0).objects
}

/// The parts of an object: the class, x, y, the heading, the length, the width and the height.
fn parts(id: &str) -> Vec<(Class, [f64; 6])> {
    let object = objects().into_iter().find(|object| object.id == id).unwrap_or_else(|| panic!("no object {id}"));
    let part = |(body, pose): &(paracosm_engine::object::Body, paracosm_engine::Pose)| {
        let half = body.outline.half_extent();
        let rounded = |number: f64| (number * 1e6).round() / 1e6;
        let numbers = [pose.position.x, pose.position.y, pose.heading, 2.0 * half.x, 2.0 * half.y, body.height];
        (body.class, numbers.map(rounded))
    };
    object.parts.iter().map(part).collect()
}

#[test]
fn things_have_the_measures_of_the_file() {
    assert_eq!(parts("lamp"), [(Class::Sign, [10.0, 6.0, 0.0, 0.2, 0.2, 5.0])]);
    assert_eq!(parts("tree"), [(Class::Tree, [20.0, -8.0, 0.0, 0.8, 0.8, 7.0])]);
    assert_eq!(parts("parked"), [(Class::Prop, [30.0, -1.75, 0.1, 4.5, 1.8, 1.5])]);
    let lamp = objects().remove(0).parts[0].0;
    assert!(matches!(lamp.outline, Outline::Disc { .. }), "{lamp:?}");
}

#[test]
fn a_signal_is_a_post_from_the_ground_to_its_top() {
    assert_eq!(parts("limit"), [(Class::Sign, [15.0, -5.0, 0.0, 0.1, 0.1, 2.3])]);
}

#[test]
fn marks_on_the_ground_and_gantries_have_no_body() {
    for id in ["crosswalk", "gantry", "line"] {
        assert_eq!(parts(id), [], "{id}");
    }
}

#[test]
fn an_outline_becomes_a_wall_along_each_edge() {
    let house = parts("house");
    assert_eq!(house.len(), 3);
    assert_eq!(house[0], (Class::Building, [64.0, 15.0, 0.0, 8.0, 0.2, 6.0]));
    let [x, y, heading, length, ..] = house[1].1;
    assert_eq!([x, y, length], [68.0, 17.5, 5.0]);
    assert!((heading - FRAC_PI_2).abs() < 1e-5, "{heading}");
    // An outline that is not closed has no last edge.
    assert_eq!(parts("fence"), [(Class::Prop, [80.0, -6.0, 0.0, 20.0, 0.2, 1.0])]);
}

#[test]
fn a_repetition_has_things_at_each_step_or_pieces_without_gaps() {
    let posts: Vec<_> = parts("posts").iter().map(|(_, [x, y, .., height])| [*x, *y, *height]).collect();
    assert_eq!(posts, [[0.0, 5.0, 1.0], [50.0, 6.0, 1.5], [100.0, 7.0, 2.0]]);
    let railing: Vec<_> = parts("railing").iter().map(|(_, [x, _, _, length, ..])| [*x, *length]).collect();
    assert_eq!(railing.len(), 3);
    assert!(railing.iter().all(|[_, length]| (length - 10.0 / 3.0).abs() < 1e-5), "{railing:?}");
    assert!((railing[0][0] - (10.0 + 5.0 / 3.0)).abs() < 1e-5, "{railing:?}");
}

#[test]
fn a_mistake_in_an_object_is_refused_with_its_line() {
    for (from, to, says) in [
        ("s=\"10\" t=\"6\"", "s=\"10\" t=\"left\"", "objects.xodr:12: `t=\"left\"` of <object>"),
        ("s=\"10\" t=\"6\"", "t=\"6\"", "objects.xodr:12: <object> has no attribute `s`"),
        ("s=\"20\"", "s=\"200\"", "objects.xodr:13: `s=\"200\"` of <object> is not allowed, expected at most 100 m"),
        (
            "radius=\"0.4\"",
            "radius=\"-1\"",
            "objects.xodr:13: `radius=\"-1\"` of <object> is not allowed, expected 0 to 1000 m",
        ),
        ("distance=\"50\"", "distance=\"0.001\"", "objects.xodr:33: `distance=\"0.001\"` of <repeat>"),
        ("s=\"15\" t=\"-5\"", "s=\"-15\" t=\"-5\"", "objects.xodr:40: `s=\"-15\"` of <signal>"),
        ("zOffset=\"1.7\"", "zOffset=\"1000\"", "objects.xodr:40: `zOffset=\"1000\"` of <signal> is not allowed"),
        (
            "<cornerRoad s=\"90\" t=\"-6\" dz=\"0\" height=\"1\"/>",
            "",
            "objects.xodr:27: <outline> has 1 corner, expected at least 2",
        ),
        ("<cornerLocal", "<cornerLokal", "did you mean `cornerLocal`?"),
    ] {
        assert!(text().contains(from), "{from}");
        let changed = text().replacen(from, to, 1);
        let error = Map::parse("objects.xodr".as_ref(), changed).expect_err(says).to_string();
        assert!(error.contains(says), "{error} instead of {says}");
    }
}
