//! `roads`: files of roads are read, drawn and written as tables; wrong files are refused, and nothing is written.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;

const BEND: &str = r#"<OpenDRIVE>
  <header revMajor="1" revMinor="6"/>
  <road id="7" name="bend" length="62.83185307179586" junction="-1">
    <planView><geometry s="0" x="0" y="0" hdg="0" length="62.83185307179586"><arc curvature="0.025"/></geometry></planView>
    <elevationProfile><elevation s="0" a="0" b="0.01" c="0" d="0"/></elevationProfile>
    <lanes><laneSection s="0">
      <left><lane id="1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></left>
      <center><lane id="0" type="none"/></center>
      <right><lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right>
    </laneSection></lanes>
  </road>
</OpenDRIVE>
"#;

fn folder(text: &str) -> tempfile::TempDir {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("bend.xodr"), text).expect("it is writable");
    dir
}

fn files(dir: &Path) -> usize {
    fs::read_dir(dir).expect("it is readable").count()
}

#[test]
fn a_file_of_roads_is_summed_up_with_its_notes() {
    let dir = folder(BEND);
    let table = stdout(&succeeds(fuzz(dir.path(), &["roads", "bend.xodr", "--format", "table"])));
    for part in
        ["1 road, 0 junctions", "62.832 m", "2, 125.66 m", "the world is flat: heights up to 0.63 m are left out"]
    {
        assert!(table.contains(part), "`{part}` is missing in: {table}");
    }
    let json = stdout(&succeeds(fuzz(dir.path(), &["roads", "bend.xodr", "--format", "json"])));
    let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    assert_eq!([&json["roads"], &json["junctions"], &json["lanes"]], [1, 0, 2]);
    assert_eq!(json["notes"].as_array().map(Vec::len), Some(1));
}

#[test]
fn the_table_of_lanes_has_the_outer_border_of_every_lane() {
    let dir = folder(BEND);
    succeeds(fuzz(dir.path(), &["roads", "bend.xodr", "--lanes", "lanes.csv", "--step", "10"]));
    let text = fs::read_to_string(dir.path().join("lanes.csv")).expect("it was written");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "road,section,lane,type,s,x,y,z,heading");
    // Three lanes with eight places each: 0, 10, ..., 60 m and the end.
    assert_eq!(lines.len(), 1 + 3 * 8);
    assert_eq!(lines[1], "7,0,1,driving,0.000000,0.000000,3.000000,0.000000,0.000000");
    // A quarter of a circle of 40 m ends at (40, 40), and its outer side at (43, 40).
    assert_eq!(lines[24], "7,0,-1,driving,62.831853,43.000000,40.000000,0.628319,1.570796");
}

#[test]
fn roads_are_drawn_from_above() {
    let dir = folder(BEND);
    succeeds(fuzz(dir.path(), &["roads", "bend.xodr", "--draw", "bend.svg"]));
    succeeds(fuzz(dir.path(), &["roads", "bend.xodr", "--draw", "bend.png"]));
    assert!(fs::read_to_string(dir.path().join("bend.svg")).expect("it was written").starts_with("<svg"));
    let png = fs::read(dir.path().join("bend.png")).expect("it was written");
    assert_eq!(&png[1..4], b"PNG");
}

#[test]
fn a_wrong_file_is_refused_with_its_place_and_nothing_is_written() {
    let wrong = BEND.replace("curvature=\"0.025\"", "curvature=\"much\"");
    let dir = folder(&wrong);
    let output = fuzz(dir.path(), &["roads", "bend.xodr", "--draw", "bend.svg", "--lanes", "lanes.csv"]);
    refused(&output, &["bend.xodr:4: `curvature=\"much\"` of <arc> is not allowed, expected a finite number"]);
    assert_eq!((files(dir.path()), stdout(&output)), (1, String::new()));
    let laughs = format!("<!DOCTYPE l [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;\">]>{BEND}");
    refused(
        &fuzz(folder(&laughs).path(), &["roads", "bend.xodr"]),
        &["bend.xodr:1", "<!DOCTYPE", "remove the declaration"],
    );
    refused(&fuzz(dir.path(), &["roads", "absent.xodr"]), &["absent.xodr: the file cannot be read"]);
}

#[test]
fn wrong_options_are_refused_before_the_file_is_read() {
    let dir = folder(BEND);
    refused(
        &fuzz(dir.path(), &["roads", "bend.xodr", "--lanes", "lanes.csv", "--step", "0"]),
        &["--step is 0", "0.001"],
    );
    refused(&fuzz(dir.path(), &["roads", "bend.xodr", "--lanes", "lanes.txt"]), &["expected .csv"]);
    refused(&fuzz(dir.path(), &["roads", "bend.xodr", "--draw", "bend.xodr"]), &["--draw bend.xodr"]);
    let long = BEND.replace("length=\"62.83185307179586\"", "length=\"10000\"");
    let many = folder(&long);
    let output = fuzz(many.path(), &["roads", "bend.xodr", "--draw", "a.svg", "--lanes", "b.csv", "--step", "0.001"]);
    refused(&output, &["--step 0.001 gives 30000006 points"]);
    assert_eq!(files(many.path()), 1);
    let many = fuzz(dir.path(), &["roads", "bend.xodr", "--step", "5"]);
    assert_eq!(many.status.code(), Some(2), "{}", stderr(&many));
}

#[test]
fn the_roads_of_a_scenario_are_written_and_read_again() {
    let dir = folder(BEND);
    for scenario in ["pedestrian-crossing", "grid-traffic", "roundabout-entry", "t-loop"] {
        succeeds(fuzz(dir.path(), &["describe", scenario, "--roads", "world.xodr"]));
        let json = stdout(&succeeds(fuzz(dir.path(), &["roads", "world.xodr", "--format", "json"])));
        let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
        assert!(json["lanes"].as_u64() > Some(1) && json["notes"].as_array().is_some_and(Vec::is_empty), "{json}");
    }
    refused(&fuzz(dir.path(), &["describe", "t-loop", "--roads", "world.svg"]), &["expected .xodr"]);
}
