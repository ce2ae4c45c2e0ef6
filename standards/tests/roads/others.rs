//! The files of others, which are not part of the repository.

use std::path::{Path, PathBuf};

/// Returns the folder with the roads and scenarios of others; `None` if it is absent, which a test then says.
pub fn files_of_others() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/standards");
    let is_there = folder.join("lanes").is_dir();
    if !is_there {
        eprintln!("skipped: {} with the roads of others is absent", folder.display());
    }
    is_there.then_some(folder)
}

/// Returns all files with an ending in a folder and the folders within.
pub fn with_ending(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder is readable") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(with_ending(&path, ending));
        } else if path.extension().is_some_and(|of| of == ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}
