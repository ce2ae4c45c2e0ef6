//! A bicycle, with or without its rider.

use super::clay::{Clay, Matter, Point, at, oval};
use super::colours::{BLACK, HAIR, RUBBER, SKIN, STEEL, TROUSERS};
use super::{Mesh, Semantic, SurfaceKind};

/// Length, width and height of the model in metres, equal to the size of
/// [`Body::bicycle`](paracosm_engine::object::Body::bicycle).
pub(crate) const SIZE: [f32; 3] = [1.89, 0.5, 1.865];

/// The size of a parked bicycle: that of [`Body::parked_bicycle`](paracosm_engine::object::Body::parked_bicycle).
pub(crate) const PARKED: [f32; 3] = [1.89, 0.5, 1.2];

const WHEEL: f32 = 0.34;
const FRONT: [f32; 3] = [0.56, 0.0, WHEEL];
const REAR: [f32; 3] = [-0.56, 0.0, WHEEL];

pub(crate) fn bicycle() -> Mesh {
    let mut clay = Clay::default();
    frame(&mut clay);
    rider(&mut clay);
    clay.fitted(SIZE).mesh()
}

/// A bicycle that nobody rides.
pub(crate) fn parked() -> Mesh {
    let mut clay = Clay::default();
    frame(&mut clay);
    clay.fitted(PARKED).mesh()
}

fn frame(clay: &mut Clay) {
    let matter = |surface, colour| Matter::new(surface, colour, Semantic::Bicycle);
    let paint = Matter::painted(SurfaceKind::Paint, Semantic::Bicycle);
    let (dark, steel) = (matter(SurfaceKind::Plain, BLACK), matter(SurfaceKind::Plain, STEEL));
    for centre in [FRONT, REAR] {
        let centre = Point::from(centre);
        clay.tyre(centre, [WHEEL - 0.045, WHEEL], 0.045, 12, matter(SurfaceKind::Plain, RUBBER));
        // Two crossed spokes are enough to show that it is a wheel.
        for spoke in [at(0.3, 0.0, 0.0), at(0.0, 0.0, 0.3)] {
            clay.tube([centre - spoke, centre + spoke], [0.006; 2], 4, steel);
        }
    }
    let (pedals, seat, head) = (at(-0.08, 0.0, 0.30), at(-0.24, 0.0, 0.86), at(0.40, 0.0, 0.82));
    for (from, to) in [(pedals, seat), (pedals, head), (seat, head), (pedals, REAR.into()), (seat, REAR.into())] {
        clay.tube([from, to], [0.022; 2], 4, paint);
    }
    clay.tube([FRONT.into(), head], [0.02; 2], 4, paint);
    clay.tube([head, at(0.36, 0.0, 1.0)], [0.018; 2], 4, steel);
    clay.tube([at(0.34, -0.3, 1.0), at(0.34, 0.3, 1.0)], [0.018; 2], 4, dark);
    clay.cuboid([-0.38, -0.07, 0.90], [-0.12, 0.07, 0.96], dark);
    clay.tube([pedals - Point::y() * 0.12, pedals + Point::y() * 0.12], [0.05; 2], 6, steel);
    clay.cuboid([0.36, -0.03, 0.86], [0.42, 0.03, 0.92], matter(SurfaceKind::WhiteLamp, super::colours::LAMP));
    clay.cuboid([-0.62, -0.03, 0.72], [-0.58, 0.03, 0.78], matter(SurfaceKind::RedLamp, super::colours::RED));
}

fn rider(clay: &mut Clay) {
    let matter = |colour| Matter::new(SurfaceKind::Plain, colour, Semantic::Rider);
    let (skin, trousers, shoes) = (matter(SKIN), matter(TROUSERS), matter(BLACK));
    let jacket = Matter::painted(SurfaceKind::Cloth, Semantic::Rider);
    // The back leans forward, as a stack of ovals.
    let back = [
        (-0.26, 0.92, 0.12, 0.16),
        (-0.16, 1.1, 0.12, 0.16),
        (0.0, 1.3, 0.13, 0.19),
        (0.1, 1.43, 0.1, 0.2),
        (0.14, 1.49, 0.05, 0.07),
    ];
    clay.loft(&back.map(|(x, z, deep, wide)| oval(at(x, 0.0, z), deep, wide, 8)), jacket);
    clay.ball(at(0.2, 0.0, 1.61), [0.1, 0.08, 0.125], 8, skin);
    clay.ball(at(0.18, 0.0, 1.66), [0.115, 0.095, 0.09], 8, matter(HAIR));
    clay.mirrored(|clay| {
        let (shoulder, elbow, hand) = (at(0.09, 0.19, 1.41), at(0.2, 0.25, 1.19), at(0.34, 0.25, 1.03));
        clay.tube([shoulder, elbow], [0.058, 0.045], 6, jacket);
        clay.tube([elbow, hand], [0.045, 0.035], 6, jacket);
        clay.ball(hand, [0.05, 0.035, 0.04], 4, skin);
    });
    // One pedal is up, the other is down.
    for (hip, knee, ankle) in [
        (at(-0.2, 0.09, 0.96), at(0.2, 0.11, 0.88), at(-0.02, 0.11, 0.52)),
        (at(-0.2, -0.09, 0.96), at(0.08, -0.11, 0.62), at(-0.16, -0.11, 0.22)),
    ] {
        clay.tube([hip, knee], [0.085, 0.06], 6, trousers);
        clay.tube([knee, ankle], [0.06, 0.04], 6, trousers);
        let toe = ankle + at(0.2, 0.0, -0.06);
        clay.tube([ankle + at(-0.04, 0.0, -0.05), toe], [0.045, 0.03], 5, shoes);
    }
}
