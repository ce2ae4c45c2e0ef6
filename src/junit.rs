//! Trials as JUnit writes its tests down, which CI systems read.
//!
//! There is no standard, but one shape that all of them know: `testsuites`, in it a `testsuite` for each study and in that
//! a `testcase` for each trial, with `failure`, `error` or `skipped` where it did not pass. Properties say what JUnit has no
//! words for: requirements, parameters, the simulated seconds, the command that runs a test again. There is no `time`: readers
//! take it for what a test took, which differs from run to run.

use crate::{Study, Subject, Trial};
use paracosm_oracles::Verdict;
use std::fmt::Write;

/// Trials of a study.
pub struct Suite<'a> {
    /// What it is called.
    pub name: String,
    /// Their study.
    pub study: &'a Study,
    /// The trials.
    pub cases: Vec<Case<'a>>,
}

/// A trial as a test case.
pub struct Case<'a> {
    /// What it is called: no other of its suites is called so.
    pub name: String,
    /// The trial.
    pub trial: &'a Trial,
    /// The command that runs it again.
    pub replay: String,
    /// How it ends as a test case.
    pub end: End,
    /// What was expected of it, if that is not that it passes.
    pub expected: Option<&'static str>,
}

/// How a test case ends, with what there is to be said of that.
pub enum End {
    /// As it should.
    Passed,
    /// It is what CI has to stop for.
    Failed(String),
    /// It came to nothing.
    Error(String),
    /// It says nothing either way.
    Skipped(String),
}

impl<'a> Case<'a> {
    /// A trial of a campaign, which ends as its verdict says.
    pub fn of(study: &Study, trial: &'a Trial, replay: String) -> Self {
        let error = trial.error.as_deref().unwrap_or_default();
        let end = match trial.verdict {
            Verdict::Pass => End::Passed,
            Verdict::Fail => End::Failed(violations(study, trial)),
            Verdict::Error => End::Error(error.to_owned()),
            Verdict::Inconclusive => End::Skipped(
                "inconclusive: the situation that the test is about never came about, or it ended too early".to_owned(),
            ),
            Verdict::Invalid => End::Skipped(format!("invalid: {error}")),
        };
        Self { name: format!("test {}", trial.index), trial, replay, end, expected: None }
    }
}

/// The contents of a file with these suites.
pub fn document(suites: &[Suite]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
    let cases = || suites.iter().flat_map(|suite| &suite.cases);
    let _ = writeln!(text, "<testsuites name=\"paracosm\"{}>", counts(cases()));
    for suite in suites {
        suite.write(&mut text);
    }
    text.push_str("</testsuites>\n");
    text
}

