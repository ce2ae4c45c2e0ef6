//! Ctrl-C during a search: what there is so far is printed.

use crate::common::{cover, stdout, succeeds};
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};

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
