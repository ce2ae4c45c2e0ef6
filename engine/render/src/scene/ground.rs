//! Builds the meshes of the roads, in chunks, and of the plain around them.
//!
//! A network is a list of strips ([`Strip`]). Every surface has its height, and raised surfaces have sides. Chunks are
//! squares, so that a renderer can skip those that are out of view.

use super::Instance;
use super::markings::{arrows, edge_lines};
use crate::Look;
use crate::mesh::clay::{Clay, Matter, at};
use crate::mesh::{Mesh, Semantic, SurfaceKind};
use nalgebra::{Isometry3, Vector2};
use paracosm_engine::road::{Bounds, Curve, RoadNetwork, Strip, Surface as Paved};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The side of a chunk in metres.
const CHUNK: f64 = 96.0;
/// The longest piece of a strip in metres, and the greatest distance between a piece and its arc.
const PIECE: f64 = 32.0;
const TOLERANCE: f64 = 0.02;
/// The height of sidewalks above the road, in metres.
pub(super) const KERB: f64 = 0.12;
/// The distance by which ground continues under the objects that lie on it, in metres.
const UNDER: f64 = 0.05;
/// The height of paint above the surface below, in metres: enough to tell the two apart from far away.
const PAINT: f64 = 0.006;
/// The height of the plain, and of the lower edge of the sides of raised surfaces, in metres.
const PLAIN: f64 = -0.03;
const SKIRT: f64 = -0.06;
/// The distance to which the plain continues around the roads, in metres.
const HORIZON: f64 = 4000.0;

const ASPHALT: [f32; 3] = [0.065, 0.066, 0.070];
const FLAGSTONE: [f32; 3] = [0.30, 0.285, 0.26];
const STONE: [f32; 3] = [0.42, 0.41, 0.38];
const GRASS: [f32; 3] = [0.085, 0.16, 0.045];
const LINE: [f32; 3] = [0.80, 0.80, 0.77];
/// The colours of asphalt and grass in the look `textured`: asphalt that has aged, and grass as a photograph shows it.
const OLD_ASPHALT: [f32; 3] = [0.105, 0.102, 0.098];
const LAWN: [f32; 3] = [0.080, 0.115, 0.032];

/// The shape of a surface: its height, and by how much it is widened to the right and left and lengthened at its ends.
struct Lie {
    matter: Matter,
    height: f64,
    wider: [f64; 2],
    longer: f64,
}

fn lie(surface: Paved, look: Look) -> Lie {
    let lie = |surface, colour, semantic, height, wider, longer| Lie {
        matter: Matter::new(surface, colour, semantic),
        height,
        wider,
        longer,
    };
    let (asphalt, (slabs, stone, paint), (grass, green)) = match look {
        Look::Flat => {
            (ASPHALT, (SurfaceKind::Asphalt, SurfaceKind::Plain, SurfaceKind::Plain), (SurfaceKind::Grown, GRASS))
        }
        Look::Textured => {
            (OLD_ASPHALT, (SurfaceKind::Slabs, SurfaceKind::Concrete, SurfaceKind::Marking), (SurfaceKind::Grass, LAWN))
        }
    };
    match surface {
        // Widened under the kerbs and lengthened under the next element, so that no seam shows.
        Paved::Carriageway => lie(SurfaceKind::Asphalt, asphalt, Semantic::Road, 0.0, [UNDER; 2], UNDER),
        Paved::Sidewalk => lie(slabs, FLAGSTONE, Semantic::Sidewalk, KERB, [0.0, -UNDER], 0.0),
        Paved::Island => lie(grass, green, Semantic::Terrain, KERB, [-UNDER, 0.0], 0.0),
        Paved::Kerb => lie(stone, STONE, Semantic::Sidewalk, KERB + 0.005, [0.0; 2], 0.0),
        Paved::CentreLine | Paved::LaneLine | Paved::EdgeLine | Paved::StopLine | Paved::GiveWayLine | Paved::Zebra => {
            lie(paint, LINE, Semantic::RoadLine, PAINT, [0.0; 2], 0.0)
        }
    }
}

/// Meshes of the ground that are being modelled, one for each square of the plane.
#[derive(Debug, Default)]
pub(super) struct Chunks(BTreeMap<[i64; 2], Clay>);

impl Chunks {
    /// Returns the mesh at a place, and the origin of its coordinates.
    pub fn at(&mut self, place: Vector2<f64>) -> (&mut Clay, Vector2<f64>) {
        let chunk: [i64; 2] = place.map(|metres| (metres / CHUNK).floor() as i64).into();
        (self.0.entry(chunk).or_default(), origin(chunk))
    }

