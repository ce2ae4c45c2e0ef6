//! The tests of a design: pairs of independent tests, and mixtures of the two tests of each pair.

use super::estimator::Values;
use super::{Explained, SensitivityFlaw};
use paracosm_campaign::{Error, Problem};
use paracosm_generators::{Request, Strategy};
use paracosm_space::Space;

/// The least number of pairs of tests. With fewer, the intervals say nothing.
const LEAST_PAIRS: usize = 16;
/// The number of tests that are evaluated at a time, enough for many cores and few enough for the memory.
const BATCH: usize = 4096;
/// The greatest share of tests that may remain unjudged.
const MOST_UNJUDGED: f64 = 0.05;

/// A parameter as the design sees it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Factor {
    /// The name of the parameter.
    pub name: String,
    /// The number of coordinates of the parameter in the unit cube.
    pub coordinates: usize,
}

/// A function that evaluates points of the unit cube. Each result has the same number of quantities; `None` is the result of
/// a point that could not be judged.
pub type Evaluate<'a> = dyn FnMut(&[Vec<f64>]) -> Result<Vec<Option<Vec<f64>>>, Error> + 'a;

/// The result of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The explained variance of each quantity.
    pub explained: Vec<Explained>,
    /// The number of points that were evaluated.
    pub evaluations: usize,
    /// The number of pairs whose points could all be judged.
    pub pairs: usize,
    /// The number of pairs that were left out, because a point could not be judged.
    pub left_out: usize,
}

/// Returns the number of tests of the largest design within a budget. The number of pairs is a power of two, because so many
/// scrambled Sobol points are most even. Each pair has two tests, and one test for each parameter.
///
/// # Errors
/// The budget is too small, or there is no parameter.
pub fn tests_within(budget: usize, parameters: usize) -> Result<usize, SensitivityFlaw> {
    if parameters == 0 {
        return Err(SensitivityFlaw::NothingOpen);
    }
    let each = parameters + 2;
    let pairs = budget / each;
    if pairs < LEAST_PAIRS {
        return Err(SensitivityFlaw::Budget { budget, least: LEAST_PAIRS * each, pairs: LEAST_PAIRS, each });
    }
    Ok(each << pairs.ilog2())
}

/// Estimates how much of the variance of each quantity each parameter explains, if the points are uniform in the unit cube.
///
/// This is the design of Saltelli et al. (2010). It has `pairs` pairs of independent points. Both points of each pair are
/// evaluated. So is, for each parameter, the first point with the parameter's coordinates of the second point. The pairs
/// are Owen-scrambled Sobol points with twice the number of coordinates. A power of two is the best number of pairs.
///
/// ```
/// use paracosm_analysis::sensitivity::{Factor, explain};
/// let factors = ["x", "y"].map(|name| Factor { name: name.to_owned(), coordinates: 1 });
/// let found = explain(&factors, 1024, 0, &mut |points| {
///     Ok(points.iter().map(|point| Some(vec![3.0 * point[0] + point[1]])).collect())
/// })?;
/// // The variances of 3 x and of y are as 9 to 1.
/// assert!((found.explained[0].parameters[0].first_order.estimate - 0.9).abs() < 0.02);
/// # Ok::<(), paracosm_campaign::Error>(())
/// ```
///
/// # Errors
/// There is no parameter, there are fewer than 16 pairs, more than 5 % of the points could not be judged, or `evaluate`
/// returned an error.
pub fn explain(factors: &[Factor], pairs: usize, seed: u64, evaluate: &mut Evaluate) -> Result<Design, Error> {
    evaluated(factors, pairs, seed, evaluate)?.explained(factors, None)
}

/// The values of a design at all its points.
pub(super) struct Evaluated {
    quantities: Vec<Values>,
    evaluations: usize,
    unjudged: usize,
    pairs: usize,
    left_out: usize,
}

/// Evaluates the points of a design. The arguments and the errors are those of [`explain`].
pub(super) fn evaluated(
    factors: &[Factor],
    pairs: usize,
    seed: u64,
    evaluate: &mut Evaluate,
) -> Result<Evaluated, Error> {
    let each = factors.len() + 2;
    tests_within(pairs * each, factors.len())?;
    let dims: usize = factors.iter().map(|factor| factor.coordinates).sum();
    let space = Space::unit_cube(2 * dims);
    let mut generator = Strategy::SOBOL_OWEN.build(&Request { seed: Some(seed), ..Request::new(&space, pairs) })?;
    let mut all = Evaluated { quantities: Vec::new(), evaluations: 0, unjudged: 0, pairs: 0, left_out: 0 };
    while all.pairs + all.left_out < pairs {
        let batch = generator.ask((BATCH / each).clamp(1, pairs - all.pairs - all.left_out));
        let points: Vec<Vec<f64>> = batch.iter().flat_map(|pair| mixtures(&pair.continuous, factors)).collect();
        let values = evaluate(&points)?;
        assert_eq!(values.len(), points.len(), "a result for each point");
        values.chunks(each).for_each(|row| all.add(row));
    }
    Ok(all)
}

impl Evaluated {
    /// Adds the values at the points of a pair.
    fn add(&mut self, row: &[Option<Vec<f64>>]) {
        self.evaluations += row.len();
        let judged: Vec<&Vec<f64>> = row.iter().flatten().collect();
        if judged.len() < row.len() {
            self.unjudged += row.len() - judged.len();
            self.left_out += 1;
            return;
        }
        self.pairs += 1;
        let empty = || Values { mixed: vec![Vec::new(); row.len() - 2], ..Values::default() };
        self.quantities.resize_with(judged[0].len(), empty);
        for (at, values) in self.quantities.iter_mut().enumerate() {
            values.first.push(judged[0][at]);
            values.second.push(judged[1][at]);
            for (mixed, value) in values.mixed.iter_mut().zip(&judged[2..]) {
                mixed.push(value[at]);
            }
        }
    }

    /// Estimates the indices of each quantity.
    ///
    /// # Errors
    /// Too many points could not be judged. `problem` is the problem of the first of these points.
    pub fn explained(self, factors: &[Factor], problem: Option<Problem>) -> Result<Design, Error> {
        let Self { quantities, evaluations, unjudged, pairs, left_out } = self;
        if unjudged as f64 > MOST_UNJUDGED * evaluations as f64 || pairs < 2 {
            return Err(SensitivityFlaw::Unjudged { unjudged, tests: evaluations, first: problem }.into());
        }
        let names: Vec<&str> = factors.iter().map(|factor| factor.name.as_str()).collect();
        let explained = quantities.iter().map(|values| values.explain(&names)).collect();
        Ok(Design { explained, evaluations, pairs, left_out })
    }
}

/// Returns both points of a pair, and for each parameter the first point with the parameter's coordinates of the second point.
fn mixtures(pair: &[f64], factors: &[Factor]) -> Vec<Vec<f64>> {
    let (first, second) = pair.split_at(pair.len() / 2);
    let mut points = vec![first.to_vec(), second.to_vec()];
    let mut begin = 0;
    for factor in factors {
        let own = begin..begin + factor.coordinates;
        let mut mixed = first.to_vec();
        mixed[own.clone()].copy_from_slice(&second[own.clone()]);
        points.push(mixed);
        begin = own.end;
    }
    points
}
