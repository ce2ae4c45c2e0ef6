//! Signals: what there is so far is printed or safe, and no process is left behind.

use crate::common::{cover, fuzz, refused, stdout, succeeds};
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::Duration;

/// `paracosm-cover generate` as it runs, once it has said a line that contains this on standard error; with what it
/// will say after that.
fn searching(dir: &Path, arguments: &[&str], says: &str) -> (Child, BufReader<impl Read>) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-cover"));
    let program = program.arg("generate").args(arguments).current_dir(dir);
    let mut child = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let mut said = BufReader::new(child.stderr.take().expect("it is piped"));
    let mut line = String::new();
    while !line.contains(says) {
        line.clear();
        assert!(said.read_line(&mut line).unwrap() > 0, "the program ended before it said {says}");
    }
    (child, said)
}

fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.expect("kill is there").success());
}

#[test]
fn an_interrupted_optimisation_prints_the_smallest_array_so_far() {
    let dir = tempfile::tempdir().unwrap();
    let model: String = (0..12).map(|i| format!("P{i}: 0, 1, 2, 3, 4, 5\n")).collect();
    fs::write(dir.path().join("m.pict"), model).unwrap();
    let (child, mut said) = searching(dir.path(), &["--space", "m.pict", "--optimise", "600"], "Ctrl-C");
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    let mut notes = String::new();
    said.read_to_string(&mut notes).unwrap();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    let csv = stdout(&output);
    let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let pairs = |row: &Vec<&str>| {
        let pair = |i: usize, j: usize| (i, j, row[i].to_owned(), row[j].to_owned());
        (0..12).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| pair(i, j)).collect::<Vec<_>>()
    };
    assert_eq!(rows.iter().flat_map(pairs).collect::<BTreeSet<_>>().len(), 66 * 36, "the array is complete");
    assert!(notes.contains("interrupted: this is the smallest array so far\n"), "{notes}");
    let size = format!("a 2-wise covering array of {} rows; at least", rows.len());
    assert!(notes.contains(&size), "{notes}");
}

#[test]
fn interrupted_tests_that_are_to_reach_epsilon_are_printed_with_what_they_reach() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = ["--dims", "2", "--epsilon", "1e-9", "--time-limit", "600"];
    let (child, mut said) = searching(dir.path(), &arguments, "Ctrl-C");
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    let mut notes = String::new();
    said.read_to_string(&mut notes).unwrap();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    assert!(notes.contains("an interrupt ended the search before epsilon 0.000000001 was reached\n"), "{notes}");
    let all = stdout(&output);
    assert!(all.ends_with('\n') && all.lines().all(|line| line.split(',').count() == 2), "no test is cut off");
    fs::write(dir.path().join("tests.csv"), &all).unwrap();
    succeeds(cover(dir.path(), &["estimate", "tests.csv", "--measures", "l2_star"]));
}

/// The process ids that a system has written to a file, once there are two: the id of the system, and of its child.
fn processes(file: &Path) -> Vec<String> {
    for _ in 0..500 {
        let ids: Vec<String> = fs::read_to_string(file).unwrap_or_default().lines().map(str::to_owned).collect();
        if ids.len() >= 2 {
            return ids;
        }
        thread::sleep(Duration::from_millis(20));
    }
    panic!("the system has not started");
}

/// Waits until no process of the list is left, for at most 5 s; returns the processes that are left.
fn left(ids: &[String]) -> Vec<&String> {
    let alive = || -> Vec<&String> {
        let is_alive = |id: &&String| {
            let status = fs::read_to_string(format!("/proc/{id}/stat"));
            // A zombie has ended; whoever adopts it removes it.
            status.is_ok_and(|status| !status.rsplit(')').next().unwrap_or_default().starts_with(" Z"))
        };
        ids.iter().filter(is_alive).collect()
    };
    for _ in 0..250 {
        if alive().is_empty() {
            break;
        }
        thread::sleep(Duration::from_millis(20));
    }
    alive()
}

