//! Finds the strips of ground near a point: a grid whose cells know the strips that reach into them.

use super::ground::cuts;
use nalgebra::Vector2;
use paracosm_engine::road::Curve;
use std::collections::BTreeMap;

/// The side of a cell in metres.
const CELL: f64 = 16.0;

/// The indices of strips by the cells of a grid.
#[derive(Debug, Default)]
pub(super) struct Cells {
    all: BTreeMap<[i64; 2], Vec<usize>>,
}

fn cell(point: Vector2<f64>) -> [i64; 2] {
    point.map(|metres| (metres / CELL).floor() as i64).into()
}

impl Cells {
    /// Adds the strip between two parallels of a curve, which lie `right` and `left` metres to the left of the curve.
    pub fn add_strip(&mut self, index: usize, curve: &Curve, right: f64, left: f64) {
        for ends in cuts(curve, right, left).windows(2) {
            let side = |offset: f64| [0, 1].map(|end| curve.beside(ends[end], offset));
            let corners = [side(right), side(left)].concat();
            let low = corners.iter().fold(corners[0], |low, corner| low.inf(corner));
            self.add(index, low, corners.iter().fold(corners[0], |high, corner| high.sup(corner)));
        }
    }

    /// Adds the disc around a point.
    pub fn add_disc(&mut self, index: usize, middle: Vector2<f64>, radius: f64) {
        self.add(index, middle.add_scalar(-radius), middle.add_scalar(radius));
    }

    fn add(&mut self, index: usize, low: Vector2<f64>, high: Vector2<f64>) {
        let (low, high) = (cell(low), cell(high));
        for at in (low[0]..=high[0]).flat_map(|x| (low[1]..=high[1]).map(move |y| [x, y])) {
            let here = self.all.entry(at).or_default();
            if here.last() != Some(&index) {
                here.push(index);
            }
        }
    }

    /// Returns the indices of all strips and discs that may contain a point.
    pub fn at(&self, point: Vector2<f64>) -> impl Iterator<Item = usize> + '_ {
        self.all.get(&cell(point)).into_iter().flatten().copied()
    }
}
