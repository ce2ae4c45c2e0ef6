//! Values beyond the standard or beyond all roads: each is refused at its place, or noted.

use super::cases::{in_file, parse, refuses, with};

#[test]
fn a_piece_of_a_reference_line_begins_on_its_road() {
    let second = "<line/></geometry>\n<geometry s=\"60\" x=\"60\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry>";
    refuses(
        &[("<line/></geometry>", second)],
        "road.xodr:6: `s=\"60\"` of <geometry> is not allowed, expected at most 50, the length of the road",
    );
}

#[test]
fn absurd_coordinates_are_refused() {
    for attribute in ["x", "y", "hdg"] {
        let (found, by) = (format!("{attribute}=\"0\""), format!("{attribute}=\"1e300\""));
        let says = format!("`{by}` of <geometry> is not allowed, expected a magnitude of at most 1000000000");
        refuses(&[(&found, &by)], &says);
    }
}

#[test]
fn the_first_width_of_a_lane_begins_with_its_section() {
    for name in ["width", "border"] {
        let by = format!("<{name} sOffset=\"5\"");
        let says = format!("`sOffset=\"5\"` of <{name}> is not allowed, expected 0 for the first <{name}> of a lane");
        refuses(&[("<width sOffset=\"0\"", &by)], &says);
    }
}

#[test]
fn objects_and_signals_with_the_id_of_another_are_noted() {
    let of = |name: &str, id: &str| format!("<{name} id=\"{id}\" s=\"5\" t=\"5\"/>\n");
    let objects =
        format!("<link/><objects>\n{}{}{}</objects>", of("object", "7"), of("object", "7"), of("object", "7"));
    let signals = format!("<signals>{}{}</signals>", of("signal", "7"), of("signal", "7"));
    let map = parse(with(&[("<link/>", &format!("{objects}{signals}"))])).expect("it is sound");
    let notes: Vec<_> = map.notes.iter().map(in_file).collect();
    let says =
        |line: u32, name: &str| format!("x.xodr:{line}: the {name} has the id `7` of another {name}; both are read");
    assert_eq!(notes, [says(6, "object") + "; and 1 object more", says(9, "signal")]);
}

#[test]
fn numbers_in_messages_have_few_digits() {
    let high = "<elevationProfile><elevation s=\"0\" a=\"1e30\" b=\"0\" c=\"0\" d=\"0\"/></elevationProfile><lanes>";
    let map = parse(with(&[("<lanes>", high)])).expect("it is sound");
    let notes: Vec<_> = map.notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes, ["the world is flat: heights up to 1e30 m are left out"]);
    let coil = "length=\"33\"><arc curvature=\"1e6\"/>";
    let says = "expected a magnitude of at most 30.303 1/m for a length of 33 m";
    refuses(&[("length=\"50\"><line/>", coil)], says);
}

#[test]
fn types_of_roads_and_values_without_effect_are_checked() {
    let road = |kind: &str| format!("<link/><type s=\"0\" type=\"{kind}\"/>");
    refuses(
        &[("<link/>", &road("twon"))],
        "`type=\"twon\"` of <type> is not allowed, expected one of unknown, rural, ",
    );
    assert!(parse(with(&[("<link/>", &road("town"))])).is_ok_and(|map| map.notes.is_empty()));
    let lane = |level: &str| format!("type=\"driving\" level=\"{level}\"");
    refuses(
        &[("type=\"driving\"", &lane("maybe"))],
        "`level=\"maybe\"` of <lane> is not allowed, expected one of true, ",
    );
    let notes = |level| parse(with(&[("type=\"driving\"", &lane(level))])).expect("it is sound").notes;
    assert!(notes("false").is_empty());
    assert_eq!(in_file(&notes("true")[0]), "x.xodr:8: `lane.level` has no effect: the world is flat");
    let side = "<laneSection s=\"0\" singleSide=\"true\">";
    let says = "`singleSide=\"true\"` of <laneSection> is not allowed, expected false: write the lanes of both sides into each section";
    refuses(&[("<laneSection s=\"0\">", side)], says);
}