/// A system that starts a child, and answers no more once there is a file `stop`.
const SLEEPER: &str = r#"echo $$ > "$1"; sleep 1000 & echo $! >> "$1"
while read -r line; do i=${line#*:}; i=${i%%,*}
if [ -e stop ]; then wait; fi; echo "{\"index\":$i,\"robustness\":{\"a\":-1}}"; done"#;

const SPACE: &str = "parameter = [{ name = \"x\", interval = [-1, 1] }, { name = \"y\", interval = [0, 1] }]\n";

/// The options of a campaign of five tests of a system.
fn sleeper<'a>(system: &'a str, out: &'a str) -> [&'a str; 11] {
    ["--system", system, "--space", "SPACE.toml", "--budget", "5", "--jobs", "1", "--out", out, "-q"]
}

#[test]
fn no_signal_leaves_a_process_of_a_system_behind() {
    if !Path::new("/proc/self/stat").exists() {
        eprintln!("there is no /proc: whether processes are left is not checked");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("system.sh"), SLEEPER).unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    succeeds(fuzz(dir.path(), &sleeper("sh system.sh first", "camp")));
    fs::write(dir.path().join("stop"), "").unwrap();
    for signal in ["INT", "TERM", "HUP"] {
        let run = sleeper("sh system.sh run", signal);
        for (file, arguments) in
            [("run", &run[..]), ("first", &["shrink", "camp", "0", "--trust", "--budget", "100", "-q"])]
        {
            let _ = fs::remove_file(dir.path().join(file));
            let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
            let program = program.args(arguments).current_dir(dir.path());
            let child = program.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts");
            let ids = processes(&dir.path().join(file));
            let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
            assert!(sent.expect("kill is there").success());
            let output = child.wait_with_output().unwrap();
            assert_ne!(output.status.code(), Some(0), "{signal} {arguments:?}");
            assert_eq!(left(&ids), [] as [&String; 0], "{signal} {arguments:?}");
        }
    }
}

/// What a shell does with a line.
fn shell(dir: &Path, line: &str) -> Output {
    Command::new("sh").args(["-c", line]).current_dir(dir).output().expect("there is a shell")
}

#[test]
fn a_program_that_is_to_ignore_the_end_of_the_terminal_ignores_it() {
    let dir = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_paracosm-fuzz");
    let line = format!("trap '' HUP; '{program}' --budget 400 --out camp -q & sleep 0.3; kill -HUP $!; wait $!");
    let output = shell(dir.path(), &line);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_limit_on_the_size_of_files_is_an_error_that_names_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_paracosm-fuzz");
    let line = format!("ulimit -f 8; '{program}' --budget 400 --out camp -q");
    let output = shell(dir.path(), &line);
    refused(&output, &["camp/", "File too large"]);
}

#[test]
fn a_full_standard_output_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let line = format!("'{}' list > /dev/full", env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let output = shell(dir.path(), &line);
    refused(&output, &["the standard output", "No space left"]);
}

#[test]
fn a_test_that_takes_minutes_is_cut_off_by_an_interrupt() {
    let dir = tempfile::tempdir().unwrap();
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("standards/tests/scenarios/files");
    fs::create_dir(dir.path().join("catalogs")).unwrap();
    for name in ["slow-leader.xosc", "straight.xodr", "catalogs/entities.xosc"] {
        fs::copy(from.join(name), dir.path().join(name)).unwrap();
    }
    // A run of a day has 8.6 million ticks.
    let text = fs::read_to_string(dir.path().join("slow-leader.xosc")).unwrap();
    let endless = text.replacen("state=\"completeState\"", "state=\"skipTransition\"", 1);
    fs::write(dir.path().join("endless.xosc"), endless).unwrap();
    let arguments = ["endless.xosc", "--driver", "default", "--duration", "86000", "--budget", "1", "--out", "c"];
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let child = program.args(arguments).current_dir(dir.path()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let child = child.expect("the program starts");
    let started = dir.path().join("c/campaign.json");
    while !started.exists() {
        thread::sleep(Duration::from_millis(20));
    }
    thread::sleep(Duration::from_millis(200));
    interrupt(&child);
    let begin = std::time::Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
    assert!(!output.status.success(), "the test ended before the interrupt");
    let log = fs::read_to_string(dir.path().join("c/trials.jsonl")).unwrap_or_default();
    assert_eq!(log, "", "the test that was cut off has no trial");
}
