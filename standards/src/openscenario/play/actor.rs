//! An entity at play: where it is, how it moves, and which actions move it.

use crate::opendrive::Map;
use crate::openscenario::entity::Entity;
use crate::openscenario::place::Place;
use crate::openscenario::project::{project, project_near};
use crate::openscenario::route::Legs;
use nalgebra::Vector2;
use paracosm_engine::road::wrapped;
use paracosm_engine::{LedMotion, Pose};
use std::cell::Cell;

/// The speed in m/s below which an entity stands.
const STANDING: f64 = 0.01;

/// The number of ticks after which an entity at the end of its road has no speed.
const STOPS_AFTER: f64 = 2.5;

/// An entity in a run.
#[derive(Debug, Clone)]
pub(in crate::openscenario) struct Actor {
    pub entity: Entity,
    place: Cell<Whereabouts>,
    /// The metres that the entity has moved since its place was found; `None` if it is still there.
    moved: Cell<Option<f64>>,
    /// The position of the reference point, and the heading.
    pub pose: Pose,
    /// The speed in m/s in the direction of the heading; negative if the entity moves backwards.
    pub speed: f64,
    /// `false` while the entity is not in the world.
    pub present: bool,
    /// The velocity in m/s.
    pub velocity: Vector2<f64>,
    /// The change of the speed over the last tick in m/s².
    pub acceleration: f64,
    /// The acceleration to the left in m/s²: the speed times the turn of the heading over the last tick.
    pub lateral_acceleration: f64,
    /// The speed in m/s to the left of the heading.
    pub lateral_speed: f64,
    /// The distance in metres that the entity has travelled.
    pub travelled: f64,
    /// The seconds for which the entity has been standing.
    pub standing: f64,
    /// The seconds for which the entity has been at the end of its road.
    pub stuck: f64,
    /// The seconds for which the entity has been beside all lanes; `None` if no condition asks for them.
    pub offroad: Option<f64>,
    /// The roads of the route that the entity follows at junctions; `None` if it has no route.
    pub route: Option<Legs>,
    /// The metres that the entity has covered on the way that it follows; `None` if it follows none.
    pub on_track: Option<f64>,
    /// The motion of this tick, which the actions change.
    pub step: Step,
}

/// The place of an entity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::openscenario) enum Whereabouts {
    /// The entity follows a lane.
    OnLane(Place),
    /// The entity is beside all roads, and goes straight on.
    Free(Pose),
}

/// The motion of an entity within a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::openscenario) struct Step {
    /// The speed at the beginning of the tick in m/s.
    pub before: f64,
    /// The offset from the middle of the lane at the end of the tick.
    pub offset: Option<f64>,
    /// The angle from the direction of the lane that the motion aside gives the entity, in radians.
    pub angle: f64,
    /// The metres that the entity moves aside, at the cost of its motion along the lane.
    pub aside: f64,
    /// `true` if an action has put the entity at a place, where it stays to the end of the tick.
    pub stays: bool,
    /// The pose at the end of the tick, if an action determines it.
    pub pose: Option<Pose>,
    /// The place on a lane at the end of the tick, if an action that determines the pose is over.
    pub landed: Option<Place>,
}

impl Actor {
    /// Makes an entity that stands at the origin until it is teleported.
    pub fn new(entity: Entity) -> Self {
        let pose = Pose { position: Vector2::zeros(), heading: 0.0 };
        Self {
            entity,
            place: Cell::new(Whereabouts::Free(pose)),
            moved: Cell::new(None),
            pose,
            speed: 0.0,
            present: true,
            velocity: Vector2::zeros(),
            acceleration: 0.0,
            lateral_acceleration: 0.0,
            lateral_speed: 0.0,
            travelled: 0.0,
            standing: 0.0,
            stuck: 0.0,
            offroad: None,
            route: None,
            on_track: None,
            step: Step::default(),
        }
    }

    /// Puts the entity at a place.
    pub fn put(&mut self, place: Whereabouts, map: &Map) {
        self.set_place(place);
        self.stuck = 0.0;
        self.pose = match place {
            Whereabouts::OnLane(place) => place.pose(map),
            Whereabouts::Free(pose) => pose,
        };
    }

    /// Sets the place of the entity, which does not move.
    pub fn set_place(&mut self, place: Whereabouts) {
        self.place.set(place);
        self.moved.set(None);
    }

    /// Returns the place of the entity. If a driver moves the entity, its place is found when it is asked for.
    pub fn place(&self, map: &Map) -> Whereabouts {
        if let Some(moved) = self.moved.take() {
            self.place.set(self.found(moved, map).map_or(Whereabouts::Free(self.pose), Whereabouts::OnLane));
        }
        self.place.get()
    }

