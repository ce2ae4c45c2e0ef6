//! Our own small files: what each element does, and what is refused. The table of `docs/opendrive.md` is written from them.

use paracosm_standards::opendrive::{LaneType, Link, Map, Note, Road, Traffic, elements};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/roads/files").join(name)
}

fn read(name: &str) -> Map {
    Map::read(&file(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// A file with one straight road, with texts in place of parts of it.
pub fn with(changes: &[(&str, &str)]) -> String {
    let mut text = r#"<OpenDRIVE>
<header revMajor="1" revMinor="6"/>
<road id="1" length="50" junction="-1">
<link/>
<planView><geometry s="0" x="0" y="0" hdg="0" length="50"><line/></geometry></planView>
<lanes><laneSection s="0">
<center><lane id="0" type="none"/></center>
<right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right>
</laneSection></lanes>
</road>
</OpenDRIVE>"#
        .to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text
}

pub fn parse(text: String) -> Result<Map, String> {
    Map::parse("road.xodr".as_ref(), text).map_err(|error| error.to_string())
}

pub fn in_file(note: &Note) -> String {
    note.in_file("x.xodr".as_ref())
}

#[track_caller]
pub fn refuses(changes: &[(&str, &str)], says: &str) {
    let message = parse(with(changes)).expect_err("it was accepted");
    assert!(message.contains(says), "expected `{says}` in: {message}");
}

#[test]
fn every_shape_of_a_reference_line_begins_where_the_one_before_ends() {
    let map = read("geometries.xodr");
    let line = &map.roads[0].line;
    assert_eq!(line.pieces().len(), 5);
    for pair in line.pieces().windows(2) {
        let end = pair[0].at(pair[0].length);
        assert!((end.position - pair[1].start.position).norm() < 1e-5, "{end:?} {:?}", pair[1].start);
        assert!((end.heading - pair[1].start.heading).abs() < 1e-5);
    }
}

#[test]
fn borders_of_lanes_follow_offsets_widths_and_borders() {
    let map = read("geometries.xodr");
    let road = &map.roads[0];
    let borders = |s: f64| [2, 1, 0, -1, -2].map(|lane| road.border(road.section_at(s), lane, s));
    assert_eq!(borders(10.0), [Some(5.5), Some(3.5), Some(0.5), Some(-2.5), Some(-6.5)]);
    // The first lane on the right is 0.05 m wider with every metre from s = 30 m on; the border of the second stays.
    let right = borders(50.0)[3].expect("a lane");
    assert!((right + 3.5).abs() < 1e-12, "{right}");
    assert_eq!(borders(50.0)[4], Some(-6.5));
    assert_eq!(borders(100.0)[0], None);
}

#[test]
fn speed_limits_have_metres_and_seconds() {
    let map = read("geometries.xodr");
    let road = &map.roads[0];
    assert_eq!(road.limits, [(0.0, Some(50.0 / 3.6))]);
    let lane = road.sections[0].lane(1).expect("a lane");
    assert_eq!(lane.limits, [(0.0, Some(30.0 * 0.44704))]);
    let none = with(&[("<link/>", r#"<type s="0" type="motorway"><speed max="no limit"/></type>"#)]);
    assert_eq!(parse(none).expect("it is sound").roads[0].limits, [(0.0, None)]);
}

#[test]
fn speed_limits_hold_along_the_lanes_of_the_network() {
    let lane = r#"<width sOffset="0" a="3.5" b="0" c="0" d="0"/>"#;
    let limited = format!(r#"{lane}<speed sOffset="10" max="20"/><speed sOffset="30" max="no limit"/>"#);
    let road = r#"<link/><type s="0" type="town"><speed max="36" unit="km/h"/></type>"#;
    let left = r#"<left><lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/>
        <speed sOffset="20" max="0"/></lane></left><center>"#;
    let text = with(&[(lane, &limited), ("<link/>", road), ("<center>", left)]);
    let network = parse(text).expect("it is sound").network().expect("it has lanes");
    let limit = |number: i32, s: f64| network.lane(network.lane_of("1", number).expect("the lane")).limit_at(s);
    for (s, expected) in [(0.0, Some(10.0)), (9.9, Some(10.0)), (10.1, Some(20.0)), (29.9, Some(20.0)), (30.1, None)] {
        assert_eq!(limit(1, s), expected, "{s} m along the road");
    }
    // The lane on the left leads back. A limit of 0 counts as the least limit.
    for (s, expected) in [(0.0, Some(1.0)), (29.9, Some(1.0)), (30.1, Some(10.0)), (49.9, Some(10.0))] {
        assert_eq!(limit(-1, s), expected, "{s} m along the lane");
    }
}

#[test]
fn lanes_of_a_network_have_their_widths_at_every_place() {
    let width = r#"<width sOffset="0" a="3.5" b="0" c="0" d="0"/>"#;
    let wider = r#"<width sOffset="0" a="3" b="0" c="0" d="0"/><width sOffset="30" a="3" b="0.05" c="0" d="0"/>"#;
    for (width, expected) in [(width, [3.5; 3]), (wider, [3.0, 3.0, 3.75])] {
        let network = parse(with(&[(r#"<width sOffset="0" a="3.5" b="0" c="0" d="0"/>"#, width)]));
        let network = network.expect("it is sound").network().expect("it has lanes");
        let lane = network.lane(network.lane_of("1", 1).expect("the lane"));
        for (s, expected) in [0.0, 20.0, 45.0].into_iter().zip(expected) {
            // The middle of a lane that becomes wider is slightly longer than the road.
            assert!((lane.width_at(s) - expected).abs() < 1e-3, "{} instead of {expected}", lane.width_at(s));
        }
        assert_eq!(lane.widths.is_empty(), expected[2] == 3.5);
    }
}

#[test]
fn heights_are_left_out_and_a_note_says_so() {
    let map = read("geometries.xodr");
    let road: &Road = &map.roads[0];
    let [Note::Flat { height, roll }] = map.notes[..] else { panic!("{:?}", map.notes) };
    assert!((height - 2.4).abs() < 1e-12 && roll == 0.05, "{height} {roll}");
    assert!((road.height(40.0, 0.0) - 1.4).abs() < 1e-12);
    assert!((road.height(40.0, -4.0) - (1.4 - 4.0 * libm::sin(0.05))).abs() < 1e-12);
}

#[test]
fn lanes_of_a_network_lead_on_from_section_to_section() {
    let network = read("geometries.xodr").network().expect("it has lanes");
    // Lane -1 of the file is lane 1 of the network.
    let first = network.lane(network.lane_of("1", 1).expect("it has the lane"));
    assert_eq!(first.successors.len(), 1);
    assert_eq!(first.right.map(|right| network.lane(right).number), Some(2));
    let back = network.lane(network.lane_of("1", -1).expect("it has the lane"));
    assert!(back.successors.is_empty() && back.predecessors.len() == 1 && back.beside().next().is_none());
    let here = network.on_lane("1", 1, 10.0).expect("the road is longer");
    assert!((here.position.y + 1.0).abs() < 1e-9 && here.heading.abs() < 1e-9, "{here:?}");
    let there = network.on_lane("1", -1, 10.0).expect("the road is longer");
    assert!((there.position.y - 2.0).abs() < 1e-9 && there.heading.abs() > 3.0, "{there:?}");
}

#[test]
fn a_junction_connects_lanes_and_says_which_road_goes_first() {
    let map = read("junction.xodr");
    assert_eq!(map.roads[0].successor, Some(Link::Junction(0)));
    let network = map.network().expect("it has lanes");
    let lane = |road: &str, number: i32| network.lane_of(road, number).expect("it has the lane");
    let next = |road: &str, number: i32| network.lane(lane(road, number)).successors.clone();
    assert_eq!(next("w", 1), [lane("we", 1)]);
    assert_eq!(next("we", 1), [lane("e", 1)]);
    assert_eq!(next("e", -1), [lane("we", -1)]);
    assert_eq!(next("we", -1), [lane("w", -1)]);
    assert_eq!(next("s", -1), [lane("sw", 1)]);
    assert_eq!(next("sw", 1), [lane("w", -1)]);
    // The turn from the south crosses the way east and joins the way west, and gives way to both.
    let turn = network.lane(lane("sw", 1));
    assert_eq!(turn.conflicts.len(), 2);
    assert!(turn.conflicts.iter().all(|conflict| conflict.gives_way));
    assert!(network.lane(lane("we", 1)).conflicts.iter().all(|conflict| !conflict.gives_way));
}

#[test]
fn links_to_lanes_that_do_not_exist_are_noted() {
    let text = fs::read_to_string(file("junction.xodr")).expect("the file is readable");
    let wrong = text.replacen("<laneLink from=\"-1\" to=\"-1\"/>", "<laneLink from=\"-9\" to=\"-8\"/>", 1);
    let map = parse(wrong).expect("it is sound");
    assert_eq!(map.notes, [Note::NoLane { line: 55, lane: -9, count: 2 }]);
}

#[test]
fn links_of_lanes_beyond_the_end_of_a_road_without_links_are_noted() {
    let lane = "<width sOffset=\"0\" a=\"3.5\"";
    let linked = with(&[(lane, &format!("<link><predecessor id=\"-1\"/>\n<successor id=\"-1\"/></link>{lane}"))]);
    let notes: Vec<String> = parse(linked).expect("it is sound").notes.iter().map(in_file).collect();
    let says = "the lane has a link beyond the end of its road, but the road has none there; cars do not use it";
    assert_eq!(notes, [format!("x.xodr:8: {says}; and 1 link more")]);
}

#[test]
fn the_end_of_a_road_can_meet_the_beginning_of_the_road_but_not_itself() {
    let link = |name: &str, contact: &str| {
        format!("<link><{name} elementType=\"road\" elementId=\"1\" contactPoint=\"{contact}\"/></link>")
    };
    for (name, contact) in [("successor", "end"), ("predecessor", "start")] {
        let says = format!(
            "road.xodr:4: `elementId=\"1\"` of <{name}> is not allowed, expected another road, or the other end"
        );
        refuses(&[("<link/>", &link(name, contact))], &says);
    }
    let circle = "length=\"50\"><arc curvature=\"0.12566370614359174\"/>";
    let lane = "<width sOffset=\"0\" a=\"3.5\"";
    let ring = with(&[
        ("<link/>", &link("successor", "start")),
        ("length=\"50\"><line/>", circle),
        (lane, &format!("<link><successor id=\"-1\"/></link>{lane}")),
    ]);
    let map = parse(ring).expect("it is sound");
    assert_eq!(map.notes, []);
    let network = map.network().expect("it has lanes");
    let lane = network.lane_of("1", 1).expect("it has the lane");
    assert_eq!(network.lane(lane).successors, [lane]);
}

#[test]
fn links_between_lanes_that_do_not_meet_are_noted_and_not_used() {
    let text = fs::read_to_string(file("junction.xodr")).expect("the file is readable");
    let apart = parse(text.replacen("x=\"10\"", "x=\"12\"", 1)).expect("it is sound");
    // Lane -1 leads to the east road, and lane 1 comes from it by a link of the road and by one of the junction.
    assert_eq!(
        apart.notes.iter().map(in_file).collect::<Vec<_>>(),
        ["x.xodr:38: the link joins lanes that are 2.000 m apart; cars do not use it; and 2 links more"]
    );
    let network = apart.network().expect("it has lanes");
    assert!(network.lane(network.lane_of("we", 1).expect("it has the lane")).successors.is_empty());
}

#[test]
fn a_connection_without_links_of_lanes_connects_lanes_with_the_same_numbers() {
    let text = fs::read_to_string(file("junction.xodr")).expect("the file is readable");
    let links = ["<laneLink from=\"-1\" to=\"-1\"/>", "<laneLink from=\"1\" to=\"1\"/>"];
    let bare = links.iter().fold(text.clone(), |text, link| text.replacen(link, "", 1));
    let successors = |text: String| {
        let network = parse(text).expect("it is sound").network().expect("it has lanes");
        network.lanes().iter().map(|lane| lane.successors.clone()).collect::<Vec<_>>()
    };
    assert_eq!(successors(bare), successors(text));
}

#[test]
fn pieces_that_are_longer_or_shorter_than_their_share_of_the_road_are_noted() {
    let note = |length| {
        let map = parse(with(&[("hdg=\"0\" length=\"50\"", length)])).expect("it is sound");
        map.notes.iter().map(Note::to_string).collect::<Vec<_>>()
    };
    let piece = "the piece at s = 0.000 m of the reference line of road `1` is";
    assert_eq!(
        note("hdg=\"0\" length=\"30\""),
        [format!("{piece} 30.000 m long, but its share of the road is 50.000 m: its shape continues")]
    );
    assert_eq!(
        note("hdg=\"0\" length=\"80\""),
        [format!("{piece} 80.000 m long, but its share of the road is 50.000 m: the rest is cut")]
    );
}

#[test]
fn an_element_of_another_namespace_is_not_of_the_standard() {
    let other = "<link/><other:planView xmlns:other=\"urn:other\"/>";
    refuses(&[("<link/>", other)], "4: <road> has an element <{urn:other}planView>, which the standard does not have");
    let own = with(&[("<OpenDRIVE", "<OpenDRIVE xmlns=\"http://code.asam.net/simulation/standard/opendrive_schema\"")]);
    assert!(parse(own).is_ok());
}

#[test]
fn sections_without_length_and_lanes_for_both_directions_are_noted() {
    let notes = |changes: &[(&str, &str)]| parse(with(changes)).expect("it is sound").notes;
    let both = [("type=\"driving\"", "type=\"driving\" direction=\"both\"")];
    assert_eq!(notes(&both), [Note::OneWay { road: "1".to_owned(), lane: -1, count: 1 }]);
    let both = [("type=\"driving\"", "type=\"bidirectional\"")];
    assert_eq!(notes(&both), [Note::OneWay { road: "1".to_owned(), lane: -1, count: 1 }]);
    let empty = "<lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center></laneSection>";
    assert_eq!(notes(&[("<lanes>", empty)]), [Note::NoLength { road: "1".to_owned(), s: 0.0, count: 1 }]);
}

#[test]
fn the_end_of_a_road_is_a_place_on_its_lanes_and_on_its_centre_line() {
    for shape in ["<line/>", "<arc curvature=\"0.02\"/>", "<spiral curvStart=\"0\" curvEnd=\"0.03\"/>"] {
        let map = parse(with(&[("<line/>", shape)])).expect("it is sound");
        let network = map.network().expect("it has lanes");
        let end = map.roads[0].line.at(50.0);
        let centre = network.on_centre_line("1", 50.0).expect("the road is as long");
        let lane = network.on_lane("1", 1, 50.0).expect("the road is as long");
        assert!((centre.position - end.position).norm() < 1e-6, "{shape}: {centre:?}");
        assert!((lane.position - (end.position - end.left() * 1.75)).norm() < 1e-6, "{shape}: {lane:?}");
        assert!(network.on_lane("1", 1, 50.1).is_err());
    }
}

#[test]
fn traffic_on_the_left_drives_along_the_lanes_on_the_left() {
    let left = with(&[("junction=\"-1\"", "junction=\"-1\" rule=\"LHT\"")]);
    let map = parse(left).expect("it is sound");
    assert_eq!(map.roads[0].traffic, Traffic::LeftHand);
    let network = map.network().expect("it has lanes");
    let heading = network.on_lane("1", 1, 10.0).expect("the road is longer").heading;
    assert!(heading.abs() > 3.0, "{heading}");
    let reversed = with(&[("type=\"driving\"", "type=\"driving\" direction=\"reversed\"")]);
    let network = parse(reversed).expect("it is sound").network().expect("it has lanes");
    assert!(network.on_lane("1", 1, 10.0).expect("the road is longer").heading.abs() > 3.0);
}

#[test]
fn elements_without_effect_are_noted_once_with_their_number() {
    let twice = with(&[("<link/>", r#"<link/><userData code="a"/><userData code="b"/>"#)]);
    let notes: Vec<String> = parse(twice).expect("it is sound").notes.iter().map(in_file).collect();
    assert_eq!(notes, ["x.xodr:4: `userData` (2 times) has no effect: it is data for other programs"]);
    let attribute = parse(with(&[("junction=\"-1\"", "junction=\"-1\" colour=\"red\"")])).expect("it is sound");
    let notes: Vec<String> = attribute.notes.iter().map(in_file).collect();
    assert_eq!(notes, ["x.xodr:3: `road.colour` has no effect: the standard does not have this attribute"]);
    assert!(parse(with(&[("<link/>", "<objects/><signals/>")])).expect("it is sound").notes.is_empty());
}

#[test]
fn older_files_are_read_with_a_note_and_newer_ones_are_refused() {
    let old = parse(with(&[("revMinor=\"6\"", "revMinor=\"1\"")])).expect("it is sound");
    assert_eq!(old.notes, [Note::Old { minor: 1 }]);
    refuses(
        &[("revMinor=\"6\"", "revMinor=\"9\"")],
        "road.xodr:2: `revMinor=\"9\"` of <header> is not allowed, expected at most 8",
    );
    refuses(&[("revMajor=\"1\"", "revMajor=\"2\"")], "expected 1");
}

#[test]
fn wrong_values_are_refused_with_its_place_and_the_nearest_name() {
    refuses(&[("</road>", "")], "not well-formed XML");
    refuses(&[("<OpenDRIVE>", "<!DOCTYPE x [<!ENTITY a \"b\">]><OpenDRIVE>")], "<!DOCTYPE");
    refuses(
        &[("<link/>", "<lnk/>")],
        "road.xodr:4: <road> has an element <lnk>, which the standard does not have (did you mean `link`?)",
    );
    refuses(&[("<link/>", "<include file=\"other.xodr\"/>")], "<include> is not supported: put the content");
    refuses(&[("\"driving\"", "\"drivng\"")], "(did you mean `driving`?)");
    refuses(
        &[("length=\"50\" junction", "length=\"NaN\" junction")],
        "`length=\"NaN\"` of <road> is not allowed, expected a finite number",
    );
    refuses(&[("length=\"50\" junction", "length=\"-5\" junction")], "expected a positive number");
    refuses(&[("length=\"50\" junction", "length=\"1e9\" junction")], "expected at most 100000 m");
    refuses(
        &[("a=\"3.5\"", "a=\"-3\"")],
        "`a=\"-3\"` of <width> is not allowed, expected values of -0.05 to 1000 m; after 0.000 m, the value is -3.000 m",
    );
    // The lane is narrower than nothing only from 2.5 to 3.5 m.
    refuses(
        &[("a=\"3.5\" b=\"0\" c=\"0\"", "a=\"1.7\" b=\"-1.2\" c=\"0.2\"")],
        "expected values of -0.05 to 1000 m; after 3.000 m, the value is -0.100 m",
    );
    refuses(
        &[("<lanes>", "<lanes><laneOffset s=\"0\" a=\"0\" b=\"100\" c=\"0\" d=\"0\"/>")],
        "of <laneOffset> is not allowed, expected values of -1000 to 1000 m; after 50.000 m, the value is 5000.000 m",
    );
    refuses(
        &[("width sOffset=\"0\" a=\"3.5\"", "border sOffset=\"0\" a=\"-3500\"")],
        "of <border> is not allowed, expected values of -1000 to 1000 m; after 0.000 m, the value is -3500.000 m",
    );
    let mark = "c=\"0\" d=\"0\"/><roadMark sOffset=\"0\" type=\"solid\" width=\"1e6\"/>";
    refuses(&[("c=\"0\" d=\"0\"/>", mark)], "`width=\"1e6\"` of <roadMark> is not allowed, expected at most 10 m");
    refuses(&[("geometry s=\"0\"", "geometry s=\"5\"")], "expected 0 for the first piece");
    let point = r#"<paramPoly3 aU="0" bU="0" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>"#;
    refuses(
        &[("<line/>", point)],
        "`bU=\"0\"` of <paramPoly3> is not allowed, expected coefficients of a curve that is about 50 m long",
    );
    refuses(&[("<line/>", "<line/><arc curvature=\"0\"/>")], "<geometry> has a second <arc>, expected at most one");
    refuses(
        &[("</laneSection>", "<right/></laneSection>")],
        "road.xodr:9: <laneSection> has a second <right>, expected at most one",
    );
    let coil = "<arc curvature=\"1e6\"/>";
    refuses(
        &[("<line/>", coil)],
        "`curvature=\"1e6\"` of <arc> is not allowed, expected a magnitude of at most 20 1/m for a length of 50 m",
    );
    refuses(&[(" hdg=\"0\"", "")], "<geometry> has no attribute `hdg`");
    refuses(&[("<line/>", "")], "<geometry> contains no <line, arc, spiral, poly3 or paramPoly3>");
    refuses(
        &[("<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>", "")],
        "<lane> contains no <width or border>",
    );
    refuses(&[("id=\"-1\"", "id=\"-2\"")], "expected -1 in <right>");
    refuses(&[("laneSection s=\"0\"", "laneSection s=\"10\"")], "expected 0 for the first section");
    refuses(&[("junction=\"-1\"", "junction=\"7\"")], "names no junction of the file");
    let predecessor = r#"<link><predecessor elementType="road" elementId="2" contactPoint="end"/></link>"#;
    refuses(&[("<link/>", predecessor)], "road.xodr:4: `elementId=\"2\"` of <predecessor> names no road of the file");
    let second = r#"</road><road id="1" length="5" junction="-1"/>"#;
    refuses(&[("</road>", second)], "the element in line 3 has the same value");
    refuses(
        &[("</OpenDRIVE>", "<junction id=\"1\" type=\"virtual\"/></OpenDRIVE>")],
        "virtual junctions are not supported",
    );
    refuses(&[("<header revMajor=\"1\" revMinor=\"6\"/>", "")], "<OpenDRIVE> contains no <header>");
    let other = Map::parse("road.xodr".as_ref(), "<OpenSCENARIO/>".to_owned()).expect_err("it was accepted");
    assert!(other.to_string().contains("the outermost element is <OpenSCENARIO>, expected <OpenDRIVE>"), "{other}");
}

#[test]
fn a_file_that_is_absent_or_no_text_is_refused() {
    let absent = Map::read(Path::new("absent.xodr")).expect_err("it was accepted").to_string();
    assert!(absent.starts_with("absent.xodr: the file cannot be read"), "{absent}");
    let noise = std::env::temp_dir().join(format!("paracosm-{}.xodr", std::process::id()));
    fs::write(&noise, [b'<', 0xff, 0xfe]).expect("the folder is writable");
    let message = Map::read(&noise).expect_err("it was accepted").to_string();
    fs::remove_file(&noise).expect("the file is there");
    assert!(message.contains("the byte at position 1 is not part of a UTF-8 text"), "{message}");
}

#[test]
fn a_network_without_driven_lanes_is_refused() {
    let walked = parse(with(&[("\"driving\"", "\"sidewalk\"")])).expect("it is sound");
    assert_eq!(walked.roads[0].sections[0].lane(-1).map(|lane| lane.kind), Some(LaneType::Sidewalk));
    let error = walked.network().expect_err("it was accepted").to_string();
    assert!(error.contains("has no lanes"), "{error}");
}

#[test]
fn headings_of_borders_count_the_length_of_a_curve_that_is_longer_than_its_piece() {
    // A curve of 100 m on a road of 50 m; the lane becomes 5 m wider.
    let curve = r#"<paramPoly3 aU="0" bU="100" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>"#;
    let map = parse(with(&[("<line/>", curve), ("b=\"0\"", "b=\"0.1\"")])).expect("it is sound");
    let heading = map.roads[0].border_heading(0, -1, 25.0).expect("the lane");
    assert!((heading + libm::atan2(5.0, 100.0)).abs() < 1e-9, "{heading}");
}

#[test]
fn a_lane_without_length_in_a_tight_bend_is_left_out() {
    // The middle of lane -1 is the centre of the arc.
    let bend = with(&[("<line/>", "<arc curvature=\"-0.1\"/>"), ("a=\"3.5\"", "a=\"20\"")]);
    let error = parse(bend).expect("it is sound").network().expect_err("the lane has no length").to_string();
    assert!(error.contains("has no lanes"), "{error}");
}

/// The elements of a text, as pairs of parent and name.
fn pairs(text: &str) -> BTreeSet<(String, String)> {
    let tree = roxmltree::Document::parse(text).expect("it is well-formed");
    let name = |node: roxmltree::Node<'_, '_>| node.tag_name().name().to_owned();
    let elements = || tree.descendants().filter(roxmltree::Node::is_element);
    // The table has the attributes without effect as `@NAME`.
    let attributes = elements()
        .flat_map(|node| node.attributes().map(move |attribute| (name(node), format!("@{}", attribute.name()))));
    elements().filter_map(|node| Some((name(node.parent_element()?), name(node)))).chain(attributes).collect()
}

/// The files in which elements occur that are read or have no effect, and the texts with elements that are refused.
fn covered() -> BTreeMap<(String, String), String> {
    let mut covered = BTreeMap::new();
    for name in ["geometries.xodr", "junction.xodr", "objects.xodr", "without_effect.xodr"] {
        read(name);
        for pair in pairs(&fs::read_to_string(file(name)).expect("the file is readable")) {
            covered.entry(pair).or_insert(format!("files/{name}"));
        }
    }
    let virtual_end = |name: &str| {
        let connection = format!("<connection id=\"0\"><{name} elementType=\"road\"/></connection>");
        with(&[("</OpenDRIVE>", &format!("<junction id=\"1\">{connection}</junction></OpenDRIVE>"))])
    };
    let include = with(&[("<link/>", "<include file=\"other.xodr\"/>")]);
    for text in [include, virtual_end("predecessor"), virtual_end("successor")] {
        let message = parse(text.clone()).expect_err("it was accepted");
        assert!(message.contains("is not supported"), "{message}");
        for pair in pairs(&text) {
            covered.entry(pair).or_insert_with(|| "cases.rs".to_owned());
        }
    }
    covered
}

#[test]
fn the_page_of_elements_is_written_from_the_table_and_its_tests() {
    let covered = covered();
    let mut page = include_str!("opendrive.head.md").to_owned();
    let mut untested = Vec::new();
    for element in elements() {
        let anywhere = |(_, name): &&(String, String)| element.parent == "*" && name == element.name;
        let key = (element.parent.to_owned(), element.name.to_owned());
        let file = covered.get(&key).or_else(|| covered.keys().find(anywhere).map(|key| &covered[key]));
        let Some(file) = file else {
            untested.push(format!("{} in {}", element.name, element.parent));
            continue;
        };
        let parent = if element.parent == "*" { "any element".to_owned() } else { format!("`{}`", element.parent) };
        page += &format!("| `{}` | {parent} | {element} | `{file}` |\n", element.name);
    }
    assert!(untested.is_empty(), "no test has these elements: {untested:?}");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/opendrive.md");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, &page).expect("the page is writable");
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(found == page, "docs/opendrive.md is old; write it again with UPDATE_GOLDEN=1");
}

#[test]
fn more_than_a_hundred_thousand_roads_are_refused() {
    let road = "<road id=\"1\" length=\"5\" junction=\"-1\"/>\n";
    let text = format!("<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\n{}</OpenDRIVE>", road.repeat(100_001));
    let message = parse(text).expect_err("they are too many");
    assert_eq!(message, "road.xodr:1: <OpenDRIVE> has 100001 roads, expected at most 100000");
}

#[test]
fn a_curve_that_is_longer_than_any_road_is_refused_with_its_line() {
    let curve = |d: &str| {
        let shape = format!(
            "<paramPoly3 aU=\"0\" bU=\"50\" cU=\"0\" dU=\"0\" aV=\"0\" bV=\"0\" cV=\"0\" dV=\"{d}\" pRange=\"normalized\"/>"
        );
        with(&[("<line/>", &shape)])
    };
    let message = parse(curve("1e9")).expect_err("it was accepted");
    let says = "road.xodr:5: `dV=\"1e9\"` of <paramPoly3> is not allowed, expected coefficients of a curve that is at most 100000 m long";
    assert!(message.contains(says), "{message}");
    // The longest curve makes a network within the patience of a user.
    let begin = std::time::Instant::now();
    parse(curve("99000")).unwrap().network().unwrap();
    assert!(begin.elapsed().as_secs() < 10, "{:?}", begin.elapsed());
}
