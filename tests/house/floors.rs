//! A crate uses crates of lower floors, never one above or beside it.
//!
//! All kinds of dependencies obey, those of tests too: a test that needs a higher crate belongs to that crate.

use crate::expect_none;
use crate::workspace::{Crate, Kind, Use, crates};

/// The house, bottom to top; ARCHITECTURE.md draws it.
const FLOORS: [(&str, u8); 21] = [
    ("paracosm-space", 0),
    ("paracosm-oracles", 0),
    ("paracosm-coverage", 1),
    ("paracosm-perception", 1),
    ("paracosm-road", 1),
    ("paracosm-generators", 2),
    ("paracosm-engine", 2),
    ("paracosm-mutants", 3),
    ("paracosm-render", 3),
    ("paracosm-rpc", 3),
    ("paracosm-neural", 3),
    ("paracosm-standards", 3),
    ("paracosm-scenarios", 3),
    ("paracosm-campaign", 4),
    ("paracosm-analysis", 5),
    ("paracosm-report", 6),
    ("paracosm", 7),
    ("paracosm-experiments", 8),
    ("paracosm-python", 8),
    ("own-scenario", 8),
    ("printed", 8),
];

/// These take a catalogue from their caller, and know none, although catalogues are below them. Their tests may name
/// one.
const TAKE_CATALOGUES: [&str; 3] = ["paracosm-campaign", "paracosm-analysis", "paracosm-report"];
const CATALOGUES: [&str; 2] = ["paracosm-scenarios", "paracosm-standards"];

fn floor(name: &str) -> Option<u8> {
    FLOORS.iter().find(|(known, _)| *known == name).map(|(_, floor)| *floor)
}

#[test]
fn every_crate_has_a_floor() {
    let homeless: Vec<_> = crates().into_iter().map(|krate| krate.name).filter(|name| floor(name).is_none()).collect();
    expect_none(
        &homeless,
        "These crates have no floor. Give each one in FLOORS in tests/house/floors.rs, and in ARCHITECTURE.md.",
    );
}

#[test]
fn a_crate_uses_only_crates_of_lower_floors() {
    let wrong = pairs(&crates(), |user, used| match (floor(&user.name), floor(&used.name)) {
        (Some(own), Some(other)) if other >= own => Some(format!(
            "{} is on floor {own} and uses {} on floor {other}, in {} of its Cargo.toml",
            user.name,
            used.name,
            used.kind.section(),
        )),
        _ => None,
    });
    expect_none(
        &wrong,
        "A crate uses crates of lower floors only. Move the code that needs the other crate up into it or above it, or move \
         what it needs down; in a test, use a small program of the test's own.",
    );
}

#[test]
fn campaigns_take_catalogues_and_know_none() {
    let wrong = pairs(&crates(), |user, used| {
        let knows = TAKE_CATALOGUES.contains(&user.name.as_str()) && CATALOGUES.contains(&used.name.as_str());
        (knows && used.kind != Kind::Dev)
            .then(|| format!("{} uses {}, in {} of its Cargo.toml", user.name, used.name, used.kind.section()))
    });
    expect_none(
        &wrong,
        "These crates take a `Catalogue` from their caller. Ask for one there instead of naming a catalogue.",
    );
}

fn pairs(crates: &[Crate], wrong: impl Fn(&Crate, &Use) -> Option<String>) -> Vec<String> {
    let mut found = Vec::new();
    for user in crates {
        // A crate may ask for its own features in its tests.
        found.extend(user.uses.iter().filter(|used| used.name != user.name).filter_map(|used| wrong(user, used)));
    }
    found
}
