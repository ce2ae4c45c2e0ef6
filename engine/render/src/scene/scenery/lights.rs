//! Traffic lights at intersections. No driver obeys them: they are scenery, like the signs.
//!
//! Two directions of an intersection take turns, and opposite arms show the same light.

use super::{Instance, Looks, Site, instance};
use crate::mesh::models::Models;
use crate::mesh::traffic_light::Aspect;
use crate::scene::figure::lot;
use paracosm_engine::Pose;
use paracosm_engine::road::{Lane, LaneKind, RoadNetwork};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// The share of intersections with traffic lights, in percent.
const SHARE: u32 = 70;
/// The metres of a post from the side of its lane, and from the end of the lane.
const BESIDE: f64 = 0.55;
const BEFORE: f64 = 0.3;
/// The radius of a post in metres, and the distance from the ego vehicle up to which lights are drawn.
const RADIUS: f64 = 0.1;
const FAR: f64 = 160.0;
/// The seconds of green, of amber, and of a whole cycle.
const GREEN: f64 = 12.0;
const AMBER: f64 = 3.0;
const CYCLE: f64 = 32.0;
/// The purpose of the lot that gives lights to an intersection.
const LIGHTS: u32 = 4;

/// A traffic light with the time in its cycle at which the run begins.
#[derive(Debug)]
pub(super) struct Light {
    /// The light in all its aspects, in the order of [`Aspect::ALL`].
    aspects: [Instance; 3],
    begins: f64,
}

impl Light {
    pub fn draw(&self, time: f64, scene: &mut Vec<Instance>) {
        let aspect = match (time + self.begins).rem_euclid(CYCLE) {
            time if time < GREEN => Aspect::Green,
            time if time < GREEN + AMBER => Aspect::Amber,
            _ => Aspect::Red,
        };
        scene.push(self.aspects[aspect as usize].clone());
    }
}

/// Adds a traffic light at the right of every road that comes to an intersection.
pub(super) fn put(site: &mut Site, network: &RoadNetwork) {
    // For each intersection, the first direction that was found.
    let mut first: BTreeMap<usize, f64> = BTreeMap::new();
    for lane in network.lanes().iter().filter(|lane| lane.kind == LaneKind::Road && lane.right.is_none()) {
        let Some(element) = intersection(network, lane) else { continue };
        if lot(element as u16, LIGHTS) % 100 >= SHARE {
            continue;
        }
        let end = lane.curve.end();
        let towards = *first.entry(element).or_insert(end.heading);
        let is_across = libm::sin(end.heading - towards).abs() > 0.7;
        let beside = lane.curve.beside(lane.length() - BEFORE, -(0.5 * lane.width + BESIDE));
        // A light faces the cars that come to it.
        let pose = Pose { position: beside, heading: end.heading + PI };
        let discs = vec![(beside, RADIUS)];
        if site.room.is_free(&discs) {
            let aspects = Models::shared().lights.each_ref().map(|mesh| instance(mesh, &pose, 0.0));
            let shift = f64::from(lot(element as u16, LIGHTS + 1) % 32) + if is_across { 0.5 * CYCLE } else { 0.0 };
            site.add(Looks::Light(Light { aspects, begins: shift }), beside, discs, FAR);
        }
    }
}

/// Returns the intersection that a lane leads to, by the index of its element.
fn intersection(network: &RoadNetwork, lane: &Lane) -> Option<usize> {
    let next = lane.successors.iter().map(|next| network.lane(*next));
    let crosses = |next: &&Lane| matches!(next.kind, LaneKind::Straight | LaneKind::Left | LaneKind::Right);
    next.into_iter().find(crosses).map(|next| next.element)
}
