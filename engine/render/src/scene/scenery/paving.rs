//! The paving of parking bays along a kerb: asphalt instead of the sidewalk, with lines between the cars, and a path for
//! people behind.

use crate::mesh::clay::{Clay, Matter, Point, at};
use crate::mesh::{Semantic, SurfaceKind};
use crate::scene::ground::KERB;
use paracosm_engine::road::Strip;

const ASPHALT: [f32; 3] = [0.085, 0.084, 0.083];
const FLAGSTONE: [f32; 3] = [0.30, 0.285, 0.26];
const LINE: [f32; 3] = [0.75, 0.75, 0.72];
/// The metres from the kerb at which the asphalt begins, and by which it is wider than the sidewalk.
const BEHIND_KERB: f64 = 0.16;
const WIDER: f64 = 0.35;
/// The widths of the path and of a line, in metres.
const PATH: f64 = 1.5;
const LINES: f64 = 0.1;
/// The heights of asphalt and lines above the sidewalk, and the height of the lower edge of all sides, in metres.
const ON_TOP: f64 = 0.008;
const PAINT: f64 = 0.014;
const FOOT: f64 = -0.06;
/// The longest flat piece in metres.
const PIECE: f64 = 6.0;

/// Paves bays for cars between two distances along the kerb of a sidewalk. A bay is `each` metres long.
pub(super) fn bays(clay: &mut Clay, strip: &Strip, [from, to]: [f64; 2], each: f64) {
    let ground = |surface, colour, semantic| Matter::new(surface, colour, semantic);
    let outer = strip.right - WIDER;
    let asphalt = ground(SurfaceKind::Asphalt, ASPHALT, Semantic::Ground);
    slab(clay, strip, [from, to], [outer, -BEHIND_KERB], (KERB + ON_TOP, asphalt));
    let slabs = ground(SurfaceKind::Slabs, FLAGSTONE, Semantic::Sidewalk);
    slab(clay, strip, [from - 1.5, to + 1.5], [outer - PATH, outer], (KERB, slabs));
    slab(clay, strip, [from - 1.5, from], [outer, strip.right], (KERB, slabs));
    slab(clay, strip, [to, to + 1.5], [outer, strip.right], (KERB, slabs));
    let paint = ground(SurfaceKind::Marking, LINE, Semantic::RoadLine);
    for i in 0..=((to - from) / each).round() as usize {
        let s = (from + i as f64 * each).clamp(from + LINES, to - LINES);
        let corners = corners(strip, [s - 0.5 * LINES, s + 0.5 * LINES], [strip.right, -BEHIND_KERB], KERB + PAINT);
        clay.facet(&corners, paint);
    }
}

/// Returns the corners of a piece, counter-clockwise as seen from above. `across` goes from right to left of the kerb.
fn corners(strip: &Strip, along: [f64; 2], across: [f64; 2], z: f64) -> [Point; 4] {
    [(along[0], across[0]), (along[1], across[0]), (along[1], across[1]), (along[0], across[1])].map(|(s, offset)| {
        let place = strip.curve.beside(s, offset);
        at(place.x as f32, place.y as f32, z as f32)
    })
}

/// Adds a slab with sides to the right and at both ends.
fn slab(clay: &mut Clay, strip: &Strip, [from, to]: [f64; 2], across: [f64; 2], (z, of): (f64, Matter)) {
    let count = ((to - from) / PIECE).ceil().max(1.0) as usize;
    let cut = |i: usize| from + (to - from) * i as f64 / count as f64;
    for i in 0..count {
        let [top, foot] = [z, FOOT].map(|z| corners(strip, [cut(i), cut(i + 1)], across, z));
        clay.facet(&top, of);
        let mut side = |a: usize, b: usize| clay.facet(&[foot[a], foot[b], top[b], top[a]], of);
        side(0, 1);
        if i == 0 {
            side(3, 0);
        }
        if i + 1 == count {
            side(1, 2);
        }
    }
}
