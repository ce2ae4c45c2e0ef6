//! Checks the tests that a strategy proposes: a strategy of a user's own may propose points that are no tests.

use crate::{Error, Reason};
use paracosm_space::{Point, Space};
use thiserror::Error;

/// The error that a strategy proposes a point that is no test of the space.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("strategy {strategy} proposed no test of the space: {flaw}")]
pub struct ForeignPoint {
    /// The name of the strategy.
    pub strategy: String,
    /// The flaw of the point.
    pub flaw: PointFlaw,
}

/// The reason why a point is no test of a space.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointFlaw {
    /// The point has too few or too many coordinates.
    #[error(
        "found {} continuous and {} discrete coordinates, expected {} and {}",
        found[0], found[1], expected[0], expected[1]
    )]
    Coordinates {
        /// The numbers of continuous and discrete coordinates of the point.
        found: [usize; 2],
        /// The numbers of the space.
        expected: [usize; 2],
    },
    /// A continuous coordinate is outside [0, 1].
    #[error("found {found} as continuous coordinate {coordinate}, counted from 1, expected a number from 0 to 1")]
    Number {
        /// The position of the coordinate, from 1.
        coordinate: usize,
        /// The coordinate.
        found: f64,
    },
    /// A discrete coordinate is not the position of a level.
    #[error("found {found} as discrete coordinate {coordinate}, counted from 1, expected a number below {levels}")]
    Level {
        /// The position of the coordinate, from 1.
        coordinate: usize,
        /// The coordinate.
        found: usize,
        /// The number of levels.
        levels: usize,
    },
}

impl Reason for ForeignPoint {}

/// Checks that points are tests of a space.
///
/// # Errors
/// A point has another number of coordinates, or a coordinate is out of range.
pub fn check(space: &Space, strategy: &str, points: &[Point]) -> Result<(), Error> {
    match points.iter().find_map(|point| flaw(space, point)) {
        Some(flaw) => Err(ForeignPoint { strategy: strategy.to_owned(), flaw }.into()),
        None => Ok(()),
    }
}

fn flaw(space: &Space, point: &Point) -> Option<PointFlaw> {
    let expected = [space.dims(), space.levels().len()];
    let found = [point.continuous.len(), point.discrete.len()];
    if found != expected {
        return Some(PointFlaw::Coordinates { found, expected });
    }
    let mut numbers = point.continuous.iter().enumerate();
    let number = numbers.find(|(_, number)| !(0.0..=1.0).contains(*number));
    let mut levels = point.discrete.iter().zip(space.levels()).enumerate();
    let level = levels.find(|(_, (level, levels))| **level >= *levels);
    let number = number.map(|(at, found)| PointFlaw::Number { coordinate: at + 1, found: *found });
    number.or(level.map(|(at, (found, levels))| PointFlaw::Level { coordinate: at + 1, found: *found, levels }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_outside_the_space_are_named_with_their_strategy() {
        let space = Space::unit_cube(2);
        let says = |continuous: Vec<f64>, discrete: Vec<usize>| {
            let point = Point { continuous, discrete };
            check(&space, "halton", &[point]).map_err(|error| error.to_string())
        };
        assert_eq!(says(vec![0.0, 1.0], Vec::new()), Ok(()));
        let begin = "strategy halton proposed no test of the space: found ";
        let errors = [
            (vec![0.5, 7.5], vec![], "7.5 as continuous coordinate 2, counted from 1, expected a number from 0 to 1"),
            (
                vec![f64::NAN, 0.5],
                vec![],
                "NaN as continuous coordinate 1, counted from 1, expected a number from 0 to 1",
            ),
            (vec![0.5], vec![], "1 continuous and 0 discrete coordinates, expected 2 and 0"),
            (vec![0.5, 0.5], vec![3], "2 continuous and 1 discrete coordinates, expected 2 and 0"),
        ];
        for (continuous, discrete, end) in errors {
            assert_eq!(says(continuous, discrete), Err(format!("{begin}{end}")));
        }
    }
}
