//! The two programs: they read arguments, call the library, print the result and return an exit status.
//!
//! Results go to standard output, everything else to standard error. The exit status is 0 if the command has done its
//! work, 1 if a requirement was violated and the user asked about violations, and 2 if the command, its input or the
//! run was wrong.

mod arguments;
mod audit;
mod bench;
mod blame;
mod cover;
mod describe;
mod diff;
mod doctor;
mod draw;
mod export;
mod fuzz;
mod gate;
mod github;
mod given;
mod interrupt;
mod likelihood;
mod list;
mod map;
mod merge;
mod monitor;
mod odd;
mod output;
mod page;
mod paint;
mod perceive;
mod perceiver;
mod program;
mod progress;
mod record;
mod regressions;
mod repeat;
mod replay;
mod report;
mod roads;
mod run;
mod sampling;
mod sensitivity;
mod shrink;
mod subject;
mod suspects;
mod system;
mod trace;
mod trust;
mod view;

use clap::Args;
use interrupt::on_interrupt;
use paracosm_campaign::executor::WORKER;
use paracosm_campaign::{Catalogue, Error, Log, Reason, SpaceFile, Study, Supervision};
use std::borrow::Cow;
use std::ffi::OsString;
use std::fmt::Display;
use std::io::{self, Write};
use std::panic;
use std::path::Path;
use std::process::ExitCode;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;
use thiserror::Error;

/// The options that decide how much is printed to standard error.
#[derive(Debug, Clone, Copy, Args)]
struct Verbosity {
    /// Print nothing but errors to standard error
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Print more to standard error
    #[arg(short, long, global = true)]
    verbose: bool,
}

impl Verbosity {
    const SILENT: Self = Self { quiet: true, verbose: false };

    /// Prints a note, which is no result.
    fn note(self, message: impl Display) {
        if !self.quiet {
            complain(&message);
        }
    }

    /// Returns the supervision of tests. With -v, the output of programs is shown line by line.
    fn supervision(self) -> Supervision {
        let supervision = Supervision::default();
        if self.verbose {
            supervision.output.listen(|role, line| {
                complain(&format!("{role}: {}", String::from_utf8_lossy(line).trim_end()));
            });
        }
        supervision
    }

    /// Does some work. Prints the note if the work takes more than two seconds.
    fn noting_if_slow<T>(self, note: &str, work: impl FnOnce() -> T) -> T {
        let (working, ended) = mpsc::channel::<()>();
        thread::scope(|scope| {
            scope.spawn(move || {
                if ended.recv_timeout(Duration::from_secs(2)) == Err(RecvTimeoutError::Timeout) {
                    self.note(note);
                }
            });
            let result = work();
            drop(working);
            result
        })
    }
}

/// The option that refuses a file of a space if reading the file gives notes, and groups that give notes.
#[derive(Debug, Clone, Copy, Args)]
struct Strict {
    /// Refuse files with notes
    ///
    /// A file of a space, or --strength, is refused if notes on it would be printed: for example a PICT model with an
    /// unknown parameter in a constraint, or a group that adds nothing.
    #[arg(long, requires = "space", hide_short_help = true)]
    strict: bool,
}

impl Strict {
    /// Reads the file of a space, and prints its notes. The path may also be that of a scenario file or of the folder of a campaign,
    /// whose open parameters are the space.
    ///
    /// # Errors
    /// The file cannot be read or is not valid; or the file has notes and `--strict` is given.
    fn read(self, path: &Path, catalogue: &Catalogue, verbosity: Verbosity) -> Result<SpaceFile, Error> {
        let file = if path.is_dir() {
            SpaceFile::from(Log::read(path, catalogue)?.study().space().clone())
        } else if let Some(name) = path.to_str().filter(|name| path.exists() && catalogue.knows(name)) {
            SpaceFile::from(Study::of(catalogue.find(name)?).build()?.space().clone())
        } else {
            SpaceFile::read(path)?
        };
        self.accept(&file.notes, "a file with notes; repair the file", verbosity)?;
        Ok(file)
    }

    /// Prints notes.
    ///
    /// # Errors
    /// There are notes, and `--strict` is given. `refused` says what is refused, and how to repair it.
    fn accept(self, notes: &[String], refused: &str, verbosity: Verbosity) -> Result<(), Error> {
        if self.strict && !notes.is_empty() {
            let notes = notes.join("\n");
            return Err(usage(format!("--strict refuses {refused}, or leave out --strict:\n{notes}")));
        }
        notes.iter().for_each(|note| verbosity.note(note));
        Ok(())
    }
}

/// The finding of a command that has done its work.
enum Status {
    Nothing,
    Violation,
}

/// The reason why a command could not do its work.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// An error in the arguments of a command, in words.
#[derive(Debug, Error)]
#[error("{0}")]
struct Usage(String);

