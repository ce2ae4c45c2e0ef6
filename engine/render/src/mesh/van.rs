//! A panel van: a box with a windscreen that leans back over a short bonnet.

use super::clay::{Clay, Matter, Point, at, patch, ring};
use super::colours::{BLACK, GLASS, GREY, LAMP, RED, RUBBER, STEEL, WHITE};
use super::{Mesh, Semantic, SurfaceKind};

/// Length, width and height of the model in metres, equal to the size of
/// [`Body::van`](paracosm_engine::object::Body::van).
pub(crate) const SIZE: [f32; 3] = [5.986, 2.04, 2.59];

const AXLES: [f32; 2] = [-1.72, 1.92];
const WHEEL: f32 = 0.35;
/// Half of the width of the sides, which lean inwards above the shoulder.
const HALF: f32 = 1.0;
/// The lower and the upper edge of the windscreen: metres ahead, and metres up.
const SCREEN: [[f32; 2]; 2] = [[2.28, 1.34], [1.5, 2.34]];

/// The semantic class has no entry for vans. Cityscapes and CARLA count vans among the cars.
fn matter(surface: SurfaceKind, colour: [f32; 3]) -> Matter {
    Matter::new(surface, colour, Semantic::Car)
}

fn paint() -> Matter {
    Matter::painted(SurfaceKind::Paint, Semantic::Car)
}

pub(crate) fn van() -> Mesh {
    let mut clay = Clay::default();
    let [low, high] = SCREEN;
    clay.prism(
        &[[-2.96, 0.32], [low[0], 0.32], low, high, [1.2, 2.5], [-2.7, 2.56], [-2.96, 2.4]],
        [-HALF, HALF],
        paint(),
    );
    clay.prism(&[[2.2, 0.3], [2.93, 0.3], [2.98, 0.72], [2.82, 1.06], [2.2, 1.36]], [-0.97, 0.97], paint());
    windows(&mut clay);
    front_and_back(&mut clay);
    clay.mirrored(|clay| {
        AXLES.into_iter().for_each(|x| wheel(clay, x));
        sides(clay);
    });
    clay.fitted(SIZE).mesh()
}

fn windows(clay: &mut Clay) {
    let [low, high] = SCREEN;
    let screen = [at(low[0], -HALF, low[1]), at(low[0], HALF, low[1]), at(high[0], HALF, high[1]), {
        at(high[0], -HALF, high[1])
    }];
    clay.facet(&patch(screen, [0.05, 0.95], [0.06, 0.94], 0.012), matter(SurfaceKind::Glass, GLASS));
}

fn front_and_back(clay: &mut Clay) {
    let (dark, plate) = (matter(SurfaceKind::Plain, BLACK), matter(SurfaceKind::Plain, WHITE));
    clay.cuboid([2.7, -0.98, 0.24], [2.99, 0.98, 0.48], dark);
    clay.cuboid([2.9, -0.55, 0.66], [2.985, 0.55, 0.82], dark);
    clay.facet(&[at(3.0, -0.26, 0.32), at(3.0, 0.26, 0.32), at(3.0, 0.26, 0.43), at(3.0, -0.26, 0.43)], plate);
    clay.cuboid([-2.99, -0.96, 0.28], [-2.8, 0.96, 0.44], dark);
    // The gap between the doors at the back, and their handle.
    clay.cuboid([-2.97, -0.012, 0.5], [-2.9, 0.012, 2.35], dark);
    clay.cuboid([-2.975, 0.03, 1.1], [-2.9, 0.16, 1.16], dark);
    clay.facet(&[at(-2.98, 0.6, 0.6), at(-2.98, 0.1, 0.6), at(-2.98, 0.1, 0.71), at(-2.98, 0.6, 0.71)], plate);
}

/// Adds the left side: the window of the door, the guide of the sliding door, a mirror, lamps and wheel housings.
fn sides(clay: &mut Clay) {
    let (glass, dark) = (matter(SurfaceKind::Glass, GLASS), matter(SurfaceKind::Plain, BLACK));
    let out = HALF + 0.012;
    clay.facet(&[at(2.12, out, 1.38), at(1.0, out, 1.36), at(1.0, out, 2.1), at(1.56, out, 2.1)], glass);
    clay.cuboid([-2.5, HALF - 0.01, 1.36], [0.75, HALF + 0.008, 1.4], matter(SurfaceKind::Plain, GREY));
    clay.cuboid([-2.6, HALF - 0.02, 0.5], [2.2, HALF + 0.018, 0.62], dark);
    clay.cuboid([1.78, 0.96, 1.36], [1.92, 1.02, 1.7], dark);
    clay.cuboid([2.72, 0.62, 0.76], [2.96, 0.95, 0.98], matter(SurfaceKind::WhiteLamp, LAMP));
    clay.cuboid([-2.975, 0.86, 0.95], [-2.85, 0.99, 1.45], matter(SurfaceKind::RedLamp, RED));
    for axle in AXLES {
        let arch: Vec<Point> = [(0.5, 0.3), (0.42, 0.62), (0.2, 0.8), (-0.2, 0.8), (-0.42, 0.62), (-0.5, 0.3)]
            .map(|(x, z)| at(axle + x, HALF + 0.005, z))
            .into();
        clay.facet(&arch, dark);
    }
}

fn wheel(clay: &mut Clay, x: f32) {
    let [inner, outer] = [at(x, 0.74, WHEEL), at(x, 1.012, WHEEL)];
    clay.tube([inner, outer], [WHEEL; 2], 12, matter(SurfaceKind::Plain, RUBBER));
    clay.facet(&ring(outer + Point::y() * 0.006, Point::y(), 0.21, 8), matter(SurfaceKind::Plain, STEEL));
}
