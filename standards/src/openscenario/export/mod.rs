//! Recorded runs as concrete scenarios of OpenSCENARIO XML, which other simulators play.

mod entity;
mod original;

use super::polyline::simplified;
use super::program::TICK;
use super::version::{NEWEST, WRITTEN};
use crate::opendrive::Map;
use crate::xml::Writer;
use entity::{Entity, stays};
use paracosm_engine::{Motion, Pose};
use std::fmt::Display;
use std::ops::Range;

pub use original::Original;

/// The seconds between a trigger and the moment at which a body enters or leaves the world: a tick and a half. An action has its
/// effect at the end of the tick in which it begins, and ticks are sums of rounded numbers.
const BEFOREHAND: f64 = 0.015;

/// The greatest difference in m/s between the recorded speed of an entity of a file and the speed on its trajectory.
const SPEED: f64 = 0.005;

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
    /// The roads of this file. Bodies of its objects and signals are no entities.
    pub map: &'a Map,
    /// The recorded run.
    pub motion: &'a Motion,
    /// The entities of the scenario, if it is a file; empty if it is a program.
    pub originals: &'a [Original],
    /// The motion of the ego vehicle.
    pub ego: EgoAs,
}

/// An action of an entity in the storyboard.
enum Act {
    /// The entity enters the world.
    Enter(Pose),
    /// The entity, which is in the world, is at another place at once.
    Jump(Pose),
    /// The entity gets the speed at the beginning of poses.
    Speed(Vec<(f64, Pose)>),
    /// The entity follows vertices with times.
    Follow(Vec<(f64, Pose)>),
    /// The entity leaves the world.
    Leave,
}

impl Act {
    fn words(&self) -> &'static str {
        match self {
            Self::Enter(_) => "enters",
            Self::Jump(_) => "jumps",
            Self::Speed(_) => "has its speed",
            Self::Follow(_) => "moves",
            Self::Leave => "leaves",
        }
    }
}

