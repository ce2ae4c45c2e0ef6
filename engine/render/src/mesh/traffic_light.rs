//! A traffic light: a post with a box of three lamps, of which one is lit.

use super::clay::{Clay, Matter, Point, at, ring};
use super::colours::{BLACK, STEEL};
use super::{Mesh, Semantic, SurfaceKind};

/// The lamp of a traffic light that is lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aspect {
    Red,
    Amber,
    Green,
}

impl Aspect {
    /// All aspects, from the upper lamp to the lower lamp.
    pub const ALL: [Self; 3] = [Self::Red, Self::Amber, Self::Green];

    /// Returns the colours of the lamp, lit and dark, in linear light.
    fn colours(self) -> [[f32; 3]; 2] {
        match self {
            Self::Red => [[1.0, 0.05, 0.03], [0.10, 0.012, 0.010]],
            Self::Amber => [[1.0, 0.42, 0.02], [0.12, 0.060, 0.008]],
            Self::Green => [[0.05, 0.85, 0.42], [0.008, 0.070, 0.035]],
        }
    }
}

/// The height of the lower edge of the box, the size of the box, and the radius of a lamp in metres (EN 12368: lamps of
/// 200 mm).
const LOW: f32 = 2.4;
const BOX: [f32; 3] = [0.22, 0.30, 0.90];
const LAMP: f32 = 0.10;

/// Makes a traffic light that faces along x.
pub(crate) fn traffic_light(lit: Aspect) -> Mesh {
    let dark = Matter::new(SurfaceKind::Plain, BLACK, Semantic::TrafficLight);
    let mut clay = Clay::default();
    clay.tube([at(0.0, 0.0, 0.0), at(0.0, 0.0, LOW + 0.5)], [0.06, 0.05], 8, {
        Matter::new(SurfaceKind::Plain, STEEL, Semantic::Pole)
    });
    let [deep, wide, high] = BOX;
    let front = 0.08 + deep;
    clay.cuboid([0.08, -0.5 * wide, LOW], [front, 0.5 * wide, LOW + high], dark);
    // A board behind the box makes the lamps stand out.
    clay.cuboid([0.05, -0.26, LOW - 0.08], [0.08, 0.26, LOW + high + 0.08], dark);
    for (place, aspect) in Aspect::ALL.into_iter().enumerate() {
        let middle = at(front + 0.004, 0.0, LOW + high - 0.15 - 0.30 * place as f32);
        let [bright, dull] = aspect.colours();
        let (surface, colour) = if aspect == lit { (SurfaceKind::Glow, bright) } else { (SurfaceKind::Plain, dull) };
        let lamp = Matter::new(surface, colour, Semantic::TrafficLight);
        clay.facet(&ring(middle, Point::x(), LAMP, 10), lamp);
        hood(&mut clay, middle, dark);
    }
    clay.mesh()
}

/// Adds a hood over a lamp, seen from both sides.
fn hood(clay: &mut Clay, middle: Point, of: Matter) {
    let (radius, deep) = (LAMP + 0.02, Point::x() * 0.16);
    let arc: Vec<Point> = [-100.0_f32, -60.0, -20.0, 20.0, 60.0, 100.0]
        .into_iter()
        .map(|degrees| {
            let (sin, cos) = libm::sincosf(degrees.to_radians());
            middle + at(0.0, radius * sin, radius * cos)
        })
        .collect();
    for pair in arc.windows(2) {
        let corners = [pair[0], pair[0] + deep, pair[1] + deep, pair[1]];
        clay.facet(&corners, of);
        clay.facet(&corners.into_iter().rev().collect::<Vec<_>>(), of);
    }
}
