//! The elements of the standards of roads and of scenarios: read, without effect, or refused, and the test of each.

use super::super::output::json;
use super::Form;
use crate::standards::{Support, Supported};
use serde_json::json;
use std::collections::BTreeMap;

/// The page of a standard, which the tests of its elements write.
pub(super) struct Page {
    text: &'static str,
    /// The folder of the tests.
    folder: &'static str,
}

/// The page of the standard of roads.
pub(super) const ROADS: Page =
    Page { text: include_str!("../../../docs/opendrive.md"), folder: "standards/tests/roads/" };
/// The page of the standard of scenarios.
pub(super) const SCENARIOS: Page =
    Page { text: include_str!("../../../docs/openscenario.md"), folder: "standards/tests/scenarios/" };

impl Page {
    /// Returns the files of the tests of elements, by the names of the element and of the element around it.
    fn tests(&self) -> BTreeMap<(&'static str, &'static str), String> {
        let row = |line: &'static str| {
            let cells: Vec<&str> = line.strip_prefix("| ")?.strip_suffix(" |")?.split(" | ").collect();
            let [name, parent, .., file] = cells[..] else { return None };
            let [name, parent, file] = [name, parent, file].map(|cell| cell.trim_matches('`'));
            let parent = if parent == "any element" { "*" } else { parent };
            Some(((name, parent), format!("{}{file}", self.folder)))
        };
        self.text.lines().filter_map(row).collect()
    }
}

/// Returns the table of the elements of a standard, in the given form.
pub(super) fn standard(elements: impl Iterator<Item = Supported>, page: &Page, form: Form) -> String {
    let tests = page.tests();
    let rows: Vec<Row<'_>> = elements
        .map(|Supported { name, parent, support, .. }| {
            let test = tests.get(&(name, parent)).map_or("", String::as_str);
            Row { name, parent, test, support: words(support) }
        })
        .collect();
    match form {
        Form::Json => {
            let row = |row: &Row<'_>| {
                let (support, reason) = row.support;
                json!({"element": row.name, "within": row.parent, "support": support, "reason": reason, "test": row.test})
            };
            json(&rows.iter().map(row).collect::<Vec<_>>())
        }
        Form::Table => {
            let widest = |of: fn(&Row<'_>) -> usize| rows.iter().map(of).max().unwrap_or(0) + 2;
            let (name, parent, test) =
                (widest(|row| row.name.len()), widest(|row| row.parent.len()), widest(|row| row.test.len()));
            let line = |row: &Row<'_>| {
                format!("{:<name$}{:<parent$}{:<test$}{}\n", row.name, row.parent, row.test, said(row.support))
            };
            rows.iter().map(line).collect()
        }
        Form::Markdown => {
            let line = |row: &Row<'_>| {
                format!("| `{}` | `{}` | {} | `{}` |\n", row.name, row.parent, said(row.support), row.test)
            };
            let head = "| element | within | support | test |\n| --- | --- | --- | --- |\n".to_owned();
            head + &rows.iter().map(line).collect::<String>()
        }
    }
}

/// An element with the names of the element around it and of the file of its test.
struct Row<'a> {
    name: &'static str,
    parent: &'static str,
    test: &'a str,
    support: (&'static str, Option<&'static str>),
}

fn words(support: Support) -> (&'static str, Option<&'static str>) {
    match support {
        Support::Read => ("read", None),
        Support::NoEffect(reason) => ("no effect", Some(reason)),
        Support::Refused(reason) => ("refused", Some(reason)),
    }
}

fn said((support, reason): (&str, Option<&str>)) -> String {
    reason.map_or_else(|| support.to_owned(), |reason| format!("{support}: {reason}"))
}
