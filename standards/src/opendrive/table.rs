//! The borders of all lanes as a table of points.

use super::map::Map;

/// A point on the outer border of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Border<'a> {
    /// The identifier of the road.
    pub road: &'a str,
    /// The index of the section.
    pub section: usize,
    /// The number of the lane.
    pub lane: i32,
    /// The type of the lane, as in the file.
    pub kind: &'static str,
    /// The place of the point, in metres along the road.
    pub s: f64,
    /// The coordinates of the point, in metres.
    pub at: [f64; 3],
    /// The heading of the border in the direction of the road, in radians in (-π, π].
    pub heading: f64,
}

/// Returns points on the outer borders of all lanes, every `step` metres from the beginning of each section, and at its
/// end. The border of lane 0 is the reference line with its offset.
pub fn borders(map: &Map, step: f64) -> impl Iterator<Item = Border<'_>> {
    let lanes = map.roads.iter().flat_map(|road| {
        road.sections
            .iter()
            .enumerate()
            .flat_map(move |(index, section)| section.lanes.iter().map(move |lane| (road, index, section, lane)))
    });
    lanes.flat_map(move |(road, index, section, lane)| {
        let length = section.end - section.s;
        let count = (length / step).ceil().max(1.0) as usize;
        (0..=count).map(move |i| {
            let s = if i == count { section.end } else { section.s + i as f64 * step };
            let t = road.border(index, lane.number, s).unwrap_or_default();
            let point = road.point(s, t);
            Border {
                road: &road.id,
                section: index,
                lane: lane.number,
                kind: lane.kind.name(),
                s,
                at: [point.x, point.y, road.height(s, t)],
                heading: road.border_heading(index, lane.number, s).unwrap_or_default(),
            }
        })
    })
}
