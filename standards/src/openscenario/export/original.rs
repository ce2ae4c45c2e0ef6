//! The entities of a scenario of a file, as an exported scenario has them: with their own boxes, limits and categories.

use crate::openscenario::concrete::Valued;
use crate::openscenario::play::Stage;
use crate::openscenario::program::Xosc;
use crate::openscenario::scope::Node;
use crate::xml::{ReadError, Writer};
use nalgebra::Vector2;
use paracosm_engine::Lead;
use paracosm_space::Values;
use std::fmt::Display;

/// An entity of the file of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Original {
    pub(super) name: String,
    pub(super) element: Copied,
    /// The middle of the box as seen from the reference point, in metres ahead and to the left.
    pub(super) middle: Vector2<f64>,
    /// The speed in m/s at the beginning of the run.
    pub(super) speed: f64,
}

/// An element with the values of a test.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Copied {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    within: Vec<Self>,
}

/// The elements that version 1.2 of the standard knows and that are copied, with their attributes.
const COPIED: [(&str, &[&str]); 11] = [
    ("Vehicle", &["name", "vehicleCategory", "mass"]),
    ("Pedestrian", &["name", "mass", "pedestrianCategory"]),
    ("MiscObject", &["name", "mass", "miscObjectCategory"]),
    ("BoundingBox", &[]),
    ("Center", &["x", "y", "z"]),
    ("Dimensions", &["width", "length", "height"]),
    ("Performance", &["maxSpeed", "maxAcceleration", "maxDeceleration"]),
    ("Axles", &[]),
    ("FrontAxle", &AXLE),
    ("RearAxle", &AXLE),
    ("AdditionalAxle", &AXLE),
];
const AXLE: [&str; 5] = ["maxSteering", "wheelDiameter", "trackWidth", "positionX", "positionZ"];

impl Xosc {
    /// Returns the entities of the scenario in a test: first the ego vehicle, and then the others in the order of the file.
    ///
    /// # Errors
    /// The scenario cannot be read with these values.
    pub fn originals(&self, test: &Values) -> Result<Vec<Original>, ReadError> {
        self.valued(test, |Valued { root, catalogs, map, board, ego }| {
            let mut elements = Vec::new();
            for object in root.child("Entities")?.all("ScenarioObject") {
                let kind = object.choice("Vehicle, Pedestrian or MiscObject")?;
                let kinds = ["Vehicle", "Pedestrian", "MiscObject"];
                elements.push(catalogs.resolved(kind, &kinds, Copied::of)?);
            }
            // A test that has run has a place for everything.
            let Ok(stage) = Stage::new(board, map, ego, Lead::new()) else { return Ok(Vec::new()) };
            let actors = stage.cast.actors.iter().zip(elements.into_iter().flatten());
            let mut all: Vec<Original> = actors
                .map(|(actor, element)| {
                    let (name, middle) = (actor.entity.name.clone(), actor.entity.middle);
                    Original { name, element, middle, speed: actor.speed }
                })
                .collect();
            all[..=ego].rotate_right(1);
            Ok(all)
        })
    }
}

impl Original {
    /// Returns the name of the entity.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns `true` if the element of the entity lacks something that all versions but the newest demand.
    pub(super) fn is_of_newest(&self) -> bool {
        let axles = self.element.within.iter().find(|inner| inner.name == "Axles");
        axles.is_some_and(|axles| axles.within.iter().all(|axle| axle.name != "FrontAxle"))
    }
}

impl Copied {
    /// Copies an element; `None` if it is not one of those that are copied.
    fn of(node: Node<'_>) -> Result<Option<Self>, ReadError> {
        let Some((name, attributes)) = COPIED.iter().find(|(name, _)| *name == node.name()) else { return Ok(None) };
        let mut copied = Self { name, attributes: Vec::new(), within: Vec::new() };
        for attribute in attributes.iter() {
            if let Some(value) = node.text(attribute)? {
                copied.attributes.push((attribute, value.into_owned()));
            }
        }
        for inner in node.elements() {
            copied.within.extend(Self::of(inner)?);
        }
        Ok(Some(copied))
    }

    /// Writes the element of an entity.
    pub fn write(&self, xml: &mut Writer) {
        self.write_with(xml, true);
    }

    fn write_with(&self, xml: &mut Writer, has_properties: bool) {
        let attributes: Vec<(&str, &dyn Display)> =
            self.attributes.iter().map(|(name, value)| (*name, value as &dyn Display)).collect();
        if self.within.is_empty() && !has_properties {
            return xml.empty(self.name, &attributes);
        }
        xml.within(self.name, &attributes, |xml| {
            self.within.iter().for_each(|inner| inner.write_with(xml, false));
            if has_properties {
                xml.empty("Properties", &[]);
            }
        });
    }
}
