//! Recorded runs as concrete scenarios of OpenSCENARIO XML 1.2, which other simulators play.

use super::polyline::simplified;
use crate::xml::Writer;
use paracosm_engine::object::Class;
use paracosm_engine::{Motion, Pose, Track};
use std::collections::BTreeMap;
use std::fmt::Display;

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
/// The name of the ego vehicle in the file.
const EGO: &str = "Ego";

/// The motion of the ego vehicle in an exported scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EgoAs {
    /// The ego vehicle follows its recorded trajectory.
    Trajectory,
    /// The ego vehicle has its recorded place and speed at the beginning, and then the other simulator moves it.
    Controller,
}

/// A concrete scenario in which everything replays a recorded run.
#[derive(Debug, Clone, Copy)]
pub struct Export<'a> {
    /// The description of the scenario.
    pub about: &'a str,
    /// The date and the time in the header, for example `2026-11-26T00:00:00`.
    pub date: &'a str,
    /// The path of the file of the roads, from the folder of the scenario.
    pub roads: &'a str,
    /// The recorded run.
    pub motion: &'a Motion,
    /// The motion of the ego vehicle.
    pub ego: EgoAs,
}

/// An entity of the file.
struct Entity<'a> {
    name: String,
    track: &'a Track,
    is_ego: bool,
    /// The distance in metres from the reference point to the middle of the body.
    ahead: f64,
    /// The length and the width in metres.
    size: [f64; 2],
}

/// The element of an entity, with its category.
enum Kind {
    Vehicle(&'static str),
    Pedestrian,
    MiscObject(&'static str),
}

impl<'a> Export<'a> {
    /// Returns the text of the scenario. Bodies that are [absent](Self::absent) at the beginning are left out. A body that
    /// leaves the world stays at its last place.
    pub fn text(&self) -> String {
        let entities = self.entities();
        let mut xml = Writer::new();
        xml.within("OpenSCENARIO", &[], |xml| {
            let header: &[(&str, &dyn Display)] = &[
                ("revMajor", &1),
                ("revMinor", &2),
                ("date", &self.date),
                ("description", &self.about),
                ("author", &"PARACOSM"),
            ];
            xml.empty("FileHeader", header);
            xml.empty("CatalogLocations", &[]);
            xml.within("RoadNetwork", &[], |xml| xml.empty("LogicFile", &[("filepath", &self.roads)]));
            xml.within("Entities", &[], |xml| entities.iter().for_each(|entity| entity.write(xml)));
            xml.within("Storyboard", &[], |xml| self.storyboard(&entities, xml));
        });
        xml.finish()
    }

    /// Returns the names of the bodies that are not in the world during the whole run.
    pub fn absent(&self) -> impl Iterator<Item = &'a str> {
        let is_absent = |track: &&Track| track.poses.iter().any(Option::is_none);
        self.motion.tracks.iter().filter(is_absent).map(|track| track.name.as_str())
    }

    fn entities(&self) -> Vec<Entity<'a>> {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        let mut entities = Vec::new();
        for (index, track) in self.motion.tracks.iter().enumerate() {
            if track.poses.first().is_none_or(Option::is_none) {
                continue;
            }
            let base = if index == 0 { EGO } else { &track.name };
            let count = counts.entry(base).and_modify(|count| *count += 1).or_insert(1);
            let name = if *count == 1 { base.to_owned() } else { format!("{base} ({count})") };
            let half = track.body.outline.half_extent();
            let size = [2.0 * half.x, 2.0 * half.y];
            let ahead = if matches!(kind(track.body.class), Kind::Vehicle(_)) { REAR * size[0] } else { 0.0 };
            entities.push(Entity { name, track, is_ego: index == 0, ahead, size });
        }
        entities
    }

