//! Tests that are there already, which new ones complete: they come from files, and may be of another space.

use crate::GeneratorError;
use paracosm_coverage::{Point, Space};

/// Checks that tests are of the space.
pub(crate) fn check_existing(space: &Space, existing: &[Point]) -> Result<(), GeneratorError> {
    let (dims, levels) = (space.dims(), space.levels());
    let belongs = |test: &Point| {
        test.continuous.len() == dims
            && test.continuous.iter().all(|x| (0.0..=1.0).contains(x))
            && test.discrete.len() == levels.len()
            && test.discrete.iter().zip(&levels).all(|(level, levels)| level < levels)
    };
    let foreign = existing.iter().position(|test| !belongs(test));
    foreign.map_or(Ok(()), |index| Err(GeneratorError::Foreign { index }))
}
