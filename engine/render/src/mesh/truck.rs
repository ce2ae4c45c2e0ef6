//! A lorry: a cab in front of a box, on three axles.

use super::clay::{Clay, Matter, Point, at, patch, ring};
use super::colours::{BLACK, GLASS, GREY, LAMP, RED, RUBBER, STEEL, WHITE};
use super::{Mesh, Semantic, SurfaceKind};

/// Length, width and height of the model in metres: those of [`Body::truck`](paracosm_engine::object::Body::truck).
pub(crate) const SIZE: [f32; 3] = [10.1, 2.5, 3.8];

const AXLES: [f32; 3] = [3.85, -2.5, -3.8];
const WHEEL: f32 = 0.52;

fn matter(surface: SurfaceKind, colour: [f32; 3]) -> Matter {
    Matter::new(surface, colour, Semantic::Truck)
}

fn paint() -> Matter {
    Matter::painted(SurfaceKind::Paint, Semantic::Truck)
}

pub(crate) fn truck() -> Mesh {
    let mut clay = Clay::default();
    load(&mut clay);
    cab(&mut clay);
    let dark = matter(SurfaceKind::Plain, BLACK);
    clay.cuboid([-4.95, -0.55, 0.55], [4.6, 0.55, 1.05], dark);
    clay.cuboid([-4.97, -1.15, 0.45], [-4.85, 1.15, 0.62], dark);
    clay.mirrored(|clay| {
        AXLES.into_iter().for_each(|x| wheel(clay, x));
        // The guard between the axles.
        clay.cuboid([-1.7, 1.14, 0.55], [2.7, 1.2, 0.95], matter(SurfaceKind::Plain, GREY));
        clay.cuboid([4.93, 0.72, 0.72], [5.02, 1.12, 0.94], matter(SurfaceKind::WhiteLamp, LAMP));
        clay.cuboid([-5.0, 0.75, 0.66], [-4.9, 1.15, 0.86], matter(SurfaceKind::RedLamp, RED));
    });
    clay.fitted(SIZE).mesh()
}

fn load(clay: &mut Clay) {
    let dark = matter(SurfaceKind::Plain, GREY);
    clay.cuboid([-4.98, -1.25, 1.12], [2.55, 1.25, 3.5], paint());
    clay.cuboid([-4.98, -1.2, 1.0], [2.55, 1.2, 1.12], dark);
    // The gap between the doors at the back, and their bars.
    for y in [-0.45, 0.0, 0.45] {
        let wide = if y == 0.0 { 0.03 } else { 0.02 };
        clay.cuboid([-5.0, y - wide, 1.2], [-4.9, y + wide, 3.42], dark);
    }
}

fn cab(clay: &mut Clay) {
    let profile = [[2.9, 0.62], [4.94, 0.5], [5.0, 1.0], [5.0, 1.62], [4.74, 2.72], [4.5, 2.92], [2.9, 2.92]];
    clay.prism(&profile, [-1.2, 1.2], paint());
    // The wind deflector above the cab.
    clay.prism(&[[2.95, 2.9], [4.4, 2.9], [3.1, 3.4], [2.95, 3.4]], [-1.05, 1.05], paint());
    let front = |x: [f32; 2], z: [f32; 2]| {
        [at(x[0], -1.2, z[0]), at(x[0], 1.2, z[0]), at(x[1], 1.2, z[1]), at(x[1], -1.2, z[1])]
    };
    let (glass, dark) = (matter(SurfaceKind::Glass, GLASS), matter(SurfaceKind::Plain, BLACK));
    clay.facet(&patch(front([5.0, 4.74], [1.62, 2.72]), [0.05, 0.95], [0.05, 0.93], 0.015), glass);
    clay.facet(&patch(front([5.0, 5.0], [1.0, 1.62]), [0.18, 0.82], [0.1, 0.75], 0.015), dark);
    clay.cuboid([4.8, -1.22, 0.48], [5.01, 1.22, 0.70], dark);
    clay.facet(
        &patch(front([5.01, 5.01], [0.48, 0.70]), [0.40, 0.60], [0.2, 0.8], 0.01),
        matter(SurfaceKind::Plain, WHITE),
    );
    clay.mirrored(|clay| {
        let side = [at(4.62, 1.2, 1.7), at(3.75, 1.2, 1.7), at(3.75, 1.2, 2.6), at(4.42, 1.2, 2.6)];
        clay.facet(&patch(side, [0.0, 1.0], [0.0, 1.0], 0.015), glass);
        // Wheel housing, and mirror.
        clay.facet(&patch(arch(), [0.0, 1.0], [0.0, 1.0], 0.01), dark);
        clay.cuboid([4.72, 1.19, 1.75], [4.82, 1.249, 2.3], dark);
    });
}

/// Returns the dark half of a hexagon above a front wheel, as a facet.
fn arch() -> [Point; 4] {
    let x = AXLES[0];
    [at(x + 0.72, 1.2, 0.6), at(x - 0.72, 1.2, 0.6), at(x - 0.45, 1.2, 1.15), at(x + 0.45, 1.2, 1.15)]
}

fn wheel(clay: &mut Clay, x: f32) {
    let [inner, outer] = [at(x, 0.85, WHEEL), at(x, 1.21, WHEEL)];
    clay.tube([inner, outer], [WHEEL; 2], 12, matter(SurfaceKind::Plain, RUBBER));
    clay.facet(&ring(outer + Point::y() * 0.012, Point::y(), 0.28, 8), matter(SurfaceKind::Plain, STEEL));
}
