//! Reads the roads of a file that was checked against the table of elements.

use super::bodies;
use super::cubics::{Cubic, Cubics, Extreme};
use super::limits;
use super::links::{self, Names};
use super::map::Map;
use super::place::place;
use super::plan_view::{Geometry, PlanView, Polynomials, Shape, Spiral};
use super::road::{
    Direction, Extent, LANE_TYPES, Lane, LaneChange, LaneType, MARK_TYPES, Road, RoadMark, Section, Traffic, milestones,
};
use crate::xml::{Element, Flaw, ReadError, rounded, short};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use std::ops::RangeInclusive;

/// The oldest and the newest minor version that are supported; the major version is 1.
pub(super) const OLDEST: u32 = 4;
const NEWEST: u32 = 8;

/// The greatest length of a road in metres, and the greatest turn of a piece of a reference line in radians.
const LONGEST: f64 = 100_000.0;
const MOST_TURN: f64 = 1000.0;

/// The greatest number of roads of a map.
const MOST_ROADS: usize = 100_000;
/// The greatest number of lanes of a section.
const MOST_LANES: usize = 1000;
/// The greatest width of a road mark in metres.
const WIDEST_MARK: f64 = 10.0;

/// The greatest magnitude of a coordinate in metres: beyond it, a place has less than six decimals. A heading has the same one.
const FARTHEST: f64 = 1e9;

/// The tolerance in metres for places at the ends of a road.
const CLOSE: f64 = 1e-3;

/// Reads the roads and junctions of a file, and the minor version of the file.
pub(super) fn map(root: Element<'_, '_>) -> Result<(Map, u32), ReadError> {
    let minor = version(root.child("header")?)?;
    let (found, most) = (root.all("road").count(), MOST_ROADS);
    if found > most {
        return Err(root.error(Flaw::TooMany { element: root.name().to_owned(), child: "road", found, most }));
    }
    let names = Names::of(root)?;
    let roads = root.all("road").map(|element| road(element, &names)).collect::<Result<Vec<_>, _>>()?;
    if roads.is_empty() {
        return Err(root.lacks("road"));
    }
    let junctions = root.all("junction").map(|element| links::junction(element, &names)).collect::<Result<_, _>>()?;
    let mut map = Map { roads, junctions, notes: Vec::new(), text: "".into() };
    map.notes = links::lost(root, &map)?;
    Ok((map, minor))
}

fn version(header: Element<'_, '_>) -> Result<u32, ReadError> {
    if header.required("revMajor")? != "1" {
        return Err(header.unexpected("revMajor", "1"));
    }
    let minor = header.required("revMinor")?.parse().ok().filter(|minor| *minor <= NEWEST);
    minor.ok_or_else(|| header.unexpected("revMinor", format!("at most {NEWEST}")))
}

fn road(element: Element<'_, '_>, names: &Names<'_>) -> Result<Road, ReadError> {
    let length = positive(element, "length")?;
    if length > LONGEST {
        return Err(element.unexpected("length", format!("at most {LONGEST} m")));
    }
    let lanes = element.child("lanes")?;
    let profile =
        |name, child| element.first(name).map_or(Ok(Cubics::default()), |profile| cubics(profile, child, "s", 0.0));
    let traffic = match element.text("rule") {
        None => Traffic::RightHand,
        Some(_) => element.one_of("rule", &[("RHT", Traffic::RightHand), ("LHT", Traffic::LeftHand)])?,
    };
    let (predecessor, successor) = links::of_road(element, names)?;
    let offset = cubics(lanes, "laneOffset", "s", 0.0)?;
    check(&offset, [0.0, length], (lanes, "laneOffset"), BORDERS)?;
    let line = plan_view(element.child("planView")?, length)?;
    let mut road = Road {
        id: element.required("id")?.to_owned(),
        name: element.text("name").unwrap_or_default().to_owned(),
        length,
        junction: names.junction_of(element)?,
        traffic,
        predecessor,
        successor,
        milestones: milestones(&line, length),
        line,
        offset,
        elevation: profile("elevationProfile", "elevation")?,
        superelevation: profile("lateralProfile", "superelevation")?,
        sections: sections(lanes, length)?,
        limits: limits::of_road(element)?,
        objects: Vec::new(),
    };
    road.objects = bodies::objects(element, &road)?;
    Ok(road)
}