    fn storyboard(&self, entities: &[Entity<'_>], xml: &mut Writer) {
        let dt = self.motion.dt;
        xml.within("Init", &[], |xml| {
            xml.within("Actions", &[], |xml| entities.iter().for_each(|entity| entity.begin(dt, xml)));
        });
        xml.within("Story", &[("name", &"replay")], |xml| {
            xml.within("Act", &[("name", &"replay")], |xml| {
                for entity in entities {
                    let is_left = entity.is_ego && self.ego == EgoAs::Controller;
                    entity.maneuver((!is_left).then_some(dt), xml);
                }
                trigger(xml, "StartTrigger", "begin", 0.0);
            });
        });
        let ticks = self.motion.tracks.first().map_or(0, |track| track.poses.len().saturating_sub(1));
        trigger(xml, "StopTrigger", "end", ticks as f64 * dt);
    }
}

impl Entity<'_> {
    fn write(&self, xml: &mut Writer) {
        let ([length, width], height) = (self.size, self.track.body.height);
        let mass = (DENSITY * length * width * height).round().max(1.0);
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
            xml.empty("Center", &[("x", &self.ahead), ("y", &0), ("z", &(0.5 * height))]);
            xml.empty("Dimensions", &[("width", &width), ("length", &length), ("height", &height)]);
        });
    }

    /// Returns the times and the poses of the reference point. A body that has left the world keeps its last pose.
    fn poses(&self, dt: f64) -> Vec<(f64, Pose)> {
        let mut last = self.track.poses.iter().flatten().next().copied().unwrap_or_default();
        let mut all = Vec::with_capacity(self.track.poses.len());
        for (tick, pose) in self.track.poses.iter().enumerate() {
            last = pose.unwrap_or(last);
            let position = last.position - last.forward() * self.ahead;
            all.push((tick as f64 * dt, Pose { position, heading: last.heading }));
        }
        all
    }

    /// Writes the place and the speed at the beginning.
    fn begin(&self, dt: f64, xml: &mut Writer) {
        let poses = self.poses(dt);
        let (_, first) = poses[0];
        let speed = poses.get(1).map_or(0.0, |(_, next)| (next.position - first.position).norm() / dt);
        // An entity at rest has no trajectory, and would go on at a small speed.
        let speed = if simplified(&poses).len() > 1 { speed } else { 0.0 };
        xml.within("Private", &[("entityRef", &self.name)], |xml| {
            xml.within("PrivateAction", &[], |xml| {
                xml.within("TeleportAction", &[], |xml| position(xml, &first));
            });
            xml.within("PrivateAction", &[], |xml| {
                xml.within("LongitudinalAction", &[], |xml| {
                    xml.within("SpeedAction", &[], |xml| {
                        let dynamics: &[(&str, &dyn Display)] =
                            &[("dynamicsShape", &"step"), ("dynamicsDimension", &"time"), ("value", &0)];
                        xml.empty("SpeedActionDynamics", dynamics);
                        xml.within("SpeedActionTarget", &[], |xml| {
                            xml.empty("AbsoluteTargetSpeed", &[("value", &speed)]);
                        });
                    });
                });
            });
        });
    }

    /// Writes the group of maneuvers of the entity. With the duration of a tick, the entity follows its trajectory.
    fn maneuver(&self, dt: Option<f64>, xml: &mut Writer) {
        let vertices = dt.map(|dt| simplified(&self.poses(dt))).filter(|vertices| vertices.len() > 1);
        xml.within("ManeuverGroup", &[("name", &self.name), ("maximumExecutionCount", &1)], |xml| {
            xml.within("Actors", &[("selectTriggeringEntities", &false)], |xml| {
                xml.empty("EntityRef", &[("entityRef", &self.name)]);
            });
            let Some(vertices) = vertices else { return };
            xml.within("Maneuver", &[("name", &self.name)], |xml| {
                let event: &[(&str, &dyn Display)] =
                    &[("name", &self.name), ("priority", &"parallel"), ("maximumExecutionCount", &1)];
                xml.within("Event", event, |xml| {
                    xml.within("Action", &[("name", &self.name)], |xml| {
                        xml.within("PrivateAction", &[], |xml| {
                            xml.within("RoutingAction", &[], |xml| self.follow(&vertices, xml));
                        });
                    });
                    trigger(xml, "StartTrigger", "begin", 0.0);
                });
            });
        });
    }

    fn follow(&self, vertices: &[(f64, Pose)], xml: &mut Writer) {
        xml.within("FollowTrajectoryAction", &[], |xml| {
            xml.within("TrajectoryRef", &[], |xml| {
                xml.within("Trajectory", &[("name", &self.name), ("closed", &false)], |xml| {
                    xml.within("Shape", &[], |xml| {
                        xml.within("Polyline", &[], |xml| {
                            for (time, pose) in vertices {
                                xml.within("Vertex", &[("time", &format!("{time:.5}"))], |xml| position(xml, pose));
                            }
                        });
                    });
                });
            });
            xml.within("TimeReference", &[], |xml| {
                let timing: &[(&str, &dyn Display)] =
                    &[("domainAbsoluteRelative", &"absolute"), ("scale", &1), ("offset", &0)];
                xml.empty("Timing", timing);
            });
            xml.empty("TrajectoryFollowingMode", &[("followingMode", &"position")]);
        });
    }
}

fn position(xml: &mut Writer, Pose { position, heading }: &Pose) {
    xml.within("Position", &[], |xml| {
        // Five decimals are a hundredth of a millimetre.
        let [x, y, h] = [position.x, position.y, *heading].map(|number| format!("{number:.5}"));
        xml.empty("WorldPosition", &[("x", &x), ("y", &y), ("h", &h)]);
    });
}

/// Writes a trigger at a time in seconds.
fn trigger(xml: &mut Writer, element: &str, name: &str, time: f64) {
    xml.within(element, &[], |xml| {
        xml.within("ConditionGroup", &[], |xml| {
            let condition: &[(&str, &dyn Display)] = &[("name", &name), ("delay", &0), ("conditionEdge", &"none")];
            xml.within("Condition", condition, |xml| {
                xml.within("ByValueCondition", &[], |xml| {
                    xml.empty("SimulationTimeCondition", &[("value", &time), ("rule", &"greaterOrEqual")]);
                });
            });
        });
    });
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
