//! Projections: what a choice of parameters shows of a set of tests.

use crate::PointSet;
use paracosm_space::Point;

/// A choice of parameters with a value for each chosen discrete parameter. A projection selects the tests with the
/// chosen values, and shows these tests along the chosen continuous parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Projection {
    /// The chosen discrete parameters with their values, as positions among the discrete parameters and levels.
    pub fixed: Vec<(usize, usize)>,
    /// The chosen continuous parameters, as positions among the continuous parameters.
    pub axes: Vec<usize>,
}

impl Projection {
    /// Returns `true` if a test has the discrete values of the projection.
    ///
    /// # Panics
    /// The test has too few discrete coordinates.
    pub fn selects(&self, test: &Point) -> bool {
        self.fixed.iter().all(|&(parameter, level)| test.discrete[parameter] == level)
    }

    /// Returns the coordinates of a test along the continuous parameters of the projection.
    ///
    /// # Panics
    /// The test has too few continuous coordinates.
    pub fn of(&self, test: &Point) -> Vec<f64> {
        self.axes.iter().map(|&axis| test.continuous[axis]).collect()
    }

    /// Returns the coordinates of tests along the axes of the projection, as a set of points. The projection must have
    /// an axis.
    pub(crate) fn points<'a>(&self, tests: impl Iterator<Item = &'a Point>) -> PointSet {
        PointSet::new(self.axes.len(), tests.map(|test| self.of(test))).expect("the tests are of the unit cube")
    }
}
