//! Scenery beside the roads that should not matter to drivers: trees, houses, lamp posts, signs, parked bicycles and
//! cars, bystanders.
//!
//! Beside every sidewalk, or the edge of a road without a sidewalk, there is a place every few metres. Chance decides
//! whether something stands there, and what; it follows from the values of the test. Each thing keeps to a disc beyond
//! the sidewalk. It is left out if the disc meets another road, a body, or the path of a body.

use super::Fixture;
use crate::flaw::WorldFlaw;
use crate::object::{Behaviour, Body, Class, Colour, ObjectSetup};
use crate::road::{Bounds, RoadNetwork, Strip, Surface};
use crate::scenario::EgoSetup;
use crate::scenario::{Place, Scenario};
use crate::sensor::Chance;
use nalgebra::Vector2;
use paracosm_road::Pose;
use paracosm_road::wrapped;
use std::f64::consts::{FRAC_PI_2, PI};

/// The distance in metres from one place to the next.
const PLACES: f64 = 8.0;
/// The distances in metres of a thing from roads and sidewalks, from other things, and from bodies and their paths.
const FROM_ROAD: f64 = 0.25;
const FROM_OTHERS: f64 = 0.5;
const FROM_BODIES: f64 = 1.5;
/// The distance in metres between two points of a path that is kept free.
const STEP: f64 = 0.5;

/// Scenery beside the roads, such as trees, to be placed. Place it last, so that it keeps clear of everything else.
///
/// Scenery exists for sensors, and for a car that runs into it. Drivers, traffic, clearances and other signals take no
/// account of it: as long as no car leaves the road, traces are the same as without scenery.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roadside {
    fullness: f64,
}

/// A kind of scenery.
struct SceneryKind {
    name: &'static str,
    /// The share of this kind among all things.
    share: f64,
    body: fn(&mut Chance) -> Body,
    /// The least distance from the road in metres beyond `FROM_ROAD`, to which chance adds at most as much again.
    back: f64,
    /// The heading, in radians counter-clockwise from the direction of the traffic beside it.
    faces: f64,
}

/// The headings towards the road, which is to the left of the traffic's direction, and against the traffic.
const TO_ROAD: f64 = FRAC_PI_2;
const TO_TRAFFIC: f64 = PI;

const KINDS: [SceneryKind; 8] = [
    SceneryKind { name: "tree", share: 0.36, body: tree, back: 1.4, faces: TO_ROAD },
    SceneryKind { name: "house", share: 0.2, body: house, back: 2.5, faces: TO_ROAD },
    SceneryKind { name: "lamp-post", share: 0.1, body: lamp_post, back: 0.0, faces: TO_ROAD },
    SceneryKind { name: "sign", share: 0.1, body: sign, back: 0.1, faces: TO_TRAFFIC },
    SceneryKind { name: "parked-bicycle", share: 0.08, body: bicycle, back: 0.1, faces: 0.2 },
    SceneryKind { name: "bystander", share: 0.08, body: bystander, back: 0.2, faces: TO_ROAD },
    SceneryKind { name: "barrel", share: 0.04, body: barrel, back: 0.1, faces: TO_ROAD },
    SceneryKind { name: "parked-car", share: 0.04, body: car, back: 0.4, faces: TO_ROAD },
];

fn tree(chance: &mut Chance) -> Body {
    Body::disc(Class::Tree, 0.3, chance.between(4.0, 8.0))
}

fn house(chance: &mut Chance) -> Body {
    const WALLS: [Colour; 4] = [[190, 175, 155], [205, 195, 185], [165, 95, 75], [200, 185, 130]];
    let wall = WALLS[chance.between(0.0, WALLS.len() as f64) as usize];
    let storeys = chance.between(1.0, 4.0).floor();
    let body = Body::block(Class::Building, chance.between(7.0, 9.0), chance.between(8.0, 12.0), 2.2 + 2.8 * storeys);
    body.coloured(wall)
}

fn lamp_post(_: &mut Chance) -> Body {
    Body::disc(Class::Sign, 0.08, 6.0)
}

fn sign(_: &mut Chance) -> Body {
    Body::disc(Class::Sign, 0.05, 2.5)
}

fn bicycle(chance: &mut Chance) -> Body {
    Body::parked_bicycle().coloured(painted(chance))
}

fn bystander(chance: &mut Chance) -> Body {
    let body = if chance.happens(0.3) { Body::child() } else { Body::adult() };
    body.coloured(painted(chance))
}

fn barrel(_: &mut Chance) -> Body {
    Body::disc(Class::Prop, 0.3, 1.25)
}

fn car(chance: &mut Chance) -> Body {
    Body::car().coloured(painted(chance))
}

/// Returns a random colour.
fn painted(chance: &mut Chance) -> Colour {
    [0; 3].map(|_: u8| chance.between(0.0, 256.0) as u8)
}

impl Roadside {
    /// Makes scenery that fills a share of the places beside the roads, from 0 (no place) to 1 (every place).
    pub fn new(fullness: f64) -> Self {
        Self { fullness }
    }
}

impl Place for Roadside {
    /// The handle is empty, because scenery has no outputs.
    type Handle = ();

