//! Objects beside the road: signs, lamp posts, cones, barriers, boxes.

use super::clay::{Clay, Matter, Point, at, oval, ring};
use super::colours::{BLACK, GREY, LAMP, ORANGE, RED, STEEL, WHITE};
use super::plant::EDGE;
use super::{Mesh, Semantic, SurfaceKind};

/// The kinds of signs, which differ in shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Plate {
    /// The red ring of a speed limit sign.
    Limit,
    /// The red triangle of a "give way" sign.
    GiveWay,
    /// The red octagon of a "stop" sign.
    Stop,
    /// The blue square of an information sign.
    Hint,
}

/// Half of a plate's size in metres.
pub(crate) const PLATE: f32 = 0.32;

fn of(semantic: Semantic) -> impl Fn([f32; 3]) -> Matter {
    move |colour| Matter::new(SurfaceKind::Plain, colour, semantic)
}

/// A pole of radius 1 and height 1.
pub(crate) fn pole() -> Mesh {
    let mut clay = Clay::default();
    clay.loft(&[0.0, 1.0].map(|z| oval(at(0.0, 0.0, z), 1.0, 1.0, 8)), of(Semantic::Pole)(STEEL));
    let mut far = Clay::default();
    far.hose(&[0.0, 1.0].map(|z| oval(at(0.0, 0.0, z), 1.1, 1.1, 4)), of(Semantic::Pole)(STEEL));
    clay.mesh().with_coarse(far.mesh(), EDGE)
}

/// Makes a plate around the origin that faces along x. The parts that are neither rim nor symbol have the colour of the
/// instance.
pub(crate) fn plate(plate: Plate) -> Mesh {
    let of = of(Semantic::TrafficSign);
    let painted = Matter::painted(SurfaceKind::Cloth, Semantic::TrafficSign);
    let mut clay = Clay::default();
    let shape = |x: f32, size: f32| match plate {
        Plate::Limit => ring(at(x, 0.0, 0.0), Point::x(), size, 14),
        Plate::GiveWay => {
            ring(at(x, 0.0, 0.0), Point::x(), size, 3).iter().map(|corner| at(x, -corner.y, -corner.z)).collect()
        }
        Plate::Stop => turned(x, size, 8),
        Plate::Hint => turned(x, size * 1.2, 4),
    };
    let rim = match plate {
        Plate::Limit | Plate::GiveWay | Plate::Stop => RED,
        Plate::Hint => [0.01, 0.08, 0.40],
    };
    clay.loft(&[shape(-0.012, PLATE), shape(0.004, PLATE)], of(GREY));
    clay.facet(&shape(0.010, PLATE), of(rim));
    if matches!(plate, Plate::Limit | Plate::GiveWay) {
        clay.facet(&shape(0.018, 0.68 * PLATE), painted);
    }
    let bar = |clay: &mut Clay, y: [f32; 2], z: [f32; 2], colour| {
        let x = 0.026;
        clay.facet(&[at(x, y[0], z[0]), at(x, y[1], z[0]), at(x, y[1], z[1]), at(x, y[0], z[1])], of(colour));
    };
    match plate {
        // Two digits, from afar.
        Plate::Limit => [[-0.11, -0.03], [0.03, 0.11]].into_iter().for_each(|y| bar(&mut clay, y, [-0.1, 0.1], BLACK)),
        Plate::GiveWay => {}
        Plate::Stop => bar(&mut clay, [-0.21, 0.21], [-0.06, 0.06], WHITE),
        Plate::Hint => {
            bar(&mut clay, [-0.035, 0.035], [-0.18, 0.02], WHITE);
            clay.facet(&[at(0.026, -0.12, 0.02), at(0.026, 0.12, 0.02), at(0.026, 0.0, 0.19)], of(WHITE));
        }
    }
    clay.mesh()
}

/// Returns a regular polygon that stands on one of its sides.
fn turned(x: f32, size: f32, sides: usize) -> Vec<Point> {
    let corners = ring(at(x, 0.0, 0.0), Point::x(), size, 2 * sides);
    corners.into_iter().skip(1).step_by(2).collect()
}

/// The height at which a lantern is modelled, in metres. By this height a renderer knows that the lantern lights up the
/// street.
pub(crate) const LANTERN: f32 = 6.0;
/// The thickness of the parts of a lantern that are missing from afar, in metres.
const RIM: f32 = 0.06;

