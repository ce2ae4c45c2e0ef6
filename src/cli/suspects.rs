//! Suspect and located combinations of discrete values, in a campaign's summary.

use super::output::{Table, digits, json};
use crate::coverage::{Value, Values};
use crate::oracles::Verdict;
use crate::{Campaign, Conclusion, Error, Folder, Located, Location, Study, Suspects, Trial};

/// How many suspects a table shows.
const SHOWN: usize = 5;

/// What is known of the combinations behind a campaign's failures.
pub(super) struct Guilt {
    suspects: Option<Suspects>,
    located: Option<Located>,
}

impl Guilt {
    /// Finds the suspects and, if that was asked for, locates the guilty: with further tests, written to
    /// `located.json` in the folder.
    pub fn of(study: &Study, trials: &[Trial], folder: Option<&Folder>) -> Result<Self, Error> {
        if study.space.levels().is_empty() {
            return Ok(Self { suspects: None, located: None });
        }
        let suspects = Suspects::of(study, trials)?;
        let located = folder.map(|folder| locate(study, trials, folder)).transpose()?.flatten();
        Ok(Self { suspects, located })
    }

    /// Adds what is known to the summary as JSON.
    pub fn add_to(&self, summary: &mut serde_json::Value) {
        if let Some(suspects) = &self.suspects {
            summary["suspects"] = serde_json::json!(suspects);
        }
        if let Some(located) = &self.located {
            summary["located"] = serde_json::json!(located);
        }
    }

    /// The rows of the summary.
    pub fn show(&self, table: &mut Table) {
        if let Some(suspects) = &self.suspects {
            show_suspects(suspects, table);
        }
        if let Some(located) = &self.located {
            for (i, location) in located.locations.iter().enumerate() {
                table.row(if i == 0 { "located" } else { "" }, &in_words(location));
            }
            let unexplained = located.unexplained.len();
            if unexplained > 0 {
                table.row("  unexplained", &plural(unexplained, "failure"));
            }
        }
    }
}

fn locate(study: &Study, trials: &[Trial], folder: &Folder) -> Result<Option<Located>, Error> {
    let campaign = Campaign::new(study)?;
    let mut next = trials.len();
    let located = Located::of(study, trials, |test| {
        let mut verdict = Verdict::Error;
        campaign.run_tests(std::slice::from_ref(test), next, |trial| {
            verdict = trial.verdict;
            Ok(())
        })?;
        next += 1;
        Ok(verdict)
    })?;
    if let Some(located) = &located {
        folder.write("located.json", json(located).as_bytes())?;
    }
    Ok(located)
}

fn show_suspects(suspects: &Suspects, table: &mut Table) {
    for (i, suspect) in suspects.ranked.iter().take(SHOWN).enumerate() {
        let all = if suspect.failures == 1 {
            "the one test failed".into()
        } else {
            format!("all {} tests failed", suspect.failures)
        };
        table.row(if i == 0 { "suspects" } else { "" }, &format!("{}: {all}", names(&suspect.values)));
    }
    let more = suspects.found.saturating_sub(SHOWN as u64);
    if more > 0 {
        table.row("", &format!("and {more} more combinations of at most {} values", suspects.size));
    }
    let few = suspects.explanation.len();
    if few > 0 && (few as u64) < suspects.found {
        let shown: Vec<String> =
            suspects.explanation.iter().take(SHOWN).map(|suspect| names(&suspect.values)).collect();
        let more = if few > SHOWN { format!("; and {} more", few - SHOWN) } else { String::new() };
        table.row("  explained by", &format!("{}{more}", shown.join("; ")));
    }
    let unexplained = suspects.unexplained.len();
    if unexplained > 0 {
        let values = if suspects.size == 1 { "value" } else { "values" };
        let message =
            format!("{} without a suspect of at most {} {values}", plural(unexplained, "failure"), suspects.size);
        table.row(if few == 0 { "suspects" } else { "  unexplained" }, &message);
    }
}

fn in_words(location: &Location) -> String {
    let Location { failing, conclusion, values, undivided, starting, restarts, bound, tests } = location;
    let values = names(values);
    let mut text = match conclusion {
        Conclusion::Guilty => values,
        Conclusion::Refuted(passed) => {
            format!(
                "{values} makes test {failing} fail, but {} with these values passed: they are no cause by themselves",
                list("test", passed)
            )
        }
        Conclusion::NoStart(passed) => {
            let them = list("test", passed);
            format!("nothing: test {failing} fails with the discrete values of {them} too, which passed")
        }
        Conclusion::NoPassingTest => format!("nothing: no test with other discrete values than test {failing} passed"),
        Conclusion::Undecided(verdict) => format!("nothing: a test on the way from test {failing} ended {verdict}"),
    };
    if undivided.iter().next().is_some() {
        text.push_str(&format!("; constraints keep {} from being told apart", names(undivided)));
    }
    let mut ran = plural(tests.len() - starting, "test");
    match bound {
        Some(bound) => ran.push_str(&format!(", at most {bound}")),
        None if *restarts > 0 => ran.push_str(", no bound where several combinations are guilty"),
        None if location.values.iter().next().is_some() => ran.push_str(", no bound under these constraints"),
        None => (),
    }
    let start = if *starting > 0 { format!(" and {starting} to start from") } else { String::new() };
    format!("{text} ({ran}{start})")
}

/// Values with their parameters.
fn names(values: &Values) -> String {
    let value = |value: &Value| value.number().map_or_else(|| value.to_string(), digits);
    values.iter().map(|(name, of)| format!("{name} {}", value(of))).collect::<Vec<_>>().join(", ")
}

/// Some indices, not too many.
fn list(what: &str, indices: &[usize]) -> String {
    let shown: Vec<String> = indices.iter().take(SHOWN).map(ToString::to_string).collect();
    let more = if indices.len() > SHOWN { format!(" and {} more", indices.len() - SHOWN) } else { String::new() };
    format!("{what}{} {}{more}", if indices.len() == 1 { "" } else { "s" }, shown.join(", "))
}

fn plural(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
