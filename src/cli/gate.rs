//! `--fail-on-violation`: the status of a campaign, which is no success if the campaign shows too little.

use super::output::plural;
use super::{Failure, Status};
use crate::Report;
use crate::analysis::Summary;
use crate::oracles::Verdict;
use crate::space::nearest;
use paracosm_campaign::{StatedRequirement, Study};

/// Returns the status of a campaign. With --fail-on-violation, a campaign that shows too little is an error.
pub(super) fn gate(report: &Report, fail_on_violation: bool) -> Result<Status, Failure> {
    if !fail_on_violation {
        return Ok(Status::Nothing);
    }
    let (log, summary) = (&report.log, &report.summary);
    // A gate that says yes although some tests have no result would be false assurance.
    if let Some(trial) = log.trials().iter().find(|trial| trial.verdict == Verdict::Error) {
        let (errors, tests) = (summary.count(Verdict::Error), plural(summary.tests(), "test"));
        let (index, first) = (trial.index, trial.error().unwrap_or_default());
        let message =
            format!("{errors} of {tests} ended in an error, so they have no verdict; the first, test {index}: {first}");
        return Err(message.into());
    }
    if let Some(why) = untested(summary).filter(|_| summary.tests() > 0) {
        return Err(format!("the campaign does not show whether a requirement is violated: {why}").into());
    }
    if summary.count(Verdict::Fail) > 0 {
        return Ok(Status::Violation);
    }
    match misspelled(log.study()) {
        Some(id) => Err(format!(
            "requirement `{id}` was not judged: it has no formula, and the scenario has no requirement of this name"
        )
        .into()),
        None => Ok(Status::Nothing),
    }
}

/// Returns the reason why the tests of a campaign show nothing; `None` if at least one test shows whether it passes.
fn untested(summary: &Summary) -> Option<String> {
    if [Verdict::Pass, Verdict::Fail].iter().all(|verdict| summary.count(*verdict) == 0) {
        let counts = [Verdict::Unpreventable, Verdict::Inconclusive, Verdict::Invalid]
            .map(|verdict| (summary.count(verdict), verdict));
        let words = counts.iter().filter(|(count, _)| *count > 0).map(|(count, verdict)| format!("{count} {verdict}"));
        return Some(format!("no test passed or failed ({})", words.collect::<Vec<_>>().join(", ")));
    }
    summary.requirements().is_empty().then(|| "there is no requirement; --spec or --requirements states one".to_owned())
}

/// Returns the id of a requirement of a file whose id seems to be misspelled: it has no formula, and it is similar to the id of another
/// requirement or says nothing else. A requirement that nobody has a formula for yet says what it is.
fn misspelled(study: &Study) -> Option<String> {
    if study.subject().scenario().is_err() {
        return None;
    }
    let (judged, unjudged): (Vec<_>, Vec<_>) = study.requirements().iter().partition(|one| one.formula.is_some());
    let says_nothing = |one: &&StatedRequirement| one.text.is_empty() && one.source.is_none() && one.severity.is_none();
    let is_similar =
        |one: &&StatedRequirement| nearest(&one.id, judged.iter().map(|other| other.id.as_str())).is_some();
    unjudged.into_iter().find(|one| says_nothing(one) || is_similar(one)).map(|one| one.id.clone())
}
