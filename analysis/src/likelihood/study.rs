//! The probability of failure of a study: its tests as chance has them.

use super::{Likelihood, LikelihoodFlaw, Question, estimate};
use paracosm_campaign::{Campaign, Error, Learned, Problem, Scales, Study, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::Values;

/// How likely a test of the study fails, when its open parameters are distributed as its space says. `watch` sees every
/// trial in order, and its first error ends the work. The campaign is one of the study and says how many tests run at a
/// time, which changes nothing; the strategy plays no part.
///
/// # Errors
/// The question cannot be answered, the space has constraints, every test broke, or an error of `watch`.
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

/// The robustness of a trial, with the sign of its verdict, on which rounding has no say; `None` of one that broke or
/// whose world cannot be. A test in which nothing was decided is as far from failing as can be.
fn robustness(scales: &Scales, trial: &Trial) -> Option<f64> {
    let worst = scales.worst(trial).map_or(f64::INFINITY, |(_, robustness)| robustness);
    match trial.verdict {
        Verdict::Error | Verdict::Invalid => None,
        Verdict::Fail => Some(if worst.is_sign_negative() { worst } else { -0.0 }),
        _ => Some(if worst.is_sign_negative() { 0.0 } else { worst }),
    }
}
