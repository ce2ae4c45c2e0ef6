//! Keeps the coverage of the tests so far while a campaign runs, for its progress line.
//!
//! The numbers are those of [`Coverage::of`](crate::Coverage::of). Every test updates them.

use paracosm_campaign::Error;
use paracosm_coverage::Bracket;
use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_coverage::kwise::KwiseCounter;
use paracosm_coverage::valid::Validity;
use paracosm_space::{Point, Space, SpaceError};

/// The coverage of a set of tests that grows by one test at a time.
///
/// ```
/// use paracosm_analysis::LiveCoverage;
/// use paracosm_space::{Point, Space};
///
/// let mut coverage = LiveCoverage::new(&Space::unit_cube(2), None)?;
/// assert_eq!(coverage.dispersion().map(|volume| volume.upper), Some(1.0));
/// coverage.add(&Point { continuous: vec![0.25, 0.5], discrete: vec![] })?;
/// assert_eq!(coverage.dispersion().map(|volume| volume.upper), Some(0.75));
/// # Ok::<(), paracosm_campaign::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LiveCoverage {
    /// The holes in the continuous parameters; `None` if the space has no continuous parameters.
    holes: Option<EmptyBoxes>,
    /// The combinations of discrete values; `None` if there are no combinations or too many.
    combinations: Option<KwiseCounter>,
}

/// The greatest number of holes that are tracked in one or two dimensions. Their update takes less time than a
/// simulation.
const MOST_HOLES: usize = 20_000;

impl LiveCoverage {
    /// Makes the coverage of an empty set of tests, to which tests can be added. `k` discrete parameters are considered
    /// together (default 2).
    ///
    /// # Errors
    /// No test can satisfy the space's constraints.
    pub fn new(space: &Space, k: Option<usize>) -> Result<Self, SpaceError> {
        let dims = space.dims();
        // A hole has 2d parts with 2d faces each.
        let most = (4 * MOST_HOLES / dims.saturating_mul(dims).max(4)).max(100);
        let rules = space.rules()?;
        let k = k.unwrap_or(2).min(rules.levels().len());
        let holes = match Validity::of(space, &rules) {
            Some(validity) => EmptyBoxes::within(validity.whole(), most),
            None => EmptyBoxes::at_most(dims, most),
        };
        let holes = holes.ok();
        Ok(Self { holes, combinations: KwiseCounter::new(&rules, k).ok() })
    }

    /// Adds a test to the set of tests whose coverage is kept.
    ///
    /// # Errors
    /// The test does not belong to the space. If only its discrete values are wrong, the dispersion counts it.
    pub fn add(&mut self, test: &Point) -> Result<(), Error> {
        if let Some(holes) = &mut self.holes {
            holes.add(&test.continuous)?;
        }
        if let Some(combinations) = &mut self.combinations {
            combinations.add(&test.discrete)?;
        }
        Ok(())
    }

    /// Returns the number of covered and the number of all valid combinations of discrete values; `None` if the space
    /// has no discrete parameters, or too many combinations to count.
    pub fn combinations(&self) -> Option<(u64, u64)> {
        self.combinations.as_ref().map(|counter| (counter.covered(), counter.valid()))
    }

    /// Returns the dispersion of the continuous parameters; `None` if the space has no continuous parameters. The
    /// result is a bracket if there are more holes than can be tracked, or if constraints leave only a part of the space.
    pub fn dispersion(&self) -> Option<Bracket> {
        self.holes.as_ref().map(EmptyBoxes::dispersion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Coverage;
    use paracosm_campaign::TestSet;
    use paracosm_coverage::Measure;
    use paracosm_generators::{Request, Strategy};
    use paracosm_space::{Domain, Parameter};

    #[test]
    fn what_is_said_after_every_test_is_what_is_measured_at_the_end() {
        for (dims, n) in [(1, 50), (2, 200), (5, 100), (12, 60)] {
            let space = Space::unit_cube(dims);
            let points = Strategy::HALTON.build(&Request::new(&space, n)).unwrap().ask(n);
            let mut live = LiveCoverage::new(&space, None).unwrap();
            points.iter().for_each(|point| live.add(point).unwrap());
            let said = live.dispersion().unwrap();
            let tests = TestSet::new(space, points);
            let measured = Coverage::of(&tests, &[Measure::DISPERSION], None, crate::Limit::None).unwrap();
            let exact = measured.continuous.unwrap().bracket(Measure::DISPERSION).unwrap().lower;
            assert!(said.lower <= exact && exact <= said.upper, "{dims}: {exact} is not in {said:?}");
            assert!(dims > 2 || said.is_exact());
        }
    }

    #[test]
    fn too_many_combinations_to_keep_count_of_are_left_out() {
        let levels = |count: i32| (0..count).map(|level| f64::from(level).into()).collect();
        let space = |count| {
            let choice = |name: &str| Parameter::new(name, Domain::Choice(levels(count)));
            Space::new(["a", "b", "c"].map(choice).to_vec()).unwrap()
        };
        let known = |count| LiveCoverage::new(&space(count), Some(3)).unwrap().combinations();
        assert_eq!(known(100), Some((0, 1_000_000)));
        assert_eq!(known(900), None);
    }

    #[test]
    fn combinations_are_counted_as_tests_arrive() {
        let text = "parameter = [{ name = \"a\", choice = [1, 2, 3] }, { name = \"x\", interval = [0, 1] },
            { name = \"b\", choice = [1, 2] }]";
        let space = Space::from_toml(text).unwrap().with_constraints(["a == 1 implies b == 2"]).unwrap();
        let mut live = LiveCoverage::new(&space, Some(2)).unwrap();
        assert_eq!(live.combinations(), Some((0, 5)));
        for (row, covered) in [([0, 1], 1), ([0, 1], 1), ([2, 0], 2), ([0, 0], 2)] {
            live.add(&Point { continuous: vec![0.5], discrete: row.to_vec() }).unwrap();
            assert_eq!(live.combinations(), Some((covered, 5)), "{row:?}");
        }
    }
}
