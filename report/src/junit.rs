//! Writes trials as JUnit test cases, which CI systems read.
//!
//! Each study is a test suite, and each trial is a test case in the suite. A trial that did not pass is a failure, an
//! error or a skipped test case. Properties hold the facts for which JUnit has no element: requirements, parameters,
//! the simulated seconds, and the command that runs the test again. No `time` is written: readers take it for the time
//! that a test took, which differs from run to run.

use crate::xml::xml_text;
use paracosm_campaign::{Artefact, Error, Log, Study, Subject, Trial};
use paracosm_oracles::Verdict;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::path::Path;

/// A file of test results in the JUnit format, which CI systems read.
#[derive(Debug, Clone, PartialEq)]
pub struct Junit(Report);

/// A trial in the form of a JUnit test case.
pub struct Case<'a> {
    /// The name of the test case, which is unique in its test suite.
    pub name: String,
    /// The trial that the test case describes.
    pub trial: &'a Trial,
    /// The command that runs the trial again.
    pub replay: String,
    /// The result of the test case.
    pub end: End,
    /// The message that explains the result of the test case.
    pub message: String,
    /// The expected result of the trial; `None` if the trial is expected to pass.
    pub expected: Option<&'static str>,
}

/// The result of a JUnit test case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The test case ended as expected.
    Passed,
    /// The test case failed, so that the CI job has to fail.
    Failed,
    /// The test case has no result because of a crash, a time-out or a similar problem.
    Error,
    /// The test case was skipped, so that it counts neither for nor against the system under test.
    Skipped,
}

impl Junit {
    /// Makes the JUnit file of a campaign, where `program` is the command that replays the tests of the campaign in
    /// `folder`.
    pub fn of_campaign(log: &Log, folder: &Path, program: &str) -> Self {
        let study = log.study();
        let (program, folder) = (shell_word(program), shell_word(&folder.to_string_lossy()));
        let command = command_option(study);
        let replay = |trial: &Trial| format!("{program} replay {folder} {}{command}", trial.index);
        let case = |trial: &Trial| Case::of(study, trial, replay(trial)).junit(study);
        let mut suite = suite(study, study.title());
        suite.add_test_cases(log.trials().iter().map(case));
        Self::of([suite])
    }

    /// Makes a JUnit file in which each test case has a test suite of its own, with the given name.
    pub fn of_cases<'a>(cases: impl IntoIterator<Item = (String, &'a Study, Case<'a>)>) -> Self {
        Self::of(cases.into_iter().map(|(name, study, case)| {
            let mut suite = suite(study, name);
            suite.add_test_case(case.junit(study));
            suite
        }))
    }

    fn of(suites: impl IntoIterator<Item = TestSuite>) -> Self {
        let mut report = Report::new("paracosm");
        report.add_test_suites(suites);
        Self(report)
    }

    /// Returns the contents of the JUnit file as XML.
    pub fn text(&self) -> String {
        xml_text(self.0.to_string().expect("the report is written to memory"))
    }
}

impl Artefact for Junit {
    fn files(&self) -> Vec<&'static str> {
        vec!["junit.xml"]
    }

    fn contents(&self, _: &str) -> Result<Vec<u8>, Error> {
        Ok(self.text().into_bytes())
    }
}

/// Makes a JUnit test suite with the properties that all its tests share.
fn suite(study: &Study, name: String) -> TestSuite {
    let mut suite = TestSuite::new(name);
    suite.add_property(("strategy", study.sampling().to_string().as_str()));
    for (name, value) in study.fixed().iter() {
        suite.add_property((format!("parameter.{name}").as_str(), value.to_string().as_str()));
    }
    for requirement in study.requirements() {
        let said = [
            ("", Some(requirement.text.clone())),
            (".formula", requirement.formula.as_ref().map(ToString::to_string)),
            (".source", requirement.source.clone()),
            (".severity", requirement.severity.clone()),
        ];
        for (key, text) in said.into_iter().filter_map(|(key, text)| Some((key, text.filter(|text| !text.is_empty())?)))
        {
            suite.add_property((format!("requirement.{}{key}", requirement.id).as_str(), text.as_str()));
        }
    }
    suite
}