    fn place(self, scenario: &mut Scenario) {
        if !(0.0..=1.0).contains(&self.fullness) {
            return scenario.flaw(WorldFlaw::Roadside { fullness: self.fullness });
        }
        // A world that cannot be built needs no scenery.
        let sound = scenario.flaws.borrow().is_empty();
        let network = scenario.networks.first().cloned().flatten();
        let Some(network) = network.filter(|_| sound && self.fullness > 0.0) else { return };
        let mut room = Room::beside(&network, scenario);
        for (number, edge) in edges(&network).enumerate() {
            let mut chance = Chance::of(scenario.keys.scenery.get(), "roadside", number as u64);
            if chance.happens(self.fullness) {
                let (name, body, at) = thing(&edge, &mut chance);
                if room.takes(at.position, body.outline.reach()) {
                    scenario.place(Fixture::new(name, body, at).as_scenery());
                }
            }
        }
    }
}

/// Returns the places along sidewalks, or edges of roads without them, facing along the traffic, the road to the left.
fn edges(network: &RoadNetwork) -> impl Iterator<Item = Pose> {
    let edge = |strip: &Strip| match strip.surface {
        Surface::Sidewalk => Some(strip.right),
        Surface::EdgeLine => Some(0.0),
        _ => None,
    };
    let beside = network.strips().into_iter().filter_map(move |strip| Some((strip.curve, edge(&strip)?)));
    beside.flat_map(|(curve, offset)| {
        let count = (curve.length() / PLACES) as usize;
        let first = 0.5 * (curve.length() - count.saturating_sub(1) as f64 * PLACES);
        (0..count).map(move |i| {
            let s = first + i as f64 * PLACES;
            Pose { position: curve.beside(s, offset), heading: curve.heading(s) }
        })
    })
}

/// Returns the thing that stands beyond a place of an edge.
fn thing(edge: &Pose, chance: &mut Chance) -> (&'static str, Body, Pose) {
    let mut left = chance.unit();
    let drawn = KINDS.iter().find(|kind| {
        left -= kind.share;
        left < 0.0
    });
    let kind = drawn.unwrap_or(&KINDS[0]);
    let body = (kind.body)(chance);
    let beyond = body.outline.reach() + FROM_ROAD + kind.back * chance.between(1.0, 2.0);
    let along = chance.between(-0.3, 0.3) * PLACES;
    let position = edge.position + edge.forward() * along - edge.left() * beyond;
    (kind.name, body, Pose { position, heading: wrapped(edge.heading + kind.faces) })
}

/// The free room beside the roads.
struct Room {
    ground: Vec<(Bounds, Strip)>,
    /// The discs that are not free: their middles and radii.
    taken: Vec<(Vector2<f64>, f64)>,
}

impl Room {
    /// Returns the room that roads, bodies and their paths leave free.
    fn beside(network: &RoadNetwork, scenario: &Scenario) -> Self {
        let wide = |strip: &Strip| strip.right.abs().max(strip.left.abs());
        let on_ground =
            |strip: &Strip| matches!(strip.surface, Surface::Carriageway | Surface::Sidewalk | Surface::Island);
        let strips = network.strips().into_iter().filter(on_ground);
        let ground = strips.map(|strip| (strip.curve.bounds().grown(wide(&strip)), strip)).collect();
        let cars = scenario.cars.iter().map(EgoSetup::disc);
        let mut taken: Vec<_> =
            cars.chain(scenario.objects.iter().chain(&scenario.scenery).flat_map(kept_free)).collect();
        taken.iter_mut().for_each(|(_, radius)| *radius += FROM_BODIES);
        Self { ground, taken }
    }

    /// Takes a disc if it is free. Returns `true` if it was.
    fn takes(&mut self, middle: Vector2<f64>, radius: f64) -> bool {
        let clear = radius + 0.9 * FROM_ROAD;
        let around = Bounds::around([middle]).grown(clear);
        let on_ground = |(bounds, strip): &(Bounds, Strip)| bounds.meets(&around) && distance(strip, middle) < clear;
        let meets = |(other, reach): &(Vector2<f64>, f64)| (other - middle).norm() < radius + reach;
        let free = !self.ground.iter().any(on_ground) && !self.taken.iter().any(meets);
        if free {
            self.taken.push((middle, radius + FROM_OTHERS));
        }
        free
    }
}

/// Returns the discs around the bodies of an object, and the discs along its planned path.
fn kept_free(object: &ObjectSetup) -> Vec<(Vector2<f64>, f64)> {
    let mut discs: Vec<_> = object.bodies.iter().map(|(body, at)| (at.position, body.outline.reach())).collect();
    let reach = discs.iter().map(|(_, reach)| *reach).fold(0.0, f64::max);
    if let Behaviour::Geometric(behaviour) = &object.behaviour
        && let Some(way) = behaviour.plan()
    {
        let steps = (way.length() / STEP).ceil() as usize;
        discs.extend((0..=steps).map(|i| (way.at((i as f64 * STEP).min(way.length())).position, reach)));
    }
    discs
}

/// Returns the distance in metres from a strip to a point; 0 for a point on it.
fn distance(strip: &Strip, point: Vector2<f64>) -> f64 {
    let local = strip.curve.at(strip.curve.nearest(point)).to_local(point);
    let aside = (strip.right - local.y).max(local.y - strip.left).max(0.0);
    Vector2::new(local.x, aside).norm()
}
