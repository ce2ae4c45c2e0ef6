//! The schemas of ASAM judge the table of elements: versions 1.0 to 1.3, as the quality checker of ASAM brings them. Without the
//! checker the test is skipped; `tests/run` installs it.

use super::elements::ROWS;
use super::version::{ATTRIBUTES_OF_NEWEST, OF_NEWEST};
use crate::xml::{Form, Row, Support};
use roxmltree::{Document, Node};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const VERSIONS: [&str; 4] = ["1.0.0", "1.1.1", "1.2.0", "1.3.0"];
const FOLDER: &str = "../target/checker/lib/python3.11/site-packages/qc_openscenario/schema";

/// An element or an attribute in the schemas: the number of versions that have it, and the number that demand it.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Seen {
    /// The index of the last version without it, from 1; 0 if the first version has it.
    absent: usize,
    versions: usize,
    demanded: usize,
}

impl Seen {
    fn add(&mut self, version: usize, is_demanded: bool) {
        if self.versions == 0 {
            self.absent = version;
        }
        self.versions += 1;
        self.demanded += usize::from(is_demanded);
    }

    fn is_of_newest(self) -> bool {
        self.absent == VERSIONS.len() - 1
    }

    fn is_always_demanded(self) -> bool {
        self.versions == self.demanded
    }
}

/// The contents of the schemas of all versions.
#[derive(Default)]
struct Schemas {
    /// By the names of the parent and the child.
    elements: BTreeMap<(String, String), Seen>,
    /// By the names of the parent, the child and the attribute of the child.
    attributes: BTreeMap<(String, String, String), Seen>,
    /// The names of the values of an attribute of an element.
    values: BTreeMap<(String, String), BTreeSet<String>>,
}

fn named<'a>(root: Node<'a, 'a>, tag: &str, name: &str) -> Option<Node<'a, 'a>> {
    root.children().find(|node| node.tag_name().name() == tag && node.attribute("name") == Some(name))
}

/// Calls a function with each element within a type: the name and the type of the element, and `true` if the type demands it.
fn particles<'a>(
    root: Node<'a, 'a>,
    node: Node<'a, 'a>,
    is_demanded: bool,
    with: &mut dyn FnMut(&'a str, &'a str, bool),
) {
    for child in node.children().filter(Node::is_element) {
        let is_demanded = is_demanded && child.attribute("minOccurs") != Some("0");
        match child.tag_name().name() {
            "element" => {
                let name = child.attribute("name").expect("an element has a name");
                with(name, child.attribute("type").unwrap_or_default(), is_demanded);
            }
            "choice" => particles(root, child, false, with),
            "group" => {
                let group = child.attribute("ref").and_then(|name| named(root, "group", name));
                particles(root, group.expect("the group exists"), is_demanded, with);
            }
            "sequence" | "all" | "complexContent" | "simpleContent" | "extension" => {
                particles(root, child, is_demanded, with);
            }
            _ => (),
        }
    }
}

impl Schemas {
    fn add(&mut self, version: usize, text: &str) {
        let tree = Document::parse(text).expect("the schema is well-formed");
        let root = tree.root_element();
        let whole = root.children().find(|node| node.tag_name().name() == "element").expect("an outermost element");
        let mut open = vec![(whole.attribute("name").expect("a name"), whole.attribute("type").unwrap_or_default())];
        let mut known = BTreeSet::new();
        while let Some((parent, kind)) = open.pop() {
            let Some(kind) = named(root, "complexType", kind).filter(|_| known.insert((parent, kind))) else {
                continue;
            };
            let mut within: BTreeMap<&str, (&str, bool)> = BTreeMap::new();
            particles(root, kind, true, &mut |name, kind, is_demanded| {
                let one = within.entry(name).or_insert((kind, false));
                one.1 |= is_demanded;
            });
            for (name, (kind, is_demanded)) in within {
                let key = (parent.to_owned(), name.to_owned());
                self.elements.entry(key).or_default().add(version, is_demanded);
                self.add_attributes(root, version, [parent, name, kind]);
                open.push((name, kind));
            }
        }
    }

    fn add_attributes(&mut self, root: Node<'_, '_>, version: usize, [parent, name, kind]: [&str; 3]) {
        let attributes = root
            .children()
            .find(|node| node.tag_name().name() == "complexType" && node.attribute("name") == Some(kind));
        for attribute in attributes.into_iter().flat_map(|kind| kind.descendants()) {
            if attribute.tag_name().name() != "attribute" {
                continue;
            }
            let of = attribute.attribute("name").expect("an attribute has a name");
            let key = (parent.to_owned(), name.to_owned(), of.to_owned());
            self.attributes.entry(key).or_default().add(version, attribute.attribute("use") == Some("required"));
            let kind = attribute.attribute("type").unwrap_or_default();
            let values = root
                .children()
                .find(|node| node.tag_name().name() == "simpleType" && node.attribute("name") == Some(kind));
            let values = values.into_iter().flat_map(|kind| kind.descendants());
            let values = values.filter(|node| node.tag_name().name() == "enumeration");
            let values = values.filter_map(|node| node.attribute("value")).map(str::to_owned);
            self.values.entry((name.to_owned(), of.to_owned())).or_default().extend(values);
        }
    }

