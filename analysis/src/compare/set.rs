//! Makes one set of points and measures how evenly it covers its cube.

use crate::Limit;
use crate::estimate::{Coverage, measure_holes};
use paracosm_campaign::Error;
use paracosm_campaign::TestSet;
use paracosm_coverage::Bracket;
use paracosm_coverage::Measure;
use paracosm_coverage::measure::Computation;
use paracosm_generators::{Request, Strategy};
use paracosm_space::Space;

/// A set of points that is to be made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Case {
    pub strategy: Strategy,
    pub dims: usize,
    pub budget: usize,
    /// The seed with which the set is made; `None` for a plain set, which uses no randomness.
    pub seed: Option<u64>,
}

/// A set of points with its measured values.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSet {
    /// The strategy that made the set.
    pub strategy: Strategy,
    /// The number of dimensions of the points.
    pub dims: usize,
    /// The number of points of the set.
    pub budget: usize,
    /// The seed with which the set was made; `None` for a plain set, which uses no randomness.
    pub seed: Option<u64>,
    /// The measures with their values; a value is `None` if the limit left no result.
    pub values: Vec<(Measure, Option<Bracket>)>,
}

impl Case {
    /// Makes the set of points and takes each measure of the set within a limit.
    pub fn measure(&self, measures: &[Measure], k: usize, limit: Limit) -> Result<MeasuredSet, Error> {
        let Self { strategy, dims, budget, seed } = *self;
        let space = Space::unit_cube(dims);
        let points = strategy.build(&Request { seed, ..Request::new(&space, budget) })?.ask(budget);
        let tests = TestSet::new(space, points);
        let value = |&measure: &Measure| {
            // A measure that does not use k must not fail because of a k that is too large.
            let k = k.min(dims);
            // The set is measured on this thread alone.
            let (coverage, _) = measure_holes(&tests, &[measure], Some(k), limit.here(), &mut |_, _| ())?;
            Ok((measure, value(&coverage, measure)))
        };
        let values = measures.iter().map(value).collect::<Result<_, Error>>()?;
        Ok(MeasuredSet { strategy, dims, budget, seed, values })
    }
}

impl MeasuredSet {
    /// Returns the value of a measure; `None` if the set has no value of the measure.
    pub fn value(&self, measure: Measure) -> Option<Bracket> {
        self.values.iter().find(|(of, _)| *of == measure).and_then(|(_, value)| *value)
    }

    /// Returns `true` if the limit made the value of a measure inexact.
    pub fn is_cut_short(&self) -> bool {
        self.values.iter().any(|(_, value)| value.is_none_or(|bracket| !bracket.is_exact()))
    }
}

/// Returns the value of a measure from a coverage report; `None` if the report does not have it.
fn value(coverage: &Coverage, measure: Measure) -> Option<Bracket> {
    match measure.descriptor().method {
        Computation::Combinations => None,
        Computation::KwiseHole => coverage.k_wise_dispersion.as_ref().map(|hole| hole.volume),
        _ => coverage.continuous.as_ref()?.bracket(measure),
    }
}
