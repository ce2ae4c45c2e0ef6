//! Results of a campaign in words and small tables, for its page.

use crate::Report;
use crate::analysis::sensitivity::{Indices, Sensitivity, of_model};
use crate::analysis::{Effects, Inconclusive};
use crate::report::html::{Finding, FindingTable};
use crate::space::{digits, plural, values_in_words};
use serde_json::Value;
use std::cmp::Reverse;

/// The number of rows of a table.
const ROWS: usize = 10;

/// Returns what the tests themselves show: doubts about programs, the explanation of failures, inconclusive tests, parameters without effect, and points.
pub(crate) fn of_tests(report: &Report) -> Vec<Finding> {
    let explanation = report
        .explanation
        .iter()
        .flat_map(|explanation| explanation.rules_in_words().into_iter().chain([explanation.trust_in_words()]));
    let points = report.points.iter().map(|points| format!("{} ({})", points.in_words(), points.protocol));
    let all = [
        ("doubts", report.doubts.clone()),
        ("explanation", explanation.collect::<Vec<String>>()),
        ("inconclusive", report.inconclusive.iter().flat_map(Inconclusive::in_words).collect()),
        ("no effect", report.effects.iter().flat_map(Effects::in_words).collect()),
        ("points on this grid", points.collect()),
    ];
    let said = all.into_iter().filter(|(_, lines)| !lines.is_empty());
    said.map(|(label, lines)| Finding { label, lines, table: None }).collect()
}

/// Returns the combinations of discrete values that only failing tests have; `None` if there are none.
pub(crate) fn suspects(report: &Report) -> Option<Finding> {
    let suspects = report.suspects.as_ref().filter(|suspects| suspects.found > 0)?;
    let row = |suspect: &crate::analysis::NamedSuspect| {
        vec![values_in_words(&suspect.values), plural(suspect.failures, "test")]
    };
    let mut lines = vec!["Every test with these values failed.".to_owned()];
    if suspects.found > ROWS as u64 {
        lines.push(format!("{} of {} combinations are shown.", ROWS.min(suspects.ranked.len()), suspects.found));
    }
    let unexplained = suspects.unexplained.len();
    if unexplained > 0 {
        lines.push(format!("No combination explains {}.", plural(unexplained, "failure")));
    }
    let rows = suspects.ranked.iter().take(ROWS).map(row).collect();
    Some(Finding { label: "suspects", lines, table: Some(table(&["values", "failing"], rows)) })
}

/// Returns the shares of the variance of the probability of failure that the parameters explain, by the model of the failures; `None` if no
/// model fits, if there is one parameter, or if parameters depend on each other.
///
/// Parameters without effect are left out. Their shares say how far the model is off.
pub(crate) fn sensitivity(report: &Report) -> Option<Finding> {
    if report.log.study().space().parameters().len() < 2 {
        return None;
    }
    let Sensitivity { failure, notes, .. } = of_model(&report.log, 0).ok()?;
    let no_effect: Vec<&str> =
        report.effects.iter().flat_map(|effects| effects.without_effect().map(|(name, _)| name)).collect();
    let (without, with): (Vec<_>, Vec<_>) =
        failure.parameters.into_iter().partition(|indices| no_effect.contains(&indices.name.as_str()));
    let row =
        |indices: &Indices| vec![indices.name.clone(), indices.first_order.to_string(), indices.total.to_string()];
    let rows: Vec<_> = with.iter().map(row).collect();
    let mut lines = vec![
        "Shares of the variance of the probability of failure (Sobol indices), by the model of the failures, with 95 % intervals.".to_owned(),
    ];
    lines.extend(notes);
    if let Some(most) = without.iter().max_by(|a, b| a.total.estimate.total_cmp(&b.total.estimate)) {
        let names = without.iter().map(|indices| indices.name.as_str()).collect::<Vec<_>>().join(", ");
        let share = format!("{:.3}", most.total.estimate);
        lines.push(format!("Left out, because they had no effect: {names}. The model gives {} a total share of {share}, which is its error.", most.name));
    }
    let head = ["parameter", "alone (first order)", "in all (total)"];
    (!rows.is_empty()).then(|| Finding { label: "sensitivity", lines, table: Some(table(&head, rows)) })
}

/// Returns the results of `blame`, from its file; `None` if no test failed.
pub(crate) fn blame(file: &Value) -> Option<Finding> {
    let counts = |of: &str| -> Option<Vec<(String, u64)>> {
        let counts = file.get(of)?.as_object()?.iter();
        Some(counts.filter_map(|(name, count)| Some((name.clone(), count.as_u64()?))).collect())
    };
    let (faults, prevents) = (counts("faults")?, counts("prevents")?);
    let failures: u64 = faults.iter().map(|(_, count)| count).sum();
    if failures == 0 {
        return None;
    }
    let said = faults.iter().filter(|(_, count)| *count > 0).map(|(fault, count)| format!("{count} {fault}"));
    let lines = vec![format!("{}: {}.", plural(failures as usize, "failure"), said.collect::<Vec<_>>().join(", "))];
    let mut prevents = prevents;
    prevents.sort_by_key(|(_, count)| Reverse(*count));
    let rows = prevents.into_iter().map(|(driver, count)| vec![driver, count.to_string()]).collect();
    Some(Finding {
        label: "blame",
        lines,
        table: Some(table(&["reference driver", "failures that it prevents"], rows)),
    })
}

