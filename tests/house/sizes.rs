//! A crate that grows too large is divided before it is a burden.

use crate::expect_none;
use crate::workspace::crates;
use std::fs;
use std::path::Path;

/// The lines that a crate may have without its tests.
const MOST: usize = 20_000;

#[test]
fn no_crate_has_more_than_20_000_lines_without_its_tests() {
    let large = crates().into_iter().filter_map(|krate| {
        let folder = krate.targets.first()?.parent()?.to_owned();
        let lines = lines_in(&folder);
        (lines > MOST).then(|| format!("{}: {lines} lines, at most {MOST}", krate.name))
    });
    expect_none(&large.collect::<Vec<_>>(), "Divide the crate, or move a part of it to the floor where it belongs.");
}

/// The lines of all sources in a folder, without files and modules of tests.
fn lines_in(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).expect("the folder of a crate can be read");
    let lines = entries.map(|entry| entry.expect("an entry can be read").path()).map(|path| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        match () {
            () if name == "tests" || name == "tests.rs" => 0,
            () if path.is_dir() => lines_in(&path),
            () if name.ends_with(".rs") => code(&fs::read_to_string(&path).expect("a source is text")).lines().count(),
            () => 0,
        }
    });
    lines.sum()
}

/// A source up to its module of tests, which stands at the end.
fn code(source: &str) -> &str {
    source.split("#[cfg(test)]\nmod tests {").next().unwrap_or(source)
}
