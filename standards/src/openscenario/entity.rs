//! The entities of a scenario: vehicles, pedestrians and things, with their dimensions and their limits.

use super::catalogs::Catalogs;
use super::scope::Node;
use super::taken::Taken;
use crate::xml::ReadError;
use nalgebra::Vector2;
use paracosm_engine::object::{Body, Class};

/// An entity of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entity {
    pub name: String,
    /// The box around the entity, with its class.
    pub body: Body,
    /// The middle of the box as seen from the reference point, in metres ahead and to the left. The reference point of a
    /// vehicle is the middle of the rear axle.
    pub middle: Vector2<f64>,
    /// Half of the length and half of the width of the box, in metres.
    pub half: Vector2<f64>,
    /// The limits of a vehicle; `None` for pedestrians and things.
    pub vehicle: Option<Limits>,
    /// `true` if the scenario assigns a controller to the entity.
    pub is_controlled: bool,
    /// The line of the `ScenarioObject`.
    pub line: u32,
}

/// A name for entities, by their indices.
pub(super) type Selection = (String, Vec<usize>);

/// The type of an entity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ObjectType {
    Vehicle,
    Pedestrian,
    Miscellaneous,
}

impl ObjectType {
    pub const NAMES: [(&str, Self); 3] =
        [("vehicle", Self::Vehicle), ("pedestrian", Self::Pedestrian), ("miscellaneous", Self::Miscellaneous)];
}

/// The limits of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// The greatest acceleration in m/s².
    pub acceleration: f64,
    /// The greatest deceleration in m/s².
    pub deceleration: f64,
    /// The greatest speed in m/s.
    pub speed: f64,
}

impl Entity {
    /// Reads all entities of a scenario, and the selections of entities with the indices of their members.
    pub fn all(entities: Node<'_>, catalogs: &Catalogs<'_>) -> Result<(Vec<Self>, Vec<Selection>), ReadError> {
        let mut read: Vec<Self> = Vec::new();
        let mut taken = Taken::default();
        for object in entities.elements() {
            if object.name() == "EntitySelection" {
                continue;
            }
            let name = object.label_required()?.into_owned();
            taken.claim(object, &name)?;
            let (is_controlled, line) = (object.first("ObjectController").is_some(), object.element.line());
            let kind = object.choice("Vehicle, Pedestrian, MiscObject or CatalogReference")?;
            let entity =
                catalogs.resolved(kind, &["Vehicle", "Pedestrian", "MiscObject"], |node| Self::one(node, &name))?;
            read.push(Self { is_controlled, line, ..entity });
        }
        let selection = |selection: Node<'_>| {
            let name = selection.label_required()?.into_owned();
            taken.claim(selection, &name)?;
            Ok((name, Self::members(selection, &read)?))
        };
        let selections = entities.all("EntitySelection").map(selection).collect::<Result<_, ReadError>>()?;
        Ok((read, selections))
    }

    fn members(selection: Node<'_>, all: &[Self]) -> Result<Vec<usize>, ReadError> {
        let mut members = Vec::new();
        for member in selection.child("Members")?.elements() {
            if member.name() == "EntityRef" {
                let name = member.required("entityRef")?;
                let names = || all.iter().map(|entity| entity.name.as_str());
                let index = names().position(|known| known == name);
                members.push(index.ok_or_else(|| member.dangling("entityRef", "entity", names()))?);
            } else {
                let wanted = member.one_of("objectType", &ObjectType::NAMES)?;
                members.extend((0..all.len()).filter(|index| all[*index].object_type() == wanted));
            }
        }
        Ok(members)
    }

    /// Returns the type of the entity.
    pub fn object_type(&self) -> ObjectType {
        match self.body.class {
            _ if self.vehicle.is_some() => ObjectType::Vehicle,
            Class::Pedestrian => ObjectType::Pedestrian,
            _ => ObjectType::Miscellaneous,
        }
    }

    /// Returns the least of the given limits and the entity's own: the greatest acceleration, deceleration and speed.
    pub fn within(&self, limits: [f64; 3]) -> [f64; 3] {
        let Some(own) = self.vehicle else { return limits };
        let [acceleration, deceleration, speed] = limits;
        [acceleration.min(own.acceleration), deceleration.min(own.deceleration), speed.min(own.speed)]
    }

    fn one(node: Node<'_>, name: &str) -> Result<Self, ReadError> {
        let class = match node.name() {
            "Vehicle" => node.one_of("vehicleCategory", &VEHICLES)?,
            "Pedestrian" => node.one_of("pedestrianCategory", &PEDESTRIANS)?,
            "MiscObject" => node.one_of("miscObjectCategory", &THINGS.map(|name| (name, Class::Prop)))?,
            _ => return Err(node.refused("use a Vehicle, a Pedestrian or a MiscObject")),
        };
        let vehicle = (node.name() == "Vehicle").then(|| Limits::read(node)).transpose()?;
        if node.element.text("mass").is_some() {
            node.length("mass")?;
        }
        let bounds = node.child("BoundingBox")?;
        let (centre, dimensions) = (bounds.child("Center")?, bounds.child("Dimensions")?);
        let [length, width, height] =
            [dimensions.length("length")?, dimensions.length("width")?, dimensions.length("height")?];
        // Files give things no extent where none matters; a body has some.
        let [length, width, height] = [length, width, height].map(|metres| metres.max(LEAST_EXTENT));
        Ok(Self {
            name: name.to_owned(),
            body: Body::block(class, length, width, height),
            middle: Vector2::new(centre.number("x")?, centre.number("y")?),
            half: Vector2::new(0.5 * length, 0.5 * width),
            vehicle,
            is_controlled: false,
            line: 0,
        })
    }
}

/// The least extent of a body in metres.
const LEAST_EXTENT: f64 = 0.01;

const VEHICLES: [(&str, Class); 10] = [
    ("car", Class::Car),
    ("van", Class::Van),
    ("truck", Class::Truck),
    ("trailer", Class::Truck),
    ("semitrailer", Class::Truck),
    ("bus", Class::Bus),
    ("motorbike", Class::Motorcycle),
    ("bicycle", Class::Bicycle),
    ("train", Class::Prop),
    ("tram", Class::Prop),
];

const PEDESTRIANS: [(&str, Class); 3] =
    [("pedestrian", Class::Pedestrian), ("wheelchair", Class::Pedestrian), ("animal", Class::Pedestrian)];

const THINGS: [&str; 17] = [
    "none",
    "obstacle",
    "pole",
    "tree",
    "vegetation",
    "barrier",
    "building",
    "parkingSpace",
    "patch",
    "railing",
    "roadMark",
    "trafficIsland",
    "crosswalk",
    "streetLamp",
    "gantry",
    "soundBarrier",
    "wind",
];

impl Limits {
    fn read(vehicle: Node<'_>) -> Result<Self, ReadError> {
        let performance = vehicle.child("Performance")?;
        Ok(Self {
            speed: performance.limit("maxSpeed")?,
            acceleration: performance.limit("maxAcceleration")?,
            deceleration: performance.limit("maxDeceleration")?,
        })
    }
}
