//! The table of features says how many crates of others each builds.

use crate::workspace::root;
use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

/// The number of crates of others that the library builds with a feature, on Linux.
fn crates_of_others(feature: &str) -> usize {
    let features = if feature == "none" { "" } else { feature };
    let output = Command::new(env!("CARGO"))
        .args(["tree", "-p", "paracosm", "--no-default-features", "--features", features, "--edges", "normal,build"])
        .args(["--prefix", "none", "--locked", "--offline", "--target", "x86_64-unknown-linux-gnu"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "cargo tree: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("cargo tree writes text");
    let here = root().to_str().expect("the path is text");
    let of_others = text.lines().filter(|line| !line.contains(here)).map(|line| line.trim_end_matches(" (*)"));
    of_others.collect::<BTreeSet<_>>().len()
}

#[test]
fn the_table_of_features_says_how_many_crates_each_builds() {
    let page = fs::read_to_string(root().join("docs/extending.md")).expect("the page is there");
    let (_, table) = page.split_once("| feature | what | crates of others |").expect("the table is there");
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let mut checked = 0;
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let feature = cells[1].split(',').next().expect("a split has a first part").trim_matches('`');
        // The networks are not built here, so cargo has not fetched their crates.
        if feature == "neural" {
            continue;
        }
        checked += 1;
        assert_eq!(cells[3], crates_of_others(feature).to_string(), "{feature}: docs/extending.md has another number");
    }
    assert_eq!(checked, 5);
}