/// Returns the number in an attribute, which must be positive.
fn positive(element: Element<'_, '_>, attribute: &'static str) -> Result<f64, ReadError> {
    let number = element.number(attribute)?;
    if number > 0.0 { Ok(number) } else { Err(element.unexpected(attribute, "a positive number")) }
}

/// Reads the polynomials in the children of an element. `from` is the place at which the places in `attribute` begin.
fn cubics(
    element: Element<'_, '_>,
    child: &'static str,
    attribute: &'static str,
    from: f64,
) -> Result<Cubics, ReadError> {
    let mut before = 0.0;
    let cubic = |of: Element<'_, '_>| {
        let s = from + place(of, attribute, &mut before)?;
        Ok(Cubic { s, coefficients: numbers(of, ["a", "b", "c", "d"])? })
    };
    element.all(child).map(cubic).collect::<Result<_, _>>().map(Cubics::new)
}

fn numbers<const N: usize>(element: Element<'_, '_>, attributes: [&'static str; N]) -> Result<[f64; N], ReadError> {
    let mut numbers = [0.0; N];
    for (number, attribute) in numbers.iter_mut().zip(attributes) {
        *number = element.number(attribute)?;
    }
    Ok(numbers)
}

/// Reads the reference line of a road of `road` metres.
fn plan_view(element: Element<'_, '_>, road: f64) -> Result<PlanView, ReadError> {
    let (mut before, mut is_first) = (0.0, true);
    let geometry = |of: Element<'_, '_>| {
        let s = place(of, "s", &mut before)?;
        if s > road + CLOSE {
            return Err(of.unexpected("s", format!("at most {road}, the length of the road")));
        }
        let [x, y, heading] = numbers(of, ["x", "y", "hdg"])?;
        for (attribute, number) in [("x", x), ("y", y), ("hdg", heading)] {
            if number.abs() > FARTHEST {
                return Err(of.unexpected(attribute, format!("a magnitude of at most {FARTHEST}")));
            }
        }
        let length = of.length("length")?;
        if length > LONGEST {
            return Err(of.unexpected("length", format!("at most {LONGEST} m")));
        }
        if is_first && s > CLOSE {
            return Err(of.unexpected("s", "0 for the first piece"));
        }
        is_first = false;
        let start = Pose { position: Vector2::new(x, y), heading };
        Ok(Geometry { s, length, start, shape: shape(of, length)? })
    };
    let pieces: Vec<_> = element.all("geometry").map(geometry).collect::<Result<_, _>>()?;
    if pieces.is_empty() { Err(element.lacks("geometry")) } else { Ok(PlanView::new(pieces)) }
}

/// The names of the shapes of a piece of a reference line.
const SHAPES: [&str; 5] = ["line", "arc", "spiral", "poly3", "paramPoly3"];

fn shape(geometry: Element<'_, '_>, length: f64) -> Result<Shape, ReadError> {
    let mut shapes = geometry.elements().filter(|element| SHAPES.contains(&element.name()));
    let element = shapes.next().ok_or_else(|| geometry.lacks("line, arc, spiral, poly3 or paramPoly3"))?;
    if let Some(second) = shapes.next() {
        let [element, parent] = [second, geometry].map(|of| of.name().to_owned());
        return Err(second.error(Flaw::Repeated { element, parent }));
    }
    Ok(match element.name() {
        "line" => Shape::Line,
        "arc" => Shape::Arc { curvature: curvature(element, "curvature", length)? },
        "spiral" => {
            let [from, to] = ["curvStart", "curvEnd"].map(|name| curvature(element, name, length));
            Shape::Spiral(Spiral::new(from?, to?, length))
        }
        "poly3" => {
            let pair = Polynomials::graph(numbers(element, ["a", "b", "c", "d"])?, length);
            polynomials(element, "b", length, pair)?
        }
        _ => {
            let end = match element.text("pRange") {
                None => 1.0,
                Some(_) => element.one_of("pRange", &[("normalized", 1.0), ("arcLength", length)])?,
            };
            let u = numbers(element, ["aU", "bU", "cU", "dU"])?;
            let v = numbers(element, ["aV", "bV", "cV", "dV"])?;
            polynomials(element, "bU", length, Polynomials::new(u, v, [end, length]))?
        }
    })
}

/// Makes the error that a curve is longer than any road. It names the coefficient with the greatest magnitude.
fn too_long(element: Element<'_, '_>, metres: f64) -> ReadError {
    let magnitude = |name: &str| element.text(name).and_then(|text| text.parse().ok()).map_or(0.0, f64::abs);
    let names = ["b", "c", "d", "bU", "cU", "dU", "bV", "cV", "dV"].into_iter();
    let greatest = names.max_by(|a, b| magnitude(a).total_cmp(&magnitude(b))).unwrap_or("b");
    let has = if metres < 1e9 { format!("{metres:.0}") } else { format!("{metres:.0e}") };
    let expected = format!("coefficients of a curve that is at most {LONGEST} m long, and this one has {has} m");
    element.unexpected(greatest, expected)
}

/// Checks that a curve of polynomials has a length, and is no longer than a road. `attribute` is the coefficient that usually
/// gives the length.
fn polynomials(
    element: Element<'_, '_>,
    attribute: &'static str,
    length: f64,
    pair: Polynomials,
) -> Result<Shape, ReadError> {
    if pair.length() > LONGEST {
        Err(too_long(element, pair.length()))
    } else if length == 0.0 || pair.length() > 0.0 {
        Ok(Shape::Polynomials(pair))
    } else {
        Err(element.unexpected(attribute, format!("coefficients of a curve that is about {length} m long")))
    }
}

/// Returns the curvature in an attribute. A piece of `length` metres with this curvature must not turn too often.
fn curvature(element: Element<'_, '_>, attribute: &'static str, length: f64) -> Result<f64, ReadError> {
    let curvature = element.number(attribute)?;
    if curvature.abs() * length <= MOST_TURN {
        Ok(curvature)
    } else {
        let most = rounded(MOST_TURN / length);
        Err(element.unexpected(attribute, format!("a magnitude of at most {most} 1/m for a length of {length} m")))
    }
}

fn sections(lanes: Element<'_, '_>, length: f64) -> Result<Vec<Section>, ReadError> {
    let mut before = 0.0;
    let mut sections: Vec<Section> = Vec::new();
    for element in lanes.all("laneSection") {
        let s = place(element, "s", &mut before)?;
        if s > length + CLOSE || (sections.is_empty() && s > CLOSE) {
            let expected =
                if sections.is_empty() { "0 for the first section".to_owned() } else { format!("at most {length}") };
            return Err(element.unexpected("s", expected));
        }
        if let Some(last) = sections.last_mut() {
            last.end = s;
        }
        sections.push(section(element, s, length)?);
    }
    for (section, element) in sections.iter().zip(lanes.all("laneSection")) {
        check_extents(section, element)?;
    }
    if sections.is_empty() { Err(lanes.lacks("laneSection")) } else { Ok(sections) }
}

/// The widths in metres that a lane may have. Published files have lanes that are slightly narrower than nothing where they end.
const WIDTHS: RangeInclusive<f64> = -0.05..=1000.0;

/// The offsets of lane 0 and the borders in metres that a lane may have.
const BORDERS: RangeInclusive<f64> = -1000.0..=1000.0;

/// Checks the widths and borders of the lanes of a section.
fn check_extents(section: &Section, element: Element<'_, '_>) -> Result<(), ReadError> {
    let span = [section.s, section.end];
    for of in element.elements().flat_map(|side| side.all("lane")) {
        match section.lane(of.whole("id")?).map(|lane| &lane.extent) {
            Some(Extent::Width(width)) => check(width, span, (of, "width"), WIDTHS)?,
            Some(Extent::Border(border)) => check(border, span, (of, "border"), BORDERS)?,
            None => {}
        }
    }
    Ok(())
}

/// Checks that a function stays in a range between two places. The function is read from the children of an element.
fn check(
    cubics: &Cubics,
    [from, to]: [f64; 2],
    (parent, child): (Element<'_, '_>, &'static str),
    range: RangeInclusive<f64>,
) -> Result<(), ReadError> {
    let outside = cubics.extremes(from, to).into_iter().find(|extreme| !range.contains(&extreme.value));
    let Some(Extreme { piece, s, value }) = outside else { return Ok(()) };
    let element = parent.all(child).nth(piece).ok_or_else(|| parent.lacks(child))?;
    let [least, most] = [range.start(), range.end()];
    let (at, value) = (s - from, short(value, 3));
    Err(element.unexpected("a", format!("values of {least} to {most} m; after {at:.3} m, the value is {value} m")))
}

fn section(element: Element<'_, '_>, s: f64, end: f64) -> Result<Section, ReadError> {
    let (found, most) = (element.elements().flat_map(|side| side.all("lane")).count(), MOST_LANES);
    if found > most {
        return Err(element.error(Flaw::TooMany { element: element.name().to_owned(), child: "lane", found, most }));
    }
    let middle = element.child("center")?.child("lane")?;
    if middle.whole("id")? != 0 {
        return Err(middle.unexpected("id", "0 in <center>"));
    }
    let mut lanes = vec![lane(middle, 0, s)?];
    let side = |name| element.first(name).into_iter().flat_map(|side| side.all("lane"));
    let sorted = |name, sign: i32| -> Result<Vec<_>, ReadError> {
        let mut found: Vec<_> = side(name).map(|of| Ok((of.whole("id")?, of))).collect::<Result<_, _>>()?;
        // Files may list the lanes of a side in any order.
        found.sort_by_key(|(number, _)| i64::from(*number) * i64::from(sign));
        for ((number, of), expected) in found.iter().zip(1..) {
            if *number != sign * expected {
                let expected = format!("{} in <{name}>: the numbers count from the middle", sign * expected);
                return Err(of.unexpected("id", expected));
            }
        }
        Ok(found)
    };
    for (number, of) in sorted("left", 1)? {
        lanes.insert(0, lane(of, number, s)?);
    }
    for (number, of) in sorted("right", -1)? {
        lanes.push(lane(of, number, s)?);
    }
    Ok(Section { s, end, lanes })
}

fn lane(element: Element<'_, '_>, number: i32, from: f64) -> Result<Lane, ReadError> {
    let kind = match element.text("type") {
        None if number == 0 => LaneType::None,
        _ => element.one_of("type", LANE_TYPES)?,
    };
    let direction = match element.text("direction") {
        None => Direction::Standard,
        Some(_) => element.one_of(
            "direction",
            &[("standard", Direction::Standard), ("reversed", Direction::Reversed), ("both", Direction::Both)],
        )?,
    };
    let (width, border) = (cubics(element, "width", "sOffset", from)?, cubics(element, "border", "sOffset", from)?);
    for name in ["width", "border"] {
        if let Some(first) = element.first(name).filter(|first| first.number("sOffset").is_ok_and(|s| s > CLOSE)) {
            return Err(first.unexpected("sOffset", format!("0 for the first <{name}> of a lane")));
        }
    }
    let extent = match (width.pieces(), border.pieces()) {
        ([], []) if number != 0 => return Err(element.lacks("width or border")),
        ([], [_, ..]) => Extent::Border(border),
        _ => Extent::Width(width),
    };
    let link = element.first("link");
    let linked = |name| link.into_iter().flat_map(move |link| link.all(name)).map(|to| to.whole("id"));
    Ok(Lane {
        number,
        kind,
        direction,
        extent,
        predecessors: linked("predecessor").collect::<Result<_, _>>()?,
        successors: linked("successor").collect::<Result<_, _>>()?,
        marks: marks(element, from)?,
        limits: limits::of_lane(element, from)?,
    })
}

fn marks(lane: Element<'_, '_>, from: f64) -> Result<Vec<RoadMark>, ReadError> {
    let mut before = 0.0;
    let mark = |element: Element<'_, '_>| {
        let s = from + place(element, "sOffset", &mut before)?;
        let change = match element.text("laneChange") {
            None => LaneChange::Both,
            Some(_) => element.one_of(
                "laneChange",
                &[
                    ("increase", LaneChange::Increase),
                    ("decrease", LaneChange::Decrease),
                    ("both", LaneChange::Both),
                    ("none", LaneChange::None),
                ],
            )?,
        };
        let width = element.text("width").map(|_| element.length("width")).transpose()?;
        if width.is_some_and(|metres| metres > WIDEST_MARK) {
            return Err(element.unexpected("width", format!("at most {WIDEST_MARK} m")));
        }
        Ok(RoadMark { s, kind: element.one_of("type", MARK_TYPES)?, width, change })
    };
    lane.all("roadMark").map(mark).collect()
}