impl Suite<'_> {
    fn write(&self, text: &mut String) {
        let counts = counts(self.cases.iter());
        let _ = writeln!(text, "  <testsuite name=\"{}\"{counts}>", escaped(&self.name));
        properties(text, "    ", &self.properties());
        for case in &self.cases {
            self.write_case(text, case);
        }
        text.push_str("  </testsuite>\n");
    }

    /// What is said of all tests.
    fn properties(&self) -> Vec<(String, String)> {
        let study = self.study;
        let mut all = vec![("strategy".to_owned(), study.strategy_label())];
        let fixed = study.subject.fixed().iter();
        all.extend(fixed.map(|(name, value)| (format!("parameter.{name}"), value.to_string())));
        for requirement in &study.requirements {
            let said = [
                ("", Some(&requirement.text)),
                (".formula", Some(&requirement.formula)),
                (".source", requirement.source.as_ref()),
                (".severity", requirement.severity.as_ref()),
            ];
            let said = said.into_iter().filter_map(|(what, text)| Some((what, text.filter(|text| !text.is_empty())?)));
            all.extend(said.map(|(what, text)| (format!("requirement.{}{what}", requirement.id), text.clone())));
        }
        all
    }

    fn write_case(&self, text: &mut String, Case { name, trial, replay, end, expected }: &Case) {
        let class = match &self.study.subject {
            Subject::Scenario(simulation) => simulation.scenario.as_str(),
            Subject::System(_) => "system",
        };
        let (class, name) = (escaped(class), escaped(name));
        let _ = writeln!(text, "    <testcase classname=\"{class}\" name=\"{name}\">");
        let mut all: Vec<(String, String)> =
            trial.test.iter().map(|(name, value)| (format!("parameter.{name}"), value.to_string())).collect();
        let became = |id: &str| match trial.robustness(id) {
            None => "undecided",
            Some(_) if trial.violates(id) => "violated",
            Some(_) => "holds",
        };
        all.extend(trial.requirements().map(|id| (format!("requirement.{id}"), became(id).to_owned())));
        // Milliseconds are enough, and hide how ticks add up.
        all.extend(self.seconds(trial).map(|seconds| ("simulated_seconds".to_owned(), format!("{seconds:.3}"))));
        all.extend(expected.map(|expected| ("expected".to_owned(), expected.to_owned())));
        all.push(("replay".to_owned(), replay.clone()));
        properties(text, "      ", &all);
        let replay = escaped(replay);
        let _ = match end {
            End::Passed => Ok(()),
            End::Failed(message) => {
                let kind = escaped(&trial.violated().collect::<Vec<_>>().join(" "));
                let message = escaped(message);
                writeln!(text, "      <failure type=\"{kind}\" message=\"{message}\">{replay}</failure>")
            }
            End::Error(message) => {
                let message = escaped(message);
                writeln!(text, "      <error type=\"error\" message=\"{message}\">{replay}</error>")
            }
            End::Skipped(message) => writeln!(text, "      <skipped message=\"{}\"/>", escaped(message)),
        };
        text.push_str("    </testcase>\n");
    }

    /// How long a trial of a scenario was, in simulated seconds; of a system only the system knows.
    fn seconds(&self, trial: &Trial) -> Option<f64> {
        match &self.study.subject {
            Subject::Scenario(simulation) => Some(trial.ticks as f64 * simulation.dt()),
            Subject::System(_) => None,
        }
    }
}

/// What a trial violates, and by how much.
fn violations(study: &Study, trial: &Trial) -> String {
    let violation = |id: &str| {
        let unit = study.requirement(id).map_or("", |requirement| requirement.unit.as_str());
        format!("{id} {} {unit}", trial.robustness(id).unwrap_or(f64::NAN)).trim_end().to_owned()
    };
    trial.violated().map(violation).collect::<Vec<_>>().join(", ")
}

/// The attributes that count test cases.
fn counts<'a>(cases: impl Iterator<Item = &'a Case<'a>> + Clone) -> String {
    let count = |ends: fn(&End) -> bool| cases.clone().filter(|case| ends(&case.end)).count();
    let failures = count(|end| matches!(end, End::Failed(_)));
    let errors = count(|end| matches!(end, End::Error(_)));
    let skipped = count(|end| matches!(end, End::Skipped(_)));
    let tests = cases.clone().count();
    format!(" tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\" skipped=\"{skipped}\"")
}

fn properties(text: &mut String, indent: &str, all: &[(String, String)]) {
    let _ = writeln!(text, "{indent}<properties>");
    for (name, value) in all {
        let (name, value) = (escaped(name), escaped(value));
        let _ = writeln!(text, "{indent}  <property name=\"{name}\" value=\"{value}\"/>");
    }
    let _ = writeln!(text, "{indent}</properties>");
}

/// A text as XML 1.0 holds it, in an attribute or between tags; signs that it cannot hold become U+FFFD.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // In an attribute they would be read as spaces.
            '\t' | '\n' | '\r' => {
                let _ = write!(escaped, "&#{};", u32::from(sign));
            }
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            sign => escaped.push(sign),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn what_xml_cannot_hold_as_it_is_is_escaped() {
        assert_eq!(escaped("a < b && \"c\" > 'd'"), "a &lt; b &amp;&amp; &quot;c&quot; &gt; 'd'");
        assert_eq!(escaped("one\ntwo\tthree\r\u{7}\u{0}é"), "one&#10;two&#9;three&#13;\u{fffd}\u{fffd}é");
    }
}
