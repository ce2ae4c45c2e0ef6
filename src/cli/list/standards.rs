//! The elements of the standards of roads and of scenarios: read, without effect, or refused, and the test of each.

use super::super::output::json;
use super::Form;
use crate::standards::Supported;
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
        .map(|element| Row { element, test: tests.get(&(element.name, element.parent)).map_or("", String::as_str) })
        .collect();
    match form {
        Form::Json => {
            let row = |row: &Row<'_>| {
                let Supported { name, parent, except, .. } = row.element;
                let (support, reason) = row.element.support();
                json!({
                    "element": name, "within": parent, "support": support, "except": except, "reason": reason,
                    "test": row.test,
                })
            };
            json(&rows.iter().map(row).collect::<Vec<_>>())
        }
        Form::Table => {
            let widest = |of: fn(&Row<'_>) -> usize| rows.iter().map(of).max().unwrap_or(0) + 2;
            let (name, parent, test) = (
                widest(|row| row.element.name.len()),
                widest(|row| row.element.parent.len()),
                widest(|row| row.test.len()),
            );
            let line = |Row { element, test: file }: &Row<'_>| {
                format!("{:<name$}{:<parent$}{file:<test$}{element}\n", element.name, element.parent)
            };
            rows.iter().map(line).collect()
        }
        Form::Markdown => {
            let line = |Row { element, test }: &Row<'_>| {
                format!("| `{}` | `{}` | {element} | `{test}` |\n", element.name, element.parent)
            };
            let head = "| element | within | support | test |\n| --- | --- | --- | --- |\n".to_owned();
            head + &rows.iter().map(line).collect::<String>()
        }
    }
}

/// An element with the file of its test.
struct Row<'a> {
    element: Supported,
    test: &'a str,
}
