//! The documentation of an item begins with a plain statement.
//!
//! Lists of items show the first sentence alone. "Whether there is one." says nothing there, and "True if the run has
//! ended." does. A word that begins a question, or that stands for a noun, is a sign of the former.

use crate::expect_none;
use crate::source::modules;
use crate::workspace::{crates, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// No documentation begins with these words.
const OPENINGS: [&str; 16] = [
    "Which", "What", "Where", "Whether", "Who", "Whom", "Whose", "Why", "How", "Of", "It", "Its", "That", "Those",
    "They", "Their",
];

#[test]
fn documentation_begins_with_a_plain_statement() {
    let targets = crates().into_iter().flat_map(|krate| krate.targets);
    let files: BTreeSet<PathBuf> = targets.flat_map(|first| modules(&first)).map(|module| module.file).collect();
    let mut wrong = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).expect("a module is text");
        let name = file.strip_prefix(root()).unwrap_or(&file).display();
        wrong.extend(unclear(&text).into_iter().map(|(line, said)| format!("{name}:{line}: {said}")));
    }
    expect_none(&wrong, "Begin with a verb (\"Returns …\") or with the noun that the item stands for.");
}

/// The first lines of documentation that do not begin plainly, with their numbers from 1.
fn unclear(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut inside = false;
    for (number, line) in text.lines().enumerate() {
        let said = ["/// ", "//! "].into_iter().find_map(|sign| line.trim_start().strip_prefix(sign));
        let opening = said.filter(|_| !inside).and_then(|said| said.split(|c: char| !c.is_alphanumeric()).next());
        if opening.is_some_and(|word| OPENINGS.contains(&word)) {
            found.push((number + 1, said.unwrap_or_default()));
        }
        inside = line.trim_start().starts_with("///") || line.trim_start().starts_with("//!");
    }
    found
}

#[test]
fn only_the_first_line_of_documentation_counts() {
    let text = "/// Returns the speed.\n/// What is more, in m/s.\nfn speed();\n\n    /// Whether it moves.\n    moves: bool,\n";
    assert_eq!(unclear(text), [(5, "Whether it moves.")]);
}
