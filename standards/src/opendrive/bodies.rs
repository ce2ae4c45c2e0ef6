//! Reads the objects and signals of a file, and finds their bodies.
//!
//! Everything becomes one or more solid parts that stand on the ground: a disc, a block, walls along an outline, pieces along a
//! repetition. Flat things such as road marks, and things high above the road such as gantries, have no parts.

use super::object::Object;
use super::road::Road;
use crate::xml::{Element, Flaw, ReadError};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Class};

/// The height in metres up to which a thing is flat: cars drive over it.
const FLAT: f64 = 0.3;
/// The height in metres above which a thing is out of the way: cars drive below it.
const ABOVE: f64 = 2.5;
/// The radius in metres of a pole, of the trunk of a tree, and of the post of a signal.
const POLE: f64 = 0.1;
const TRUNK: f64 = 0.3;
const POST: f64 = 0.05;
/// The height in metres of the top of a signal, if the file does not say it.
const SIGNAL: f64 = 2.5;
/// The thickness in metres of a wall along an outline, and of a repetition without a width.
const WALL: f64 = 0.2;
/// The greatest length in metres of a piece of a repetition without gaps.
const PIECE: f64 = 4.0;
/// The greatest length, width, radius or height in metres, and the greatest number of pieces of a repetition.
const LARGEST: f64 = 1000.0;
const MOST: f64 = 10_000.0;
/// The least number of corners of an outline.
const FEWEST_CORNERS: usize = 2;

/// The types of objects that are marks on the ground, or that span the road.
const NO_BODY: &[&str] = &["crosswalk", "gantry", "parkingSpace", "patch", "roadMark", "roadSurface", "trafficIsland"];

/// Reads the objects and signals of a road.
pub(super) fn objects(element: Element<'_, '_>, road: &Road) -> Result<Vec<Object>, ReadError> {
    let within = |name, child| element.all(name).flat_map(move |of: Element<'_, '_>| of.all(child));
    let objects = within("objects", "object").map(|of| object(of, road));
    let signals = within("signals", "signal").map(|of| signal(of, road));
    objects.chain(signals).collect()
}

/// The measures of a thing in metres; 0 for a measure that the file does not give.
#[derive(Clone, Copy)]
struct Measures {
    length: f64,
    width: f64,
    radius: f64,
    height: f64,
    bottom: f64,
}

