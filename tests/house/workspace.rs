//! The crates of the workspace, as cargo sees them.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the workspace lies.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A crate of the workspace.
pub struct Crate {
    pub name: String,
    pub uses: Vec<Use>,
    /// The first file of its library and of each of its programs.
    pub targets: Vec<PathBuf>,
}

/// That a crate names another one in its manifest.
pub struct Use {
    pub name: String,
    pub kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Normal,
    Build,
    Dev,
}

impl Kind {
    pub fn section(self) -> &'static str {
        match self {
            Kind::Normal => "[dependencies]",
            Kind::Build => "[build-dependencies]",
            Kind::Dev => "[dev-dependencies]",
        }
    }
}

/// All crates, in the order that cargo gives them.
pub fn crates() -> Vec<Crate> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata writes JSON");
    entries(&metadata["packages"]).map(package).collect()
}

fn package(package: &Value) -> Crate {
    Crate {
        name: text(&package["name"]),
        uses: entries(&package["dependencies"]).map(dependency).collect(),
        targets: entries(&package["targets"])
            .filter(|target| {
                entries(&target["kind"]).any(|kind| ["lib", "cdylib", "bin"].map(Some).contains(&kind.as_str()))
            })
            .map(|target| text(&target["src_path"]).into())
            .collect(),
    }
}

fn dependency(dependency: &Value) -> Use {
    let kind = match dependency["kind"].as_str() {
        Some("dev") => Kind::Dev,
        Some("build") => Kind::Build,
        _ => Kind::Normal,
    };
    Use { name: text(&dependency["name"]), kind }
}

fn entries(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn text(value: &Value) -> String {
    value.as_str().expect("cargo metadata has a text here").to_owned()
}
