//! A table of least dispersions with their proofs, as a file that another program can check.

#[cfg(doc)]
use super::PRECISION;
use super::{Least, is_proved};
use crate::dispersion::dispersion;
use crate::{Deadline, PointSet};
use serde::{Deserialize, Serialize};

/// The least dispersions of 1, 2, 3 .. points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// The word `least-dispersion`, by which a reader knows the file.
    pub measure: String,
    /// The version of the format, 1.
    pub format: u32,
    /// The number of dimensions.
    pub dims: usize,
    /// The rows, for 1 point and more. A proof builds on the levels of the rows before.
    pub rows: Vec<Row>,
}

/// The least dispersion of a number of points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The best points.
    pub points: Vec<Vec<f64>>,
    /// The dispersion of the points.
    pub dispersion: f64,
    /// No points have a dispersion below this level.
    pub level: f64,
    /// The steps of the proof; empty if the level is the gap that the points leave along an axis.
    pub steps: String,
}

impl Row {
    /// Returns true if the level is the least dispersion, except for a share of [`PRECISION`].
    pub fn is_proved(&self) -> bool {
        is_proved(self.level, self.dispersion)
    }
}

impl Table {
    /// Makes a table without rows.
    pub fn new(dims: usize) -> Self {
        Self { measure: "least-dispersion".to_owned(), format: 1, dims, rows: Vec::new() }
    }

    /// Returns a level for each number of points from 0 up to the last row.
    pub fn levels(&self) -> Vec<f64> {
        [1.0].into_iter().chain(self.rows.iter().map(|row| row.level)).collect()
    }

    /// Returns the points of the last row with a point in the middle of their largest empty box, which are no worse; `None` if there are no rows.
    pub fn next_points(&self) -> Option<PointSet> {
        let mut points = self.rows.last()?.points.clone();
        let set = PointSet::new(self.dims, &points).ok()?;
        let hole = dispersion(&set, Deadline::never()).witness;
        points.push(hole.lower.iter().zip(&hole.upper).map(|(low, high)| f64::midpoint(*low, *high)).collect());
        PointSet::new(self.dims, points).ok()
    }

    /// Adds the next row.
    pub fn add(&mut self, least: &Least) {
        self.rows.push(Row {
            points: least.points.iter().map(<[f64]>::to_vec).collect(),
            dispersion: least.dispersion,
            level: least.level,
            steps: least.steps.iter().map(ToString::to_string).collect(),
        });
    }
}