    /// Returns the place on a lane; `None` beside all roads.
    pub fn on_lane(&self, map: &Map) -> Option<Place> {
        match self.place(map) {
            Whereabouts::OnLane(place) => Some(place),
            Whereabouts::Free(_) => None,
        }
    }

    /// Returns the place under the entity, which has moved since its place was found; `None` beside all roads. Where roads overlap,
    /// this is the road that follows on the way of the entity.
    fn found(&self, moved: f64, map: &Map) -> Option<Place> {
        let near = match self.place.get() {
            Whereabouts::OnLane(before) => {
                let mut ahead = before;
                ahead.follow(moved, self.route.as_ref(), map);
                project_near(&self.pose, &ahead, map).or_else(|| project_near(&self.pose, &before, map))
            }
            Whereabouts::Free(_) => None,
        };
        near.or_else(|| project(&self.pose, map))
    }

    /// Returns the position of the middle of the entity's box, and the entity's heading.
    pub fn middle(&self) -> Pose {
        Pose { position: self.pose.position + self.pose.turn_to_plane(self.entity.middle), heading: self.pose.heading }
    }

    /// Returns the motion of the middle of the entity's box.
    pub fn motion(&self) -> LedMotion {
        LedMotion { pose: self.middle(), speed: self.speed }
    }

    /// Moves the entity on by a tick of `dt` seconds, as its actions say.
    pub fn advance(&mut self, dt: f64, map: &Map) {
        let from = self.pose;
        let Step { before, offset, angle, aside, stays, pose, landed } = std::mem::take(&mut self.step);
        if let Some(pose) = pose {
            self.put(landed.map_or(Whereabouts::Free(pose), Whereabouts::OnLane), map);
        } else {
            let metres = if stays { 0.0 } else { along(self.speed * dt, aside) };
            let mut place = self.place(map);
            let arrived = match &mut place {
                Whereabouts::OnLane(place) => {
                    if let Some(offset) = offset {
                        place.offset = offset;
                    }
                    let moved = place.follow(metres, self.route.as_ref(), map);
                    self.pose = place.pose(map);
                    self.pose.heading = wrapped(self.pose.heading + angle);
                    !moved
                }
                Whereabouts::Free(pose) => {
                    pose.position += pose.forward() * metres;
                    self.pose = *pose;
                    false
                }
            };
            self.set_place(place);
            self.stuck = if arrived || self.stuck > 0.0 && metres == 0.0 { self.stuck + dt } else { 0.0 };
            if self.stuck > STOPS_AFTER * dt {
                self.speed = 0.0;
            }
        }
        self.finish(dt, before, from, map);
        if stays {
            self.velocity = self.pose.forward() * self.speed;
        }
    }

    /// Takes over the motion of a car that a driver drives.
    pub fn follow(&mut self, motion: LedMotion, dt: f64, map: &Map) {
        let (from, before) = (self.pose, self.speed);
        let heading = motion.pose.heading;
        let forward = Pose { position: Vector2::zeros(), heading };
        let position = motion.pose.position - forward.turn_to_plane(self.entity.middle);
        self.pose = Pose { position, heading };
        self.speed = motion.speed;
        self.moved.set(Some(self.moved.get().unwrap_or(0.0) + motion.speed * dt));
        self.finish(dt, before, from, map);
    }

    fn finish(&mut self, dt: f64, before: f64, from: Pose, map: &Map) {
        if let Some(seconds) = self.offroad {
            let is_off = match self.place(map) {
                Whereabouts::OnLane(place) => place.is_offroad(map),
                Whereabouts::Free(pose) => project(&pose, map).is_none_or(|place| place.is_offroad(map)),
            };
            self.offroad = Some(if is_off { seconds + dt } else { 0.0 });
        }
        self.lateral_speed = from.turn_to_local(self.pose.position - from.position).y / dt;
        self.acceleration = (self.speed - before) / dt;
        self.lateral_acceleration = self.speed * wrapped(self.pose.heading - from.heading) / dt;
        self.velocity = (self.pose.position - from.position) / dt;
        self.travelled += (self.pose.position - from.position).norm();
        self.standing = if self.speed.abs() < STANDING { self.standing + dt } else { 0.0 };
    }
}

/// Returns the metres along a lane of an entity that travels `metres` metres, `aside` of them to the side.
fn along(metres: f64, aside: f64) -> f64 {
    if aside == 0.0 { metres } else { (metres * metres - aside * aside).max(0.0).sqrt().copysign(metres) }
}