impl<'a> Case<'a> {
    /// Makes the JUnit test case of a trial in a campaign. The trial's verdict decides how the test case ends.
    fn of(study: &Study, trial: &'a Trial, replay: String) -> Self {
        let error = trial.error().unwrap_or_default();
        let (end, message) = match trial.verdict {
            Verdict::Pass => (End::Passed, String::new()),
            Verdict::Fail => (End::Failed, violations(study, trial)),
            Verdict::Error => (End::Error, error.to_owned()),
            Verdict::Unpreventable => {
                (End::Skipped, format!("unpreventable: no reference driver avoids it: {}", violations(study, trial)))
            }
            Verdict::Inconclusive => (
                End::Skipped,
                "inconclusive: the situation that the test is about never came about, or the test ended too early"
                    .to_owned(),
            ),
            Verdict::Invalid => (End::Skipped, format!("invalid: {error}")),
        };
        Self { name: format!("test {}", trial.index), trial, replay, end, message, expected: None }
    }

    fn junit(&self, study: &Study) -> TestCase {
        let Self { name, trial, replay, expected, .. } = self;
        let mut case = TestCase::new(name.as_str(), self.status());
        case.set_classname(match study.subject() {
            Subject::Scenario(simulation) => simulation.scenario(),
            Subject::System(_) => "system",
        });
        for (name, value) in trial.test.iter() {
            case.add_property((format!("parameter.{name}").as_str(), value.to_string().as_str()));
        }
        for id in trial.requirements() {
            let became = match trial.robustness(id) {
                None => "undecided",
                Some(_) if trial.violates(id) => "violated",
                Some(_) => "holds",
            };
            case.add_property((format!("requirement.{id}").as_str(), became));
        }
        if let Subject::Scenario(simulation) = study.subject() {
            // Milliseconds are precise enough, and hide the rounding errors of summed ticks.
            let seconds = format!("{:.3}", trial.ticks as f64 * simulation.dt());
            case.add_property(("simulated_seconds", seconds.as_str()));
        }
        if let Some(expected) = expected {
            case.add_property(("expected", *expected));
        }
        case.add_property(("replay", replay.as_str()));
        case
    }

    /// Returns the JUnit status of the test case. An attribute cannot have several lines, so the attribute holds the
    /// first line of the message, and the description holds the whole message.
    fn status(&self) -> TestCaseStatus {
        let message = &self.message;
        let (kind, word) = match self.end {
            End::Passed => return TestCaseStatus::success(),
            End::Skipped => {
                let mut status = TestCaseStatus::skipped();
                status.set_message(message.as_str());
                return status;
            }
            End::Failed => (NonSuccessKind::Failure, self.trial.violated().collect::<Vec<_>>().join(" ")),
            End::Error => (NonSuccessKind::Error, "error".to_owned()),
        };
        let mut status = TestCaseStatus::non_success(kind);
        status.set_type(word).set_message(first_line(message)).set_description(format!("{message}\n{}", self.replay));
        status
    }
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// Returns the requirements that a trial violates, with the robustness of each.
fn violations(study: &Study, trial: &Trial) -> String {
    let violation = |id: &str| {
        let unit = study.requirement(id).map_or("", |requirement| requirement.unit.as_str());
        format!("{id} {} {unit}", trial.robustness(id).unwrap_or(f64::NAN)).trim_end().to_owned()
    };
    trial.violated().map(violation).collect::<Vec<_>>().join(", ")
}

/// Returns a word of a shell command, in quotes if necessary.
pub fn shell_word(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,@+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Returns the options that repeat the commands of a study, each after a space, or the option that trusts the address of
/// its driver or the file of its scenario. The text is empty if the study has none of them. Without the options, the programs do not run
/// the commands and the files that a folder or a file names, and send nothing to the address.
pub fn command_option(study: &Study) -> String {
    let runs_a_file = study.subject().scenario().is_ok_and(paracosm_campaign::study::Simulation::runs_a_file);
    if study.address().is_some() || runs_a_file {
        return " --trust".to_owned();
    }
    study.commands().iter().map(|named| format!(" {} {}", named.option, shell_word(named.command))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_split_them() {
        assert_eq!(shell_word("out/run-1"), "out/run-1");
        assert_eq!(shell_word("my out"), "'my out'");
        assert_eq!(shell_word("it's"), "'it'\\''s'");
    }
}
