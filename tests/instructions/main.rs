//! Counts the instructions of key works, and fails if a work takes more than the baseline allows.
//!
//! The number of instructions does not depend on the load of the machine, so that it can guard speed in every run of
//! the tests. Callgrind counts (valgrind). Without valgrind, or with another compiler than the compiler of the
//! baseline, the check says so and is skipped.
//!
//! `cargo test --release --test instructions -- --write` writes the baseline. The commit that changes the baseline
//! says why.

mod baseline;
mod works;

use baseline::Baseline;
use std::process::{Command, ExitCode};

/// The share by which a work may take more instructions than in the baseline.
const TOLERANCE: f64 = 0.03;

/// The command that writes the baseline.
const WRITE: &str = "cargo test --release --test instructions -- --write";

/// The argument by which the program calls itself under valgrind, for one work.
const DO: &str = "--do";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [first, name] = &arguments[..]
        && first == DO
    {
        alone(name);
        return ExitCode::SUCCESS;
    }
    if arguments.iter().any(|argument| argument == "--list") {
        works::ALL.iter().for_each(|(name, _)| println!("{name}: test"));
        return ExitCode::SUCCESS;
    }
    let filters: Vec<&String> = arguments.iter().filter(|argument| !argument.starts_with('-')).collect();
    let is_wanted = |name: &str| filters.is_empty() || filters.iter().any(|filter| name.contains(filter.as_str()));
    let wanted: Vec<_> = works::ALL.iter().map(|(name, _)| *name).filter(|name| is_wanted(name)).collect();
    if wanted.is_empty() {
        return ExitCode::SUCCESS;
    }
    let is_writing = arguments.iter().any(|argument| argument == "--write");
    if is_writing && !filters.is_empty() {
        println!(
            "instructions: --write counts all works, because all counts are of one compiler; leave out {filters:?}"
        );
        return ExitCode::FAILURE;
    }
    check(&wanted, is_writing)
}

/// Counts the instructions of the works, and compares them with the baseline or writes the baseline.
fn check(works: &[&str], is_writing: bool) -> ExitCode {
    let here = baseline::compiler();
    let known = Baseline::read().or_else(|| is_writing.then(Baseline::default));
    let Some(baseline) = known else {
        println!("instructions: {} cannot be read; write it by `{WRITE}`", baseline::FILE);
        return ExitCode::FAILURE;
    };
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("instructions: skipped, because valgrind is not installed");
        return ExitCode::SUCCESS;
    }
    if !is_writing && baseline.compiler != here {
        println!("instructions: skipped, because the baseline is of {}, and this is {here}", baseline.compiler);
        return ExitCode::SUCCESS;
    }
    let mut counted = Baseline::default();
    let mut failures = 0;
    println!("{:>15} {:>15} {:>7}  work", "baseline", "instructions", "change");
    for &work in works {
        let Some(found) = count(work) else {
            println!("{:>39}  {work}: valgrind counted nothing", "");
            failures += 1;
            continue;
        };
        let expected = baseline.of(work);
        let change = expected.map(|expected| found as f64 / expected as f64 - 1.0);
        let is_failure = !is_writing && change.is_none_or(|change| change > TOLERANCE);
        let note = match (is_failure, change) {
            (true, Some(_)) => "  FAILED",
            (true, None) => "  FAILED: the baseline does not have this work",
            (false, Some(change)) if change < -TOLERANCE => "  faster: the baseline can be lowered",
            (false, _) => "",
        };
        let change = change.map_or_else(String::new, |change| format!("{:+.1} %", 100.0 * change));
        let expected = expected.map_or_else(String::new, |expected| expected.to_string());
        println!("{expected:>15} {found:>15} {change:>7}  {work}{note}");
        failures += usize::from(is_failure);
        counted.set(work, found);
    }
    if is_writing {
        counted.compiler = here;
        counted.write();
        println!("written: {}", baseline::FILE);
    }
    if failures == 0 {
        return ExitCode::SUCCESS;
    }
    println!(
        "\n{failures} of {} works failed. A work may take {:.0} % more instructions than {} says. Find out why it takes\n\
         more. If the new number is right, write it by `{WRITE}`, and say in the commit why.",
        works.len(),
        100.0 * TOLERANCE,
        baseline::FILE
    );
    ExitCode::FAILURE
}

/// Returns the number of instructions of a work; `None` if valgrind fails.
fn count(work: &str) -> Option<u64> {
    let program = std::env::current_exe().expect("the path of this program");
    let counted = Command::new("valgrind")
        .args([
            "--tool=callgrind",
            "--callgrind-out-file=/dev/null",
            "--collect-atstart=no",
            "--toggle-collect=*instructions::counted*",
        ])
        .arg(program)
        .args([DO, work])
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&counted.stderr);
    let count = said.lines().find_map(|line| line.split_once("Collected : ")).map(|(_, count)| count.trim().parse());
    count.and_then(Result::ok).filter(|count| *count > 0 && counted.status.success())
}

/// Does a single work. All of it runs on this thread, because valgrind counts what a thread does inside [`counted`].
fn alone(name: &str) {
    let (_, prepare) = works::ALL.iter().find(|(other, _)| *other == name).expect("the name of a work");
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global().expect("a pool of one thread");
    counted(&mut prepare());
}

/// The only function whose instructions are counted, with all that it calls.
#[inline(never)]
fn counted(work: &mut works::Ready) {
    work();
}
