//! Results of a campaign in words and small tables, for its page.

use crate::Report;
use crate::analysis::sensitivity::{Indices, Sensitivity, of_model};
use crate::analysis::{Effects, Inconclusive};
use crate::campaign::Log;
use crate::report::html::{Finding, FindingTable};
use crate::space::{plural, values_in_words};
use serde_json::Value;
use std::cmp::Reverse;

/// The number of rows of a table.
const ROWS: usize = 10;

/// Returns what the tests themselves show: the explanation of failures, inconclusive tests, parameters without effect, and points.
pub(crate) fn of_tests(report: &Report) -> Vec<Finding> {
    let explanation = report
        .explanation
        .iter()
        .flat_map(|explanation| explanation.rules_in_words().into_iter().chain([explanation.trust_in_words()]));
    let points = report.points.iter().map(|points| format!("{} ({})", points.in_words(), points.protocol));
    let all = [
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
pub(crate) fn sensitivity(log: &Log) -> Option<Finding> {
    if log.study().space().parameters().len() < 2 {
        return None;
    }
    let Sensitivity { failure, notes, .. } = of_model(log, 0).ok()?;
    let row =
        |indices: &Indices| vec![indices.name.clone(), indices.first_order.to_string(), indices.total.to_string()];
    let rows: Vec<_> = failure.parameters.iter().map(row).collect();
    let mut lines = vec![
        "Shares of the variance of the probability of failure (Sobol indices), by the model of the failures, with 95 % intervals.".to_owned(),
    ];
    lines.extend(notes);
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

fn table(head: &[&str], rows: Vec<Vec<String>>) -> FindingTable {
    FindingTable { head: head.iter().map(|title| (*title).to_owned()).collect(), rows }
}
