//! How a run is cut into pages: stretches of time that each fit into one view of the same size, in which a car can still
//! be told from a lorry.
//!
//! A page ends where the car under test drives out of the largest view, so that pages follow it as a reader's eyes
//! follow a line of text. Pages on which it is all alone are left out, if there are others.

use super::record::{Record, Scene};
use super::view::View;
use crate::road::Bounds;
use std::ops::Range;

/// Metres that a page shows at most from left to right, and from top to bottom, unless there would be too many pages.
const SPAN: [f64; 2] = [170.0, 100.0];
/// How many pages there are at most.
const MOST: usize = 6;
/// Metres around what has to be seen.
const MARGIN: f64 = 10.0;
/// How far from the car under test, in metres, others have to be seen: the first of these that gives one page.
const REACHES: [f64; 4] = [f64::INFINITY, 200.0, 100.0, NEAR];
/// How far others are seen in any case.
const NEAR: f64 = 50.0;

/// A stretch of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Page {
    pub view: View,
    pub moments: Range<usize>,
}

/// The pages of a run, each a picture of this width in pixels, all of one size and scale. There are moments.
pub(super) fn pages(record: &Record, scene: &Scene, width: f64) -> Vec<Page> {
    let all = 0..record.moments.len();
    let mut stretches = None;
    for reach in REACHES {
        let bounds = record.bounds(scene, all.clone(), reach).grown(MARGIN);
        if stretches.is_none() && fits(&bounds, 1.0) {
            stretches = Some(vec![(bounds, all.clone())]);
        }
    }
    let mut zoom = 1.0;
    let stretches = loop {
        let found = stretches.take().unwrap_or_else(|| with_company(record, scene, cut(record, scene, zoom)));
        if found.len() <= MOST {
            break found;
        }
        zoom *= 2.0;
    };
    // All views have the size of the one that fits all.
    let extents = stretches.iter().map(|(bounds, _)| bounds.max - bounds.min);
    let extent = extents.reduce(|a, b| a.sup(&b)).expect("there is a page");
    let page = |(bounds, moments): (Bounds, Range<usize>)| {
        let centre = 0.5 * (bounds.min + bounds.max);
        let bounds = Bounds { min: centre - 0.5 * extent, max: centre + 0.5 * extent };
        Page { view: View::fit(&bounds, width), moments }
    };
    stretches.into_iter().map(page).collect()
}

fn fits(bounds: &Bounds, zoom: f64) -> bool {
    let extent = bounds.max - bounds.min;
    extent.x <= SPAN[0] * zoom && extent.y <= SPAN[1] * zoom
}

/// Each page as long as it fits.
fn cut(record: &Record, scene: &Scene, zoom: f64) -> Vec<(Bounds, Range<usize>)> {
    let mut pages: Vec<(Bounds, Range<usize>)> = Vec::new();
    for i in 0..record.moments.len() {
        let here = record.bounds(scene, i..i + 1, NEAR).grown(MARGIN);
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

/// The pages on which others are to be seen; all of them if there are none.
fn with_company(record: &Record, scene: &Scene, pages: Vec<(Bounds, Range<usize>)>) -> Vec<(Bounds, Range<usize>)> {
    let alone = |(_, moments): &(Bounds, Range<usize>)| {
        let car = record.moments[moments.clone()].iter().map(|moment| moment.poses[0].position);
        let bounds = Bounds::around(car);
        bounds == record.bounds(scene, moments.clone(), NEAR)
    };
    let met: Vec<_> = pages.iter().filter(|page| !alone(page)).cloned().collect();
    if met.is_empty() { pages } else { met }
}
