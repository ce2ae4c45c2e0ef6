//! Posts and barriers beside roads: bollards, delineator posts, guard rails.

use super::clay::{Clay, Matter, at, oval};
use super::colours::{BLACK, GREY, ORANGE, STEEL, WHITE};
use super::{Mesh, Semantic, SurfaceKind};

/// The length of the piece of a guard rail in metres.
pub(crate) const RAIL: f64 = 4.0;

/// The height of a guard rail, and of a delineator post, in metres (EN 1317; RPS, Germany).
const RAIL_HIGH: f32 = 0.75;
const POST_HIGH: f32 = 1.0;
/// The size of the edges that a bollard has from afar, in metres.
const BOLLARD_EDGE: f32 = 0.04;

fn plain(colour: [f32; 3], semantic: Semantic) -> Matter {
    Matter::new(SurfaceKind::Plain, colour, semantic)
}

/// A bollard of 0.95 m with a white band.
pub(crate) fn bollard() -> Mesh {
    let mut clay = Clay::default();
    let level = |z: f32, radius: f32| oval(at(0.0, 0.0, z), radius, radius, 8);
    let dark = plain(GREY, Semantic::Pole);
    clay.hose(&[level(0.0, 0.055), level(0.70, 0.055)], dark);
    clay.hose(&[level(0.70, 0.056), level(0.82, 0.056)], plain(WHITE, Semantic::Pole));
    clay.hose(&[level(0.82, 0.055), level(0.92, 0.055), level(0.95, 0.035)], dark);
    clay.facet(&level(0.95, 0.035), dark);
    let mut far = Clay::default();
    for (low, high, of) in [(0.0, 0.70, dark), (0.70, 0.82, plain(WHITE, Semantic::Pole)), (0.82, 0.94, dark)] {
        far.hose(&[low, high].map(|z| oval(at(0.0, 0.0, z), 0.06, 0.06, 4)), of);
    }
    clay.mesh().with_coarse(far.mesh(), BOLLARD_EDGE)
}

/// A white delineator post with a slanted black band and a reflector. Its front faces along x.
pub(crate) fn delineator() -> Mesh {
    let mut clay = Clay::default();
    let (white, black) = (plain(WHITE, Semantic::Pole), plain(BLACK, Semantic::Pole));
    clay.prism(&[[-0.05, 0.0], [0.05, 0.0], [0.05, POST_HIGH - 0.04], [-0.05, POST_HIGH]], [-0.06, 0.06], white);
    clay.prism(&[[-0.052, 0.72], [0.052, 0.70], [0.052, 0.90], [-0.052, 0.92]], [-0.062, 0.062], black);
    for (x, colour) in [(0.054, ORANGE), (-0.054, WHITE)] {
        let quad = [at(x, -0.03, 0.73), at(x, 0.03, 0.73), at(x, 0.03, 0.89), at(x, -0.03, 0.89)];
        let corners: Vec<_> = if x > 0.0 { quad.to_vec() } else { quad.into_iter().rev().collect() };
        clay.facet(&corners, plain(colour, Semantic::Pole));
    }
    clay.mesh()
}

/// A piece of a guard rail along x with its post; the road is on the left.
pub(crate) fn rail() -> Mesh {
    let mut clay = Clay::default();
    let (bright, dark) = (plain(STEEL, Semantic::GuardRail), plain(GREY, Semantic::GuardRail));
    clay.cuboid([-0.05, -0.10, 0.0], [0.05, 0.0, RAIL_HIGH - 0.06], dark);
    let half = 0.5 * RAIL as f32;
    // The beam has two waves towards the road, and is seen from both sides.
    let wave = [[0.02, 0.0], [0.08, 0.06], [0.08, 0.11], [0.03, 0.155], [0.08, 0.20], [0.08, 0.25], [0.02, 0.31]];
    for pair in wave.windows(2) {
        let [low, high] = [pair[0], pair[1]].map(|[y, z]| (y, RAIL_HIGH - 0.31 + z));
        let corners =
            [at(half, low.0, low.1), at(-half, low.0, low.1), at(-half, high.0, high.1), at(half, high.0, high.1)];
        clay.facet(&corners, bright);
        let back: Vec<_> = corners.into_iter().rev().collect();
        clay.facet(&back, dark);
    }
    clay.mesh()
}
