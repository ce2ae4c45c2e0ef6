//! The speed limits of roads and lanes.

use super::place::place;
use crate::xml::{Element, ReadError};

/// The types of roads.
const ROAD_TYPES: [&str; 13] = [
    "unknown",
    "rural",
    "motorway",
    "town",
    "lowSpeed",
    "pedestrian",
    "bicycle",
    "townExpressway",
    "townCollector",
    "townArterial",
    "townPrivate",
    "townLocal",
    "townPlayStreet",
];
/// Returns the limits of a road: the place from which a limit holds, in metres along the road, and the limit in m/s.
pub(super) fn of_road(road: Element<'_, '_>) -> Result<Vec<(f64, Option<f64>)>, ReadError> {
    let mut before = 0.0;
    let limit = |element: Element<'_, '_>| {
        let s = place(element, "s", &mut before)?;
        // The type of a road gives no limit by itself.
        element.one_of("type", &ROAD_TYPES.map(|name| (name, ())))?;
        Ok((s, element.first("speed").map(limit).transpose()?.flatten()))
    };
    road.all("type").map(limit).collect()
}

/// Returns the limits of a lane in a section that begins `from` metres along the road, as [`of_road`] does.
pub(super) fn of_lane(lane: Element<'_, '_>, from: f64) -> Result<Vec<(f64, Option<f64>)>, ReadError> {
    let mut before = 0.0;
    let limit = |element: Element<'_, '_>| Ok((from + place(element, "sOffset", &mut before)?, limit(element)?));
    lane.all("speed").map(limit).collect()
}

/// Returns a speed limit in m/s; `None` if there is no limit.
fn limit(speed: Element<'_, '_>) -> Result<Option<f64>, ReadError> {
    if ["no limit", "undefined"].contains(&speed.required("max")?) {
        return Ok(None);
    }
    let unit = match speed.text("unit") {
        None => 1.0,
        Some(_) => speed.one_of("unit", &[("m/s", 1.0), ("km/h", 1.0 / 3.6), ("mph", 0.44704)])?,
    };
    Ok(Some(speed.length("max")? * unit))
}
