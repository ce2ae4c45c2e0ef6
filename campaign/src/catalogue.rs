//! Catalogues: they find scenarios by name or by file.
//!
//! A campaign knows no scenario by itself. It is given a catalogue: a list of programs, and readers that make programs
//! from files.

use crate::{Error, Reason};
use paracosm_engine::Program;
use paracosm_space::{did_you_mean, nearest};
use std::ffi::OsStr;
use std::path::Path;
use thiserror::Error;

/// The scenarios that a command or a program can name.
///
/// ```
/// use paracosm_campaign::Catalogue;
///
/// let catalogue = Catalogue::of(paracosm_scenarios::ALL);
/// assert_eq!(catalogue.find("cut-in")?.name(), "cut-in");
/// let error = catalogue.find("cut-inn").unwrap_err();
/// assert!(error.to_string().contains("did you mean `cut-in`?"));
/// # Ok::<(), paracosm_campaign::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    programs: Vec<Program>,
    readers: Vec<Reader>,
}

/// A reader that makes programs from files.
#[derive(Debug, Clone, Copy)]
pub struct Reader {
    /// The ending of the files that the reader reads, without the dot.
    pub ending: &'static str,
    /// The kind of the files, in a few words.
    pub about: &'static str,
    /// Reads a file and returns its program.
    pub read: fn(&Path) -> Result<Program, Error>,
}

/// The error that no scenario has this name.
#[derive(Debug, Error, PartialEq)]
#[error("no scenario is called `{name}`{}; `paracosm-fuzz list` shows all scenarios", did_you_mean(.nearest))]
pub struct UnknownScenario {
    /// The name that was asked for.
    pub name: String,
    /// The name of a scenario that was perhaps meant.
    pub nearest: Option<String>,
}

impl Reason for UnknownScenario {}

impl Catalogue {
    /// Makes a catalogue of these programs.
    pub fn of(programs: &[&Program]) -> Self {
        Self { programs: programs.iter().copied().cloned().collect(), readers: Vec::new() }
    }

    /// Adds a program. It replaces a program of the same name.
    pub fn with(mut self, program: Program) -> Self {
        self.programs.retain(|other| other.name() != program.name());
        self.programs.push(program);
        self
    }

    /// Adds a reader of files.
    pub fn reading(mut self, reader: Reader) -> Self {
        self.readers.push(reader);
        self
    }

    /// Returns all programs that have a name, in order.
    pub fn programs(&self) -> &[Program] {
        &self.programs
    }

    /// Returns the readers of files, in order.
    pub fn readers(&self) -> &[Reader] {
        &self.readers
    }

    /// Returns the program with this name, or the program in the file with this path.
    ///
    /// # Errors
    /// No scenario has the name; the error suggests the nearest name. Or a reader cannot make a program from the file.
    pub fn find(&self, name: &str) -> Result<Program, Error> {
        if let Some(program) = self.programs.iter().find(|program| program.name() == name) {
            return Ok(program.clone());
        }
        let ending = Path::new(name).extension().and_then(OsStr::to_str);
        if let Some(reader) = self.readers.iter().find(|reader| Some(reader.ending) == ending) {
            return (reader.read)(Path::new(name));
        }
        let nearest = nearest(name, self.programs.iter().map(Program::name)).map(str::to_owned);
        Err(UnknownScenario { name: name.to_owned(), nearest }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_makes_programs_of_the_files_with_its_ending_and_of_no_others() {
        let read = |path: &Path| {
            let name = path.file_stem().and_then(OsStr::to_str).unwrap_or_default().to_owned();
            Ok(Program::of(name, "a world of a file", |_| ()))
        };
        let catalogue = Catalogue::default().reading(Reader { ending: "world", about: "worlds of a test", read });
        assert_eq!(catalogue.find("folder/town.world").expect("it is read").name(), "town");
        let error = catalogue.find("town.xodr").expect_err("nothing reads it");
        assert!(matches!(error.reason(), Some(UnknownScenario { name, .. }) if name == "town.xodr"), "{error}");
        assert_eq!(catalogue.readers().len(), 1);
    }
}
