//! Suspect and located combinations of discrete values in the summary of a campaign.

use super::output::{Table, plural};
use crate::Report;
use crate::space::{Values, values_in_words};
use paracosm_analysis::{Conclusion, LocatedReport, Location, SuspectReport, Unexplained};
use paracosm_oracles::Verdict;
use std::cmp::Reverse;
use std::fmt;

/// The number of suspects in a table.
const SHOWN: usize = 5;

/// The number of located combinations in a table.
const LOCATED_SHOWN: usize = 10;

/// Adds suspects and located combinations to a summary as JSON.
pub(super) fn add_to(summary: &mut serde_json::Value, report: &Report) {
    if let Some(suspects) = &report.suspects {
        summary["suspects"] = serde_json::json!(suspects);
    }
    if let Some(located) = &report.located {
        summary["located"] = serde_json::json!(located);
    }
}

/// Adds suspects and located combinations to a table. `asked` is true if the user asked to locate combinations.
pub(super) fn show(table: &mut Table, report: &Report, asked: bool) {
    if let Some(suspects) = &report.suspects {
        show_suspects(suspects, table);
    }
    match &report.located {
        Some(located) => show_located(located, table),
        None if asked => table.row("located", "nothing: locating needs a failing test and a passing test"),
        None => (),
    }
}

fn show_suspects(suspects: &SuspectReport, table: &mut Table) {
    for (i, suspect) in suspects.ranked.iter().take(SHOWN).enumerate() {
        let all = match suspect.failures {
            1 => "the only test with these values failed".to_owned(),
            count => format!("all {count} tests with these values failed"),
        };
        table.row(if i == 0 { "suspects" } else { "" }, &format!("{}: {all}", values_in_words(&suspect.values)));
    }
    let more = suspects.found.saturating_sub(SHOWN as u64);
    if more > 0 {
        let more = plural(more as usize, "more combination");
        table.row("", &format!("and {more} of at most {}", plural(suspects.size, "value")));
    }
    let few = suspects.explanation.len();
    if few > 0 && (few as u64) < suspects.found {
        let shown: Vec<String> =
            suspects.explanation.iter().take(SHOWN).map(|suspect| values_in_words(&suspect.values)).collect();
        let more = if few > SHOWN { format!("; and {} more", few - SHOWN) } else { String::new() };
        table.row("  explained by", &format!("{}{more}", shown.join("; ")));
    }
    let unexplained = suspects.unexplained.len();
    if unexplained > 0 {
        let combination = match suspects.size {
            1 => "single value".to_owned(),
            size => format!("combination of up to {size} values"),
        };
        let message = format!("no {combination} explains {}", plural(unexplained, "failure"));
        table.row(if few == 0 { "suspects" } else { "  unexplained" }, &message);
    }
}

fn show_located(located: &LocatedReport, table: &mut Table) {
    let guilty = |location: &&Location| location.conclusion == Conclusion::Guilty;
    let mut found: Vec<&Location> = located.locations.iter().filter(guilty).collect();
    found.sort_by_key(|location| Reverse(location.explains.len()));
    let more = found.len().saturating_sub(LOCATED_SHOWN);
    let lines =
        found.into_iter().take(LOCATED_SHOWN).map(in_words).chain((more > 0).then(|| format!("and {more} more")));
    rows("located", lines, "nothing", table);
    table.row("  further tests", &format!("{} run, of at most {}", located.ran, located.limit));
    // Failures that are unexplained for the same reason share a line.
    let mut reasons: Vec<(Reason, Vec<usize>)> = Vec::new();
    for Unexplained { failing, why } in &located.unexplained {
        let reason = Reason::of(located, *failing, why);
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, failures)) => failures.push(*failing),
            None => reasons.push((reason, vec![*failing])),
        }
    }
    if !reasons.is_empty() {
        let more = reasons.len().saturating_sub(SHOWN);
        let lines =
            reasons.iter().take(SHOWN).map(|(reason, failures)| format!("{}: {reason}", list("test", failures)));
        rows(
            "  unexplained",
            lines.chain((more > 0).then(|| format!("and {}", plural(more, "more reason")))),
            "",
            table,
        );
    }
}

