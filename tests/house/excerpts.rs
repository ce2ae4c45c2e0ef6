//! The page on extending shows code that exists.

use crate::expect_none;
use crate::workspace::root;
use std::fs;

#[test]
fn the_excerpts_of_the_page_on_extending_stand_in_the_files_that_it_names() {
    let page = fs::read_to_string(root().join("docs/extending.md")).expect("the page is there");
    let mut excerpts = 0;
    let mut wrong = Vec::new();
    for section in page.split("\n## ").skip(1) {
        let files: String = section.split("](../").skip(1).filter_map(|link| link.split_once(')')).fold(
            String::new(),
            |texts, (path, _)| {
                texts + &fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
            },
        );
        for excerpt in section.split("```rust,ignore\n").skip(1) {
            excerpts += 1;
            let code = excerpt.split("```").next().expect("there is a first part");
            if !words(&files).contains(&words(code)) {
                wrong.push(format!("docs/extending.md, section `{}`: {code}", section.lines().next().unwrap_or("")));
            }
        }
    }
    assert!(excerpts >= 5, "the page shows {excerpts} excerpts");
    expect_none(&wrong, "Copy the code again from the file that the section names.");
}

/// The text without differences in white space.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
