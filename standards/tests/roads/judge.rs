//! The quality checker of ASAM judges the files that are written. Without Python or the checker the test is skipped; `tests/run`
//! installs both.

use crate::round_trip::networks;
use paracosm_engine::road::CrossIntersection;
use paracosm_standards::opendrive::write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The number of checks that the checker completes; with fewer, it judged nothing.
const CHECKS: usize = 20;

/// Returns the Python that has the checker.
fn judge() -> Option<PathBuf> {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/checker/bin/python3");
    let found = Command::new(&python).args(["-c", "import qc_opendrive"]).stderr(Stdio::null()).status();
    let found = found.is_ok_and(|status| status.success());
    if !found {
        eprintln!("no asam-qc-opendrive: the test is skipped");
    }
    found.then_some(python)
}

/// Returns the report of the checker on a file.
fn report(python: &Path, folder: &Path, name: &str, text: &str) -> String {
    let [file, config, result] = ["xodr", "xml", "xqar"].map(|ending| folder.join(name).with_extension(ending));
    fs::write(&file, text).expect("the folder is writable");
    let (input, output) = (file.display(), result.display());
    let settings = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Config><Param name=\"InputFile\" value=\"{input}\"/>\
         <CheckerBundle application=\"xodrBundle\"><Param name=\"resultFile\" value=\"{output}\"/></CheckerBundle></Config>"
    );
    fs::write(&config, settings).expect("the folder is writable");
    let run = "import sys; from qc_opendrive.main import main; sys.argv = ['qc_opendrive', '-c', sys.argv[1]]; main()";
    let output = Command::new(python).args(["-c", run]).arg(&config).output().expect("python3 starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(&result).expect("the checker writes a report")
}

#[test]
fn files_that_are_written_pass_the_quality_checker_of_asam() {
    let Some(python) = judge() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let alone = CrossIntersection::new().build().expect("it is sound");
    for (name, network) in networks().into_iter().chain([("no-roads", alone)]) {
        let text = write(&network, name).expect("it is of our elements");
        let report = report(&python, folder.path(), name, &text);
        assert!(report.matches("status=\"completed\"").count() >= CHECKS, "{name}: {report}");
        assert!(!report.contains("<Issue"), "{name}: {report}");
    }
    // The checker finds what is wrong.
    let text = write(&networks().remove(0).1, "wrong").expect("it is of our elements");
    let wrong = text.replacen("type=\"driving\"", "type=\"flying\"", 1);
    assert!(report(&python, folder.path(), "wrong", &wrong).contains("<Issue"));
}
