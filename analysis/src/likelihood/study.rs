//! Estimates the probability of failure of a study whose tests are drawn from the distributions of its parameters.

use super::{Likelihood, LikelihoodFlaw, Method, Question, estimate};
use crate::combinations::combinations;
use crate::statistics::random::SplitMix64;
use paracosm_campaign::{Campaign, Error, Learned, Problem, Scales, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{Space, Values};

/// The greatest number of rows of discrete values in which constraints are checked as a whole.
const MOST_ROWS: usize = 4096;
/// The greatest number of draws for one valid test.
const MOST_DRAWS: usize = 100_000;
/// The number that makes the seed of further draws another one than the seed of the method.
const APART: u64 = 0x6c69_6b65_6c69_686f;

/// Draws tests that keep the constraints of a space, from the distributions of its parameters.
struct Draws<'s> {
    space: &'s Space,
    random: SplitMix64,
    drawn: usize,
    kept: usize,
}

impl Draws<'_> {
    /// Returns the test at the given quantiles. If the test breaks a constraint, returns the first of further random tests that
    /// does not. So tests have the distributions of the parameters, given that the test is valid.
    fn test(&mut self, quantiles: &[f64]) -> Result<Values, LikelihoodFlaw> {
        let mut point = self.space.at_quantiles(quantiles);
        for _ in 0..MOST_DRAWS {
            self.drawn += 1;
            if self.space.allows(&point) {
                self.kept += 1;
                return Ok(self.space.decode(&point));
            }
            let again: Vec<f64> = quantiles.iter().map(|_| self.random.unit()).collect();
            point = self.space.at_quantiles(&again);
        }
        Err(LikelihoodFlaw::NoValidTest { drawn: MOST_DRAWS })
    }
}

/// Returns `true` if it is certain that every test of a space keeps the constraints.
pub(crate) fn always_hold(space: &Space) -> bool {
    let levels = space.levels();
    let rows = levels.iter().try_fold(1_usize, |rows, levels| rows.checked_mul(*levels));
    if rows.is_none_or(|rows| rows > MOST_ROWS) {
        return space.constraints().is_empty();
    }
    let (lower, upper) = (vec![0.0; space.dims()], vec![1.0; space.dims()]);
    combinations(&levels).all(|row| space.allows_part(&row, &lower, &upper) == Some(true))
}

/// Estimates the probability that a test of a study fails, if the open parameters have the distributions of the space.
/// `watch` receives every trial in order; its first error ends the work. The campaign must be one of this study. It
/// sets how many tests run at a time, which does not change the result. The study's strategy is not used.
///
/// # Errors
/// The question is not valid, constraints leave a part of the space and the method is not Monte Carlo, no valid test was drawn, no test could be judged, or `watch` returned an error.
pub fn of_study(
    study: &Study,
    campaign: &Campaign,
    question: &Question,
    mut watch: impl FnMut(&Trial) -> Result<(), Error>,
) -> Result<Likelihood, Error> {
    let space = study.space();
    let is_part = !always_hold(space);
    if is_part && question.method != Method::MonteCarlo {
        return Err(LikelihoodFlaw::Constraints { method: question.method }.into());
    }
    let mut draws = Draws { space, random: SplitMix64(question.seed ^ APART), drawn: 0, kept: 0 };
    let mut done = 0;
    let scales = Scales::of(study, Learned::new());
    let (mut broken, mut judged): (Option<Problem>, usize) = (None, 0);
    let found = estimate(question, space.coordinates().count(), &mut |points| {
        let tests = points.iter().map(|point| draws.test(point)).collect::<Result<Vec<Values>, _>>()?;
        let mut values = Vec::with_capacity(tests.len());
        campaign.run_tests(&tests, done, |trial| {
            values.push(robustness(&scales, trial));
            judged += usize::from(trial.covers());
            if broken.is_none() {
                broken.clone_from(&trial.problem);
            }
            watch(trial)
        })?;
        done += tests.len();
        Ok(values)
    });
    match (found, broken) {
        (Err(Error::Use(_)), first @ Some(_)) if judged == 0 => Err(LikelihoodFlaw::NothingJudged { first }.into()),
        (Ok(mut found), _) if is_part => {
            let Draws { drawn, kept, .. } = draws;
            found.notes.push(format!(
                "the probability is that of tests that keep the constraints: {kept} of {drawn} random tests did"
            ));
            Ok(found)
        }
        (found, _) => found,
    }
}

/// Returns the robustness of a trial, with the sign of its verdict even if rounding gave another sign; `None` if the
/// trial broke or its world could not be built. A test without a decided requirement has an infinite robustness.
fn robustness(scales: &Scales, trial: &Trial) -> Option<f64> {
    let worst = scales.worst(trial).map_or(f64::INFINITY, |(_, robustness)| robustness);
    match trial.verdict {
        Verdict::Error | Verdict::Invalid => None,
        Verdict::Fail => Some(if worst.is_sign_negative() { worst } else { -0.0 }),
        _ => Some(if worst.is_sign_negative() { 0.0 } else { worst }),
    }
}