impl Reason for Usage {}

/// Makes an error about the arguments of a command.
fn usage(message: String) -> Error {
    Usage(message).into()
}

/// Runs the program `paracosm-fuzz` with the scenarios of a catalogue. A program of one's own has all commands of `paracosm-fuzz`
/// for its own scenarios if its `main` calls this function:
///
/// ```no_run
/// # use paracosm::engine::{Program, Scenario};
/// # fn jogger(_: &mut Scenario) {}
/// fn main() -> std::process::ExitCode {
///     paracosm::cli::fuzz(&paracosm::catalogue().with(Program::new("jogger", "a jogger crosses", jogger)))
/// }
/// ```
pub fn fuzz(catalogue: &Catalogue) -> ExitCode {
    ExitCode::from(fuzz_in_process(catalogue))
}

/// Runs the program `paracosm-cover` with the scenarios of a catalogue, whose spaces it can measure.
pub fn cover(catalogue: &Catalogue) -> ExitCode {
    ExitCode::from(cover_in_process(catalogue))
}

/// Takes the words of the command line from the caller, for a process whose own words are others: a program in Python that runs
/// [`fuzz_in_process`] or [`cover_in_process`]. The first word is the program. Only the first call counts.
pub fn called_with(words: Vec<OsString>) {
    program::is_called_with(words);
}

/// Runs the program `paracosm-fuzz`, like [`fuzz`], and returns its exit status. It ends the process itself if the arguments are wrong, for
/// help, and after Ctrl-C.
pub fn fuzz_in_process(catalogue: &Catalogue) -> u8 {
    program::takes_the_place();
    quiet_workers();
    interrupt::listen();
    status(fuzz::Command::of(catalogue).and_then(|command| command.execute(catalogue)))
}

/// Runs the program `paracosm-cover`, like [`cover`], and returns its exit status. It ends the process itself if the arguments are wrong, for
/// help, and after Ctrl-C.
pub fn cover_in_process(catalogue: &Catalogue) -> u8 {
    interrupt::listen();
    status(arguments::parse::<cover::Command>().execute(catalogue).map(|()| Status::Nothing))
}

/// Returns the exit status of a command, and prints its error.
fn status(result: Result<Status, Failure>) -> u8 {
    match result {
        Ok(Status::Nothing) => 0,
        Ok(Status::Violation) => 1,
        // The reader closed the pipe, as `head` does. This is no error.
        Err(error) if error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe) => 0,
        Err(error) => {
            complain(&format_args!("error: {error}"));
            2
        }
    }
}

/// Prints a message to standard error. A closed standard error is no error.
fn complain(message: &impl Display) {
    let text = message.to_string();
    let text = program::message(&text);
    let lines = text.split('\n').map(shortened).collect::<Vec<_>>().join("\n");
    let _ = writeln!(io::stderr(), "{}", printable(&lines));
}

/// The greatest number of characters in a line of a message.
const LONGEST: usize = 4000;

/// Returns a line of a message without its middle if the line is very long, since files of others may have values of
/// millions of characters.
fn shortened(line: &str) -> Cow<'_, str> {
    let characters = line.chars().count();
    if characters <= LONGEST {
        return Cow::Borrowed(line);
    }
    let head: String = line.chars().take(LONGEST / 2).collect();
    let tail: String = line.chars().skip(characters - LONGEST / 2).collect();
    Cow::Owned(format!("{head} [{} characters are not shown] {tail}", characters - LONGEST))
}

/// Returns a text with its control characters escaped, except ends of lines and tabs. A file or a system of somebody
/// else could otherwise write to any place of the terminal, or change the order in which its characters are shown.
fn printable(text: &str) -> Cow<'_, str> {
    let turns =
        |c| matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let is_harmful = |c: char| c.is_control() && !matches!(c, '\n' | '\t') || turns(c);
    if !text.contains(is_harmful) {
        return Cow::Borrowed(text);
    }
    let escape = |c: char| if is_harmful(c) { c.escape_default().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(escape).collect())
}

/// Prints a result, with colours on a terminal.
fn print(text: &str) -> Result<(), Failure> {
    let mut text = printable(text);
    if paint::is_wanted() {
        text = Cow::Owned(paint::painted(&text));
    }
    let mut stdout = io::stdout().lock();
    let written = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush());
    Ok(written.map_err(output_error)?)
}

/// Returns an error in writing to the standard output with words that say so, unless the reader of a pipe has gone.
fn output_error(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::BrokenPipe => error,
        kind => io::Error::new(kind, format!("cannot write to the standard output: {error}")),
    }
}

/// Keeps panics of tests off the terminal. They are recorded as trials.
fn quiet_workers() {
    let default = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        let thread = std::thread::current();
        if !thread.name().is_some_and(|name| name.starts_with(WORKER)) {
            default(info);
        }
    }));
}
