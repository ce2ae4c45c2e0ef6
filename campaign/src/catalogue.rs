//! Catalogues: they find scenarios by name or by file.
//!
//! A campaign knows no scenario by itself. It is given a catalogue: a list of programs, and readers that make programs
//! from files.

use crate::{Error, Reason, Trust};
use paracosm_engine::Program;
use paracosm_space::{Value, did_you_mean, nearest};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A catalogue that finds scenarios by name or by file.
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
    /// The folder of the campaign whose scenario is looked for.
    near: Option<PathBuf>,
    /// `true` if files that a campaign names may be run.
    is_trusted: bool,
}

/// A reader that makes the programs of scenarios from files.
#[derive(Debug, Clone, Copy)]
pub struct Reader {
    /// The file name extension that the reader accepts, without the dot.
    pub ending: &'static str,
    /// A short description of the kind of files that the reader reads.
    pub about: &'static str,
    /// The kind of contents of the files.
    pub holds: Holds,
    /// The function that reads a file and returns the program of a scenario in the file: of the scenario with this name, or of the only one.
    pub read: fn(&Path, Option<&str>) -> Result<Program, Error>,
    /// The function that reads tests of the scenario in the first file from other files: each is the same scenario with the values of
    /// one test. `None` if there are no such files.
    pub tests: Option<TestsOf>,
}

/// The kind of contents of files of scenarios.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holds {
    /// The description of one scenario.
    Description,
    /// Programs, which run when they are read. A file may have several scenarios: `FILE:NAME` names one of them.
    Programs,
}

/// The value of a parameter that the file of a concrete scenario has.
#[derive(Debug, Clone, PartialEq)]
pub struct ConcreteValue {
    /// The name of the parameter.
    pub name: String,
    /// The value.
    pub value: Value,
    /// The number of the line that has the value, from 1.
    pub line: usize,
}

/// A function that reads tests of the scenario in a file from other files.
pub type TestsOf = fn(&Path, &[PathBuf]) -> Result<Vec<Vec<ConcreteValue>>, Error>;

/// The error that no scenario has the requested name.
#[derive(Debug, Error, PartialEq)]
#[error("no scenario is called `{name}`{}; `paracosm-fuzz list` shows all scenarios", did_you_mean(.nearest))]
pub struct UnknownScenario {
    /// The name that no scenario has.
    pub name: String,
    /// The most similar name of a scenario; `None` if no name is similar.
    pub nearest: Option<String>,
}

/// The error that two scenarios have the requested name.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("two scenarios are called `{name}`: \"{}\" and \"{}\"; give one of them another name", about[0], about[1])]
pub struct AmbiguousScenario {
    /// The name of the scenarios.
    pub name: String,
    /// The descriptions of the first two scenarios of the name.
    pub about: [String; 2],
}

/// The error that the file of a campaign's scenario is not there.
#[derive(Debug, Error, PartialEq, Eq)]
#[error(
    "found no file {name} in {}, in a folder around it, or in the present folder; expected the file where the campaign began",
    near.display()
)]
pub struct NoScenarioFile {
    /// The path of the file from the folder in which the campaign began.
    pub name: String,
    /// The folder of the campaign.
    pub near: PathBuf,
}

/// The error that a campaign names a file that is a program, which nobody trusts.
#[derive(Debug, Error, PartialEq, Eq)]
#[error(
    "the file of the scenario `{name}` is a program: if you trust its author, add `--trust` (in Python `trust=True`)"
)]
pub struct UntrustedScenario {
    /// The name of the scenario.
    pub name: String,
}

impl Reason for UntrustedScenario {}
impl Reason for UnknownScenario {}
impl Reason for AmbiguousScenario {}
impl Reason for NoScenarioFile {}

impl Catalogue {
    /// Makes a catalogue of the given programs of scenarios.
    pub fn of(programs: &[&Program]) -> Self {
        Self { programs: programs.iter().copied().cloned().collect(), ..Self::default() }
    }

    /// Adds the program of a scenario to the catalogue. If two programs have the same name, [`find`](Self::find) returns an error for
    /// this name.
    pub fn with(mut self, program: Program) -> Self {
        self.programs.push(program);
        self
    }

    /// Adds a reader of scenario files to the catalogue, in the place of another reader of files with the same ending.
    pub fn reading(mut self, reader: Reader) -> Self {
        self.readers.retain(|other| other.ending != reader.ending);
        self.readers.push(reader);
        self
    }

    /// Returns the catalogue with the trust of the user in the files that campaigns name. Without trust in all, no such file is run.
    pub fn trusting(&self, trust: &Trust) -> Self {
        Self { is_trusted: trust.is_all(), ..self.clone() }
    }

    /// Returns a catalogue for the scenario of the campaign in a folder. The campaign names a file by its path from the folder in which
    /// the campaign began, which need not be the present folder. So the file is looked for from the folder of the campaign, then from
    /// the folders around it, the nearest first, and at last from the present folder.
    pub fn near(&self, folder: &Path) -> Self {
        Self { near: Some(folder.to_owned()), ..self.clone() }
    }

    /// Returns the path of a file of a scenario.
    fn file(&self, name: &str) -> Result<PathBuf, NoScenarioFile> {
        let named = PathBuf::from(name);
        let Some(near) = &self.near else { return Ok(named) };
        let around = std::path::absolute(near).unwrap_or_else(|_| near.clone());
        let mut places = around.ancestors().map(|folder| folder.join(name)).chain([named.clone()]);
        let found = places.find(|place| place.is_file());
        let found = found.ok_or_else(|| NoScenarioFile { name: name.to_owned(), near: near.clone() })?;
        // The same file keeps its name.
        let is_named = named.canonicalize().is_ok_and(|own| found.canonicalize().is_ok_and(|found| own == found));
        Ok(if is_named { named } else { found })
    }

