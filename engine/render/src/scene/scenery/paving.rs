//! The paving of parking bays along a kerb: asphalt instead of the sidewalk, with lines between the cars, and a path for
//! people behind.

use crate::mesh::clay::{Matter, Point, at};
use crate::mesh::{Semantic, SurfaceKind};
use crate::scene::ground::{Chunks, KERB, cuts};
use nalgebra::Vector2;
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
/// Paves bays for cars between two distances along the kerb of a sidewalk. A bay is `each` metres long.
pub(super) fn bays(chunks: &mut Chunks, strip: &Strip, [from, to]: [f64; 2], each: f64) {
    let ground = |surface, colour, semantic| Matter::new(surface, colour, semantic);
    let outer = strip.right - WIDER;
    let asphalt = ground(SurfaceKind::Asphalt, ASPHALT, Semantic::Ground);
    slab(chunks, strip, [from, to], [outer, -BEHIND_KERB], (KERB + ON_TOP, asphalt));
    let slabs = ground(SurfaceKind::Slabs, FLAGSTONE, Semantic::Sidewalk);
    slab(chunks, strip, [from - 1.5, to + 1.5], [outer - PATH, outer], (KERB, slabs));
    slab(chunks, strip, [from - 1.5, from], [outer, strip.right], (KERB, slabs));
    slab(chunks, strip, [to, to + 1.5], [outer, strip.right], (KERB, slabs));
    let paint = ground(SurfaceKind::Marking, LINE, Semantic::RoadLine);
    for i in 0..=((to - from) / each).round() as usize {
        let s = (from + i as f64 * each).clamp(from + LINES, to - LINES);
        let across = [strip.right, -BEHIND_KERB];
        let (clay, origin) = chunks.at(strip.curve.beside(s, strip.right));
        clay.facet(&corners(strip, [s - 0.5 * LINES, s + 0.5 * LINES], across, (KERB + PAINT, origin)), paint);
    }
}

/// Returns the corners of a piece, counter-clockwise as seen from above, in coordinates from an origin. `across` goes from
/// right to left of the kerb.
fn corners(strip: &Strip, along: [f64; 2], across: [f64; 2], (z, origin): (f64, Vector2<f64>)) -> [Point; 4] {
    [(along[0], across[0]), (along[1], across[0]), (along[1], across[1]), (along[0], across[1])].map(|(s, offset)| {
        let place = strip.curve.beside(s, offset) - origin;
        at(place.x as f32, place.y as f32, z as f32)
    })
}

/// Adds a slab with sides to the right and at both ends. Its pieces end where the pieces of the sidewalk end.
fn slab(chunks: &mut Chunks, strip: &Strip, [from, to]: [f64; 2], across: [f64; 2], (z, of): (f64, Matter)) {
    let inner = cuts(&strip.curve, strip.right, strip.left).into_iter().filter(|s| from < *s && *s < to);
    let ends: Vec<f64> = [from].into_iter().chain(inner).chain([to]).collect();
    let last = ends.len() - 2;
    for (i, pair) in ends.windows(2).enumerate() {
        let along = [pair[0], pair[1]];
        let (clay, origin) = chunks.at(strip.curve.beside(0.5 * (along[0] + along[1]), across[0]));
        let [top, foot] = [z, FOOT].map(|z| corners(strip, along, across, (z, origin)));
        clay.facet(&top, of);
        let mut side = |a: usize, b: usize| clay.facet(&[foot[a], foot[b], top[b], top[a]], of);
        side(0, 1);
        if i == 0 {
            side(3, 0);
        }
        if i == last {
            side(1, 2);
        }
    }
}
