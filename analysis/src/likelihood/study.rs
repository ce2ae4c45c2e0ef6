//! Estimates the probability of failure of a study whose tests are drawn from the distributions of its parameters.

use super::{Likelihood, LikelihoodFlaw, Question, estimate};
use paracosm_campaign::{Campaign, Error, Learned, Problem, Scales, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::Values;

/// Estimates the probability that a test of a study fails, if the open parameters have the distributions of the space.
/// `watch` receives every trial in order; its first error ends the work. The campaign must be one of this study. It
/// sets how many tests run at a time, which does not change the result. The study's strategy is not used.
///
/// # Errors
/// The question is not valid, the space has constraints, no test could be judged, or `watch` returned an error.
pub fn of_study(
    study: &Study,
    campaign: &Campaign,
    question: &Question,
    mut watch: impl FnMut(&Trial) -> Result<(), Error>,
) -> Result<Likelihood, Error> {
    let space = study.space();
    if !space.constraints().is_empty() {
        return Err(LikelihoodFlaw::Constraints.into());
    }
    let mut done = 0;
    let scales = Scales::of(study, Learned::new());
    let (mut broken, mut judged): (Option<Problem>, usize) = (None, 0);
    let found = estimate(question, space.coordinates().count(), &mut |points| {
        let tests: Vec<Values> = points.iter().map(|point| space.decode(&space.at_quantiles(point))).collect();
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