impl Measures {
    /// Reads the measures in the attributes with these names. Measures that are absent are those of `usual`.
    fn read(of: Element<'_, '_>, names: [&'static str; 5], usual: Self) -> Result<Self, ReadError> {
        let [length, width, radius, height, bottom] = names;
        Ok(Self {
            length: size(of, length, usual.length)?,
            width: size(of, width, usual.width)?,
            radius: size(of, radius, usual.radius)?,
            height: size(of, height, usual.height)?,
            bottom: number_or(of, bottom, usual.bottom)?,
        })
    }

    /// Returns the measures between these and others.
    fn between(self, other: Self, share: f64) -> Self {
        let mixed = |of: fn(&Self) -> f64| of(&self) + share * (of(&other) - of(&self));
        Self {
            length: mixed(|m| m.length),
            width: mixed(|m| m.width),
            radius: mixed(|m| m.radius),
            height: mixed(|m| m.height),
            bottom: mixed(|m| m.bottom),
        }
    }

    /// Returns the height of the top of a solid thing above the ground; `None` for a flat thing, or one that is high above.
    fn top(&self) -> Option<f64> {
        let top = self.bottom + self.height;
        (self.height > FLAT && top > FLAT && self.bottom < ABOVE).then_some(top)
    }

    fn body(&self, class: Class) -> Option<Body> {
        let top = self.top()?;
        Some(if self.radius > 0.0 {
            Body::disc(class, self.radius, top)
        } else if self.length > 0.0 && self.width > 0.0 {
            Body::block(class, self.length, self.width, top)
        } else {
            Body::disc(class, if class == Class::Tree { TRUNK } else { POLE }, top)
        })
    }
}

const NOTHING: Measures = Measures { length: 0.0, width: 0.0, radius: 0.0, height: 0.0, bottom: 0.0 };
const PLAIN: [&str; 5] = ["length", "width", "radius", "height", "zOffset"];
const STARTS: [&str; 5] = ["lengthStart", "widthStart", "radiusStart", "heightStart", "zOffsetStart"];
const ENDS: [&str; 5] = ["lengthEnd", "widthEnd", "radiusEnd", "heightEnd", "zOffsetEnd"];

/// Returns the number in an attribute, or another number if the attribute is absent.
fn number_or(of: Element<'_, '_>, attribute: &'static str, other: f64) -> Result<f64, ReadError> {
    of.text(attribute).map_or(Ok(other), |_| of.number(attribute))
}

/// Returns the size in an attribute, or another size if the attribute is absent.
fn size(of: Element<'_, '_>, attribute: &'static str, other: f64) -> Result<f64, ReadError> {
    let metres = number_or(of, attribute, other)?;
    if (0.0..=LARGEST).contains(&metres) {
        Ok(metres)
    } else {
        Err(of.unexpected(attribute, format!("0 to {LARGEST} m")))
    }
}

/// Returns the place of a thing in metres along its road and to the left of the reference line.
fn place(of: Element<'_, '_>, road: &Road) -> Result<[f64; 2], ReadError> {
    Ok([along(of, "s", road)?, of.number("t")?])
}

/// Returns the place in an attribute, which must lie on the road.
fn along(of: Element<'_, '_>, attribute: &'static str, road: &Road) -> Result<f64, ReadError> {
    let s = of.length(attribute)?;
    // Published files have things slightly beyond the end of the road.
    if s <= road.length + 1.0 {
        Ok(s.min(road.length))
    } else {
        Err(of.unexpected(attribute, format!("at most {} m, the length of the road", road.length)))
    }
}

fn class(kind: &str) -> Class {
    match kind {
        "building" => Class::Building,
        "tree" | "vegetation" => Class::Tree,
        "pole" | "streetLamp" | "lamp" | "guide-post" | "trafficSign" => Class::Sign,
        _ => Class::Prop,
    }
}

fn object(of: Element<'_, '_>, road: &Road) -> Result<Object, ReadError> {
    let kind = of.text("type").unwrap_or_default();
    let class = class(kind);
    let [s, t] = place(of, road)?;
    let measures = Measures::read(of, PLAIN, NOTHING)?;
    let turned = number_or(of, "hdg", 0.0)?;
    let here = pose(road, s, t, turned);
    let mut parts = Vec::new();
    let outlines = of.all("outline").chain(of.all("outlines").flat_map(|all| all.all("outline")));
    let mut has_outline = false;
    for outline in outlines {
        has_outline = true;
        walls(outline, road, &here, &measures, class, &mut parts)?;
    }
    let mut is_repeated = false;
    for repeat in of.all("repeat") {
        is_repeated = true;
        pieces(repeat, road, &measures, turned, class, &mut parts)?;
    }
    if !has_outline && !is_repeated {
        parts.extend(measures.body(class).map(|body| (body, here)));
    }
    if NO_BODY.contains(&kind) {
        parts.clear();
    }
    Ok(Object { id: of.text("id").unwrap_or_default().to_owned(), kind: kind.to_owned(), is_signal: false, parts })
}

fn signal(of: Element<'_, '_>, road: &Road) -> Result<Object, ReadError> {
    let [s, t] = place(of, road)?;
    let height = size(of, "height", SIGNAL)?;
    let measures = Measures { radius: POST, height, bottom: number_or(of, "zOffset", 0.0)?, ..NOTHING };
    let turned = number_or(of, "hOffset", 0.0)?;
    // The post reaches from the ground to the plate.
    let top = (measures.bottom + height).max(0.0);
    if top > LARGEST {
        return Err(
            of.unexpected("zOffset", format!("a place at which the top of the signal is at most {LARGEST} m high"))
        );
    }
    let is_solid = height > FLAT && top >= FLAT;
    let post = Body::disc(Class::Sign, POST, top.max(FLAT));
    Ok(Object {
        id: of.text("id").unwrap_or_default().to_owned(),
        kind: of.text("type").unwrap_or_default().to_owned(),
        is_signal: true,
        parts: is_solid.then(|| (post, pose(road, s, t, turned))).into_iter().collect(),
    })
}

/// Returns the pose of a thing that is turned by an angle against the direction of the road.
fn pose(road: &Road, s: f64, t: f64, turned: f64) -> Pose {
    Pose { position: road.point(s, t), heading: road.line.at(s).heading + turned }
}

/// Adds a wall between two points.
fn wall([from, to]: [Vector2<f64>; 2], [thickness, top]: [f64; 2], class: Class, parts: &mut Vec<(Body, Pose)>) {
    let way = to - from;
    if way.norm() > 0.0 {
        let at = Pose { position: 0.5 * (from + to), heading: libm::atan2(way.y, way.x) };
        parts.push((Body::block(class, way.norm(), thickness, top), at));
    }
}

/// Adds walls along an outline.
fn walls(
    outline: Element<'_, '_>,
    road: &Road,
    here: &Pose,
    measures: &Measures,
    class: Class,
    parts: &mut Vec<(Body, Pose)>,
) -> Result<(), ReadError> {
    let mut corners = Vec::new();
    for of in outline.elements() {
        let (point, bottom) = match of.name() {
            "cornerRoad" => {
                let [s, t] = place(of, road)?;
                (road.point(s, t), number_or(of, "dz", 0.0)?)
            }
            "cornerLocal" => {
                let [u, v] = [of.number("u")?, of.number("v")?];
                (here.position + here.forward() * u + here.left() * v, measures.bottom + number_or(of, "z", 0.0)?)
            }
            _ => continue,
        };
        corners.push((point, Measures { height: size(of, "height", measures.height)?, bottom, ..*measures }.top()));
    }
    if corners.len() < FEWEST_CORNERS {
        let (element, found) = (outline.name().to_owned(), corners.len());
        return Err(outline.error(Flaw::TooFew { element, child: "corner", found, least: FEWEST_CORNERS }));
    }
    let is_closed = outline.text("closed") != Some("false");
    let last = corners.first().copied().filter(|_| is_closed && corners.len() > 2);
    let all: Vec<_> = corners.iter().copied().chain(last).collect();
    for pair in all.windows(2) {
        if let [(from, Some(a)), (to, Some(b))] = pair {
            wall([*from, *to], [WALL, a.max(*b)], class, parts);
        }
    }
    Ok(())
}

/// Adds the pieces of a repetition: one at each step, or without gaps.
fn pieces(
    repeat: Element<'_, '_>,
    road: &Road,
    measures: &Measures,
    turned: f64,
    class: Class,
    parts: &mut Vec<(Body, Pose)>,
) -> Result<(), ReadError> {
    let start = along(repeat, "s", road)?;
    let length = repeat.length("length")?;
    // Beyond the end of the road there is no reference line. A note says what is cut.
    let reach = length.min(road.length - start);
    let distance = repeat.length("distance")?;
    let [t, t_end] = [repeat.number("tStart")?, repeat.number("tEnd")?];
    let ends = [Measures::read(repeat, STARTS, *measures)?, Measures::read(repeat, ENDS, *measures)?];
    let step = if distance > 0.0 { distance } else { PIECE };
    let count = reach / step;
    if count > MOST {
        return Err(repeat.unexpected("distance", format!("a distance that gives at most {MOST} pieces")));
    }
    let at = |way: f64| {
        let share = if length > 0.0 { way / length } else { 0.0 };
        (start + way, t + share * (t_end - t), ends[0].between(ends[1], share))
    };
    if distance > 0.0 {
        for i in 0..=count as usize {
            let (s, t, measures) = at((i as f64 * distance).min(reach));
            parts.extend(measures.body(class).map(|body| (body, pose(road, s, t, turned))));
        }
        return Ok(());
    }
    let count = count.ceil().max(1.0);
    for i in 0..count as usize {
        let [(s, t, _), (_, _, middle), (s_end, t_end, _)] =
            [0.0, 0.5, 1.0].map(|part| at((i as f64 + part) / count * reach));
        if let Some(top) = middle.top() {
            let thickness = if middle.width > 0.0 { middle.width } else { WALL };
            wall([road.point(s, t), road.point(s_end, t_end)], [thickness, top], class, parts);
        }
    }
    Ok(())
}
