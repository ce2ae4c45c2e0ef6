//! The places on roads and the lanes that a scenario names: each must be on the map.
//!
//! A condition on a place that does not exist would never hold, and the run would go on without a word.

use super::scope::Node;
use crate::opendrive::Map;
use crate::xml::ReadError;

/// The greatest distance in metres beyond the end of a road of a place on the road.
const BEYOND: f64 = 1e-6;
/// The greatest number of roads that an error lists.
const MOST_LISTED: usize = 8;

/// The map on which a scenario takes place.
#[derive(Clone, Copy)]
pub(super) struct Sites<'a> {
    pub map: &'a Map,
    /// `true` if parameters have the values of a test, `false` if they have the values of their declarations, which need not be
    /// the values of any test.
    pub with_test: bool,
}

impl Sites<'_> {
    /// Checks that a `LanePosition` or a `RoadPosition` is a place of the map.
    pub fn check_place(self, node: Node<'_>) -> Result<(), ReadError> {
        if !self.knows(node, &["roadId", "s", "laneId"]) {
            return Ok(());
        }
        let (id, s) = (node.required("roadId")?, node.number("s")?);
        let Some(road) = self.map.road(&id).map(|index| &self.map.roads[index]) else {
            let names = || self.map.roads.iter().map(|road| road.id.as_str());
            let all: Vec<_> = names().take(MOST_LISTED + 1).collect();
            let list = if all.len() > MOST_LISTED { String::new() } else { format!(": {}", all.join(", ")) };
            return Err(node.element.unexpected_value("roadId", &id, format!("a road of the map{list}"), names()));
        };
        let length = road.length;
        if !(0.0..=length + BEYOND).contains(&s) {
            let expected = format!("a place on road `{id}`, which is {length} m long");
            return Err(node.unexpected("s", &node.required("s")?, expected));
        }
        if node.element.text("laneId").is_none() {
            return Ok(());
        }
        let lanes = &road.sections[road.section_at(s.min(length))].lanes;
        let lane = node.lane("laneId")?;
        if lanes.iter().any(|known| known.number == lane) {
            return Ok(());
        }
        let numbers = lanes.iter().rev().map(|lane| lane.number).filter(|number| *number != 0);
        let list = numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(", ");
        let expected = format!("a lane of road `{id}` at s = {s} m: {list}");
        Err(node.unexpected("laneId", &node.required("laneId")?, expected))
    }

    /// Checks that some road of the map has the lane in an attribute.
    pub fn check_lane(self, node: Node<'_>, attribute: &'static str) -> Result<(), ReadError> {
        let lane = node.lane(attribute)?;
        let all = || self.map.roads.iter().flat_map(|road| &road.sections).flat_map(|section| &section.lanes);
        if !self.knows(node, &[attribute]) || all().any(|known| known.number == lane) {
            return Ok(());
        }
        let numbers = || all().map(|lane| lane.number);
        let (first, last) = (numbers().min().unwrap_or(0), numbers().max().unwrap_or(0));
        let expected = format!("a lane of the map, whose lanes are {first} to {last}");
        Err(node.unexpected(attribute, &node.required(attribute)?, expected))
    }

    /// Returns `true` if attributes have the values that they have in a run.
    fn knows(self, node: Node<'_>, attributes: &[&str]) -> bool {
        let follows = |attribute: &&str| node.element.text(attribute).is_some_and(|text| text.starts_with('$'));
        self.with_test || !attributes.iter().any(follows)
    }
}