/// Returns the combinations of values that further tests found guilty, from their file; `None` if there are none.
pub(crate) fn located(file: &Value) -> Option<Finding> {
    let guilty = |location: &&Value| location.get("conclusion").and_then(Value::as_str) == Some("guilty");
    let row = |location: &Value| {
        let values = location.get("values")?.as_object()?.iter();
        let values = values
            .map(|(name, value)| format!("{name} {}", value.as_str().map_or_else(|| value.to_string(), str::to_owned)));
        let explains = location.get("explains")?.as_array()?.len();
        Some(vec![values.collect::<Vec<_>>().join(", "), plural(explains, "failure")])
    };
    let locations = file.get("locations")?.as_array()?.iter().filter(guilty);
    let rows: Vec<_> = locations.filter_map(row).take(ROWS).collect();
    let lines = vec!["Further tests showed that these values make tests fail.".to_owned()];
    (!rows.is_empty()).then(|| Finding { label: "located", lines, table: Some(table(&["values", "behind"], rows)) })
}

/// Returns what suites of tests would have missed, from the file of an audit.
pub(crate) fn audit(file: &Value) -> Option<Finding> {
    let others = file.get("others").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let suites: Vec<Audited> = std::iter::once(file).chain(others).filter_map(Audited::of).collect();
    let lines = suites.iter().flat_map(Audited::lines).collect();
    let head = ["suite", "tests", "largest hole", "mutation score"];
    let rows: Vec<_> = suites.iter().map(Audited::row).collect();
    (!rows.is_empty()).then(|| Finding { label: "audit", lines, table: Some(table(&head, rows)) })
}

/// A suite in the file of an audit.
struct Audited<'a> {
    file: &'a Value,
    name: &'a str,
    tests: usize,
}

impl<'a> Audited<'a> {
    fn of(file: &'a Value) -> Option<Self> {
        Some(Self { file, name: file.get("suite")?.as_str()?, tests: count(file, "tests")? })
    }

    /// The part of the file with a name; `None` if the audit found nothing of this kind.
    fn part(&self, name: &str) -> Option<&'a Value> {
        self.file.get(name).filter(|part| !part.is_null())
    }

    fn row(&self) -> Vec<String> {
        let score = self.part("mutants").and_then(|mutants| {
            let (killed, counted) = (count(mutants, "killed")?, count(mutants, "counted")?);
            let share = share(mutants.get("mutation_score")?)?;
            Some(format!("{share}: {killed} of {counted}"))
        });
        let hole = self.part("hole").and_then(bracket);
        vec![self.name.to_owned(), self.tests.to_string(), hole.unwrap_or_default(), score.unwrap_or_default()]
    }

    fn lines(&self) -> Vec<String> {
        let Self { name, tests, .. } = self;
        let witness = self.part("witness").and_then(|witness| {
            let sides = witness.get("box")?.as_object()?.iter().filter_map(|(name, ends)| {
                Some(format!("{name} {}..{}", digits(ends.get(0)?.as_f64()?), digits(ends.get(1)?.as_f64()?)))
            });
            let row = witness.get("row")?.as_object()?.iter();
            let row = row.map(|(name, value)| format!("{name} {}", value.as_str().map_or_else(|| value.to_string(), str::to_owned)));
            let place = sides.chain(row).collect::<Vec<_>>().join(", ");
            let (failing, tried) = (count(witness, "failing")?, count(witness, "tried")?);
            Some(format!(
                "{name}: a driver that does not brake where {place} gets the same verdicts as the given driver in the {tests} tests, and fails in {failing} of {} there.",
                plural(tried, "test")
            ))
        });
        let additions = self.part("additions").and_then(|additions| {
            let missed = count(additions, "missed").filter(|missed| *missed > 0)?;
            let more = additions.get("tests")?.as_array()?.len();
            Some(format!("{name} misses {}; {} kill them.", plural(missed, "mutant"), plural(more, "more test")))
        });
        let better = self.part("better").and_then(|better| {
            let (fewer, hole) = (count(better, "tests")?, bracket(better.get("hole")?)?);
            let score = better.get("mutation_score").and_then(share);
            let score = score.map(|score| format!(" and the mutation score {score}")).unwrap_or_default();
            Some(format!("{name}: there is a suite of {} with the largest hole {hole}{score}.", plural(fewer, "test")))
        });
        [witness, additions, better].into_iter().flatten().collect()
    }
}

fn count(of: &Value, name: &str) -> Option<usize> {
    of.get(name)?.as_u64().map(|count| count as usize)
}

/// Returns the bracket of a volume in words.
fn bracket(of: &Value) -> Option<String> {
    let [lower, upper] = ["lower", "upper"].map(|end| of.get(end).and_then(Value::as_f64));
    let (lower, upper) = (lower?, upper?);
    Some(if lower == upper { digits(lower) } else { format!("{}..{}", digits(lower), digits(upper)) })
}

/// Returns a share with its interval, in percent.
fn share(of: &Value) -> Option<String> {
    let [value, lower, upper] = ["value", "lower", "upper"].map(|end| of.get(end).and_then(Value::as_f64));
    Some(format!("{:.1} % ({:.1} % to {:.1} %)", 100.0 * value?, 100.0 * lower?, 100.0 * upper?))
}

fn table(head: &[&str], rows: Vec<Vec<String>>) -> FindingTable {
    FindingTable { head: head.iter().map(|title| (*title).to_owned()).collect(), rows }
}
