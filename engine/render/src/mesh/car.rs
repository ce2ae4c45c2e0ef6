//! A passenger car: a body with wheel arches under a cabin of glass.

use super::clay::{Clay, Matter, Point, at, patch, ring};
use super::colours::{BLACK, GLASS, LAMP, RED, RUBBER, STEEL, WHITE};
use super::{Mesh, Semantic, SurfaceKind};

/// Length, width and height of the model in metres: those of [`Body::car`](paracosm_engine::object::Body::car).
pub(crate) const SIZE: [f32; 3] = [4.5, 1.8, 1.45];

/// The positions of the axles along x.
const AXLES: [f32; 2] = [-1.36, 1.40];
const WHEEL: f32 = 0.32;
/// The cutouts of the sides for the wheels: metres ahead of the axle, and the height of the cutout there.
const ARCH: [(f32, f32); 7] =
    [(-0.40, 0.20), (-0.37, 0.45), (-0.21, 0.64), (0.0, 0.70), (0.21, 0.64), (0.37, 0.45), (0.40, 0.20)];

/// A cross-section of the body at one place along it.
struct Station {
    x: f32,
    /// Half of the width of the car's body.
    half: f32,
    /// The heights above the ground of the lower edge, the shoulder and the middle of the car's body.
    low: f32,
    shoulder: f32,
    top: f32,
}

fn matter(surface: SurfaceKind, colour: [f32; 3]) -> Matter {
    Matter::new(surface, colour, Semantic::Car)
}

fn paint() -> Matter {
    Matter::painted(SurfaceKind::Paint, Semantic::Car)
}

pub(crate) fn car() -> Mesh {
    let mut clay = Clay::default();
    body(&mut clay);
    cabin(&mut clay);
    clay.mirrored(|clay| {
        AXLES.into_iter().for_each(|x| wheel(clay, x));
        lamps(clay);
        let mirror = [at(0.78, 0.74, 0.94), at(0.92, 0.9, 1.06)];
        clay.cuboid(mirror[0].into(), mirror[1].into(), paint());
    });
    clay.fitted(SIZE).mesh()
}

fn stations() -> Vec<Station> {
    let plain = |x, half, low, shoulder, top| Station { x, half, low, shoulder, top };
    let arch = |axle: f32| {
        ARCH.into_iter().map(move |(x, low)| {
            let x = axle + x;
            // The bonnet falls to the front, the boot is level.
            let fall = (x - 0.9).max(0.0);
            plain(x, 0.9, low, 0.93 - 0.12 * fall, 0.99 - 0.13 * fall)
        })
    };
    let mut stations = vec![plain(-2.25, 0.74, 0.36, 0.80, 0.84), plain(-2.14, 0.85, 0.24, 0.92, 0.98)];
    stations.extend(arch(AXLES[0]));
    stations.extend(arch(AXLES[1]));
    stations.extend([plain(2.10, 0.84, 0.22, 0.72, 0.77), plain(2.25, 0.70, 0.32, 0.60, 0.64)]);
    stations
}

/// Returns half of a cross-section, from its lower edge to its middle.
fn section(station: &Station) -> [Point; 4] {
    let Station { x, half, low, shoulder, top } = *station;
    let waist = (shoulder - 0.14).max(low + 0.02);
    [at(x, half - 0.03, low), at(x, half, waist), at(x, half - 0.09, shoulder), at(x, 0.0, top)]
}

fn body(clay: &mut Clay) {
    let sections: Vec<[Point; 4]> = stations().iter().map(section).collect();
    clay.mirrored(|clay| {
        for pair in sections.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            for i in 0..3 {
                clay.facet(&[a[i], a[i + 1], b[i + 1], b[i]], paint());
            }
        }
        let end = |section: &[Point; 4]| {
            let mut end = vec![at(section[0].x, 0.0, section[0].z)];
            end.extend(section);
            end
        };
        clay.facet(&end(&sections[sections.len() - 1]), paint());
        clay.facet(&end(&sections[0]).into_iter().rev().collect::<Vec<_>>(), paint());
    });
    let dark = matter(SurfaceKind::Plain, BLACK);
    clay.cuboid([-2.16, -0.68, 0.19], [2.12, 0.68, 0.68], dark);
    // Bumper and grille, and a number plate at either end.
    clay.cuboid([2.1, -0.5, 0.36], [2.262, 0.5, 0.50], dark);
    clay.cuboid([-2.262, -0.62, 0.36], [-2.1, 0.62, 0.46], dark);
    let plate = matter(SurfaceKind::Plain, WHITE);
    clay.facet(&[at(2.27, -0.26, 0.38), at(2.27, 0.26, 0.38), at(2.27, 0.26, 0.49), at(2.27, -0.26, 0.49)], plate);
    clay.facet(&[at(-2.27, 0.26, 0.56), at(-2.27, -0.26, 0.56), at(-2.27, -0.26, 0.67), at(-2.27, 0.26, 0.67)], plate);
}

fn cabin(clay: &mut Clay) {
    let [front, rear] = [at(1.0, 0.76, 0.90), at(-1.80, 0.74, 0.93)];
    let [high, back] = [at(0.24, 0.60, 1.40), at(-1.16, 0.57, 1.39)];
    // The roof bends inwards over the windows.
    let inner = [at(0.10, 0.42, 1.45), at(-1.02, 0.40, 1.45)];
    let across = |point: Point| at(point.x, -point.y, point.z);
    let glass = matter(SurfaceKind::Glass, GLASS);
    let windscreen = [across(front), front, high, across(high)];
    let window = [rear, across(rear), across(back), back];
    for (facet, u, v) in [(windscreen, [0.05, 0.95], [0.10, 0.95]), (window, [0.08, 0.92], [0.12, 0.92])] {
        clay.facet(&facet, paint());
        clay.facet(&patch(facet, u, v, 0.012), glass);
    }
    clay.mirrored(|clay| {
        let side = [front, rear, back, high];
        clay.facet(&side, paint());
        for u in [[0.07, 0.46], [0.50, 0.84]] {
            clay.facet(&patch(side, u, [0.10, 0.90], 0.012), glass);
        }
        clay.facet(&[high, back, inner[1], inner[0]], paint());
    });
    let [a, b] = inner;
    clay.facet(&[across(high), high, a, across(a)], paint());
    clay.facet(&[a, b, across(b), across(a)], paint());
    clay.facet(&[back, across(back), across(b), b], paint());
}

fn wheel(clay: &mut Clay, x: f32) {
    let [inner, outer] = [at(x, 0.66, WHEEL), at(x, 0.885, WHEEL)];
    clay.tube([inner, outer], [WHEEL; 2], 12, matter(SurfaceKind::Plain, RUBBER));
    clay.facet(&ring(outer + Point::y() * 0.008, Point::y(), 0.2, 8), matter(SurfaceKind::Plain, STEEL));
}

fn lamps(clay: &mut Clay) {
    clay.cuboid([1.98, 0.46, 0.52], [2.245, 0.79, 0.64], matter(SurfaceKind::WhiteLamp, LAMP));
    clay.cuboid([-2.235, 0.48, 0.68], [-2.02, 0.815, 0.82], matter(SurfaceKind::RedLamp, RED));
}
