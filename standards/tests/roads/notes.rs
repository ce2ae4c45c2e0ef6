//! Notes on what differs between a file and its map.

use super::cases::{in_file, parse, refuses, with};

/// Returns the notes on the road of a file with changes.
fn notes(changes: &[(&str, &str)]) -> Vec<String> {
    let map = parse(with(changes)).unwrap_or_else(|error| panic!("{error}"));
    map.notes.iter().map(in_file).collect()
}

#[test]
fn what_does_not_count_is_noted() {
    let width = "<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>";
    let narrow = width.replace("3.5", "0.4");
    assert_eq!(
        notes(&[(width, &narrow)]),
        ["x.xodr: lane -1 of road `1` is at most 0.400 m wide; cars do not drive on it"]
    );
    let twice = format!("{narrow}\n{width}");
    assert_eq!(notes(&[(width, &twice)]), ["x.xodr:8: `width` has no effect: the next one begins at the same place"]);
    let geometry = "<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"50\"><line/></geometry>";
    let empty = format!("{}{geometry}", geometry.replace("\"50\"", "\"0\""));
    assert_eq!(
        notes(&[(geometry, &empty)]),
        ["x.xodr:5: `geometry` has no effect: the next one begins at the same place"]
    );
    let junction = "<junction id=\"7\" name=\"\"/></OpenDRIVE>";
    assert_eq!(notes(&[("</OpenDRIVE>", junction)]), ["x.xodr: junction `7` has no connections; cars do not cross it"]);
}

#[test]
fn kinks_and_links_between_roads_apart_are_noted() {
    let line = "<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"50\"><line/></geometry>";
    let kink = line.replace("length=\"50\"", "length=\"20\"")
        + "<geometry s=\"20\" x=\"20\" y=\"0\" hdg=\"1.5\" length=\"30\"><line/></geometry>";
    assert_eq!(notes(&[(line, &kink)]), ["x.xodr: the reference line of road `1` turns by 1.500 rad at s = 20.000 m"]);
    let second = |x: f64| {
        let road = with(&[]);
        let from = road.find("<road").unwrap();
        let road = road[from..].replace("id=\"1\" length", "id=\"2\" length");
        road.replace("x=\"0\" y", &format!("x=\"{x}\" y"))
    };
    let link = "<link><successor elementType=\"road\" elementId=\"2\" contactPoint=\"start\"/></link>";
    assert!(notes(&[("<link/>", link), ("</OpenDRIVE>", &second(50.0))]).is_empty());
    assert_eq!(
        notes(&[("<link/>", link), ("</OpenDRIVE>", &second(80.0))]),
        ["x.xodr:4: the link joins roads that are 30.000 m apart; nobody uses it"]
    );
    let lane = "<lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
    let many: String = (1..=1001).map(|number| lane.replace("\"-1\"", &format!("\"-{number}\""))).collect();
    refuses(&[(lane, &many)], "<laneSection> has 1002 lanes, expected at most 1000");
}

#[test]
fn things_beyond_the_end_of_their_road_are_noted() {
    let object = |s: f64, child: &str| {
        let sizes = "type=\"pole\" t=\"4\" zOffset=\"0\" hdg=\"0\" radius=\"0.1\" height=\"2\"";
        format!("</lanes>\n<objects>\n<object id=\"1\" s=\"{s}\" {sizes}>{child}</object>\n</objects>")
    };
    let of = |s: f64, child: &str| notes(&[("</lanes>", &object(s, child))]);
    let repeat = |s: f64, length: f64| {
        format!(
            "\n<repeat s=\"{s}\" length=\"{length}\" distance=\"10\" tStart=\"4\" tEnd=\"8\" zOffsetStart=\"0\" zOffsetEnd=\"0\" heightStart=\"2\" heightEnd=\"2\"/>"
        )
    };
    assert!(of(50.0, &repeat(10.0, 40.0)).is_empty());
    let line =
        with(&[("</lanes>", &object(0.0, ""))]).lines().position(|line| line.starts_with("<object id")).unwrap() + 1;
    assert_eq!(
        of(50.5, ""),
        [format!("x.xodr:{line}: the object reaches 0.500 m beyond the end of its road; it is moved to the end")]
    );
    assert_eq!(
        of(0.0, &repeat(10.0, 80.0)),
        [format!("x.xodr:{}: the repeat reaches 40.000 m beyond the end of its road; the rest is cut", line + 1)]
    );
    // The repetition takes the place of its object, which stands nowhere.
    assert!(of(50.5, &repeat(10.0, 40.0)).is_empty());
    let corner = |s: f64| format!("<cornerRoad s=\"{s}\" t=\"5\" dz=\"0\" height=\"2\"/>");
    let outline = format!("\n<outlines><outline id=\"1\">{}{}</outline></outlines>", corner(40.0), corner(50.25));
    assert_eq!(
        of(0.0, &outline),
        [format!(
            "x.xodr:{}: the cornerRoad reaches 0.250 m beyond the end of its road; it is moved to the end",
            line + 1
        )]
    );
    // The cut part does not pull the rest aside: half of the way, half of the offset.
    let map = parse(with(&[("</lanes>", &object(0.0, &repeat(10.0, 80.0)))])).unwrap();
    let last = map.roads[0].objects[0].parts.last().unwrap().1.position;
    assert!((last - nalgebra::Vector2::new(50.0, 6.0)).norm() < 1e-9, "{last}");
}
