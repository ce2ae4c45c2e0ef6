//! All commands work on the scenario of this crate.

use std::path::Path;
use std::process::Command;

/// Runs the program with these arguments in a folder, and returns what it prints.
fn run(dir: &Path, arguments: &[&str]) -> String {
    let program = env!("CARGO_BIN_EXE_own-scenario");
    let output = Command::new(program).args(arguments).current_dir(dir).output().expect("the program starts");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("it prints text")
}

#[test]
fn the_scenario_has_the_commands_of_paracosm() {
    let dir = tempfile::tempdir().expect("a folder");
    let run = |arguments: &[&str]| run(dir.path(), arguments);
    // Help has the name of this program.
    assert!(run(&["--help"]).contains("own-scenario replay paracosm-out 17"));
    assert!(run(&["list", "scenarios"]).contains("jogger"));
    assert!(run(&["describe", "jogger"]).contains("a jogger crosses the road"));
    let summary = run(&["jogger", "--budget", "60", "--strategy", "halton"]);
    assert!(summary.contains("jogger, driver aeb, strategy halton: 60 tests"), "{summary}");
    // Commands on the folder of a campaign find the scenario, too.
    let failing = summary.split("test ").nth(1).and_then(|text| text.split([':', ' ', ')']).next()).expect("a failure");
    run(&["replay", "paracosm-out", failing]);
    run(&["shrink", "paracosm-out", failing]);
    run(&["blame", "paracosm-out"]);
    run(&["sensitivity", "paracosm-out"]);
    run(&["trace", "paracosm-out"]);
    run(&["map", "paracosm-out"]);
    run(&["jogger", "--budget", "80", "--strategy", "halton", "--out", "other"]);
    run(&["diff", "paracosm-out", "other"]);
    run(&["likelihood", "jogger", "--budget", "20"]);
    run(&["audit", "jogger", "--tests", "halton:10", "--mutants", "20"]);
    // The scenarios of PARACOSM are there as well.
    run(&["cut-in", "--budget", "2", "--out", "cut-in"]);
}
