//! Tests from a folder of concrete scenarios: files that are the scenario of a study with the values of one test each.

use crate::test_set::{CellFlaw, TestSet};
use crate::{Catalogue, ConcreteValue, Error, Reason, Study};
use paracosm_space::{Point, Values};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The error that a folder has no files of tests.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{} is a folder and not that of a campaign, and has no file that ends with .{ending}; expected a CSV of tests, the folder of \
     a campaign, or a folder of concrete scenarios .{ending}", path.display()
)]
pub struct NoConcrete {
    /// The path of the folder.
    pub path: PathBuf,
    /// The ending of the files.
    pub ending: &'static str,
}

/// The error that a folder of files of tests does not fit a scenario that is no file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{} is a folder and not that of a campaign, and `{scenario}` is not the scenario of a file, so it has no concrete scenarios; \
     expected a CSV of tests or the folder of a campaign", path.display()
)]
pub struct NoFileOfScenario {
    /// The path of the folder.
    pub path: PathBuf,
    /// The name of the scenario.
    pub scenario: String,
}

impl Reason for NoConcrete {}
impl Reason for NoFileOfScenario {}
impl Reason for CellFlaw {}

impl TestSet {
    /// Reads the tests of a folder of concrete scenarios, in the order of the names of the files. Each file is the scenario of the
    /// study with other values of its parameters. Files with other endings and folders in the folder are left alone.
    ///
    /// # Errors
    /// The scenario is not that of a file, the folder has no concrete scenario, a file is no such scenario, or a value is not one
    /// that the study gives the parameter.
    pub fn of_folder(folder: &Path, study: &Study, catalogue: &Catalogue) -> Result<Self, Error> {
        let scenario = study.program()?.name();
        let reader = catalogue.reader_of(scenario).and_then(|reader| Some((reader.ending, reader.tests?)));
        let Some((ending, tests)) = reader else {
            return Err(NoFileOfScenario { path: folder.to_owned(), scenario: scenario.to_owned() }.into());
        };
        let entries = folder.read_dir().map_err(Error::io("read", folder))?;
        let paths = entries.map(|entry| Ok(entry.map_err(Error::io("read", folder))?.path()));
        let mut files = paths.collect::<Result<Vec<_>, Error>>()?;
        files.retain(|file| file.is_file() && file.extension().is_some_and(|of| of.eq_ignore_ascii_case(ending)));
        files.sort();
        if files.is_empty() {
            return Err(NoConcrete { path: folder.to_owned(), ending }.into());
        }
        Self::check_size(files.len(), study.space().parameters().len())?;
        let tests = tests(Path::new(scenario), &files)?;
        let points = files.iter().zip(tests).map(|(file, test)| point(file, &test, study)).collect::<Result<_, _>>()?;
        Ok(Self::new(study.space().clone(), points))
    }
}

/// Returns the test of a file as a point of the space of a study.
fn point(file: &Path, stated: &[ConcreteValue], study: &Study) -> Result<Point, Error> {
    let mut test = Values::default();
    for ConcreteValue { name, value, line } in stated {
        let wrong = |flaw: CellFlaw| Error::in_file(file, *line, flaw);
        if let Some(parameter) = study.space().find(name) {
            parameter.check(value).map_err(|error| wrong(CellFlaw::Parameter(error)))?;
            test.set(name.as_str(), value.clone());
        } else if let Some(fixed) = study.fixed().get(name).filter(|fixed| *fixed != value) {
            return Err(wrong(CellFlaw::Fixed { found: value.clone(), name: name.clone(), value: fixed.clone() }));
        }
    }
    study.space().encode(&test).map_err(|error| Error::in_file(file, None, CellFlaw::Space(error)))
}
