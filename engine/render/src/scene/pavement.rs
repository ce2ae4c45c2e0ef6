//! Computes the height of the ground, so that people step up to a sidewalk.

use super::ground::{KERB, cuts};
use nalgebra::Vector2;
use paracosm_engine::road::{RoadNetwork, Strip, Surface};
use std::collections::BTreeMap;

/// The side of a cell in metres.
const CELL: f64 = 16.0;
/// The distance from the edge of a sidewalk over which a person steps up, in metres.
const STEP: f64 = 0.3;

/// The sidewalks of a network, sorted by the cells of a grid that they lie in.
#[derive(Debug)]
pub(super) struct Pavement {
    strips: Vec<Strip>,
    cells: BTreeMap<[i64; 2], Vec<usize>>,
}

fn cell(point: Vector2<f64>) -> [i64; 2] {
    point.map(|metres| (metres / CELL).floor() as i64).into()
}

impl Pavement {
    pub fn of(network: &RoadNetwork) -> Self {
        let mut strips = network.strips();
        strips.retain(|strip| strip.surface == Surface::Sidewalk);
        let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
        for (index, strip) in strips.iter().enumerate() {
            for ends in cuts(&strip.curve, strip.right, strip.left).windows(2) {
                let side = |offset: f64| [0, 1].map(|end| strip.curve.beside(ends[end], offset));
                let corners = [side(strip.right), side(strip.left)].concat();
                let low = cell(corners.iter().fold(corners[0], |low, corner| low.inf(corner)));
                let high = cell(corners.iter().fold(corners[0], |high, corner| high.sup(corner)));
                for (x, y) in (low[0]..=high[0]).flat_map(|x| (low[1]..=high[1]).map(move |y| (x, y))) {
                    let here = cells.entry([x, y]).or_default();
                    if here.last() != Some(&index) {
                        here.push(index);
                    }
                }
            }
        }
        Self { strips, cells }
    }

    /// Returns the height of the ground at a point, in metres above the road. It rises from the edges of a sidewalk to
    /// its top.
    pub fn height(&self, point: Vector2<f64>) -> f64 {
        let here = self.cells.get(&cell(point)).into_iter().flatten();
        let inside = here.map(|index| inside(&self.strips[*index], point)).fold(0.0, f64::max);
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
