//! Every command that a document shows runs, in the order of the document, in a fresh folder.
//!
//! A block marked `console` shows a session: a line that begins with `$` is a command, other lines are its output. A
//! block marked `sh` shows commands that prepare a machine or build something; only a few kinds of them may stand in
//! documents.

use std::fs;
use std::io::{self, Write};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The beginnings of commands that this test does not run. They build from the sources, or install packages.
const PREPARATIONS: [&str; 6] = [
    "apt install ",
    "cargo install ",
    "cargo run ",
    "pip install ",
    "tests/run",
    "paracosm-fuzz record follow-leader --model ",
];

/// The folders of the repository that commands may name.
const FOLDERS: [&str; 5] = ["examples", "experiments", "python", "standards", "tests"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// README.md and the chapters of the book.
fn documents() -> Vec<PathBuf> {
    let mut all = pages("docs");
    all.push(root().join("README.md"));
    all
}

/// The pages in a folder.
fn pages(folder: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(root().join(folder)).expect("the folder is there").map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect();
    pages.sort();
    pages
}

/// The commands in the blocks of a kind: lines in `sh`, lines that begin with `$` in `console`, joined where they go
/// on.
fn commands(text: &str, kind: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut block = None;
    let mut goes_on = false;
    for line in text.lines() {
        if let Some(opened) = line.strip_prefix("```") {
            block = if block.is_some() { None } else { Some(opened.to_owned()) };
            continue;
        }
        if block.as_deref() != Some(kind) {
            continue;
        }
        let command = if kind == "console" { line.strip_prefix("$ ") } else { Some(line) };
        if goes_on {
            found.last_mut().expect("a command goes on").push_str(line.trim().trim_end_matches('\\'));
            goes_on = line.ends_with('\\');
        } else if let Some(command) = command.filter(|command| !command.is_empty()) {
            found.push(command.trim_end_matches('\\').to_owned());
            goes_on = line.ends_with('\\');
        }
    }
    found
}

/// A fresh folder in which the folders of the repository can be named.
fn fresh() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    for name in FOLDERS {
        symlink(root().join(name), folder.path().join(name)).expect("a link can be made");
    }
    folder
}

/// Runs a command in a shell that knows the two programs.
fn run(command: &str, folder: &Path, programs: &Path) -> Result<(), String> {
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap_or_default());
    let output = Command::new("bash")
        .args(["-euo", "pipefail", "-c", command])
        .current_dir(folder)
        .env("PATH", path)
        .output()
        .expect("bash starts");
    if output.status.success() {
        return Ok(());
    }
    Err(format!("$ {command}\n{}", String::from_utf8_lossy(&output.stderr)))
}

/// Whether a driver in Python can run here.
fn has_python_driver() -> bool {
    let import = "import numpy, paracosm, grpc";
    Command::new("python3").args(["-c", import]).output().is_ok_and(|output| output.status.success())
}

#[test]
fn every_command_that_a_document_shows_runs() {
    let programs = tempfile::tempdir().expect("a folder can be made");
    for (name, path) in [
        ("paracosm-fuzz", env!("CARGO_BIN_EXE_paracosm-fuzz")),
        ("paracosm-cover", env!("CARGO_BIN_EXE_paracosm-cover")),
    ] {
        symlink(path, programs.path().join(name)).expect("a link can be made");
    }
    let drives = has_python_driver();
    let (mut wrong, mut ran) = (Vec::new(), 0);
    for document in documents() {
        let text = fs::read_to_string(&document).expect("a document is text");
        let name = document.strip_prefix(root()).unwrap_or(&document).display().to_string();
        let folder = fresh();
        for command in commands(&text, "console") {
            if command.contains("lane_follow.py") && !drives {
                let _ = writeln!(io::stderr(), "skipped: `{command}` needs the package of drivers in Python");
                continue;
            }
            ran += 1;
            if let Err(said) = run(&command, folder.path(), programs.path()) {
                wrong.push(format!("{name}: {said}"));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(ran > 60, "only {ran} commands ran");
}

#[test]
fn what_a_document_shows_beside_sessions_only_builds_or_installs() {
    let mut wrong = Vec::new();
    for document in documents() {
        let text = fs::read_to_string(&document).expect("a document is text");
        for command in commands(&text, "sh") {
            if !PREPARATIONS.iter().any(|beginning| command.starts_with(beginning)) {
                wrong.push(format!("{}: {command}", document.display()));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "Write these as a session, ```console with `$`, so that they are run:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn the_first_command_of_the_readme_is_the_first_of_its_tour_and_the_picture_stands_on_the_first_screen() {
    let text = fs::read_to_string(root().join("README.md")).expect("README.md is there");
    let first = commands(&text, "sh").into_iter().next().expect("it has a command");
    let tour = commands(&text, "console").into_iter().next().expect("it has a tour");
    let arguments = first.strip_prefix("cargo run --release --bin paracosm-fuzz --").expect("it runs the program");
    assert_eq!(format!("paracosm-fuzz{arguments}"), tour);
    let picture = text.lines().position(|line| line.contains("failure-map.png")).expect("it has a picture");
    assert!(picture < 45, "the picture stands in line {}", picture + 1);
}

#[test]
fn the_book_has_every_chapter_and_every_link_leads_somewhere() {
    let summary = fs::read_to_string(root().join("docs/SUMMARY.md")).expect("the book has a summary");
    let mut wrong = Vec::new();
    for document in documents().into_iter().chain(pages("docs/decisions")) {
        let chapter = document.strip_prefix(root().join("docs")).ok().map(|path| path.display().to_string());
        let name = chapter.clone().unwrap_or_else(|| "README.md".to_owned());
        if chapter.is_some_and(|name| name != "SUMMARY.md" && !summary.contains(&format!("({name})"))) {
            wrong.push(format!("docs/SUMMARY.md does not name {name}"));
        }
        let text = fs::read_to_string(&document).expect("a document is text");
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
            if target.contains("://") {
                continue;
            }
            let linked = if path.is_empty() { document.clone() } else { document.parent().unwrap().join(path) };
            if !linked.exists() {
                wrong.push(format!("{name}: there is no {target}"));
            } else if !anchor.is_empty() && !headings(&linked).iter().any(|heading| heading == anchor) {
                wrong.push(format!("{name}: {path} has no heading #{anchor}"));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// The anchors of a page's headings.
fn headings(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).expect("a page is text");
    let headings = text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let anchor = |heading: &str| -> String {
        let kept = heading.to_lowercase().replace(' ', "-");
        kept.chars().filter(|letter| letter.is_alphanumeric() || matches!(letter, '-' | '_')).collect()
    };
    headings.map(anchor).collect()
}
