//! The borders of lanes are where another program finds them, in roads of others.

use crate::others::files_of_others;
use paracosm_standards::opendrive::Map;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The points of each border, by road, section and lane.
type Borders = BTreeMap<(String, usize, i32), Vec<[f64; 4]>>;

fn expected(file: &Path) -> Borders {
    let text = fs::read_to_string(file).expect("the table is readable");
    let mut borders = Borders::new();
    let mut key = None;
    for line in text.lines() {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        if fields[0] == "lane" {
            let number = |i: usize| fields[i].parse().expect("a number");
            key = Some((fields[1].to_owned(), number(2) as usize, number(3)));
        } else if fields.len() >= 4 {
            let point = [0, 1, 2, 3].map(|i| fields[i].parse().expect("a number"));
            borders.entry(key.clone().expect("a lane comes first")).or_default().push(point);
        }
    }
    borders
}

/// The greatest distance of a border from the expected points with its place, and the greatest sine of the angle between the
/// headings. Headings in the tables are those of the middles of lanes.
fn farthest(map: &Map, borders: &Borders) -> ((f64, String), f64) {
    let mut worst = (0.0, String::new());
    let mut turn: f64 = 0.0;
    for ((id, section, lane), points) in borders {
        let road = &map.roads[map.road(id).unwrap_or_else(|| panic!("road {id}"))];
        let of = &road.sections[*section];
        for (i, [x, y, _, heading]) in points.iter().enumerate() {
            let s = of.s + (of.end - of.s) * i as f64 / (points.len() - 1) as f64;
            let point = road.point(s, road.border(*section, *lane, s).expect("the lane"));
            let distance = libm::hypot(point.x - x, point.y - y);
            let turned = libm::sin(road.lane_heading(*section, *lane, s).expect("the lane") - heading).abs();
            turn = turn.max(turned);
            if distance > worst.0 {
                worst = (distance, format!("road {id}, section {section}, lane {lane}, s = {s}"));
            }
        }
    }
    (worst, turn)
}

#[test]
fn borders_of_lanes_are_where_esmini_finds_them() {
    let Some(folder) = files_of_others() else { return };
    let mut wrong = Vec::new();
    for entry in fs::read_dir(folder.join("lanes")).expect("the folder is readable") {
        let table = entry.expect("an entry").path();
        let name = table.file_stem().expect("a name").to_string_lossy().into_owned();
        let file = folder.join(name.replace("__", "/")).with_extension("xodr");
        let map = match Map::read(&file) {
            Ok(map) => map,
            Err(error) => {
                wrong.push(error.to_string());
                continue;
            }
        };
        let ((distance, place), turn) = farthest(&map, &expected(&table));
        println!("{distance:.6} m and {turn:.6} rad in {name}: {place}");
        if distance > 0.001 || turn > 0.01 {
            wrong.push(format!("{distance:.4} m in {name}: {place}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
