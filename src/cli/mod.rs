//! The two programs, as the library sees them: arguments in, an exit status out.
//!
//! Results go to standard output, everything else to standard error. The exit status is 0 when done, 1 when a
//! violation was found and that was asked about, 2 when the command, its input or the run was wrong.

mod arguments;
mod bench;
mod blame;
mod cover;
mod describe;
mod doctor;
mod draw;
mod fuzz;
mod interrupt;
mod likelihood;
mod list;
mod map;
mod monitor;
mod odd;
mod output;
mod progress;
mod record;
mod regressions;
mod replay;
mod report;
mod run;
mod sampling;
mod shrink;
mod subject;
mod suspects;
mod system;
mod trace;

use clap::Args;
use paracosm_campaign::executor::WORKER;
use paracosm_campaign::{Error, Reason, SpaceFile};
use std::fmt::Display;
use std::io::{self, Write};
use std::panic;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// How much is said on standard error.
#[derive(Debug, Clone, Copy, Args)]
struct Verbosity {
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say more on standard error
    #[arg(short, long, global = true)]
    verbose: bool,
}

impl Verbosity {
    /// Says what a reader should know of a file.
    fn noted(self, file: SpaceFile) -> SpaceFile {
        file.notes.iter().for_each(|note| self.note(note));
        file
    }

    /// Says something that is no result.
    fn note(self, message: impl Display) {
        if !self.quiet {
            complain(&message);
        }
    }
}

/// What a command that did its work found.
enum Status {
    Nothing,
    Violation,
}

/// Why a command could not do its work, in words.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// A command that makes no sense as it is.
#[derive(Debug, Error)]
#[error("{0}")]
struct Usage(String);

impl Reason for Usage {}

/// The error of a command that makes no sense as it is.
fn usage(message: String) -> Error {
    Usage(message).into()
}

/// The program `paracosm-fuzz`.
pub fn fuzz() -> ExitCode {
    quiet_workers();
    exit(arguments::parse::<fuzz::Command>().execute())
}

/// The program `paracosm-cover`.
pub fn cover() -> ExitCode {
    exit(arguments::parse::<cover::Command>().execute().map(|()| Status::Nothing))
}

fn exit(result: Result<Status, Failure>) -> ExitCode {
    match result {
        Ok(Status::Nothing) => ExitCode::SUCCESS,
        Ok(Status::Violation) => ExitCode::from(1),
        // Somebody closed the pipe that we print to, as `head` does: no reason to complain.
        Err(error) if error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe) => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            complain(&format_args!("error: {error}"));
            ExitCode::from(2)
        }
    }
}

/// Says something on standard error; where nobody listens, nothing is said.
fn complain(message: &impl Display) {
    let _ = writeln!(io::stderr(), "{message}");
}

/// Lets an interrupt set this; where there can be no handler, it ends the program at once, which logs survive as well.
fn on_interrupt(stop: Arc<AtomicBool>) {
    let _ = ctrlc::set_handler(move || stop.store(true, Ordering::Relaxed));
}

/// Prints a result.
fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    Ok(stdout.flush()?)
}

/// Keeps panics of tests, which are recorded as trials, off the terminal.
fn quiet_workers() {
    let default = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        let thread = std::thread::current();
        if !thread.name().is_some_and(|name| name.starts_with(WORKER)) {
            default(info);
        }
    }));
}
