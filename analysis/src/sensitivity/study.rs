//! The sensitivity of a campaign's study: from tests of its own, or from the model of its failures.

use super::design::{Design, Factor, evaluated, explain, tests_within};
use super::{Sensitivity, SensitivityFlaw, Source};
use crate::failure_estimate::failure_model;
use crate::likelihood::always_hold;
use paracosm_campaign::reasons::OtherTrace;
use paracosm_campaign::{Campaign, Error, Log, Problem, Scales, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{Parameter, Point, Space, Values, plural};

/// The number of pairs of tests for which a model is evaluated. A model answers at once.
const PAIRS_OF_MODEL: usize = 4096;

/// Returns the parameters of a space, if they are independent.
fn factors(space: &Space) -> Result<Vec<Factor>, SensitivityFlaw> {
    if !always_hold(space) {
        return Err(SensitivityFlaw::Constraints);
    }
    let factor = |parameter: &Parameter| Factor { name: parameter.name.clone(), coordinates: parameter.coordinates() };
    Ok(space.parameters().iter().map(factor).collect())
}

/// Estimates the sensitivity of the study of a log from tests of its own, of which there are at most `budget`. The tests
/// have the distributions of the space. `watch` receives every trial in order; its first error ends the work. The campaign must
/// be one of the log's study.
///
/// # Errors
/// No parameter is open, constraints leave a part of the space, the budget is too small, more than 5 % of the tests could not be
/// judged, or `watch` returned an error.
pub fn of_tests(
    log: &Log,
    campaign: &Campaign,
    budget: usize,
    seed: u64,
    mut watch: impl FnMut(&Trial) -> Result<(), Error>,
) -> Result<Sensitivity, Error> {
    let (space, scales) = (log.study().space(), log.scales());
    let factors = factors(space)?;
    let pairs = tests_within(budget, factors.len())? / (factors.len() + 2);
    let (mut done, mut undecided, mut problem): (usize, usize, Option<Problem>) = (0, 0, None);
    let changed = changed(log, campaign)?;
    let evaluated = evaluated(&factors, pairs, seed, &mut |points| {
        let tests: Vec<Values> = points.iter().map(|point| space.decode(&space.at_quantiles(point))).collect();
        let mut results = Vec::with_capacity(tests.len());
        campaign.run_tests(&tests, done, |trial| {
            let is_judged = !matches!(trial.verdict, Verdict::Error | Verdict::Invalid);
            let robustness = scales.objective(trial);
            undecided += usize::from(is_judged && robustness.is_none());
            let quantities = vec![f64::from(u8::from(trial.is_failure())), robustness.unwrap_or(Scales::MOST)];
            results.push(is_judged.then_some(quantities));
            if problem.is_none() {
                problem.clone_from(&trial.problem);
            }
            watch(trial)
        })?;
        done += tests.len();
        Ok(results)
    })?;
    let Design { explained, evaluations, pairs, left_out } = evaluated.explained(&factors, problem)?;
    let mut notes: Vec<String> = changed.into_iter().collect();
    if undecided > 0 {
        let tests = plural(undecided, "test");
        let most = Scales::MOST;
        notes.push(format!("{tests} decided no requirement: their robustness counts as the greatest one, {most}"));
    }
    if left_out > 0 {
        let left_out = plural(left_out, "pair");
        notes.push(format!("{left_out} of tests are left out, because a test could not be judged"));
    }
    let [failure, robustness] = <[_; 2]>::try_from(explained).expect("every test gives both quantities");
    Ok(Sensitivity { source: Source::Tests, evaluations, pairs, failure, robustness: Some(robustness), notes })
}

/// Runs a test of the log again, and returns a note if it has another trace now: the new tests are then not about the system of the log.
fn changed(log: &Log, campaign: &Campaign) -> Result<Option<String>, Error> {
    let Some(logged) = log.trials().iter().find(|trial| trial.trace_hash.is_some()) else { return Ok(None) };
    let now = campaign.run_test(&logged.test, logged.index)?;
    let is_same = now.trace_hash == logged.trace_hash;
    Ok((!is_same).then(|| {
        format!("{}; the shares describe the present scenario and driver", OtherTrace { index: logged.index })
    }))
}

/// Estimates the sensitivity of the study of a log from the model of its failures, without a test. The quantity is the
/// probability that a test fails.
///
/// # Errors
/// No parameter is open, constraints leave a part of the space, or there is no model: no test failed, no test passed, or no model fits.
pub fn of_model(log: &Log, seed: u64) -> Result<Sensitivity, Error> {
    let space = log.study().space();
    let factors = factors(space)?;
    let Some(model) = failure_model(log)? else {
        let has = |verdict| log.trials().iter().any(|trial| trial.verdict == verdict);
        let why = match (log.trials().iter().any(Trial::is_failure), has(Verdict::Pass)) {
            (false, _) => "no test failed",
            (true, false) => "no test passed",
            (true, true) => "no model fits its tests",
        };
        return Err(SensitivityFlaw::NoModel { why }.into());
    };
    let Design { explained, evaluations, pairs, .. } = explain(&factors, PAIRS_OF_MODEL, seed, &mut |points| {
        let points: Vec<Point> = points.iter().map(|point| space.at_quantiles(point)).collect();
        Ok(model.probabilities(&points).into_iter().map(|probability| Some(vec![probability])).collect())
    })?;
    let notes = vec![
        "the intervals count the error of the sample, and not the error of the model; tests of its own have no error of a model"
            .to_owned(),
    ];
    let [failure] = <[_; 1]>::try_from(explained).expect("a model gives one quantity");
    let source = Source::FailureModel { tests: log.trials().len() };
    Ok(Sensitivity { source, evaluations, pairs, failure, robustness: None, notes })
}
