//! What the end-to-end tests share: calling the programs, and comparing what they print with golden files.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// `paracosm-fuzz` with these arguments, in a folder.
pub fn fuzz(dir: &Path, arguments: &[&str]) -> Output {
    program(env!("CARGO_BIN_EXE_paracosm-fuzz"), dir, arguments)
}

/// `paracosm-cover` with these arguments, in a folder.
pub fn cover(dir: &Path, arguments: &[&str]) -> Output {
    program(env!("CARGO_BIN_EXE_paracosm-cover"), dir, arguments)
}

fn program(path: &str, dir: &Path, arguments: &[&str]) -> Output {
    Command::new(path).args(arguments).current_dir(dir).output().expect("the program starts")
}

/// Standard output as text.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("it prints text")
}

/// Standard error as text.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("it prints text")
}

/// The lines of a log without the hash of the study, to compare the tests of different studies.
pub fn without_study(log: &str) -> String {
    let without =
        |line: &str| line.split_once(",\"study\":").map_or(line.to_owned(), |(tests, _)| format!("{tests}}}"));
    log.lines().map(|line| without(line) + "\n").collect()
}

/// Checks that a command did its work.
#[track_caller]
pub fn succeeds(output: Output) -> Output {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    output
}

/// Checks that a command was refused with exit status 2 and a message that says these things, without a panic.
#[track_caller]
pub fn refused(output: &Output, says: &[&str]) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
    for word in says {
        assert!(message.contains(word), "`{word}` is missing in: {message}");
    }
}

/// Compares with `tests/golden/NAME`; with `UPDATE_GOLDEN=1` in the environment writes it instead.
#[track_caller]
pub fn golden(name: &str, found: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, found).expect("the golden file can be written");
        return;
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    assert!(expected == found, "{name} differs; UPDATE_GOLDEN=1 accepts this:\n{found}");
}

/// The names and the contents of all files in a folder.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(path).unwrap())).collect()
}
