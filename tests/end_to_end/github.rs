//! `--github`: the summary of a step of a GitHub workflow.

use crate::common::{golden, refused, stderr};
use crate::python::{package, python};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// `paracosm-fuzz` with these arguments, as a step of a workflow whose summary is `summary.md`.
fn step(dir: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    command.args(arguments).current_dir(dir).env("GITHUB_STEP_SUMMARY", "summary.md").output().unwrap()
}

#[test]
fn a_step_has_the_verdict_the_map_the_requirements_and_the_modes_below_what_was_there() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("summary.md"), "of an earlier step\n").unwrap();
    let arguments = ["--budget", "500", "--github", "--fail-on-violation"];
    assert_eq!(step(dir.path(), &arguments).status.code(), Some(1), "the gate stays closed");
    let text = fs::read_to_string(dir.path().join("summary.md")).unwrap();
    // The name by which the program was called differs from machine to machine.
    golden("step-summary.md", &text.replace(env!("CARGO_BIN_EXE_paracosm-fuzz"), "paracosm-fuzz"));
    let squares: Vec<usize> =
        text.lines().map(|line| line.matches(['🟦', '🟥', '⬜']).count()).filter(|count| *count > 3).collect();
    assert_eq!(squares, [24; 12], "a map of 24 by 12 squares");
}

#[test]
fn a_campaign_without_a_failure_and_one_that_shows_nothing_say_so() {
    let dir = tempfile::tempdir().unwrap();
    step(dir.path(), &["--set", "speed=0.5", "--set", "distance=20", "--github", "--out", "a"]);
    let text = fs::read_to_string(dir.path().join("summary.md")).unwrap();
    assert!(
        text.contains("✅ No failure in 1 test: 1 pass") && text.contains("**Nearest to a failure**: test 0"),
        "{text}"
    );
    fs::remove_file(dir.path().join("summary.md")).unwrap();
    // The system ends at once, so that every test ends in an error.
    fs::write(dir.path().join("SPACE.toml"), "[[parameter]]\nname = \"a\"\ninterval = [0, 1]\n").unwrap();
    let broken = step(
        dir.path(),
        &["run", "--system", "true", "--space", "SPACE.toml", "--budget", "2", "--github", "--out", "b"],
    );
    assert_eq!(broken.status.code(), Some(2), "{}", stderr(&broken));
    let text = fs::read_to_string(dir.path().join("summary.md")).unwrap();
    assert!(text.contains("⚠️ None of 2 tests shows whether it passes, 2 error"), "{text}");
    assert!(text.contains("First error, test 0: the system ended without an answer"), "{text}");
}

#[test]
fn no_failure_beside_errors_is_a_warning() {
    let dir = tempfile::tempdir().unwrap();
    let answer = r#"i=${line#*:}; i=${i%%,*}; [ $i = 0 ] || exit 1; echo "{\"index\":0,\"robustness\":{\"safe\":1}}""#;
    fs::write(dir.path().join("system.sh"), format!("while read -r line; do {answer}; done\n")).unwrap();
    fs::write(dir.path().join("SPACE.toml"), "[[parameter]]\nname = \"a\"\ninterval = [0, 1]\n").unwrap();
    let run = [
        "run",
        "--system",
        "sh system.sh",
        "--space",
        "SPACE.toml",
        "--budget",
        "6",
        "--github",
        "--fail-on-violation",
    ];
    assert_eq!(step(dir.path(), &run).status.code(), Some(2));
    let text = fs::read_to_string(dir.path().join("summary.md")).unwrap();
    assert!(text.contains("⚠️ No failure in 6 tests: 1 pass, 5 error"), "{text}");
}

#[test]
fn names_of_strangers_are_text_in_a_summary() {
    let dir = tempfile::tempdir().unwrap();
    let hostile = "<img src=x onerror=alert(1)> | ``` @everyone [x](http://example.com) \u{202e}";
    let answer = r#"i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"above\":-1}}""#;
    fs::write(dir.path().join("system.sh"), format!("while read -r line; do {answer}; done\n")).unwrap();
    let levels = format!("[[parameter]]\nname = \"a\"\nchoice = [{hostile:?}, \"b\"]\n");
    fs::write(dir.path().join("SPACE.toml"), levels.replace("\\u{202e}", "\\u202e")).unwrap();
    let run =
        ["run", "--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "2", "--github", "--out", "``` c"];
    let ran = step(dir.path(), &run);
    assert_eq!(ran.status.code(), Some(0), "{}", stderr(&ran));
    let text = fs::read_to_string(dir.path().join("summary.md")).unwrap();
    assert!(!text.contains("<img") && !text.contains("@everyone") && !text.contains('\u{202e}'), "{text}");
    assert!(text.contains("&#60;img src=x onerror=alert(1)&#62;"), "{text}");
    assert!(text.contains("\n````sh\n") && text.ends_with("\n````\n"), "{text}");
}

#[test]
fn outside_a_workflow_the_option_is_refused_before_the_first_test() {
    let dir = tempfile::tempdir().unwrap();
    let fuzz = |summary: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
        command.args(["--github"]).current_dir(dir.path()).env("GITHUB_STEP_SUMMARY", summary).output().unwrap()
    };
    refused(&fuzz(""), &["--github", "GITHUB_STEP_SUMMARY is not set"]);
    refused(&fuzz("no/summary.md"), &["cannot write no/summary.md"]);
    assert!(!dir.path().join("paracosm-out").exists());
}

/// The command of a step of the workflow in the examples, on one line.
fn command_of(name: &str) -> String {
    let workflow = include_str!("../../examples/github/paracosm.yml");
    let (_, step) = workflow.split_once(&format!("- name: {name}\n")).unwrap();
    let (_, command) = step.split_once("run: ").unwrap();
    let (first, rest) = command.split_once('\n').unwrap();
    let folded = rest.lines().take_while(|line| line.starts_with("          ")).map(str::trim);
    let parts: Vec<&str> = if first == ">" { folded.collect() } else { vec![first] };
    parts.join(" ")
}

#[test]
fn the_commands_of_the_workflow_in_the_examples_run() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    fs::create_dir(dir.join("drivers")).unwrap();
    let script = dir.join("drivers/mine.py");
    fs::copy(package().join("examples/brake.py"), &script).unwrap();
    if python(&script).is_none() {
        return;
    }
    let programs = Path::new(env!("CARGO_BIN_EXE_paracosm-fuzz")).parent().unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    let run = |command: &str| {
        let mut bash = Command::new("bash");
        bash.args(["-c", command]).current_dir(dir).env("PATH", &path).env("PYTHONPATH", package().join("src"));
        bash.env("GITHUB_STEP_SUMMARY", "summary.md").output().unwrap()
    };
    let campaign = command_of("Campaign");
    assert!(campaign.contains("--budget 500"), "{campaign}");
    let ran = run(&campaign.replace("--budget 500", "--budget 20"));
    assert!(matches!(ran.status.code(), Some(0 | 1)), "{}", stderr(&ran));
    assert!(fs::read_to_string(dir.join("summary.md")).unwrap().contains("of 20 tests"));
    let reported = run(&command_of("Report"));
    assert_eq!(reported.status.code(), Some(0), "{}", stderr(&reported));
    assert!(dir.join("report.html").exists());
}
