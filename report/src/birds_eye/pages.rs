//! Cuts a run into pages: stretches of time that each fit into one view of the same size, in which a car can still be
//! told from a lorry.
//!
//! A page ends when the ego vehicle drives out of the largest view, so pages follow the car as a reader's eyes
//! follow a line of text. Pages on which the car is alone are left out, if there are others.

use super::body::is_actor;
use super::record::{MotionRecord, Scene};
use super::view::{View, across, with_margin};
use paracosm_engine::Pose;
use paracosm_engine::object::Body;
use paracosm_engine::road::Bounds;
use std::ops::Range;

/// The greatest width and height of a page in metres, unless there would be too many pages.
const SPAN: [f64; 2] = [170.0, 100.0];
/// The factor by which a page may be larger if the whole run then fits on one page.
const ALONE: f64 = 1.6;
/// The greatest number of pages, and the greatest height of all pages together as a share of their width.
const MOST: usize = 6;
const HIGHEST: f64 = 1.5;
/// Distances in metres within which others have to be seen from the ego vehicle: the first that gives one page.
const REACHES: [f64; 4] = [f64::INFINITY, 200.0, 100.0, NEAR];
/// The distance in metres within which others are always seen.
const NEAR: f64 = 50.0;
/// The number of bisection steps in the search for the smallest span with the same number of pages.
const HALVINGS: usize = 7;
/// The number of moments from one search for the edges of the road to the next.
const EDGES: usize = 10;

/// A stretch of a run and the view that shows it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Page {
    pub view: View,
    pub moments: Range<usize>,
}

/// The bounds that have to be seen, and the moments of a stretch.
type Stretch = (Bounds, Range<usize>);

/// Cuts a run, which has moments, into pages: pictures of this width in pixels, all of one size and scale.
pub(super) fn pages(record: &MotionRecord, scene: &Scene, width: f64) -> Vec<Page> {
    let all = 0..record.moments.len();
    let whole = |reach: &f64| with_margin(&record.bounds(scene, all.clone(), *reach));
    let one = REACHES.iter().map(whole).find(|bounds| fits(bounds, ALONE));
    let mut stretches = one.map_or_else(|| several(record, scene), |bounds| vec![(bounds, all)]);
    for (bounds, moments) in &mut stretches {
        let cars = record.moments[moments.clone()].iter().step_by(EDGES).map(|moment| moment.poses[0].position);
        *bounds = bounds.union(&across(&scene.network, cars));
    }
    // All views have the size that fits every stretch.
    let extents = stretches.iter().map(|(bounds, _)| bounds.max - bounds.min);
    let extent = extents.reduce(|a, b| a.sup(&b)).expect("there is a page");
    let page = |(bounds, moments): Stretch| {
        let centre = 0.5 * (bounds.min + bounds.max);
        let bounds = Bounds { min: centre - 0.5 * extent, max: centre + 0.5 * extent };
        Page { view: View::fit(&bounds, width), moments }
    };
    stretches.into_iter().map(page).collect()
}

/// Returns the least possible number of pages, each about equally full.
fn several(record: &MotionRecord, scene: &Scene) -> Vec<Stretch> {
    let cut = |zoom: f64| with_company(record, scene, cut(record, scene, zoom));
    let mut zoom = 1.0;
    let mut pages = cut(zoom);
    while pages.len() > 1 && (pages.len() > MOST || height(&pages) > HIGHEST) {
        zoom *= 2.0;
        pages = cut(zoom);
    }
    let (mut too_small, mut enough) = (0.5 * zoom, zoom);
    for _ in 0..HALVINGS {
        let tried = 0.5 * (too_small + enough);
        let found = cut(tried);
        if found.len() <= pages.len() {
            (enough, pages) = (tried, found);
        } else {
            too_small = tried;
        }
    }
    pages
}

/// Returns the height of all pages together, as a share of their common width.
fn height(pages: &[Stretch]) -> f64 {
    let extents = pages.iter().map(|(bounds, _)| bounds.max - bounds.min);
    extents.reduce(|a, b| a.sup(&b)).map_or(0.0, |extent| pages.len() as f64 * extent.y / extent.x)
}

fn fits(bounds: &Bounds, zoom: f64) -> bool {
    let extent = bounds.max - bounds.min;
    extent.x <= SPAN[0] * zoom && extent.y <= SPAN[1] * zoom
}

/// Cuts the run into pages, each of which lasts as long as its content fits.
fn cut(record: &MotionRecord, scene: &Scene, zoom: f64) -> Vec<Stretch> {
    let mut pages: Vec<Stretch> = Vec::new();
    for i in 0..record.moments.len() {
        let here = with_margin(&record.bounds(scene, i..i + 1, NEAR));
        match pages.last_mut() {
            Some((bounds, moments)) if fits(&bounds.union(&here), zoom) => {
                *bounds = bounds.union(&here);
                moments.end = i + 1;
            }
            // The new page begins where the one before it ends.
            _ => pages.push((here, i.saturating_sub(1)..i + 1)),
        }
    }
    pages
}

/// Returns the pages on which other actors are near the ego vehicle; all pages if there is no such page.
fn with_company(record: &MotionRecord, scene: &Scene, pages: Vec<Stretch>) -> Vec<Stretch> {
    let met = |(_, moments): &Stretch| {
        record.moments[moments.clone()].iter().any(|moment| {
            let near = |(pose, body): (&Pose, &Body)| {
                is_actor(body.class) && (pose.position - moment.poses[0].position).norm() <= NEAR
            };
            moment.poses.iter().zip(&scene.bodies).skip(1).any(near)
        })
    };
    let those: Vec<_> = pages.iter().filter(|page| met(page)).cloned().collect();
    if those.is_empty() { pages } else { those }
}
