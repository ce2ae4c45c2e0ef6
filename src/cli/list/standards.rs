//! The elements of the standards of roads and of scenarios: read, without effect, or refused.

use super::super::output::json;
use super::Form;
use crate::standards::{Support, Supported};
use serde_json::json;

/// Returns the table of the elements of a standard, in the given form.
pub(super) fn standard(elements: impl Iterator<Item = Supported>, form: Form) -> String {
    let rows: Vec<_> = elements.map(|element| (element, words(element.support))).collect();
    match form {
        Form::Json => {
            let row = |(element, (support, reason)): &(Supported, (&str, Option<&str>))| {
                let (name, within) = (element.name, element.parent);
                json!({"element": name, "within": within, "support": support, "reason": reason})
            };
            json(&rows.iter().map(row).collect::<Vec<_>>())
        }
        Form::Table => {
            let widest = |of: fn(&Supported) -> &'static str| {
                rows.iter().map(|(element, _)| of(element).len()).max().unwrap_or(0) + 2
            };
            let widths = [widest(|element| element.name), widest(|element| element.parent)];
            let line = |(element, support): &(Supported, (&str, Option<&str>))| {
                let [name, parent] = widths;
                format!("{:<name$}{:<parent$}{}\n", element.name, element.parent, said(*support))
            };
            rows.iter().map(line).collect()
        }
        Form::Markdown => {
            let line = |(element, support): &(Supported, (&str, Option<&str>))| {
                format!("| `{}` | `{}` | {} |\n", element.name, element.parent, said(*support))
            };
            let head = "| element | within | support |\n| --- | --- | --- |\n".to_owned();
            head + &rows.iter().map(line).collect::<String>()
        }
    }
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
