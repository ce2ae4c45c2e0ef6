//! A set of points in the unit cube, the form in which the continuous measures take their tests.

use thiserror::Error;

/// Points of `[0,1]^d`, one after the other in one allocation.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSet {
    dims: usize,
    coordinates: Vec<f64>,
}

/// Why a list of numbers is no set of points in the unit cube.
#[derive(Debug, Error, PartialEq)]
pub enum PointSetError {
    /// There is no dimension to measure in.
    #[error("points need at least one coordinate, found none")]
    NoDimension,
    /// A point with too many or too few coordinates.
    #[error("point {index} has {found} coordinates, expected {expected}")]
    Ragged {
        /// The point's position, from 0.
        index: usize,
        /// How many coordinates it has.
        found: usize,
        /// How many the first point has.
        expected: usize,
    },
    /// A coordinate that is not in `[0,1]`; NaN is not.
    #[error("point {index}, coordinate {axis}: found {value}, expected a number in [0, 1]")]
    OutsideCube {
        /// The point's position, from 0.
        index: usize,
        /// The coordinate's position, from 0.
        axis: usize,
        /// The number found.
        value: f64,
    },
}

impl PointSet {
    /// A set of points with `dims` coordinates each.
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

    /// The number of coordinates of each point.
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dims
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// The points in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> + Clone {
        self.coordinates.chunks_exact(self.dims)
    }

    /// The point at `index`.
    ///
    /// # Panics
    /// `index` is not below [`PointSet::len`].
    pub fn point(&self, index: usize) -> &[f64] {
        &self.coordinates[index * self.dims..][..self.dims]
    }
}