/// Adds lines under one label, or the word `none` if there are no lines.
fn rows(label: &str, lines: impl Iterator<Item = String>, none: &str, table: &mut Table) {
    let mut lines = lines.peekable();
    if lines.peek().is_none() {
        table.row(label, none);
    }
    for (i, line) in lines.enumerate() {
        table.row(if i == 0 { label } else { "" }, &line);
    }
}

/// A guilty combination, with what it explains and what it took.
fn in_words(location: &Location) -> String {
    let Location { values, undivided, explains, starting, confirming, restarts, bound, tests, .. } = location;
    let mut text = format!("{}: behind {}", values_in_words(values), plural(explains.len(), "failure"));
    if undivided.iter().next().is_some() {
        text.push_str(&format!("; constraints keep {} from being told apart", values_in_words(undivided)));
    }
    let mut ran = plural(tests.len() - starting - confirming, "test");
    match bound {
        Some(bound) => ran.push_str(&format!(" of at most {bound}")),
        None if *restarts > 0 => ran.push_str(", no bound where several combinations are guilty"),
        None => ran.push_str(", no bound under these constraints"),
    }
    let others = [(*starting, "to start from"), (*confirming, "to confirm")];
    let others = others.into_iter().filter(|(tests, _)| *tests > 0);
    let others: String = others.map(|(tests, what)| format!(", {tests} {what}")).collect();
    format!("{text} ({ran}{others})")
}

/// The reason why a failure has no guilty combination. Failures with equal reasons share a line.
#[derive(PartialEq)]
enum Reason<'a> {
    /// Tests with these values passed.
    Refuted {
        values: Option<&'a Values>,
        passed: usize,
    },
    NoStart,
    NoPassingTest,
    Undecided(Verdict),
    LimitReached,
}

impl<'a> Reason<'a> {
    fn of(located: &'a LocatedReport, failing: usize, why: &Conclusion) -> Self {
        match why {
            Conclusion::Refuted { trials, further } => {
                let of_it = located.locations.iter().rev().find(|location| location.failing == failing);
                Self::Refuted { values: of_it.map(|location| &location.values), passed: trials.len() + further }
            }
            Conclusion::NoStart(_) => Self::NoStart,
            Conclusion::NoPassingTest => Self::NoPassingTest,
            Conclusion::Undecided(verdict) => Self::Undecided(*verdict),
            Conclusion::LimitReached => Self::LimitReached,
            Conclusion::Guilty => unreachable!("a guilty combination explains its failure"),
        }
    }
}

impl fmt::Display for Reason<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refuted { values, passed } => write!(
                f,
                "changing {} makes tests pass, but {} with these values passed, too: the values alone are no cause",
                values.map(values_in_words).unwrap_or_default(),
                plural(*passed, "test")
            ),
            Self::NoStart => f.write_str("with the discrete values of a passing test, this test fails, too"),
            Self::NoPassingTest => f.write_str("all passing tests have the same discrete values"),
            Self::Undecided(verdict) => write!(f, "a further test ended with the verdict {verdict}"),
            Self::LimitReached => f.write_str("the limit of further tests was reached; --locate=N allows more"),
        }
    }
}

/// Lists the first indices.
fn list(what: &str, indices: &[usize]) -> String {
    let shown: Vec<String> = indices.iter().take(SHOWN).map(ToString::to_string).collect();
    let more = if indices.len() > SHOWN { format!(" and {} more", indices.len() - SHOWN) } else { String::new() };
    format!("{what}{} {}{more}", if indices.len() == 1 { "" } else { "s" }, shown.join(", "))
}
