//! A space with constraints that has parameters of both kinds, and what is made and measured in it.

use crate::common::{cover, stderr, stdout, succeeds};
use serde_json::Value;
use std::path::Path;

pub const SPACE: &str = "\
constraints = [\"lanes == 2 implies sky != 'fog'\", \"not (car == 'truck' and lanes == 6)\"]\n\
[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n\
[[parameter]]\nname = \"lanes\"\nchoice = [2, 4, 6]\n\
[[parameter]]\nname = \"sky\"\nchoice = [\"clear\", \"rain\", \"fog\"]\n\
[[parameter]]\nname = \"car\"\nchoice = [\"small\", \"truck\"]\n\
[[parameter]]\nname = \"wet\"\nchoice = [\"no\", \"yes\"]\n";

/// The space without its continuous parameter.
pub fn discrete_space() -> String {
    SPACE.replace("[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n", "")
}

/// The rows of what `generate` prints, as words, without the header.
pub fn rows(csv: &str) -> Vec<Vec<String>> {
    csv.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

pub fn generated(dir: &Path, arguments: &[&str]) -> (String, String) {
    let output = succeeds(cover(dir, &[&["generate"], arguments].concat()));
    (stdout(&output), stderr(&output))
}

pub fn measured(dir: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&succeeds(cover(dir, &[&["estimate", "--format", "json"], arguments].concat()))))
        .unwrap()
}