/// Makes the top of a lamp post: an arm over the road, and the lamp.
pub(crate) fn lantern() -> Mesh {
    let mut clay = Clay::default();
    let (of, top) = (of(Semantic::Pole), LANTERN);
    clay.tube([at(0.0, 0.0, top - 0.05), at(1.3, 0.0, top - 0.06)], [0.05, 0.04], 6, of(STEEL));
    clay.cuboid([1.05, -0.14, top - 0.1], [1.75, 0.14, top], of(GREY));
    let lamp = Matter::new(SurfaceKind::WhiteLamp, LAMP, Semantic::Pole);
    clay.cuboid([1.1, -0.11, top - 0.15], [1.7, 0.11, top - 0.09], lamp);
    let mut far = Clay::default();
    far.hose(&[0.0, 1.3].map(|x| ring(at(x, 0.0, top - 0.05), Point::x(), 0.05, 3)), of(STEEL));
    far.cuboid([1.05, -0.14, top - 0.1], [1.75, 0.14, top], of(GREY));
    let below = [[1.1, -0.11], [1.1, 0.11], [1.7, 0.11], [1.7, -0.11]].map(|[x, y]| at(x, y, top - 0.12));
    far.facet(&below, lamp);
    clay.mesh().with_coarse(far.mesh(), RIM)
}

/// A traffic cone in a box of 1 m each way.
pub(crate) fn cone() -> Mesh {
    let mut clay = Clay::default();
    let of = of(Semantic::Dynamic);
    let painted = Matter::painted(SurfaceKind::Cloth, Semantic::Dynamic);
    clay.cuboid([-0.5, -0.5, 0.0], [0.5, 0.5, 0.05], of(BLACK));
    let layer = |z: f32| oval(at(0.0, 0.0, z), 0.40 - 0.32 * z, 0.40 - 0.32 * z, 8);
    for (from, to, matter) in [
        (0.05, 0.30, painted),
        (0.30, 0.48, of(WHITE)),
        (0.48, 0.66, painted),
        (0.66, 0.80, of(WHITE)),
        (0.80, 1.0, painted),
    ] {
        clay.hose(&[layer(from), layer(to)], matter);
    }
    clay.facet(&layer(1.0), painted);
    clay.fitted([1.0; 3]).mesh()
}

/// A barrel in a box of 1 m each way.
pub(crate) fn barrel() -> Mesh {
    let mut clay = Clay::default();
    let painted = Matter::painted(SurfaceKind::Cloth, Semantic::Dynamic);
    let layers = [(0.0, 0.47), (0.06, 0.5), (0.94, 0.5), (1.0, 0.47)];
    clay.loft(&layers.map(|(z, radius)| oval(at(0.0, 0.0, z), radius, radius, 12)), painted);
    for z in [0.3, 0.66] {
        let layer = |z| oval(at(0.0, 0.0, z), 0.51, 0.51, 12);
        clay.hose(&[layer(z), layer(z + 0.1)], of(Semantic::Dynamic)(WHITE));
    }
    clay.fitted([1.0; 3]).mesh()
}

/// A ball in a box of 1 m each way.
pub(crate) fn ball() -> Mesh {
    let mut clay = Clay::default();
    clay.ball(at(0.0, 0.0, 0.5), [0.5; 3], 12, Matter::painted(SurfaceKind::Cloth, Semantic::Dynamic));
    clay.fitted([1.0; 3]).mesh()
}

/// A box of 1 m each way, with tape over it.
pub(crate) fn parcel() -> Mesh {
    let mut clay = Clay::default();
    clay.cuboid([-0.5, -0.5, 0.0], [0.5, 0.5, 1.0], Matter::painted(SurfaceKind::Cloth, Semantic::Dynamic));
    let tape = of(Semantic::Dynamic)(TAPE);
    clay.cuboid([-0.505, -0.06, -0.0], [0.505, 0.06, 1.004], tape);
    clay.fitted([1.0; 3]).mesh()
}

const TAPE: [f32; 3] = [0.45, 0.33, 0.18];

/// A barrier across a road in a box of 1 m each way, long along y: two boards in stripes on feet.
pub(crate) fn barrier() -> Mesh {
    let mut clay = Clay::default();
    let of = of(Semantic::Dynamic);
    for y in [-0.36, 0.36] {
        clay.cuboid([-0.5, y - 0.03, 0.0], [0.5, y + 0.03, 0.06], of(BLACK));
        clay.cuboid([-0.1, y - 0.02, 0.06], [0.1, y + 0.02, 0.98], of(GREY));
    }
    for z in [0.40, 0.72] {
        for stripe in 0..8 {
            let (from, colour) = (-0.5 + 0.125 * stripe as f32, if stripe % 2 == 0 { ORANGE } else { WHITE });
            clay.cuboid([-0.2, from, z], [0.2, from + 0.125, z + 0.26], of(colour));
        }
    }
    clay.fitted([1.0; 3]).mesh()
}
