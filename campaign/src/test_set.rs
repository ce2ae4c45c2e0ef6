//! Tests from a file: a CSV with a header, its columns named as the parameters of a space.

use crate::{Error, Reason};
use paracosm_space::demand::Demand;
use paracosm_space::{Coordinate, Parameter, ParameterError, Point, Space, SpaceError, Value, Values, nearest};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// More numbers than this, some gigabytes of tests, are refused rather than kept in memory.
const MOST_NUMBERS: usize = 50_000_000;

/// Tests with the space that they are points of.
#[derive(Debug, Clone, PartialEq)]
pub struct TestSet {
    /// Their space.
    pub space: Space,
    /// Their coordinates.
    pub points: Vec<Point>,
    /// How many discrete parameters at a time they were made to cover, if that was said.
    pub k: Option<usize>,
    /// What is asked of them beside all combinations of k values. Which values are negative matters to the combinations
    /// of discrete values; to the continuous parameters all tests count.
    pub demand: Demand,
}

/// More tests than fit in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{tests} tests of {parameters} parameters are more than fit in memory: at most {MOST_NUMBERS} numbers")]
pub struct TooManyTests {
    /// How many tests.
    pub tests: usize,
    /// Of how many parameters.
    pub parameters: usize,
}

/// What is wrong with the header of a file of tests.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HeaderFlaw {
    /// There is none.
    #[error("the file is empty, expected a header with the names of the columns")]
    Empty,
    /// Numbers stand in its place.
    #[error("found numbers, expected a header with the names of the columns")]
    Numbers,
    /// The columns are separated otherwise.
    #[error("the columns seem to be separated by `;`, expected `,`")]
    Semicolons,
    /// A column is missing.
    #[error("no column is called `{name}`{}", nearest.as_ref().map(|column| format!(" (is it `{column}`?)")).unwrap_or_default())]
    NoColumn {
        /// The name of the coordinate.
        name: String,
        /// A column that is perhaps meant.
        nearest: Option<String>,
    },
}

/// What is wrong with a test of a file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CellFlaw {
    /// Nothing stands there.
    #[error(
        "found an empty cell, expected a value{}",
        if *is_mixed { "; tests to complete may be begun only where no parameter is continuous" } else { "" }
    )]
    Open {
        /// Whether some parameters are continuous and others discrete.
        is_mixed: bool,
    },
    /// A word stands where a number is expected.
    #[error("found `{found}`, expected a number")]
    NoNumber {
        /// What stands there.
        found: Value,
    },
    /// Another value than the one at which a parameter is fixed.
    #[error("found {found}, but `{name}` is fixed at {value}; --open {name} lets it vary")]
    Fixed {
        /// What stands there.
        found: Value,
        /// The parameter.
        name: String,
        /// Its value.
        value: Value,
    },
    /// The parameter does not take the value.
    #[error(transparent)]
    Parameter(ParameterError),
    /// The values are no test of the space.
    #[error(transparent)]
    Space(SpaceError),
}

/// What is wrong with a test of a file, and in which column.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{}{flaw}{}",
    column.as_ref().map(|column| format!("column `{column}`: ")).unwrap_or_default(),
    if *is_made_up { "; name the space of the tests with --space SPACE.toml" } else { "" }
)]
pub struct WrongCell {
    /// The column, if it is one column's fault.
    pub column: Option<String>,
    /// What is wrong.
    pub flaw: CellFlaw,
    /// Whether no space was named, so that the columns were taken for coordinates.
    pub is_made_up: bool,
}

/// A folder where a file of tests is expected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{} is a folder, expected a CSV; a campaign has its tests in {}", path.display(), path.join("trials.csv").display()
)]
pub struct IsFolder {
    /// The folder.
    pub path: PathBuf,
}

impl Reason for TooManyTests {}
impl Reason for HeaderFlaw {}
impl Reason for WrongCell {}
impl Reason for IsFolder {}

impl TestSet {
    /// Tests of which nothing more is known.
    pub fn new(space: Space, points: Vec<Point>) -> Self {
        Self { space, points, k: None, demand: Demand::default() }
    }

    /// Checks that so many tests of so many parameters can be kept in memory.
    ///
    /// # Errors
    /// They are more than 50 million numbers.
    pub fn check_size(tests: usize, parameters: usize) -> Result<(), TooManyTests> {
        if parameters.saturating_mul(tests) <= MOST_NUMBERS {
            return Ok(());
        }
        Err(TooManyTests { tests, parameters })
    }

