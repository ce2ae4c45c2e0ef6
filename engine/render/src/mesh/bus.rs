//! A city bus: a long box of windows over a low floor, with a lit destination board.

use super::clay::{Clay, Matter, Point, at, ring};
use super::colours::{BLACK, GLASS, GREY, LAMP, ORANGE, RED, RUBBER, STEEL, WHITE};
use super::{Mesh, Semantic, SurfaceKind};

/// Length, width and height of the model in metres, equal to the size of
/// [`Body::bus`](paracosm_engine::object::Body::bus).
pub(crate) const SIZE: [f32; 3] = [12.135, 2.55, 3.12];

const AXLES: [f32; 2] = [-2.55, 3.3];
const WHEEL: f32 = 0.48;
const HALF: f32 = 1.24;
/// The places of the doors along the right side: the rear and the front edge, in metres ahead.
const DOORS: [[f32; 2]; 2] = [[4.5, 5.75], [-0.65, 0.65]];
/// The edges of the windows along a side, in metres ahead.
const WINDOWS: [[f32; 2]; 6] = [[-5.7, -4.35], [-4.25, -2.6], [-2.5, -0.75], [0.75, 2.3], [2.4, 4.4], [4.5, 5.75]];

fn matter(surface: SurfaceKind, colour: [f32; 3]) -> Matter {
    Matter::new(surface, colour, Semantic::Bus)
}

pub(crate) fn bus() -> Mesh {
    let paint = Matter::painted(SurfaceKind::Paint, Semantic::Bus);
    let mut clay = Clay::default();
    let profile = [[-6.03, 0.34], [6.0, 0.3], [6.04, 1.1], [5.86, 2.8], [5.6, 2.96], [-5.8, 2.96], [-6.03, 2.75]];
    clay.prism(&profile, [-HALF, HALF], paint);
    // The air conditioning on the roof.
    clay.cuboid([-3.6, -0.8, 2.95], [0.4, 0.8, 3.12], matter(SurfaceKind::Plain, GREY));
    ends(&mut clay);
    clay.mirrored(|clay| {
        AXLES.into_iter().for_each(|x| wheel(clay, x));
        WINDOWS.into_iter().for_each(|window| pane(clay, window, 1.22));
        clay.cuboid([5.9, 0.7, 0.6], [6.06, 1.14, 0.86], matter(SurfaceKind::WhiteLamp, LAMP));
        clay.cuboid([-6.06, 0.85, 0.85], [-5.9, 1.2, 1.35], matter(SurfaceKind::RedLamp, RED));
        clay.cuboid([5.7, 1.2, 1.7], [5.95, 1.275, 2.3], matter(SurfaceKind::Plain, BLACK));
    });
    for [rear, front] in DOORS {
        let out = -HALF - 0.016;
        let door = [at(rear, out, 0.42), at(front, out, 0.42), at(front, out, 2.5), at(rear, out, 2.5)];
        clay.facet(&door, matter(SurfaceKind::Glass, GLASS));
        let middle = 0.5 * (rear + front);
        clay.cuboid([middle - 0.03, out - 0.01, 0.42], [middle + 0.03, out, 2.5], matter(SurfaceKind::Plain, BLACK));
    }
    clay.fitted(SIZE).mesh()
}

/// Adds the windscreen, the destination board, the rear window and the bumpers.
fn ends(clay: &mut Clay) {
    let (glass, dark) = (matter(SurfaceKind::Glass, GLASS), matter(SurfaceKind::Plain, BLACK));
    let across = |x: [f32; 2], z: [f32; 2], half: f32| {
        [at(x[0], -half, z[0]), at(x[0], half, z[0]), at(x[1], half, z[1]), at(x[1], -half, z[1])]
    };
    clay.facet(&across([6.055, 5.93], [1.1, 2.3], 1.14), glass);
    clay.facet(&across([5.93, 5.885], [2.34, 2.74], 1.0), dark);
    clay.facet(&across([5.935, 5.9], [2.42, 2.66], 0.7), matter(SurfaceKind::Plain, ORANGE));
    clay.cuboid([5.8, -1.2, 0.28], [6.07, 1.2, 0.52], dark);
    clay.facet(&across([6.08, 6.08], [0.34, 0.46], 0.26), matter(SurfaceKind::Plain, WHITE));
    clay.cuboid([-6.07, -1.2, 0.32], [-5.8, 1.2, 0.56], dark);
    let rear = across([-6.05, -6.05], [1.75, 2.6], 0.95).into_iter().rev().collect::<Vec<_>>();
    clay.facet(&rear, glass);
    // The grille of the engine.
    clay.cuboid([-6.05, -0.7, 0.75], [-5.9, 0.7, 1.45], dark);
}

/// Adds a window on the left side between its rear and its front edge, from `low` to the roof.
fn pane(clay: &mut Clay, [rear, front]: [f32; 2], low: f32) {
    let out = HALF + 0.012;
    let corners = [at(front, out, low), at(rear, out, low), at(rear, out, 2.6), at(front, out, 2.6)];
    clay.facet(&corners, matter(SurfaceKind::Glass, GLASS));
}

fn wheel(clay: &mut Clay, x: f32) {
    let [inner, outer] = [at(x, 0.9, WHEEL), at(x, 1.25, WHEEL)];
    clay.tube([inner, outer], [WHEEL; 2], 14, matter(SurfaceKind::Plain, RUBBER));
    clay.facet(&ring(outer + Point::y() * 0.008, Point::y(), 0.27, 8), matter(SurfaceKind::Plain, STEEL));
}
