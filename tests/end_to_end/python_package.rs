//! The Python package, by its own tests in `python/tests`: `pytest` runs them with the package that `tests/run` has installed.

use std::path::Path;
use std::process::Command;

#[test]
fn the_python_package_passes_its_tests() {
    // From another folder, so that the installed package is found and not the sources.
    let folder = tempfile::tempdir().unwrap();
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).current_dir(folder.path()).output();
    let has_all = "import paracosm._core, pytest";
    if !python(&["-c", has_all]).is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: no Python with the package and pytest; pip install ./python pytest");
        return;
    }
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("python/tests");
    let tests = tests.to_str().expect("a path in UTF-8");
    let ran = python(&["-m", "pytest", "-q", "--tb=short", "-p", "no:cacheprovider", tests]).unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stdout));
}
