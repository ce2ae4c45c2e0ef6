//! A set of points in the unit cube: the input of all measures of the continuous parameters.

use thiserror::Error;

/// A set of points in the unit cube `[0,1]^d`, stored in one allocation.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSet {
    dims: usize,
    coordinates: Vec<f64>,
}

/// The reason why a list of numbers is not a set of points in the unit cube.
#[derive(Debug, Error, PartialEq)]
pub enum PointSetError {
    /// The number of coordinates of a point is 0.
    #[error("points need at least one coordinate, found 0")]
    NoDimension,
    /// The number of coordinates of a point differs from the number of coordinates of the set.
    #[error("point {index} has a wrong number of coordinates: found {found}, expected {expected}")]
    Ragged {
        /// The position of the wrong point among the points, from 0.
        index: usize,
        /// The number of coordinates of the wrong point.
        found: usize,
        /// The expected number of coordinates of each point.
        expected: usize,
    },
    /// A coordinate of a point is not in `[0,1]`, or is NaN.
    #[error("point {index}, coordinate {axis}: found {value}, expected a number in [0, 1]")]
    OutsideCube {
        /// The position of the wrong point among the points, from 0.
        index: usize,
        /// The position of the wrong coordinate in the point, from 0.
        axis: usize,
        /// The value of the wrong coordinate.
        value: f64,
    },
}

impl PointSet {
    /// Makes a set of points that have `dims` coordinates each.
    ///
    /// # Errors
    /// `dims` is 0, a point has another number of coordinates, or a coordinate is not in `[0,1]`.
    pub fn new<P: AsRef<[f64]>>(dims: usize, points: impl IntoIterator<Item = P>) -> Result<Self, PointSetError> {
        if dims == 0 {
            return Err(PointSetError::NoDimension);
        }
        let mut coordinates = Vec::new();
        for (index, point) in points.into_iter().enumerate() {
            let point = point.as_ref();
            if point.len() != dims {
                return Err(PointSetError::Ragged { index, found: point.len(), expected: dims });
            }
            if let Some(axis) = point.iter().position(|x| !(0.0..=1.0).contains(x)) {
                return Err(PointSetError::OutsideCube { index, axis, value: point[axis] });
            }
            coordinates.extend_from_slice(point);
        }
        Ok(Self { dims, coordinates })
    }

    /// Returns the number of coordinates of each point.
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// Returns the number of points in the set.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dims
    }

    /// Returns `true` if the set of points has no point.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// Iterates over the points of the set, in the order in which the set was made.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> + Clone {
        self.coordinates.chunks_exact(self.dims)
    }

    /// Returns the coordinates of the point at position `index`.
    ///
    /// # Panics
    /// `index` is not below [`PointSet::len`].
    pub fn point(&self, index: usize) -> &[f64] {
        &self.coordinates[index * self.dims..][..self.dims]
    }
}