    /// Returns the programs of the catalogue, in the order in which the programs were added.
    pub fn programs(&self) -> &[Program] {
        &self.programs
    }

    /// Returns the readers of scenario files, in the order in which the readers were added.
    pub fn readers(&self) -> &[Reader] {
        &self.readers
    }

    /// Returns `true` if a scenario has the name, or if a reader accepts files with the ending of the name.
    pub fn knows(&self, name: &str) -> bool {
        self.programs.iter().any(|program| program.name() == name) || self.located(name).is_some()
    }

    /// Returns the reader of the files with the ending of a name. Capital and small letters of the ending are the same.
    pub fn reader_of(&self, name: &str) -> Option<&Reader> {
        let ending = Path::new(name).extension().and_then(OsStr::to_str)?;
        self.readers.iter().find(|reader| reader.ending.eq_ignore_ascii_case(ending))
    }

    /// Returns the reader of the file that a name begins with, the file, and the name of one of its scenarios.
    fn located<'n>(&self, name: &'n str) -> Option<(&Reader, &'n str, Option<&'n str>)> {
        if let Some(reader) = self.reader_of(name) {
            return Some((reader, name, None));
        }
        let (file, part) = name.rsplit_once(':')?;
        let reader = self.reader_of(file).filter(|reader| reader.holds == Holds::Programs)?;
        Some((reader, file, Some(part)))
    }

    /// Returns the program of the scenario with the given name, or the program in the file with the given path.
    ///
    /// # Errors
    /// No scenario has the name; the error suggests the nearest name. Two scenarios have the name. Or a reader cannot make a program from
    /// the file.
    pub fn find(&self, name: &str) -> Result<Program, Error> {
        let mut named = self.programs.iter().filter(|program| program.name() == name);
        match (named.next(), named.next()) {
            (Some(program), None) => return Ok(program.clone()),
            (Some(one), Some(other)) => {
                let about = [one, other].map(|program| program.about().to_owned());
                return Err(AmbiguousScenario { name: name.to_owned(), about }.into());
            }
            (None, _) => {}
        }
        if let Some((reader, file, part)) = self.located(name) {
            if reader.holds == Holds::Programs && self.near.is_some() && !self.is_trusted {
                return Err(UntrustedScenario { name: name.to_owned() }.into());
            }
            return (reader.read)(&self.file(file)?, part);
        }
        let nearest = nearest(name, self.programs.iter().map(Program::name)).map(str::to_owned);
        Err(UnknownScenario { name: name.to_owned(), nearest }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_scenarios_of_one_name_are_an_error_that_shows_both() {
        let program = |about| Program::of("jogger", about, |_| ());
        let catalogue = Catalogue::default().with(program("a jogger crosses")).with(program("a jogger stands"));
        let error = catalogue.find("jogger").expect_err("the name is ambiguous").to_string();
        assert_eq!(
            error,
            "two scenarios are called `jogger`: \"a jogger crosses\" and \"a jogger stands\"; give one of them another name"
        );
    }

    #[test]
    fn a_reader_makes_programs_of_the_files_with_its_ending_and_of_no_others() {
        let read = |path: &Path, _: Option<&str>| {
            let name = path.file_stem().and_then(OsStr::to_str).unwrap_or_default().to_owned();
            Ok(Program::of(name, "a world of a file", |_| ()))
        };
        let reader =
            Reader { ending: "world", about: "worlds of a test", holds: Holds::Description, read, tests: None };
        let catalogue = Catalogue::default().reading(reader);
        for file in ["folder/town.world", "folder/town.WORLD"] {
            assert_eq!(catalogue.find(file).expect("it is read").name(), "town");
            assert!(catalogue.knows(file));
        }
        let error = catalogue.find("town.xodr").expect_err("nothing reads it");
        assert!(matches!(error.reason(), Some(UnknownScenario { name, .. }) if name == "town.xodr"), "{error}");
        assert_eq!(catalogue.readers().len(), 1);
    }

    #[test]
    fn a_file_of_programs_that_a_campaign_names_runs_only_with_trust() {
        let read = |path: &Path, part: Option<&str>| {
            let name = format!("{}:{}", path.display(), part.unwrap_or("only"));
            Ok(Program::of(name, "a program", |_| ()))
        };
        let reader = Reader { ending: "prog", about: "programs of a test", holds: Holds::Programs, read, tests: None };
        let catalogue = Catalogue::default().reading(reader);
        let find = |catalogue: &Catalogue, name| catalogue.find(name).map(|program| program.name().to_owned());
        assert_eq!(find(&catalogue, "a.prog").expect("the user names it"), "a.prog:only");
        assert_eq!(find(&catalogue, "a.prog:second").expect("the user names it"), "a.prog:second");
        assert!(catalogue.knows("a.prog:second") && !catalogue.knows("a.xosc:second"));

        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("a.prog"), "").expect("a file");
        let near = catalogue.near(folder.path());
        let error = near.find("a.prog:second").expect_err("nobody trusts it");
        assert!(matches!(error.reason(), Some(UntrustedScenario { name }) if name == "a.prog:second"), "{error}");
        let trusted = find(&near.trusting(&Trust::all()), "a.prog:second").expect("it is trusted");
        assert!(trusted.ends_with("a.prog:second"), "{trusted}");
        assert!(near.trusting(&Trust::NOTHING.command("drive")).find("a.prog").is_err());
    }
}
