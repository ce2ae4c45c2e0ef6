//! The best sets of points that are known to us, which this crate ships. `paracosm-cover optimise` and `least` have found them.

use crate::{Measure, PointSet};

/// A set of points with a small measure.
#[derive(Debug)]
pub struct Record {
    /// The measure that is small.
    pub measure: Measure,
    /// The number of dimensions.
    pub dims: usize,
    /// The number of points.
    pub points: usize,
    csv: &'static str,
}

/// Lists the files of a measure, with the numbers of dimensions and of points.
macro_rules! records {
    ($($measure:ident $name:literal: $($dims:literal $points:literal),+;)+) => {
        &[$($(Record {
            measure: Measure::$measure,
            dims: $dims,
            points: $points,
            csv: include_str!(concat!("../data/", $name, "-", $dims, "d-", $points, ".csv")),
        }),+),+]
    };
}

/// All sets that are shipped.
pub const RECORDS: &[Record] = records! {
    DISPERSION "least": 2 2, 2 3, 2 4, 2 5, 2 6, 2 7, 2 8, 3 2, 3 3, 3 4, 3 5, 4 2, 4 3, 4 4;
    DISPERSION "dispersion": 2 20, 2 50, 2 100, 2 200, 3 20, 3 50, 3 100, 3 200, 4 50, 5 50, 5 100;
    STAR "star": 2 10, 2 16, 2 20, 2 30, 2 60, 2 100, 2 500, 2 1020, 3 30, 3 60, 3 120, 3 240, 4 30, 4 60, 4 120, 4 240, 5 30, 5 60, 6 30;
};

/// Returns the shipped set with a small measure that has this size; `None` if there is none.
pub fn record(measure: Measure, dims: usize, points: usize) -> Option<PointSet> {
    let is_asked = |record: &&Record| (record.measure, record.dims, record.points) == (measure, dims, points);
    RECORDS.iter().find(is_asked).map(Record::set)
}

/// Returns the largest shipped set with a small measure that has fewer points; `None` if there is none.
pub fn largest_record_below(measure: Measure, dims: usize, points: usize) -> Option<PointSet> {
    let is_smaller = |record: &&Record| (record.measure, record.dims) == (measure, dims) && record.points < points;
    RECORDS.iter().filter(is_smaller).max_by_key(|record| record.points).map(Record::set)
}

impl Record {
    /// Returns the points.
    pub fn set(&self) -> PointSet {
        let number = |text: &str| -> f64 { text.parse().expect("a shipped file has numbers") };
        let rows = self.csv.lines().skip(1).map(|line| line.split(',').map(number).collect::<Vec<f64>>());
        PointSet::new(self.dims, rows).expect("shipped points are in the cube")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_shipped_set_has_its_size() {
        for found in RECORDS {
            let set = record(found.measure, found.dims, found.points).unwrap();
            assert_eq!((set.len(), set.dims()), (found.points, found.dims));
        }
        assert_eq!(record(Measure::DISPERSION, 2, 99), None);
        assert_eq!(largest_record_below(Measure::DISPERSION, 2, 99).unwrap().len(), 50);
    }
}
