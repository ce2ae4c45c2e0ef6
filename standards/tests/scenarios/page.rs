//! The page of supported elements, which is written from the table of elements and from our own files.

use super::others::with_ending;
use super::worlds::file;
use paracosm_standards::Support;
use paracosm_standards::openscenario::elements;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Returns the pairs of an element and its parent in our own files, each with the first file that has it.
fn covered() -> BTreeMap<(String, String), String> {
    let mut covered = BTreeMap::new();
    for path in with_ending(&file(""), "xosc") {
        let text = fs::read_to_string(&path).unwrap();
        let tree = roxmltree::Document::parse(&text).unwrap();
        let name = path.strip_prefix(file("")).unwrap().to_string_lossy().into_owned();
        for node in tree.descendants().filter(roxmltree::Node::is_element) {
            if let Some(parent) = node.parent_element() {
                let key = (parent.tag_name().name().to_owned(), node.tag_name().name().to_owned());
                covered.entry(key).or_insert_with(|| name.clone());
            }
            // The table has the attributes without effect as `@NAME`.
            for attribute in node.attributes() {
                let key = (node.tag_name().name().to_owned(), format!("@{}", attribute.name()));
                covered.entry(key).or_insert_with(|| name.clone());
            }
        }
    }
    covered
}

#[test]
fn the_page_of_elements_is_written_from_the_table_and_its_tests() {
    let covered = covered();
    let mut page = include_str!("openscenario.head.md").to_owned();
    let mut untested = Vec::new();
    for element in elements() {
        let key = (element.parent.to_owned(), element.name.to_owned());
        let test = match element.support {
            Support::Refused(_) => Some("`bad.rs`".to_owned()),
            _ => covered.get(&key).map(|file| format!("`files/{file}`")),
        };
        let Some(test) = test else {
            untested.push(format!("{} in {}", element.name, element.parent));
            continue;
        };
        page += &format!("| `{}` | `{}` | {element} | {test} |\n", element.name, element.parent);
    }
    assert!(untested.is_empty(), "no test has these {} elements: {untested:#?}", untested.len());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/openscenario.md");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(found == page, "docs/openscenario.md is old; write it again with UPDATE_GOLDEN=1");
}