    /// Reads the tests in a file.
    ///
    /// Without a space the columns are coordinates in `[0,1]`, all continuous; with one, columns that are no parameters of it
    /// are passed over, and so are tests of a campaign that broke or could not be.
    ///
    /// # Errors
    /// The file cannot be read, or does not hold tests of the space: the error says in which line and why.
    pub fn read(path: &Path, space: Option<Space>) -> Result<Self, Error> {
        let mut file = TestsFile::open(path, space)?;
        let mut points = Vec::new();
        while let Some((line, record)) = file.next(points.len())? {
            points.push(file.test(line, &record)?.1);
        }
        Ok(Self::new(file.space, points))
    }

    /// Reads tests of a space without continuous parameters that may say nothing yet of some of the others: an empty
    /// cell is no level. Each comes with its line.
    ///
    /// # Errors
    /// As [`TestSet::read`].
    pub fn read_partial(path: &Path, space: &Space) -> Result<Vec<(usize, PartialRow)>, Error> {
        let mut file = TestsFile::open(path, Some(space.clone()))?;
        let mut rows = Vec::new();
        while let Some((line, record)) = file.next(rows.len())? {
            let level = |(coordinate, column): (Coordinate, &usize)| {
                let text = &record[*column];
                if is_open(text, coordinate.parameter) {
                    return Ok(None);
                }
                // What a constant of this choice would take, a coordinate of a signal does.
                let constant = Parameter { signal: None, ..coordinate.parameter.clone() };
                let value = value(text, &constant);
                constant.check(&value).map_err(|error| file.wrong(line, CellFlaw::Parameter(error), None))?;
                Ok(constant.level(&value))
            };
            let levels = space.discrete().zip(&file.columns).map(level).collect::<Result<_, Error>>()?;
            rows.push((line.unwrap_or_default(), levels));
        }
        Ok(rows)
    }
}

/// A test of discrete parameters that may leave some levels open.
pub type PartialRow = Vec<Option<usize>>;

/// Whether a cell says nothing of a parameter: it is empty, and the parameter does not take the empty word.
fn is_open(text: &str, parameter: &Parameter) -> bool {
    let takes_it = || parameter.levels().is_some_and(|levels| levels.contains(&Value::Word(String::new())));
    text.trim().is_empty() && !takes_it()
}

/// The value that a cell means to a parameter: the level that is written so, with its spaces or without them, else what the
/// text is by itself.
fn value(text: &str, parameter: &Parameter) -> Value {
    let levels = parameter.levels().unwrap_or_default();
    let written = |text: &str| levels.iter().find(|level| level.to_string() == text);
    written(text).or_else(|| written(text.trim())).cloned().unwrap_or_else(|| Value::parse(text))
}

/// Reads the values of tests of a space. Where a column is called as one of the fixed parameters, which are none of the
/// space, its values have to be the fixed ones.
///
/// # Errors
/// As [`TestSet::read`], or a column differs from what is fixed.
pub fn read_values(path: &Path, space: &Space, fixed: &Values) -> Result<Vec<Values>, Error> {
    if path.is_dir() {
        return Err(IsFolder { path: path.to_owned() }.into());
    }
    let mut file = TestsFile::open(path, Some(space.clone()))?;
    let fixed: Vec<(usize, &str, &Value)> = file.columns_of(fixed);
    let mut tests = Vec::new();
    while let Some((line, record)) = file.next(tests.len())? {
        for &(column, name, value) in &fixed {
            let found = Value::parse(&record[column]);
            if found != *value {
                let flaw = CellFlaw::Fixed { found, name: name.to_owned(), value: value.clone() };
                return Err(file.wrong(line, flaw, Some(column)));
            }
        }
        tests.push(file.test(line, &record)?.0);
    }
    Ok(tests)
}

/// A CSV of tests, past its header.
struct TestsFile<'p> {
    path: &'p Path,
    reader: csv::Reader<BufReader<File>>,
    header: csv::StringRecord,
    space: Space,
    /// In which column each coordinate stands.
    columns: Vec<usize>,
    /// In which column the verdicts of a campaign stand.
    verdict: Option<usize>,
    /// Whether the space follows from the columns.
    is_made_up: bool,
}

