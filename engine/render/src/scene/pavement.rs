//! Computes the height of the ground, so that people step up to a sidewalk.

use super::cells::Cells;
use super::ground::KERB;
use nalgebra::Vector2;
use paracosm_engine::road::{RoadNetwork, Strip, Surface};

/// The distance from the edge of a sidewalk over which a person steps up, in metres.
const STEP: f64 = 0.3;

/// The sidewalks of a network.
#[derive(Debug)]
pub(super) struct Pavement {
    strips: Vec<Strip>,
    cells: Cells,
}

impl Pavement {
    pub fn of(network: &RoadNetwork) -> Self {
        let mut strips = network.strips();
        strips.retain(|strip| strip.surface == Surface::Sidewalk);
        let mut cells = Cells::default();
        for (index, strip) in strips.iter().enumerate() {
            cells.add_strip(index, &strip.curve, strip.right, strip.left);
        }
        Self { strips, cells }
    }

    /// Returns the height of the ground at a point, in metres above the road. It rises from the edges of a sidewalk to
    /// its top.
    pub fn height(&self, point: Vector2<f64>) -> f64 {
        let inside = self.cells.at(point).map(|index| inside(&self.strips[index], point)).fold(0.0, f64::max);
        let share = (inside / STEP).min(1.0);
        KERB * share * share * (3.0 - 2.0 * share)
    }
}

/// Returns the distance in metres from a point within a strip to the nearest side; not positive outside the strip.
fn inside(strip: &Strip, point: Vector2<f64>) -> f64 {
    let near = strip.curve.at(strip.curve.nearest(point)).to_local(point);
    // Beyond an end of the curve, the nearest point on the curve does not lie beside `point`.
    let beside = near.x.abs() < 1e-6 * (1.0 + near.y.abs());
    if beside { (near.y - strip.right).min(strip.left - near.y) } else { 0.0 }
}