    fn check(&self, row: &Row, wrong: &mut Vec<String>) {
        for (parent, is_needed) in row.parents() {
            for name in row.names.split('|') {
                if let Some(attribute) = name.strip_prefix('@') {
                    self.check_values(row, parent, attribute, wrong);
                    continue;
                }
                let Some(seen) = self.elements.get(&(parent.to_owned(), name.to_owned())) else {
                    wrong.push(format!("no version has {name} in {parent}"));
                    continue;
                };
                if seen.is_always_demanded() != is_needed {
                    wrong.push(format!("{name} in {parent}: demanded is {is_needed}, but {seen:?}"));
                }
                if row.support == Support::Read {
                    self.check_attributes(row, parent, name, wrong);
                }
            }
        }
    }

    fn check_attributes(&self, row: &Row, parent: &str, name: &str, wrong: &mut Vec<String>) {
        let of = |attribute: &str| self.attributes.get(&(parent.to_owned(), name.to_owned(), attribute.to_owned()));
        for (attribute, is_needed) in row.attributes() {
            match of(attribute) {
                None => wrong.push(format!("no version has {attribute} of {name} in {parent}")),
                Some(seen) if seen.is_always_demanded() != is_needed => {
                    wrong.push(format!("{attribute} of {name}: demanded is {is_needed}, but {seen:?}"));
                }
                Some(_) => (),
            }
        }
    }

    fn check_values(&self, row: &Row, element: &str, attribute: &str, wrong: &mut Vec<String>) {
        let Some(values) = self.values.get(&(element.to_owned(), attribute.to_owned())) else {
            wrong.push(format!("no version has {attribute} of {element}"));
            return;
        };
        if let Form::OneOf(names) = row.form {
            let names: BTreeSet<_> = names.split('|').map(str::to_owned).collect();
            if names != *values {
                wrong.push(format!("{attribute} of {element}: {names:?} is not {values:?}"));
            }
        }
    }
}

#[test]
fn the_table_has_the_elements_and_attributes_of_the_schemas() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(FOLDER);
    let mut schemas = Schemas::default();
    for (index, version) in VERSIONS.into_iter().enumerate() {
        let Ok(text) = fs::read_to_string(folder.join(version).join("OpenSCENARIO.xsd")) else {
            return eprintln!("no schema of version {version}: the test is skipped");
        };
        schemas.add(index, &text);
    }
    let mut wrong = Vec::new();
    ROWS.iter().for_each(|row| schemas.check(row, &mut wrong));
    // The table has everything within the elements that are read.
    let of = |name: &str| {
        let name = name.to_owned();
        ROWS.iter().filter(move |row| row.names.split('|').any(|of| of == name))
    };
    let is_read = |name: &str| name == "OpenSCENARIO" || of(name).any(|row| row.support == Support::Read);
    for (parent, name) in schemas.elements.keys().filter(|(parent, _)| is_read(parent)) {
        if !of(name).any(|row| row.parents().any(|(of, _)| of == parent)) {
            wrong.push(format!("the table lacks {name} in {parent}"));
        }
    }
    for (parent, name, attribute) in schemas.attributes.keys() {
        let is_of = |row: &&Row| row.parents().any(|(of, _)| of == parent) && row.support == Support::Read;
        let row = of(name).find(is_of);
        let has_none = |row: &Row| row.parents().any(|(of, _)| of == name);
        let is_without_effect = || of(&format!("@{attribute}")).any(has_none);
        if row.is_some_and(|row| !row.knows(attribute)) && !is_without_effect() {
            wrong.push(format!("the table lacks {attribute} of {name} in {parent}"));
        }
    }
    // The elements of the newest version, of which no older version has one elsewhere.
    let is_supported = |name: &str| of(name).any(|row| !matches!(row.support, Support::Refused(_)));
    let mut newest: BTreeMap<&str, bool> = BTreeMap::new();
    for ((parent, name), seen) in
        schemas.elements.iter().filter(|((parent, name), _)| is_read(parent) && is_supported(name))
    {
        *newest.entry(name).or_insert(true) &= seen.is_of_newest();
        if seen.is_of_newest() && !newest[name.as_str()] && !OF_NEWEST.contains(&parent.as_str()) {
            println!("{name} in {parent} is of the newest version");
        }
    }
    let newest: Vec<&str> = newest.into_iter().filter(|(_, is_newest)| *is_newest).map(|(name, _)| name).collect();
    assert_eq!(newest, OF_NEWEST);
    let mut attributes: BTreeSet<(&str, &str)> = BTreeSet::new();
    for ((parent, name, attribute), seen) in &schemas.attributes {
        let is_old = !schemas.elements[&(parent.clone(), name.clone())].is_of_newest();
        if is_read(parent) && is_supported(name) && is_old && seen.is_of_newest() {
            attributes.insert((name, attribute));
        }
    }
    assert_eq!(attributes, ATTRIBUTES_OF_NEWEST.into_iter().collect());
    assert!(schemas.elements.len() > 400 && schemas.attributes.len() > 300, "{}", schemas.elements.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
