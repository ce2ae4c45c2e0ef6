//! The room that roads, bodies, their paths and other scenery leave free.

use crate::scene::cells::Cells;
use nalgebra::Vector2;
use paracosm_engine::object::{BodyState, Class, Outline};
use paracosm_engine::road::{RoadNetwork, Strip, Surface};
use paracosm_engine::{Pose, Run};

/// The distances in metres of things from roads and sidewalks, from other things and bodies, and from vehicles and their
/// paths.
const FROM_ROAD: f64 = 0.15;
const FROM_OTHERS: f64 = 0.1;
const FROM_VEHICLES: f64 = 0.3;
/// The distance in metres of things from people and their paths, so that nothing hides a person who is about to cross.
const FROM_PEOPLE: f64 = 4.0;
/// The distance along a kerb that stays free beside a zebra crossing, in metres.
const FROM_ZEBRA: f64 = 10.0;
/// The distance in metres between two points of a path that is kept free.
const STEP: f64 = 1.0;
/// The greatest side in metres of the squares that a rectangle is divided into, and the greatest reach of a disc.
const PIECE: f64 = 3.0;
const REACH: f64 = 3.0;

/// A disc on the ground: its middle, and its radius in metres.
pub(super) type Disc = (Vector2<f64>, f64);

/// The room beside roads.
pub(super) struct Room {
    ground: Vec<Strip>,
    of_ground: Cells,
    taken: Vec<Disc>,
    of_taken: Cells,
    zebras: Vec<Vector2<f64>>,
}

impl Room {
    /// Returns the room in the world of a run that has just begun.
    pub fn of(run: &Run) -> Self {
        let network = run.network();
        let mut ground = network.strips();
        let is_ground =
            |surface: Surface| matches!(surface, Surface::Carriageway | Surface::Sidewalk | Surface::Island);
        ground.retain(|strip| is_ground(strip.surface));
        let mut of_ground = Cells::default();
        for (index, strip) in ground.iter().enumerate() {
            of_ground.add_strip(index, &strip.curve, strip.right - REACH, strip.left + REACH);
            for end in [strip.curve.start(), strip.curve.end()] {
                of_ground.add_disc(index, end.position, strip.right.abs().max(strip.left.abs()) + REACH);
            }
        }
        let zebras = zebras(network);
        let mut room = Self { ground, of_ground, taken: Vec::new(), of_taken: Cells::default(), zebras };
        let bodies = run.bodies();
        for state in bodies.iter().filter(|state| state.present) {
            room.take(discs(&state.body.outline, &state.pose).map(|(middle, radius)| (middle, radius + margin(state))));
        }
        for (body, way) in run.plans() {
            let half = bodies[body].body.outline.half_extent();
            let wide = half.x.min(half.y) + margin(&bodies[body]);
            let steps = (way.length() / STEP).ceil() as usize;
            room.take((0..=steps).map(|i| (way.at((i as f64 * STEP).min(way.length())).position, wide)));
        }
        room
    }

    /// Takes discs, whether they are free or not.
    pub fn take(&mut self, discs: impl Iterator<Item = Disc>) {
        for (middle, radius) in discs {
            self.of_taken.add_disc(self.taken.len(), middle, radius + REACH);
            self.taken.push((middle, radius));
        }
    }

    /// Returns `true` if no body, no path and no other thing takes any of these discs.
    pub fn is_free(&self, discs: &[Disc]) -> bool {
        let meets = |(middle, radius): &Disc, (other, reach): &Disc| {
            let near = radius + reach + FROM_OTHERS;
            (other - middle).norm_squared() < near * near
        };
        discs.iter().all(|disc| !self.of_taken.at(disc.0).any(|index| meets(disc, &self.taken[index])))
    }

    /// Returns `true` if these discs lie beside all roads and sidewalks.
    pub fn is_off_roads(&self, discs: &[Disc]) -> bool {
        let meets = |(middle, radius): &Disc, strip: &Strip| distance(strip, *middle) < radius + FROM_ROAD;
        discs.iter().all(|disc| !self.of_ground.at(disc.0).any(|index| meets(disc, &self.ground[index])))
    }

    /// Returns `true` if a place at a kerb is so near to a zebra crossing that it stays free.
    pub fn is_at_zebra(&self, place: Vector2<f64>) -> bool {
        self.zebras.iter().any(|zebra| (zebra - place).norm() < FROM_ZEBRA)
    }
}

fn zebras(network: &RoadNetwork) -> Vec<Vector2<f64>> {
    let lanes = network.crossings().iter().flat_map(|crossing| &crossing.lanes);
    lanes.map(|(lane, at)| network.lane(*lane).curve.point(*at)).collect()
}

fn margin(state: &BodyState) -> f64 {
    match state.body.class {
        Class::Pedestrian | Class::Bicycle => FROM_PEOPLE,
        class if class.is_road_user() => FROM_VEHICLES,
        _ => 0.0,
    }
}

/// Returns discs that cover an outline.
pub(super) fn discs(outline: &Outline, pose: &Pose) -> impl Iterator<Item = Disc> + use<> {
    let pose = *pose;
    let (half, round) = (outline.half_extent(), matches!(outline, Outline::Disc { .. }));
    let count = half.map(|half| if round { 1 } else { (2.0 * half / PIECE).ceil().max(1.0) as usize });
    let piece = half.component_div(&count.map(|count| count as f64));
    let radius = if round { half.x } else { piece.norm() };
    (0..count.x).flat_map(move |i| (0..count.y).map(move |j| [i, j])).map(move |at| {
        let place = Vector2::new(at[0] as f64, at[1] as f64) * 2.0 + Vector2::repeat(1.0);
        let local = place.component_mul(&piece) - half;
        (pose.position + pose.forward() * local.x + pose.left() * local.y, radius)
    })
}

/// Returns the distance in metres from a strip to a point; 0 for a point on the strip.
fn distance(strip: &Strip, point: Vector2<f64>) -> f64 {
    let local = strip.curve.at(strip.curve.nearest(point)).to_local(point);
    let aside = (strip.right - local.y).max(local.y - strip.left).max(0.0);
    Vector2::new(local.x, aside).norm()
}