    /// Returns the finished meshes.
    pub fn meshes(self) -> impl Iterator<Item = Instance> {
        self.0.into_iter().map(|(chunk, clay)| standing(clay.mesh_at(origin(chunk).into()), origin(chunk)))
    }
}

/// Returns the meshes of the road network and of the plain around it.
pub(super) fn ground(network: &RoadNetwork, look: Look) -> Vec<Instance> {
    let mut chunks = Chunks::default();
    for strip in network.strips().iter().flat_map(Strip::solid_parts) {
        lay(&strip, look, &mut chunks);
    }
    if look == Look::Textured {
        edge_lines(network).iter().for_each(|line| lay(line, look, &mut chunks));
        arrows(network).iter().for_each(|part| paint(part, &mut chunks));
    }
    chunks.meshes().chain([plain(&network.bounds(), look)]).collect()
}

/// Adds a convex polygon of paint to the meshes of the ground.
fn paint(part: &[Vector2<f64>], chunks: &mut Chunks) {
    let (clay, origin) = chunks.at(part[0]);
    let corners = part.iter().map(|point| {
        let point = point - origin;
        at(point.x as f32, point.y as f32, PAINT as f32)
    });
    let matter = lie(Paved::LaneLine, Look::Textured).matter;
    clay.facet(&corners.collect::<Vec<_>>(), matter);
}

fn origin(chunk: [i64; 2]) -> Vector2<f64> {
    Vector2::from(chunk.map(|index| index as f64 * CHUNK))
}

/// Returns the distances along a curve at which a strip on the curve is cut into flat pieces.
pub(super) fn cuts(curve: &Curve, right: f64, left: f64) -> Vec<f64> {
    let widest = [right, left].map(|offset| (1.0 - curve.curvature() * offset).abs()).into_iter().fold(0.0, f64::max);
    let (angle, radius) = (curve.length() * curve.curvature().abs(), widest / curve.curvature().abs());
    let flat = 2.0 * libm::acos((1.0 - TOLERANCE / radius).max(0.0));
    let bends = if curve.curvature() == 0.0 { 1.0 } else { angle / flat };
    let pieces = bends.max(curve.length() * widest / PIECE).ceil().max(1.0) as usize;
    (0..=pieces).map(|i| curve.length() * i as f64 / pieces as f64).collect()
}

/// Adds the surface of a strip of road to the meshes of the ground.
fn lay(strip: &Strip, look: Look, chunks: &mut Chunks) {
    let Lie { matter, height, wider, longer } = lie(strip.surface, look);
    let (right, left) = (strip.right - wider[0], strip.left + wider[1]);
    if right >= left {
        return;
    }
    let mut cuts = cuts(&strip.curve, strip.right, strip.left);
    let last = cuts.len() - 1;
    cuts[0] -= longer;
    cuts[last] += longer;
    for i in 0..last {
        let ends = [cuts[i], cuts[i + 1]];
        let middle = strip.curve.beside(0.5 * (ends[0] + ends[1]), 0.5 * (left + right));
        let (clay, origin) = chunks.at(middle);
        let corners = |z: f64| {
            [(ends[0], right), (ends[1], right), (ends[1], left), (ends[0], left)].map(|(along, offset)| {
                let point = strip.curve.beside(along, offset) - origin;
                at(point.x as f32, point.y as f32, z as f32)
            })
        };
        let top = corners(height);
        clay.facet(&top, matter);
        if height > PAINT {
            let foot = corners(SKIRT);
            let mut side = |a: usize, b: usize| clay.facet(&[foot[a], foot[b], top[b], top[a]], matter);
            side(0, 1);
            side(2, 3);
            if i == 0 {
                side(3, 0);
            }
            if i + 1 == last {
                side(1, 2);
            }
        }
    }
}

/// Returns the wide plain of grass around the roads.
fn plain(bounds: &Bounds, look: Look) -> Instance {
    let middle = (0.5 * (bounds.min + bounds.max)).map(f64::round);
    let half = (0.5 * (bounds.max - bounds.min)).map(|metres| (metres + HORIZON) as f32);
    let mut clay = Clay::default();
    let corners = [(-half.x, -half.y), (half.x, -half.y), (half.x, half.y), (-half.x, half.y)];
    clay.facet(&corners.map(|(x, y)| at(x, y, PLAIN as f32)), lie(Paved::Island, look).matter);
    standing(clay.mesh_at(middle.into()), middle)
}

fn standing(mesh: Mesh, at: Vector2<f64>) -> Instance {
    let pose = Isometry3::translation(at.x as f32, at.y as f32, 0.0);
    Instance { mesh: Arc::new(mesh), pose, scale: [1.0; 3], paint: [1.0; 3], id: 0 }
}
