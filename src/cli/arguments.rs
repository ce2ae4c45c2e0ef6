//! Reads the arguments with clap, and explains in words for people that a number was expected.

use super::{complain, output_error, paint, program};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Parser};
use std::error::Error;
use std::io::{self, IsTerminal, Write};
use std::num::{IntErrorKind, ParseFloatError, ParseIntError};
use std::process;

/// The headings of options.
pub(super) const TESTED: &str = "What is tested";
pub(super) const CHOSEN: &str = "How tests are chosen";
pub(super) const REQUIRED: &str = "Requirements";
pub(super) const SUITES: &str = "The suites";
pub(super) const COMPARED: &str = "What is compared";
pub(super) const ESTIMATED: &str = "The estimate";
pub(super) const RECORDED: &str = "What is recorded";
pub(super) const TRIED: &str = "The perceiver on trial";
pub(super) const RUNNING: &str = "Running";
pub(super) const OUTPUT: &str = "Output";

/// Returns the program's arguments. Ends the program if they are wrong, or if only help was asked for.
pub(super) fn parse<C: Parser>() -> C {
    // The usage shows the name in the source, whatever the file is called, so that `program::help` replaces it everywhere.
    let command = C::command();
    let name = command.get_name().to_owned();
    let matches = adapted(command.bin_name(name)).try_get_matches_from(program::words());
    let read = matches.and_then(|mut matches| C::from_arg_matches_mut(&mut matches));
    read.unwrap_or_else(|error| match explained(&error) {
        Some(message) => {
            complain(&format_args!("error: {message}\n\nFor more information, try '--help'."));
            process::exit(2)
        }
        None => {
            // Help and the version go to the standard output, which may be full or closed.
            let printed = shown(&error).and_then(|()| io::stdout().flush());
            process::exit(match printed.map_err(output_error) {
                Err(problem) if problem.kind() != io::ErrorKind::BrokenPipe => {
                    complain(&format_args!("error: {problem}"));
                    2
                }
                _ => error.exit_code(),
            })
        }
    })
}

/// Prints help, an error or the version. A program of a user's own has its own name in help and errors. The version is the version of
/// this software.
fn shown(error: &clap::Error) -> io::Result<()> {
    if program::is_usual() || error.kind() == ErrorKind::DisplayVersion {
        return error.print();
    }
    let rendered = error.render();
    let text = |is_coloured: bool| {
        program::help(&if is_coloured { rendered.ansi().to_string() } else { rendered.to_string() })
    };
    if error.use_stderr() {
        io::stderr().write_all(text(io::stderr().is_terminal()).as_bytes())
    } else {
        io::stdout().write_all(text(paint::is_wanted()).as_bytes())
    }
}

/// Reads `-1` as a value and not as an option, so that the error can say which value was expected. The short help of a command with
/// subcommands lists the subcommands alone.
fn adapted(command: Command) -> Command {
    let lists = command.has_subcommands();
    let command = command.allow_negative_numbers(true).mut_subcommands(adapted);
    if lists { command.mut_args(|option| option.hide_short_help(true)) } else { command }
}

/// Says what was found and what was expected, if a number was expected.
fn explained(error: &clap::Error) -> Option<String> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text),
        _ => None,
    };
    let source = Some(error).filter(|error| error.kind() == ErrorKind::ValueValidation)?.source()?;
    let whole = source.downcast_ref().map(|error: &ParseIntError| match error.kind() {
        IntErrorKind::Zero => "a whole number from 1 on",
        IntErrorKind::PosOverflow => "a smaller number",
        _ => "a whole number from 0 on",
    });
    let expected = whole.or_else(|| source.is::<ParseFloatError>().then_some("a number"))?;
    let (option, found) = (text(ContextKind::InvalidArg)?, text(ContextKind::InvalidValue)?);
    Some(format!("{option}: found `{found}`, expected {expected}"))
}
