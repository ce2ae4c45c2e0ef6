//! How well the tests so far cover their space, while a campaign runs: what its progress line says.
//!
//! The numbers are those of [`Tests::measure`](crate::Tests::measure), kept up to date with every test rather than
//! measured anew.

use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_coverage::{Bracket, Point, PointSetError, Space};

/// Coverage that grows by one test at a time.
///
/// ```
/// use paracosm::LiveCoverage;
/// use paracosm::coverage::{Point, Space};
///
/// let mut coverage = LiveCoverage::new(&Space::unit_cube(2));
/// assert_eq!(coverage.dispersion().map(|volume| volume.upper), Some(1.0));
/// coverage.add(&Point { continuous: vec![0.25, 0.5], discrete: vec![] })?;
/// assert_eq!(coverage.dispersion().map(|volume| volume.upper), Some(0.75));
/// # Ok::<(), paracosm::coverage::PointSetError>(())
/// ```
#[derive(Debug, Clone)]
pub struct LiveCoverage {
    /// The holes in the continuous parameters; none where the space has none.
    holes: Option<EmptyBoxes>,
}

/// How many holes are looked after in one or two dimensions. That many take less time than a simulation.
const MOST_HOLES: usize = 20_000;

impl LiveCoverage {
    /// The coverage of no tests.
    pub fn new(space: &Space) -> Self {
        let dims = space.dims();
        // A hole has 2d parts with 2d faces each.
        let most = (4 * MOST_HOLES / dims.saturating_mul(dims).max(4)).max(100);
        Self { holes: EmptyBoxes::at_most(dims, most).ok() }
    }

    /// Takes one more test.
    ///
    /// # Errors
    /// It is none of the space. Nothing has changed then.
    pub fn add(&mut self, test: &Point) -> Result<(), PointSetError> {
        self.holes.as_mut().map_or(Ok(()), |holes| holes.add(&test.continuous))
    }

    /// The dispersion of the continuous parameters; `None` where the space has none. It is a bracket where there are
    /// more holes than can be looked after.
    pub fn dispersion(&self) -> Option<Bracket> {
        self.holes.as_ref().map(EmptyBoxes::dispersion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Measure, Tests};
    use paracosm_generators::{Request, Strategy};

    #[test]
    fn what_is_said_after_every_test_is_what_is_measured_at_the_end() {
        for (dims, n) in [(1, 50), (2, 200), (5, 100), (12, 60)] {
            let space = Space::unit_cube(dims);
            let points = Strategy::Halton.build(&Request::new(&space, n)).unwrap().ask(n);
            let mut live = LiveCoverage::new(&space);
            points.iter().for_each(|point| live.add(point).unwrap());
            let said = live.dispersion().unwrap();
            let tests = Tests { space, points, k: None };
            let measured = tests.measure(&[Measure::Dispersion], None, None).unwrap();
            let exact = measured.continuous.unwrap().dispersion.unwrap().volume.lower;
            assert!(said.lower <= exact && exact <= said.upper, "{dims}: {exact} is not in {said:?}");
            assert!(dims > 2 || said.is_exact());
        }
    }
}
