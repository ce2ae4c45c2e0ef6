//! Judges the trace of a test by the formulas that were given with a study.

use crate::study::StatedRequirement;
use crate::{Problem, ProblemKind, Trial};
use paracosm_engine::{Judgement, Violation};
use paracosm_oracles::{EvaluationError, Trace, Truth, Verdict};

/// Judges the trace of a trial by the given requirements, and adds the judgements to the trial. The given requirements
/// are the requirements of the study that the scenario itself does not judge.
///
/// A formula that cannot be evaluated ends the trial with an error. If there are several errors, an error that every
/// trace would have takes precedence over an error of this trace alone.
pub fn judge<'r>(trial: &mut Trial, requirements: impl Iterator<Item = &'r StatedRequirement>, trace: &Trace) {
    if trial.problem.is_some() {
        return;
    }
    let mut problem: Option<Problem> = None;
    for StatedRequirement { id, formula, time, .. } in requirements {
        let Some(formula) = formula else { continue };
        let evaluation = formula.evaluate_in(*time, trace);
        let truth = evaluation.as_ref().map_or(Truth::Undecided, |evaluation| evaluation.truth);
        let robustness = evaluation.as_ref().map_or(f64::NAN, |evaluation| evaluation.robustness);
        let violation = (truth == Truth::Violated).then(|| Violation::of(formula, *time, trace));
        trial.judgements.push(Judgement {
            violation: violation.flatten().map(Box::new),
            ..Judgement::new(id.as_str(), (truth != Truth::Undecided).then_some(robustness))
        });
        trial.verdict = match (truth, trial.verdict) {
            (Truth::Violated, _) | (_, Verdict::Fail) => Verdict::Fail,
            (Truth::Undecided, _) => Verdict::Inconclusive,
            (Truth::Holds, verdict) => verdict,
        };
        if let Err(error) = evaluation {
            let found = unasked(id, &error);
            let is_worse = |known: &Problem| is_misfit(&found.kind) && !is_misfit(&known.kind);
            if problem.as_ref().is_none_or(is_worse) {
                problem = Some(found);
            }
        }
    }
    if problem.is_some() {
        (trial.verdict, trial.problem) = (Verdict::Error, problem);
    }
}

/// Returns the problem of a formula that cannot judge a trace.
fn unasked(id: &str, error: &EvaluationError) -> Problem {
    let requirement = id.to_owned();
    match error {
        EvaluationError::NoValue { .. } => Problem::new(ProblemKind::Unasked { requirement }, format!("{id}: {error}")),
        error if error.fits_no_trace() => {
            let period = match error {
                EvaluationError::TimeBound { dt, .. } => Some(*dt),
                _ => None,
            };
            Problem::new(ProblemKind::Misfit { requirement, period }, format!("{id} does not fit the trace: {error}"))
        }
        error => Problem::new(ProblemKind::Unasked { requirement }, format!("{id} cannot judge this trace: {error}")),
    }
}

fn is_misfit(cause: &ProblemKind) -> bool {
    matches!(cause, ProblemKind::Misfit { .. })
}
