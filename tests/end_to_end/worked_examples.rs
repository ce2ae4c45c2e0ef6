//! The systems in `experiments/systems`, tested with the commands that its README shows.

use crate::common::{fuzz, succeeds};
use serde_json::Value;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::Command;

/// The trials of a system of that folder.
fn trials(command: &str, space: &str, more: &[&str]) -> Vec<Value> {
    let (root, out) = (Path::new(env!("CARGO_MANIFEST_DIR")), tempfile::tempdir().unwrap());
    let folder = out.path().join("out");
    let arguments = ["--system", command, "--space", space, "-q", "--out", folder.to_str().unwrap()];
    succeeds(fuzz(root, &[&arguments[..], more].concat()));
    let log = fs::read_to_string(folder.join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn two_lines_of_shell_are_a_system() {
    let system = "sh experiments/systems/stopping-distance.sh";
    let trials = trials(system, "experiments/systems/stopping-distance.toml", &["--budget", "100"]);
    for trial in &trials {
        let value = |name: &str| trial["test"][name].as_f64().unwrap().trunc();
        let (speed, gap) = (value("speed"), value("gap"));
        let left = gap - (speed * 3.0 / 10.0).trunc() - (speed * speed / 100.0).trunc();
        assert_eq!(trial["robustness"]["stops-in-time"], left, "{trial}");
        assert_eq!(trial["verdict"], if left < 0.0 { "fail" } else { "pass" }, "{trial}");
    }
    assert!(trials.iter().any(|trial| trial["verdict"] == "fail"));
}

#[test]
fn a_python_script_is_a_system_that_a_search_falsifies() {
    if Command::new("python3").arg("--version").output().is_err() {
        let _ = writeln!(io::stderr(), "skipped: there is no python3 on this machine");
        return;
    }
    let (system, space) = ("python3 experiments/systems/cruise-control.py", "experiments/systems/cruise-control.toml");
    let trials = trials(system, space, &["--spec", "always (excess < 2)", "--strategy", "auto", "--budget", "60"]);
    assert!(trials.iter().all(|trial| trial["verdict"] != "error" && trial["ticks"] == 600));
    assert!(trials.iter().any(|trial| trial["verdict"] == "fail"));
}
