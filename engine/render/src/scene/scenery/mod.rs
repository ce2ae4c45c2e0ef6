//! Scenery that exists only in pictures of the look `textured`: houses and trees, parked cars along kerbs, posts, guard
//! rails, traffic lights. Nobody drives by it, and nobody collides with it.
//!
//! The scenery follows from the roads and from the values of the test. It keeps clear of lanes, of all bodies at the
//! beginning of a run, and of their planned paths. A thing is not drawn while a body stands where the thing would be.

mod lights;
mod paving;
mod room;
mod street;
mod verge;

use super::Instance;
use super::figure::Figure;
use super::ground::Chunks;
use crate::Look;
use crate::mesh::Mesh;
use lights::Light;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2, Vector3};
use paracosm_engine::object::{Body, BodyState};
use paracosm_engine::road::{LaneKind, Surface};
use paracosm_engine::sensor::Chance;
use paracosm_engine::{Pose, Run};
use room::{Disc, Room, discs};
use std::sync::Arc;

/// The least id of an object that exists only in pictures. The ids of bodies are below.
const FIRST: u16 = 0xf000;
/// A road with more lanes than this in a direction is a highway, which has no houses beside it.
const IN_TOWN: i32 = 2;
/// The distance in metres that things keep from the ego vehicle, so that its cameras are never within them.
const FROM_CAR: f64 = 0.5;

/// Returns `true` if an id in an image belongs to an object that exists only in pictures, such as a parked car of the look
/// [`Textured`](Look::Textured). A detector should neither be rewarded nor punished if it finds such an object.
pub fn is_only_pictured(id: u16) -> bool {
    id >= FIRST
}

/// The scenery of a run.
#[derive(Debug, Default)]
pub(super) struct Scenery {
    ground: Vec<Instance>,
    things: Vec<Thing>,
}

/// An object that exists only in pictures.
#[derive(Debug)]
struct Thing {
    looks: Looks,
    place: Vector2<f64>,
    /// The discs that the thing takes, and a radius around `place` that contains them.
    discs: Vec<Disc>,
    reach: f64,
    /// The distance in metres from the ego vehicle beyond which the thing is not drawn.
    far: f64,
}

#[derive(Debug)]
enum Looks {
    Still(Vec<Instance>),
    Light(Light),
}

impl Scenery {
    /// Makes the scenery of a run that has just begun.
    pub fn of(run: &Run) -> Self {
        let network = run.network();
        let mut site = Site::of(run);
        let roads = || network.lanes().iter().filter(|lane| lane.kind == LaneKind::Road);
        let is_town = roads().all(|lane| lane.number.abs() <= IN_TOWN);
        lights::put(&mut site, network);
        for (number, strip) in network.strips().iter().enumerate() {
            let mut chance = Chance::of(run.scenery(), "scenery", number as u64);
            match strip.surface {
                Surface::Sidewalk if is_town => street::put(&mut site, strip, &mut chance),
                Surface::Sidewalk => verge::put(&mut site, &strip.curve, strip.right, &mut chance),
                Surface::EdgeLine => verge::put(&mut site, &strip.curve, 0.0, &mut chance),
                _ => (),
            }
        }
        site.finish()
    }

    /// Adds the scenery at a time in seconds, as far as no body is in its place, and it is near enough to the first body.
    pub fn draw(&self, bodies: &[BodyState], time: f64, scene: &mut Vec<Instance>) {
        scene.extend_from_slice(&self.ground);
        for thing in &self.things {
            let is_near = bodies
                .first()
                .is_none_or(|car| (car.pose.position - thing.place).norm_squared() < thing.far * thing.far);
            if is_near && !bodies.iter().enumerate().any(|(index, state)| thing.meets(index, state)) {
                match &thing.looks {
                    Looks::Still(instances) => scene.extend_from_slice(instances),
                    Looks::Light(light) => light.draw(time, scene),
                }
            }
        }
    }
}

impl Thing {
    fn meets(&self, index: usize, state: &BodyState) -> bool {
        let near = self.reach + state.body.outline.reach() + FROM_CAR;
        if !state.present || (state.pose.position - self.place).norm_squared() > near * near {
            return false;
        }
        let (half, margin) = (state.body.outline.half_extent(), if index == 0 { FROM_CAR } else { 0.0 });
        let overlaps = |(middle, radius): &Disc| {
            let beyond = (state.pose.to_local(*middle).abs() - half).sup(&Vector2::zeros());
            beyond.norm() < radius + margin
        };
        self.discs.iter().any(overlaps)
    }
}

/// The scenery of a run while it is made.
struct Site {
    room: Room,
    things: Vec<Thing>,
    /// The paving of parking bays.
    paving: Chunks,
    /// The number of things with ids.
    known: u16,
}

impl Site {
    fn of(run: &Run) -> Self {
        Self { room: Room::of(run), things: Vec::new(), paving: Chunks::default(), known: 0 }
    }

    fn finish(self) -> Scenery {
        Scenery { ground: self.paving.meshes().collect(), things: self.things }
    }

    /// Returns an id for a thing that detectors may find; 0 if there are no more ids.
    fn id(&mut self) -> u16 {
        let id = FIRST.checked_add(self.known).unwrap_or_default();
        self.known = self.known.saturating_add(1);
        id
    }

    /// Adds a thing that looks like a body, `raised` metres above the ground. Returns `true` if there was room.
    fn body(&mut self, (body, pose, raised): (Body, Pose, f64), id: u16, far: f64, on_grass: bool) -> bool {
        let discs: Vec<Disc> = discs(&body.outline, &pose).collect();
        if !self.room.is_free(&discs) || (on_grass && !self.room.is_off_roads(&discs)) {
            return false;
        }
        let state = BodyState { body, pose, velocity: Vector2::zeros(), altitude: 0.0, travelled: 0.0, present: true };
        let mut instances = Vec::new();
        Figure::new(&state, raised as f32, id, Look::Textured).draw(&mut instances);
        self.add(Looks::Still(instances), pose.position, discs, far);
        true
    }

    /// Adds a thing of one mesh that takes a disc of a radius, if there is room on roadsides or sidewalks.
    fn post(&mut self, mesh: &Arc<Mesh>, pose: Pose, raised: f64, radius: f64, far: f64) {
        let discs = vec![(pose.position, radius)];
        if self.room.is_free(&discs) {
            let instances = vec![instance(mesh, &pose, raised)];
            self.add(Looks::Still(instances), pose.position, discs, far);
        }
    }

    fn add(&mut self, looks: Looks, place: Vector2<f64>, discs: Vec<Disc>, far: f64) {
        let reach = discs.iter().map(|(middle, radius)| (middle - place).norm() + radius).fold(0.0, f64::max);
        self.room.take(discs.iter().copied());
        self.things.push(Thing { looks, place, discs, reach, far });
    }
}

fn instance(mesh: &Arc<Mesh>, pose: &Pose, raised: f64) -> Instance {
    let place = Translation3::new(pose.position.x as f32, pose.position.y as f32, raised as f32);
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), pose.heading as f32);
    Instance { mesh: mesh.clone(), pose: Isometry3::from_parts(place, turn), scale: [1.0; 3], paint: [1.0; 3], id: 0 }
}
