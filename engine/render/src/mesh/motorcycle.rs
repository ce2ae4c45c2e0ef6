//! A motorcycle with its rider, who wears a helmet.

use super::clay::{Clay, Matter, Point, at, oval};
use super::colours::{BLACK, GREY, LAMP, RED, RUBBER, STEEL, TROUSERS};
use super::{Mesh, Semantic, SurfaceKind};

/// Length, width and height of the model in metres, equal to the size of
/// [`Body::motorcycle`](paracosm_engine::object::Body::motorcycle).
pub(crate) const SIZE: [f32; 3] = [2.08, 0.79, 1.7];

const WHEEL: f32 = 0.31;
const FRONT: [f32; 3] = [0.72, 0.0, WHEEL];
const REAR: [f32; 3] = [-0.7, 0.0, WHEEL];

pub(crate) fn motorcycle() -> Mesh {
    let mut clay = Clay::default();
    machine(&mut clay);
    rider(&mut clay);
    clay.fitted(SIZE).mesh()
}

fn machine(clay: &mut Clay) {
    let matter = |surface, colour| Matter::new(surface, colour, Semantic::Motorcycle);
    let paint = Matter::painted(SurfaceKind::Paint, Semantic::Motorcycle);
    let (dark, steel) = (matter(SurfaceKind::Plain, BLACK), matter(SurfaceKind::Plain, STEEL));
    for centre in [FRONT, REAR] {
        let centre = Point::from(centre);
        clay.tyre(centre, [WHEEL - 0.09, WHEEL], 0.14, 12, matter(SurfaceKind::Plain, RUBBER));
        clay.tube([centre - Point::y() * 0.05, centre + Point::y() * 0.05], [0.16; 2], 8, steel);
    }
    // The engine, the tank, the seat and the tail.
    clay.cuboid([-0.3, -0.17, 0.22], [0.34, 0.17, 0.6], matter(SurfaceKind::Plain, GREY));
    clay.prism(&[[-0.12, 0.6], [0.4, 0.58], [0.42, 0.84], [0.2, 0.95], [-0.1, 0.82]], [-0.15, 0.15], paint);
    clay.prism(&[[-0.85, 0.78], [-0.1, 0.68], [-0.1, 0.82], [-0.55, 0.84], [-0.9, 0.92]], [-0.12, 0.12], dark);
    clay.prism(&[[0.36, 0.62], [0.62, 0.66], [0.66, 0.92], [0.5, 1.12], [0.42, 1.0]], [-0.16, 0.16], paint);
    clay.tube([FRONT.into(), at(0.42, 0.0, 0.98)], [0.045; 2], 6, steel);
    clay.tube([REAR.into(), at(-0.1, 0.0, 0.42)], [0.05; 2], 6, dark);
    clay.tube([at(0.36, -0.38, 1.02), at(0.36, 0.38, 1.02)], [0.022; 2], 6, dark);
    clay.tube([at(-0.2, -0.2, 0.26), at(-0.78, -0.22, 0.42)], [0.05, 0.06], 6, steel);
    clay.cuboid([0.62, -0.09, 0.76], [0.69, 0.09, 0.9], matter(SurfaceKind::WhiteLamp, LAMP));
    clay.cuboid([-0.92, -0.07, 0.82], [-0.86, 0.07, 0.9], matter(SurfaceKind::RedLamp, RED));
    clay.mirrored(|clay| clay.cuboid([0.42, 0.3, 1.1], [0.46, 0.4, 1.18], dark));
}

fn rider(clay: &mut Clay) {
    let matter = |colour| Matter::new(SurfaceKind::Plain, colour, Semantic::Rider);
    let (leather, dark) = (matter(TROUSERS), matter(BLACK));
    let jacket = Matter::painted(SurfaceKind::Cloth, Semantic::Rider);
    let back = [
        (-0.32, 0.8, 0.14, 0.18),
        (-0.26, 1.0, 0.14, 0.18),
        (-0.12, 1.22, 0.14, 0.22),
        (-0.03, 1.36, 0.1, 0.21),
        (0.0, 1.42, 0.05, 0.07),
    ];
    clay.loft(&back.map(|(x, z, deep, wide)| oval(at(x, 0.0, z), deep, wide, 8)), jacket);
    clay.ball(at(0.05, 0.0, 1.55), [0.15, 0.125, 0.15], 10, dark);
    clay.mirrored(|clay| {
        let (shoulder, elbow, hand) = (at(-0.04, 0.21, 1.32), at(0.12, 0.32, 1.1), at(0.35, 0.33, 1.03));
        clay.tube([shoulder, elbow], [0.065, 0.055], 6, jacket);
        clay.tube([elbow, hand], [0.055, 0.045], 6, jacket);
        let (hip, knee, foot) = (at(-0.28, 0.11, 0.86), at(0.16, 0.22, 0.78), at(-0.14, 0.22, 0.36));
        clay.tube([hip, knee], [0.1, 0.075], 6, leather);
        clay.tube([knee, foot], [0.075, 0.05], 6, leather);
        clay.tube([foot + at(-0.06, 0.0, -0.04), foot + at(0.2, 0.0, -0.06)], [0.05, 0.04], 5, dark);
    });
}
