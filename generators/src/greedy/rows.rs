//! Greedy points for every discrete row: each row's points are as low in dispersion as if the row were alone.

use super::Greedy;
use crate::seeded::{Purpose, seeded};
use crate::sequence::RowSet;
use crate::strategy::MakeBoxes;
use std::collections::HashMap;
use std::sync::Mutex;

/// The greedy points of every discrete row. A point is computed at its first request, and then remembered.
pub(crate) struct GreedyRows {
    make: MakeBoxes,
    dims: usize,
    seed: u64,
    existing: HashMap<u64, Vec<Vec<f64>>>,
    rows: Mutex<HashMap<u64, Row>>,
}

/// The points of a row so far, and the method that finds the next point.
struct Row {
    greedy: Greedy,
    points: Vec<Vec<f64>>,
}

impl GreedyRows {
    /// Makes the greedy points of all rows, without computing a point. `make` makes the kind of holes that count.
    /// `existing` holds the existing points of each row, by the row's number.
    pub(crate) fn new(make: MakeBoxes, dims: usize, seed: u64, existing: HashMap<u64, Vec<Vec<f64>>>) -> Self {
        Self { make, dims, seed, existing, rows: Mutex::default() }
    }
}

impl RowSet for GreedyRows {
    fn point(&self, row: u64, _size: u64, index: u64) -> Vec<f64> {
        let mut rows = self.rows.lock().expect("nobody panics while holding it");
        let Row { greedy, points } = rows.entry(row).or_insert_with(|| {
            let rng = seeded(self.seed, Purpose::Greedy, row);
            let existing = self.existing.get(&row).into_iter().flatten();
            Row {
                greedy: Greedy::new(self.make, self.dims, rng, existing).expect("points of the cube"),
                points: Vec::new(),
            }
        });
        while points.len() as u64 <= index {
            points.push(greedy.next());
        }
        points[index as usize].clone()
    }
}
