//! The side of a street in a town: parked cars in bays along the kerb, bollards, street trees, lamp posts, signs, and a
//! row of houses.

use super::Site;
use super::paving;
use super::room::discs;
use crate::mesh::models::Models;
use crate::scene::ground::KERB;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Class, Colour};
use paracosm_engine::road::Strip;
use paracosm_engine::sensor::Chance;
use std::f64::consts::{FRAC_PI_2, PI};

/// The greatest curvature in 1/m of a street; a kerb that bends more goes around a corner.
const STRAIGHT: f64 = 0.03;
/// The length of a parking bay for one car, and the greatest number of cars in a row.
const BAY: f64 = 5.8;
const ROW: f64 = 6.0;
/// The metres at both ends of a street without parked cars, and the metres between two rows.
const ENDS: f64 = 9.0;
const BETWEEN: [f64; 2] = [5.0, 18.0];
/// The share of bays in which a car stands.
const PARKED: f64 = 0.7;
/// The distances in metres from the kerb of the middle of a parked car, and of a bollard.
const CAR: f64 = 1.15;
const BOLLARD: f64 = 0.45;
/// The share of corners with bollards, and the metres between two bollards.
const CORNERS: f64 = 0.5;
const BOLLARDS: f64 = 1.7;
/// The metres between two places for trees, lamp posts and signs behind a sidewalk; every third place has a lamp post.
const PLACES: f64 = 9.0;
/// The metres between a sidewalk and the houses, and between two houses.
const GARDEN: [f64; 2] = [3.5, 5.5];
const ALLEY: [f64; 2] = [0.8, 5.0];
/// The distances in metres from the ego vehicle up to which things are drawn.
const HOUSES_FAR: f64 = 260.0;
const TREES_FAR: f64 = 180.0;
const CARS_FAR: f64 = 130.0;
const POSTS_FAR: f64 = 120.0;
const BOLLARDS_FAR: f64 = 60.0;
/// The depth of a house in metres, and the widths and storeys of houses. Houses of few sizes share their meshes, which makes
/// images fast.
const DEEP: f64 = 8.7;
const HOUSES: [(f64, f64); 6] = [(8.7, 1.0), (11.6, 1.0), (8.7, 2.0), (11.6, 2.0), (11.6, 3.0), (14.5, 4.0)];
/// The usual colours of walls.
const WALLS: [Colour; 7] =
    [[196, 184, 164], [208, 200, 188], [165, 95, 75], [205, 190, 145], [186, 190, 190], [150, 88, 70], [214, 206, 200]];

/// Adds everything beside a sidewalk. The curve of the strip is the kerb, with the road to the left.
pub(super) fn put(site: &mut Site, strip: &Strip, chance: &mut Chance) {
    if strip.curve.curvature().abs() > STRAIGHT {
        return corner(site, strip, chance);
    }
    bays(site, strip, chance);
    places(site, strip, chance);
    houses(site, strip, chance);
}

/// Returns the pose `beyond` metres to the right of a kerb, turned from the direction of the traffic.
fn pose(strip: &Strip, s: f64, beyond: f64, turned: f64) -> Pose {
    Pose { position: strip.curve.beside(s, -beyond), heading: strip.curve.heading(s) + turned }
}

/// Returns the distance from the kerb to the outer edge of the sidewalk.
fn edge(strip: &Strip) -> f64 {
    -strip.right
}

fn corner(site: &mut Site, strip: &Strip, chance: &mut Chance) {
    if chance.happens(CORNERS) {
        let count = (strip.curve.length() / BOLLARDS) as usize;
        (0..=count).for_each(|i| bollard(site, strip, i as f64 * BOLLARDS));
    }
}

fn bollard(site: &mut Site, strip: &Strip, s: f64) {
    site.post(&Models::shared().bollard, pose(strip, s, BOLLARD, 0.0), KERB, 0.06, BOLLARDS_FAR);
}

fn bays(site: &mut Site, strip: &Strip, chance: &mut Chance) {
    let mut s = ENDS + chance.between(0.0, BETWEEN[1]);
    loop {
        let cars = chance.between(2.0, ROW + 1.0).floor();
        let end = s + cars * BAY;
        if end > strip.curve.length() - ENDS {
            return;
        }
        row(site, strip, [s, end], chance);
        s = end + chance.between(BETWEEN[0], BETWEEN[1]);
    }
}

/// Adds a row of bays with some cars, if the whole row is free.
fn row(site: &mut Site, strip: &Strip, [from, to]: [f64; 2], chance: &mut Chance) {
    let count = ((to - from) / BAY).round() as usize;
    let middle = |i: usize| from + (i as f64 + 0.5) * BAY;
    let is_free = |i: usize| {
        let place = pose(strip, middle(i), CAR, 0.0);
        let car: Vec<_> = discs(&Body::car().outline, &place).collect();
        site.room.is_free(&car) && !site.room.is_at_zebra(place.position)
    };
    if !(0..count).all(is_free) {
        return;
    }
    paving::bays(&mut site.paving, strip, [from, to], BAY);
    for i in 0..count {
        if chance.happens(PARKED) {
            let at = middle(i) + chance.between(-0.3, 0.3);
            let turned = chance.between(-0.02, 0.02);
            let car = (Body::car(), pose(strip, at, CAR + chance.between(-0.05, 0.08), turned), KERB);
            let id = site.id();
            site.body(car, id, CARS_FAR, false);
        }
    }
    [from - 0.4, to + 0.4].into_iter().for_each(|s| bollard(site, strip, s));
}

fn places(site: &mut Site, strip: &Strip, chance: &mut Chance) {
    let count = (strip.curve.length() / PLACES) as usize;
    for i in 0..count {
        let s = (i as f64 + 0.5) * PLACES + chance.between(-2.0, 2.0);
        let behind = |beyond: f64, turned: f64| pose(strip, s, edge(strip) + beyond, turned);
        let lot = chance.unit();
        let thing = if i % 3 == 1 {
            (Body::disc(Class::Sign, 0.08, 6.0), behind(0.3, FRAC_PI_2), 0.0)
        } else if lot < 0.12 {
            (Body::disc(Class::Sign, 0.05, 2.5), behind(0.35, PI), 0.0)
        } else if lot < 0.6 {
            (Body::disc(Class::Tree, 0.3, chance.between(4.0, 7.5)), behind(1.3, FRAC_PI_2), 0.0)
        } else {
            continue;
        };
        let far = if thing.0.class == Class::Tree { TREES_FAR } else { POSTS_FAR };
        site.body(thing, 0, far, true);
    }
}

fn houses(site: &mut Site, strip: &Strip, chance: &mut Chance) {
    let garden = chance.between(GARDEN[0], GARDEN[1]);
    let mut s = 0.0;
    loop {
        let (wide, storeys) = HOUSES[chance.between(0.0, HOUSES.len() as f64) as usize];
        if s + wide > strip.curve.length() {
            return;
        }
        let wall = WALLS[chance.between(0.0, WALLS.len() as f64) as usize];
        let body = Body::block(Class::Building, DEEP, wide, 2.2 + 2.8 * storeys).coloured(wall);
        let beyond = edge(strip) + garden + 0.5 * DEEP;
        site.body((body, pose(strip, s + 0.5 * wide, beyond, FRAC_PI_2), 0.0), 0, HOUSES_FAR, true);
        s += wide + chance.between(ALLEY[0], ALLEY[1]);
    }
}
