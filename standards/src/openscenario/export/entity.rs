//! The entities of an exported scenario: their boxes, and the stays of their bodies in the world.

use super::original::Original;
use crate::opendrive::Map;
use crate::xml::Writer;
use nalgebra::Vector2;
use paracosm_engine::object::Class;
use paracosm_engine::{Motion, Track};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::Range;

/// The distance of the rear axle from the middle of a vehicle, as a share of its length.
const REAR: f64 = 0.3;
/// The distance between the axles of a vehicle, as a share of its length.
const BASE: f64 = 0.6;
/// The track width of a vehicle as a share of its width.
const TRACK_WIDTH: f64 = 0.85;
/// The diameter of a wheel in metres.
const WHEEL: f64 = 0.6;
/// The greatest angle of the front wheels in radians.
const STEERING: f64 = 0.6;
/// The mass in kilograms of a cubic metre of an entity, with the empty space within it.
const DENSITY: f64 = 150.0;
/// The greatest speed of a vehicle of the file in m/s. It bounds no recorded motion.
const FASTEST: f64 = 100.0;
/// The greatest acceleration of a vehicle of the file in m/s². It bounds no recorded motion.
const STRONGEST: f64 = 20.0;
/// The least excess in m/s of the speed at which an entity jumps over its speed before and after.
const JUMP: f64 = 0.5;
/// The name of the ego vehicle in the file.
const EGO: &str = "Ego";

/// An entity of the file.
pub(super) struct Entity<'a> {
    pub name: String,
    pub track: &'a Track,
    /// The ticks of each stay in the world. A stay of an entity of a file ends where the entity jumps to another place, too.
    pub stays: Vec<Range<usize>>,
    pub is_ego: bool,
    /// The middle of the body as seen from the reference point, in metres ahead and to the left.
    pub middle: Vector2<f64>,
    /// The entity of the file of the scenario; `None` if the scenario is a program.
    pub original: Option<&'a Original>,
    /// The length and the width in metres.
    size: [f64; 2],
}

