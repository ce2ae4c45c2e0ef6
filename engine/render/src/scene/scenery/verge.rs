//! The side of a highway: guard rails, delineator posts, trees.

use super::Site;
use crate::mesh::barriers::RAIL;
use crate::mesh::models::Models;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Class};
use paracosm_engine::road::Curve;
use paracosm_engine::sensor::Chance;
use std::f64::consts::PI;

/// The greatest curvature in 1/m of a road with guard rails.
const STRAIGHT: f64 = 0.03;
/// The metres between two delineator posts (RPS, Germany: 50 m on straight roads), and their distance from the edge.
const DELINEATORS: f64 = 50.0;
const BESIDE: f64 = 0.5;
/// The lengths of a guard rail and of a gap, in metres, and the distance of a guard rail from the edge.
const RAILS: [f64; 2] = [40.0, 140.0];
const GAPS: [f64; 2] = [30.0, 90.0];
const BEHIND: f64 = 0.9;
/// The metres at both ends of a road without guard rails.
const ENDS: f64 = 6.0;
/// The metres between two places of trees, the share of places with a tree, and the distances of trees from the edge.
const PLACES: f64 = 8.0;
const GROWN: f64 = 0.55;
const TREES: [f64; 2] = [5.0, 22.0];
/// The distances in metres from the ego vehicle up to which things are drawn.
const FAR: f64 = 200.0;
const POSTS_FAR: f64 = 120.0;

/// Adds everything beside a road whose edge lies `offset` metres to the left of a curve, with the road to the left.
pub(super) fn put(site: &mut Site, curve: &Curve, offset: f64, chance: &mut Chance) {
    if curve.curvature().abs() > STRAIGHT {
        return;
    }
    let pose = |s: f64, beyond: f64, turned: f64| Pose {
        position: curve.beside(s, offset - beyond),
        heading: curve.heading(s) + turned,
    };
    let models = Models::shared();
    let mut s = chance.between(0.0, GAPS[1]);
    while s < curve.length() {
        let end = (s + chance.between(RAILS[0], RAILS[1])).min(curve.length() - ENDS);
        while s + RAIL <= end {
            site.post(&models.rail, pose(s + 0.5 * RAIL, BEHIND, 0.0), 0.0, 0.3, FAR);
            s += RAIL;
        }
        s = end.max(s) + chance.between(GAPS[0], GAPS[1]);
    }
    let count = (curve.length() / DELINEATORS) as usize;
    for i in 0..count {
        // Posts show their front to the traffic beside them.
        let at = pose((i as f64 + 0.5) * DELINEATORS, BESIDE, PI);
        site.post(&models.delineator, at, 0.0, 0.1, POSTS_FAR);
    }
    for i in 0..(curve.length() / PLACES) as usize {
        if chance.happens(GROWN) {
            let s = (i as f64 + chance.unit()) * PLACES;
            let tree = Body::disc(Class::Tree, 0.3, chance.between(4.0, 10.0));
            let at = pose(s, chance.between(TREES[0], TREES[1]), chance.between(-PI, PI));
            site.body((tree, at, 0.0), 0, FAR, true);
        }
    }
}
