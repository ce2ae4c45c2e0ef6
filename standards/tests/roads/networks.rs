//! The road networks of files: lanes where the files have them, and connected as the files say.

use crate::others::{files_of_others, with_ending};
use paracosm_engine::road::{LaneId, RoadNetwork};
use paracosm_standards::opendrive::Map;

/// The greatest distance in metres between the end of a lane and the beginning of the next lane.
const GAP: f64 = 0.05;

#[test]
fn lanes_of_published_maps_are_connected_without_gaps() {
    let Some(folder) = files_of_others() else { return };
    let mut wrong = Vec::new();
    for file in with_ending(&folder, "xodr") {
        let map = Map::read(&file).unwrap_or_else(|error| panic!("{error}"));
        let network = map.network().unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let name = file.file_name().expect("a name").to_string_lossy().into_owned();
        let (widest, place) = widest_gap(&network);
        let links: usize = network.lanes().iter().map(|lane| lane.successors.len()).sum();
        let conflicts: usize = network.lanes().iter().map(|lane| lane.conflicts.len()).sum();
        let curves: usize = network.lanes().iter().map(|lane| lane.curve.curves().count()).sum();
        println!(
            "{name}: {} roads, {} lanes, {curves} curves, {links} links, {conflicts} conflicts, {} strips, gap {widest:.4} m ({place}), {} notes",
            map.roads.len(),
            network.lanes().len(),
            network.strips().len(),
            map.notes.len(),
        );
        if widest > GAP {
            wrong.push(format!("{name}: {widest:.3} m, {place}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn widest_gap(network: &RoadNetwork) -> (f64, String) {
    let names: Vec<&str> = network.elements().collect();
    let told = |id: LaneId| format!("road {}, lane {}", names[network.lane(id).element], network.lane(id).number);
    let gaps = network.ids().flat_map(|id| {
        let lane = network.lane(id);
        let gap = |next: &LaneId| (network.lane(*next).curve.start().position - lane.curve.end().position).norm();
        lane.successors.iter().map(move |next| (gap(next), id, *next)).collect::<Vec<_>>()
    });
    let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0));
    widest.map_or((0.0, String::new()), |(gap, id, next)| (gap, format!("{} to {}", told(id), told(next))))
}

#[test]
fn the_lines_of_lanes_are_midway_between_their_borders() {
    let Some(folder) = files_of_others() else { return };
    let mut worst: f64 = 0.0;
    for file in with_ending(&folder, "xodr") {
        let map = Map::read(&file).unwrap_or_else(|error| panic!("{error}"));
        let network = map.network().unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        for road in &map.roads {
            for (index, section) in road.sections.iter().enumerate() {
                let count = 40;
                for lane in section.lanes.iter().filter(|lane| lane.kind.is_driven()) {
                    for i in 1..count {
                        let s = section.s + (section.end - section.s) * f64::from(i) / f64::from(count);
                        let middle = road.point(s, road.middle(index, lane.number, s));
                        if road.width(index, lane.number, s) > 1.5 {
                            worst = worst.max(network.project(middle).distance);
                        }
                    }
                }
            }
        }
    }
    println!("{worst:.6} m");
    assert!(worst < 0.001, "{worst} m");
}