/// The element of an entity, with its category.
enum Kind {
    Vehicle(&'static str),
    Pedestrian,
    MiscObject(&'static str),
}

impl<'a> Entity<'a> {
    /// Returns the entities of all bodies that are in the world during the run, without those of the map. Their names are all
    /// different. `originals` are the entities of the first bodies, if the scenario is a file.
    pub fn all(motion: &'a Motion, map: &Map, originals: &'a [Original]) -> Vec<Self> {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        let mut entities = Vec::new();
        for (index, track) in motion.tracks.iter().enumerate() {
            let mut stays = stays(track);
            let original = originals.get(index);
            if original.is_some() {
                stays = stays.into_iter().flat_map(|stay| without_jumps(stay, track, motion.dt)).collect();
            }
            if stays.is_empty() || original.is_none() && is_of_map(track, map) {
                continue;
            }
            let usual = if index == 0 { EGO } else { &track.name };
            let base = original.map_or(usual, |original| &original.name);
            let count = counts.entry(base).and_modify(|count| *count += 1).or_insert(1);
            let name = if *count == 1 { base.to_owned() } else { format!("{base} ({count})") };
            let half = track.body.outline.half_extent();
            let size = [2.0 * half.x, 2.0 * half.y];
            let is_vehicle = matches!(kind(track.body.class), Kind::Vehicle(_));
            let usual = if is_vehicle { Vector2::new(REAR * size[0], 0.0) } else { Vector2::zeros() };
            let middle = original.map_or(usual, |original| original.middle);
            entities.push(Self { name, track, stays, is_ego: index == 0, middle, original, size });
        }
        entities
    }

    /// Writes the element of the entity.
    pub fn write(&self, xml: &mut Writer) {
        let ([length, width], height) = (self.size, self.track.body.height);
        let mass = (DENSITY * length * width * height).round().max(1.0);
        if let Some(original) = self.original {
            return xml.within("ScenarioObject", &[("name", &self.name)], |xml| original.element.write(xml));
        }
        xml.within("ScenarioObject", &[("name", &self.name)], |xml| match kind(self.track.body.class) {
            Kind::Vehicle(category) => {
                let attributes: &[(&str, &dyn Display)] =
                    &[("name", &category), ("vehicleCategory", &category), ("mass", &mass)];
                xml.within("Vehicle", attributes, |xml| {
                    self.bounding_box(xml);
                    let performance: &[(&str, &dyn Display)] =
                        &[("maxSpeed", &FASTEST), ("maxAcceleration", &STRONGEST), ("maxDeceleration", &STRONGEST)];
                    xml.empty("Performance", performance);
                    xml.within("Axles", &[], |xml| {
                        for (axle, x, steering) in [("FrontAxle", BASE * length, STEERING), ("RearAxle", 0.0, 0.0)] {
                            let attributes: &[(&str, &dyn Display)] = &[
                                ("maxSteering", &steering),
                                ("wheelDiameter", &WHEEL),
                                ("trackWidth", &(TRACK_WIDTH * width)),
                                ("positionX", &x),
                                ("positionZ", &(0.5 * WHEEL)),
                            ];
                            xml.empty(axle, attributes);
                        }
                    });
                    xml.empty("Properties", &[]);
                });
            }
            Kind::Pedestrian => {
                let attributes: &[(&str, &dyn Display)] =
                    &[("name", &"pedestrian"), ("mass", &mass), ("pedestrianCategory", &"pedestrian")];
                xml.within("Pedestrian", attributes, |xml| {
                    self.bounding_box(xml);
                    xml.empty("Properties", &[]);
                });
            }
            Kind::MiscObject(category) => {
                let attributes: &[(&str, &dyn Display)] =
                    &[("name", &category), ("mass", &mass), ("miscObjectCategory", &category)];
                xml.within("MiscObject", attributes, |xml| {
                    self.bounding_box(xml);
                    xml.empty("Properties", &[]);
                });
            }
        });
    }

    fn bounding_box(&self, xml: &mut Writer) {
        let ([length, width], height) = (self.size, self.track.body.height);
        xml.within("BoundingBox", &[], |xml| {
            xml.empty("Center", &[("x", &self.middle.x), ("y", &self.middle.y), ("z", &(0.5 * height))]);
            xml.empty("Dimensions", &[("width", &width), ("length", &length), ("height", &height)]);
        });
    }
}

/// Returns `true` if a body is that of an object or of a signal of a map.
fn is_of_map(track: &Track, map: &Map) -> bool {
    let mut parts = map.objects().flat_map(|object| &object.parts);
    parts.any(|(body, at)| *body == track.body && track.poses.iter().all(|pose| *pose == Some(*at)))
}

/// Returns the ticks of each stay of a body in the world.
pub(super) fn stays(track: &Track) -> Vec<Range<usize>> {
    let mut stays: Vec<Range<usize>> = Vec::new();
    for tick in (0..track.poses.len()).filter(|tick| track.poses[*tick].is_some()) {
        match stays.last_mut() {
            Some(last) if last.end == tick => last.end = tick + 1,
            _ => stays.push(tick..tick + 1),
        }
    }
    stays
}

/// Divides a stay where the body jumps to another place: there it is faster than just before and just after.
fn without_jumps(stay: Range<usize>, track: &Track, dt: f64) -> Vec<Range<usize>> {
    let place = |tick: usize| track.poses.get(tick).copied().flatten().map(|pose| pose.position);
    let fast = |tick: usize| Some((place(tick)? - place(tick.checked_sub(1)?)?).norm() / dt);
    let jumps = |tick: &usize| {
        let others = [tick.checked_sub(1).and_then(fast), fast(tick + 1)];
        let excess = |other: Option<f64>| Some(fast(*tick)? - other?);
        others.iter().any(Option::is_some) && others.into_iter().filter_map(excess).all(|excess| excess > JUMP)
    };
    let borders: Vec<usize> = (stay.start + 1..stay.end).filter(jumps).chain([stay.end]).collect();
    let starts = [stay.start].into_iter().chain(borders.iter().copied());
    starts.zip(&borders).map(|(start, end)| start..*end).collect()
}

fn kind(class: Class) -> Kind {
    match class {
        Class::Car => Kind::Vehicle("car"),
        Class::Van => Kind::Vehicle("van"),
        Class::Truck => Kind::Vehicle("truck"),
        Class::Bus => Kind::Vehicle("bus"),
        Class::Motorcycle => Kind::Vehicle("motorbike"),
        Class::Bicycle => Kind::Vehicle("bicycle"),
        Class::Pedestrian => Kind::Pedestrian,
        Class::Building => Kind::MiscObject("building"),
        Class::Tree => Kind::MiscObject("tree"),
        Class::Sign => Kind::MiscObject("pole"),
        Class::Prop => Kind::MiscObject("obstacle"),
    }
}
