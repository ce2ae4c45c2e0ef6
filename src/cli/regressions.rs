//! `paracosm-fuzz replay FILE...`: runs regression files.

use super::draw::is_ours_to_write;
use super::output::{Format, digits, json};
use super::usage;
use super::{Failure, Status, print, program};
use crate::oracles::Verdict;
use paracosm_campaign::files::write_whole;
use paracosm_campaign::{Catalogue, Error, Expectation, Regression, Replayed, Study, Trial, Trust};
use paracosm_report::junit::{Case, End};
use paracosm_report::{Junit, command_option, shell_word};
use serde_json::json;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Runs all regression files, even if one of them breaks, and prints a line for each. `expect` overrides the
/// expectation of the files. `junit` is written in the place of an older report, and goes by the expectations. The exit status counts
/// the tests for which `counts` is true. The first test that broke, or did not repeat the trace that the same software has recorded,
/// becomes the error of the command.
pub(super) fn replay(
    files: &[PathBuf],
    catalogue: &Catalogue,
    trust: &Trust,
    expect: Option<Expectation>,
    junit: Option<&Path>,
    counts: fn(&Replayed) -> bool,
    format: Format,
) -> Result<Status, Failure> {
    junit.map_or(Ok(()), |path| is_report(path, files))?;
    let mut regressions = Vec::new();
    let catalogue = catalogue.trusting(trust);
    for file in files {
        let mut regression = Regression::read(file, &catalogue)?.trusting(trust);
        regression.expect = expect.unwrap_or(regression.expect);
        regressions.push((file, regression));
    }
    let (mut lines, mut objects) = (String::new(), Vec::new());
    let (mut found, mut wrong) = (Status::Nothing, None);
    let (mut trials, mut ends) = (Vec::new(), Vec::new());
    for (file, regression) in &regressions {
        let replayed = regression.run().map_err(|error| usage(format!("{}: {error}", file.display())))?;
        let words = words(regression, &replayed);
        let _ = writeln!(lines, "{}: {words}", file.display());
        objects.push(json!({"file": file, "about": regression.about, "replayed": replayed}));
        if counts(&replayed) {
            found = Status::Violation;
        }
        let ended = end(regression, &replayed);
        if ended == End::Error {
            wrong.get_or_insert_with(|| format!("{}: {words}", file.display()));
        }
        trials.push(replayed.trial);
        ends.push((ended, words));
    }
    if let Some(path) = junit {
        let suites = regressions.iter().zip(&trials).zip(ends);
        let suites = suites.map(|(((file, regression), trial), end)| suite(file, regression, (trial, end)));
        write_whole(path, Junit::of_cases(suites).text().as_bytes())?;
    }
    print(&match format {
        Format::Table => lines,
        Format::Json => json(&objects),
    })?;
    wrong.map_or(Ok(found), |message| Err(message.into()))
}

/// Checks that a report may be written to `path`, and that `path` is not a regression file, given by mistake.
fn is_report(path: &Path, files: &[PathBuf]) -> Result<(), Error> {
    let files: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    is_ours_to_write("--junit", path, &files)?;
    if path.extension().is_some_and(|ending| ending == "json") {
        return Err(usage(format!("--junit {}: a report is XML, expected FILE.xml", path.display())));
    }
    Ok(())
}

/// Returns the end of a test for CI. It depends on the expectation, not on the verdict alone. Another trace is an error only if this
/// process made the trace: a driver in a process of its own may have changed.
fn end(regression: &Regression, replayed: &Replayed) -> End {
    let is_another = replayed.same_trace == Some(false) && !regression.study().is_outside();
    match replayed {
        _ if broke(&replayed.trial) || is_another => End::Error,
        Replayed { as_expected: true, .. } => End::Passed,
        _ if replayed.trial.is_failure() => End::Failed,
        _ => End::Skipped,
    }
}

/// The suite of one test.
fn suite<'a>(
    file: &Path,
    regression: &'a Regression,
    (trial, (end, message)): (&'a Trial, (End, String)),
) -> (String, &'a Study, Case<'a>) {
    let name = file.to_string_lossy().into_owned();
    let replay = format!("{} replay {}{}", program::name(), shell_word(&name), command_option(regression.study()));
    let expected = Some(if regression.expect == Expectation::Fail { "fail" } else { "pass" });
    let case = Case { name: name.clone(), trial, replay, end, message, expected };
    (name, regression.study(), case)
}

/// Describes the end of a test.
fn words(regression: &Regression, replayed: &Replayed) -> String {
    let Replayed { expect, as_expected, same_trace, trial } = replayed;
    let end = match trial.verdict {
        Verdict::Fail => format!("fails, {}", violations(regression, replayed)),
        Verdict::Pass => "passes".to_owned(),
        verdict => {
            format!("ends {verdict}{}", trial.error().iter().map(|error| format!(", {error}")).collect::<String>())
        }
    };
    let note = match (expect, as_expected) {
        (_, true) => ", as expected".to_owned(),
        (Expectation::Fail, false) if trial.is_failure() => {
            format!(", expected to violate {}", regression.violates.join(", "))
        }
        _ if broke(trial) => format!(", expected to {}", if *expect == Expectation::Fail { "fail" } else { "pass" }),
        (Expectation::Fail, false) => {
            ", expected to fail: if the failure is mended, set `expect` in the file to \"pass\"".to_owned()
        }
        (Expectation::Pass, false) => ", EXPECTED TO PASS".to_owned(),
    };
    let hash = |hash: &Option<String>| hash.clone().unwrap_or_else(|| "none".to_owned());
    let trace = match same_trace {
        Some(false) => {
            let why = if regression.study().is_outside() { " (changed since, or not deterministic)" } else { "" };
            format!("; its trace hash is {}, recorded {}{why}", hash(&trial.trace_hash), hash(&regression.trace_hash))
        }
        Some(true) => "; the same trace".to_owned(),
        None => String::new(),
    };
    format!("{end}{note}{trace}")
}

/// Returns true if a test is invalid or ended in an error.
fn broke(trial: &Trial) -> bool {
    matches!(trial.verdict, Verdict::Error | Verdict::Invalid)
}

/// Describes the violated requirements with their robustness.
fn violations(regression: &Regression, replayed: &Replayed) -> String {
    let requirements = regression.study().requirements().iter();
    let violated = requirements.filter_map(|requirement| {
        let worth = replayed.trial.robustness(&requirement.id)?;
        let violated = replayed.trial.violates(&requirement.id);
        violated.then(|| format!("{} {} {}", requirement.id, digits(worth), requirement.unit).trim_end().to_owned())
    });
    violated.collect::<Vec<_>>().join(", ")
}