impl<'a> Export<'a> {
    /// Returns the text of the scenario. Its version is 1.2, or 1.3 if a vehicle has no front axle. Each body is in the world while it is there in the recorded run. Bodies that are
    /// [never](Self::never_there) there are left out.
    pub fn text(&self) -> String {
        let entities = Entity::all(self.motion, self.map, self.originals);
        let is_of_newest = self.originals.iter().any(Original::is_of_newest);
        let minor = if is_of_newest { NEWEST } else { WRITTEN };
        let mut xml = Writer::new();
        xml.within("OpenSCENARIO", &[], |xml| {
            let header: &[(&str, &dyn Display)] = &[
                ("revMajor", &1),
                ("revMinor", &minor),
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

    /// Returns the names of the bodies that are never in the world during the run.
    pub fn never_there(&self) -> impl Iterator<Item = &'a str> {
        let tracks = self.motion.tracks.iter().filter(|track| stays(track).is_empty());
        tracks.map(|track| track.name.as_str())
    }

    fn storyboard(&self, entities: &[Entity<'_>], xml: &mut Writer) {
        let dt = self.motion.dt;
        xml.within("Init", &[], |xml| {
            let there = entities.iter().filter(|entity| entity.stays[0].start == 0);
            xml.within("Actions", &[], |xml| there.for_each(|entity| entity.begin(dt, xml)));
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
    /// Returns the times and the poses of the reference point during a stay.
    fn poses(&self, stay: &Range<usize>, dt: f64) -> Vec<(f64, Pose)> {
        let reference = |Pose { position, heading }: Pose| {
            let pose = Pose { position, heading };
            Pose { position: position - pose.turn_to_plane(self.middle), heading }
        };
        let poses = stay.clone().zip(self.track.poses[stay.clone()].iter().flatten());
        poses.map(|(tick, pose)| (tick as f64 * dt, reference(*pose))).collect()
    }

    /// Writes the place and the speed at the beginning of the run.
    fn begin(&self, dt: f64, xml: &mut Writer) {
        let poses = self.poses(&self.stays[0], dt);
        xml.within("Private", &[("entityRef", &self.name)], |xml| {
            xml.within("PrivateAction", &[], |xml| {
                xml.within("TeleportAction", &[], |xml| position(xml, &poses[0].1));
            });
            speed(self.original.map_or_else(|| first_speed(&poses, dt), |original| original.speed), xml);
        });
    }

    /// Returns the vertices of a trajectory through poses.
    fn simplified(&self, poses: &[(f64, Pose)]) -> Vec<(f64, Pose)> {
        simplified(poses, if self.original.is_some() { SPEED } else { f64::INFINITY })
    }

    /// Writes the group of maneuvers of the entity. With the duration of a tick, the entity follows its trajectory.
    fn maneuver(&self, dt: Option<f64>, xml: &mut Writer) {
        xml.within("ManeuverGroup", &[("name", &self.name), ("maximumExecutionCount", &1)], |xml| {
            xml.within("Actors", &[("selectTriggeringEntities", &false)], |xml| {
                xml.empty("EntityRef", &[("entityRef", &self.name)]);
            });
            let Some(dt) = dt else { return };
            let events: Vec<_> = self.stays.iter().flat_map(|stay| self.events(stay, dt)).collect();
            if events.is_empty() {
                return;
            }
            xml.within("Maneuver", &[("name", &self.name)], |xml| {
                for (index, (time, actions)) in events.iter().enumerate() {
                    let name = format!("{} {}", self.name, index + 1);
                    let event: &[(&str, &dyn Display)] =
                        &[("name", &name), ("priority", &"parallel"), ("maximumExecutionCount", &1)];
                    xml.within("Event", event, |xml| {
                        for action in actions {
                            let words = format!("{name} {}", action.words());
                            xml.within("Action", &[("name", &words)], |xml| self.act(action, dt, xml));
                        }
                        trigger(xml, "StartTrigger", "begin", *time);
                    });
                }
            });
        });
    }

    /// Returns the actions of a stay that come after the beginning of the run, each with its time in seconds.
    fn events(&self, stay: &Range<usize>, dt: f64) -> Vec<(f64, Vec<Act>)> {
        let at = |tick: usize| (tick as f64 * dt - BEFOREHAND).max(0.0);
        let poses = self.poses(stay, dt);
        let vertices = self.simplified(&poses);
        let is_there = |tick: Option<usize>| tick.is_some_and(|tick| self.track.poses[tick].is_some());
        let mut events = Vec::new();
        let mut begin = at(stay.start);
        if stay.start > 0 {
            let place = poses[0].1;
            let first = if is_there(stay.start.checked_sub(1)) { Act::Jump(place) } else { Act::Enter(place) };
            events.push((begin, vec![first, Act::Speed(poses)]));
            // The entity keeps its speed for this tick. An entity at the beginning of its trajectory has none.
            begin += TICK;
        }
        if vertices.len() > 1 {
            events.push((begin, vec![Act::Follow(vertices)]));
        }
        if stay.end < self.track.poses.len() && !is_there(Some(stay.end)) {
            events.push((at(stay.end), vec![Act::Leave]));
        }
        events
    }

    fn act(&self, action: &Act, dt: f64, xml: &mut Writer) {
        let global = |xml: &mut Writer, within: &dyn Fn(&mut Writer)| {
            xml.within("GlobalAction", &[], |xml| xml.within("EntityAction", &[("entityRef", &self.name)], within));
        };
        match action {
            Act::Enter(pose) => global(xml, &|xml| xml.within("AddEntityAction", &[], |xml| position(xml, pose))),
            Act::Jump(pose) => xml.within("PrivateAction", &[], |xml| {
                xml.within("TeleportAction", &[], |xml| position(xml, pose));
            }),
            Act::Leave => global(xml, &|xml| xml.empty("DeleteEntityAction", &[])),
            Act::Speed(poses) => speed(first_speed(poses, dt), xml),
            Act::Follow(vertices) => xml.within("PrivateAction", &[], |xml| {
                xml.within("RoutingAction", &[], |xml| self.follow(vertices, xml));
            }),
        }
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

/// Returns the speed at the beginning of poses.
fn first_speed(poses: &[(f64, Pose)], dt: f64) -> f64 {
    let speed = poses.get(1).map_or(0.0, |(_, next)| (next.position - poses[0].1.position).norm() / dt);
    // An entity at rest has no trajectory, and would go on at a small speed.
    if simplified(poses, f64::INFINITY).len() > 1 { speed } else { 0.0 }
}

/// Writes the action that gives an entity its speed at once.
fn speed(speed: f64, xml: &mut Writer) {
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