impl<'p> TestsFile<'p> {
    fn open(path: &'p Path, space: Option<Space>) -> Result<Self, Error> {
        let mut file = BufReader::new(File::open(path).map_err(Error::io("read", path))?);
        if file.fill_buf().map_err(Error::io("read", path))?.is_empty() {
            return Err(Error::in_file(path, None, HeaderFlaw::Empty));
        }
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_reader(file);
        let header = reader.headers().map_err(|error| Error::in_csv(path, error))?.clone();
        if header.iter().all(|name| name.parse::<f64>().is_ok()) {
            return Err(Error::in_file(path, 1, HeaderFlaw::Numbers));
        }
        if header.len() == 1 && header[0].contains(';') {
            return Err(Error::in_file(path, 1, HeaderFlaw::Semicolons));
        }
        let (space, is_made_up) = match space {
            Some(space) => (space, false),
            None => (of_columns(path, &header)?, true),
        };
        let columns = columns(path, &space, &header)?;
        let verdict = header.iter().position(|name| name == "verdict").filter(|column| !columns.contains(column));
        Ok(Self { path, reader, header, space, columns, verdict, is_made_up })
    }

    /// The next line, with its number; `known` tests came before. Tests of a campaign that ended in an error, or whose world
    /// could not be built, cover nothing and are passed over.
    fn next(&mut self, known: usize) -> Result<Option<(Option<usize>, csv::StringRecord)>, Error> {
        let mut record = csv::StringRecord::new();
        loop {
            if !self.reader.read_record(&mut record).map_err(|error| Error::in_csv(self.path, error))? {
                return Ok(None);
            }
            let verdict = self.verdict.and_then(|column| record.get(column));
            if !matches!(verdict, Some("error" | "invalid")) {
                break;
            }
        }
        let line = record.position().map(|position| position.line() as usize);
        TestSet::check_size(known, self.space.parameters().len())
            .map_err(|error| Error::in_file(self.path, line, error))?;
        Ok(Some((line, record)))
    }

    /// The test in a line.
    fn test(&self, line: Option<usize>, record: &csv::StringRecord) -> Result<(Values, Point), Error> {
        let mut test = Values::default();
        let mut columns = self.columns.iter();
        for parameter in self.space.parameters() {
            let mut values = Vec::new();
            for column in columns.by_ref().take(parameter.coordinates()) {
                if is_open(&record[*column], parameter) {
                    let is_mixed = self.space.dims() > 0 && self.space.discrete().next().is_some();
                    return Err(self.wrong(line, CellFlaw::Open { is_mixed }, Some(*column)));
                }
                let value = value(&record[*column], parameter);
                if parameter.levels().is_none() && value.number().is_none() {
                    return Err(self.wrong(line, CellFlaw::NoNumber { found: value }, Some(*column)));
                }
                values.push(value);
            }
            let value = if parameter.signal.is_some() { values.into_iter().collect() } else { values.remove(0) };
            test.set(parameter.name.clone(), value);
        }
        let point = self.space.encode(&test).map_err(|error| self.wrong(line, CellFlaw::Space(error), None))?;
        Ok((test, point))
    }

    /// The columns that are called as these, with the name and the value, or as one of a list of values.
    fn columns_of<'v>(&self, values: &'v Values) -> Vec<(usize, &'v str, &'v Value)> {
        let mut columns = Vec::new();
        for (name, value) in values.iter() {
            for (i, scalar) in value.scalars().iter().enumerate() {
                let called = if matches!(value, Value::List(_)) { format!("{name}[{i}]") } else { name.to_owned() };
                columns.extend(self.header.iter().position(|column| column == called).map(|c| (c, name, scalar)));
            }
        }
        columns
    }

    fn wrong(&self, line: Option<usize>, flaw: CellFlaw, column: Option<usize>) -> Error {
        let column = column.map(|column| self.header[column].to_owned());
        Error::in_file(self.path, line, WrongCell { column, flaw, is_made_up: self.is_made_up })
    }
}

/// The unit cube whose axes are called as the columns.
fn of_columns(path: &Path, header: &csv::StringRecord) -> Result<Space, Error> {
    let mut axes = Space::unit_cube(header.len()).parameters().to_vec();
    for (axis, name) in axes.iter_mut().zip(header) {
        name.clone_into(&mut axis.name);
    }
    Space::new(axes).map_err(|error| Error::in_file(path, 1, error))
}

/// In which column each coordinate stands.
fn columns(path: &Path, space: &Space, header: &csv::StringRecord) -> Result<Vec<usize>, Error> {
    let column = |name: &str| {
        header.iter().position(|column| column == name).ok_or_else(|| {
            let nearest = nearest(name, header).map(str::to_owned);
            Error::in_file(path, 1, HeaderFlaw::NoColumn { name: name.to_owned(), nearest })
        })
    };
    space.coordinates().map(|coordinate| column(&coordinate.name())).collect()
}
