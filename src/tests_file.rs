//! Tests from a file: a CSV with a header, its columns named as the parameters of a space.

use crate::estimate::Tests;
use crate::{Error, Folder, Study, Trial};
use paracosm_coverage::{Coordinate, Parameter, Point, Space, Value, Values, nearest};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// More numbers than this, some gigabytes of tests, are refused rather than kept in memory.
const MOST_NUMBERS: usize = 50_000_000;

impl Tests {
    /// Checks that so many tests of so many parameters can be kept in memory.
    ///
    /// # Errors
    /// They are more than 50 million numbers.
    pub fn check_size(tests: usize, parameters: usize) -> Result<(), Error> {
        if parameters.saturating_mul(tests) <= MOST_NUMBERS {
            return Ok(());
        }
        let message = format!(
            "{tests} tests of {parameters} parameters are more than fit in memory: at most {MOST_NUMBERS} numbers"
        );
        Err(Error::Usage(message))
    }

    /// Reads the tests in a file or in the folder of a campaign.
    ///
    /// Without a space the columns of a file are coordinates in `[0,1]`, all continuous; with one, columns that are
    /// no parameters of it are passed over. Of a campaign, broken and impossible tests are left out, and those that it
    /// counts as done come first.
    ///
    /// # Errors
    /// The file cannot be read, or does not hold tests of the space: the error says in which line and why.
    pub fn read(path: &Path, space: Option<Space>) -> Result<Self, Error> {
        if path.is_dir() {
            if space.is_some() {
                let message = format!(
                    "{} is the folder of a campaign, which has its own space: leave --space out",
                    path.display()
                );
                return Err(Error::Usage(message));
            }
            let (mut study, trials) = Folder::read(path)?;
            Folder::read_extended(path, &mut study)?;
            return Self::of_trials(&study, &trials);
        }
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
    /// As [`Tests::read`].
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
                constant.check(&value).map_err(|error| file.wrong(line, error.to_string(), None))?;
                Ok(constant.level(&value))
            };
            let levels = space.discrete().zip(&file.columns).map(level).collect::<Result<_, Error>>()?;
            rows.push((line.unwrap_or_default(), levels));
        }
        Ok(rows)
    }

    /// The tests of a campaign that say anything of where they are: not those with the verdict `error` or
    /// `invalid`. Those that the study counts as done come first.
    ///
    /// # Errors
    /// A test is not of the space, or those that are done have not been read.
    pub fn of_trials(study: &Study, trials: &[Trial]) -> Result<Self, Error> {
        let mut points = study.existing()?;
        for trial in trials.iter().filter(|trial| trial.covers()) {
            points.push(study.space.encode(&trial.test)?);
        }
        Ok(Self { k: study.strength(), ..Self::new(study.space.clone(), points) })
    }
}

/// A test of discrete parameters that may leave some levels open.
pub(crate) type PartialRow = Vec<Option<usize>>;

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
/// As [`Tests::read`], or a column differs from what is fixed.
pub(crate) fn read_values(path: &Path, space: &Space, fixed: &Values) -> Result<Vec<Values>, Error> {
    if path.is_dir() {
        let tests = path.join("trials.csv");
        let message =
            format!("{} is a folder, expected a CSV; a campaign has its tests in {}", path.display(), tests.display());
        return Err(Error::Usage(message));
    }
    let mut file = TestsFile::open(path, Some(space.clone()))?;
    let fixed: Vec<(usize, &str, &Value)> = file.columns_of(fixed);
    let mut tests = Vec::new();
    while let Some((line, record)) = file.next(tests.len())? {
        for &(column, name, value) in &fixed {
            let found = Value::parse(&record[column]);
            if found != *value {
                let message = format!("found {found}, but `{name}` is fixed at {value}; --open {name} lets it vary");
                return Err(file.wrong(line, message, Some(column)));
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
    /// What to do about wrong values where the space was made up.
    hint: &'static str,
}

impl<'p> TestsFile<'p> {
    fn open(path: &'p Path, space: Option<Space>) -> Result<Self, Error> {
        let mut file = BufReader::new(File::open(path).map_err(Error::file("read", path))?);
        if file.fill_buf().map_err(Error::file("read", path))?.is_empty() {
            let message = "the file is empty, expected a header with the names of the columns";
            return Err(Error::content(path, None, message));
        }
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_reader(file);
        let header = reader.headers().map_err(|error| broken(path, &error))?.clone();
        if header.iter().all(|name| name.parse::<f64>().is_ok()) {
            let message = "found numbers, expected a header with the names of the columns";
            return Err(Error::content(path, 1, message));
        }
        if header.len() == 1 && header[0].contains(';') {
            let message = "the columns seem to be separated by `;`, expected `,`";
            return Err(Error::content(path, 1, message));
        }
        let (space, hint) = match space {
            Some(space) => (space, ""),
            None => (of_columns(path, &header)?, "; name the space of the tests with --space SPACE.toml"),
        };
        let columns = columns(path, &space, &header)?;
        let verdict = header.iter().position(|name| name == "verdict").filter(|column| !columns.contains(column));
        Ok(Self { path, reader, header, space, columns, verdict, hint })
    }

    /// The next line, with its number; `known` tests came before. Tests of a campaign that ended in an error, or whose world
    /// could not be built, cover nothing and are passed over.
    fn next(&mut self, known: usize) -> Result<Option<(Option<usize>, csv::StringRecord)>, Error> {
        let mut record = csv::StringRecord::new();
        loop {
            if !self.reader.read_record(&mut record).map_err(|error| broken(self.path, &error))? {
                return Ok(None);
            }
            let verdict = self.verdict.and_then(|column| record.get(column));
            if !matches!(verdict, Some("error" | "invalid")) {
                break;
            }
        }
        let line = record.position().map(|position| position.line() as usize);
        Tests::check_size(known, self.space.parameters().len())
            .map_err(|error| Error::content(self.path, line, error.to_string()))?;
        Ok(Some((line, record)))
    }

    /// What is wrong with an empty cell, and where one may be left to be filled.
    fn open_cell(&self) -> String {
        let is_mixed = self.space.dims() > 0 && self.space.discrete().next().is_some();
        let mixed =
            if is_mixed { "; tests to complete may be begun only where no parameter is continuous" } else { "" };
        format!("found an empty cell, expected a value{mixed}")
    }

    /// The test in a line.
    fn test(&self, line: Option<usize>, record: &csv::StringRecord) -> Result<(Values, Point), Error> {
        let mut test = Values::default();
        let mut columns = self.columns.iter();
        for parameter in self.space.parameters() {
            let mut values = Vec::new();
            for column in columns.by_ref().take(parameter.coordinates()) {
                if is_open(&record[*column], parameter) {
                    return Err(self.wrong(line, self.open_cell(), Some(*column)));
                }
                let value = value(&record[*column], parameter);
                if parameter.levels().is_none() && value.number().is_none() {
                    return Err(self.wrong(line, format!("found `{value}`, expected a number"), Some(*column)));
                }
                values.push(value);
            }
            let value = if parameter.signal.is_some() { values.into_iter().collect() } else { values.remove(0) };
            test.set(parameter.name.clone(), value);
        }
        let point = self.space.encode(&test).map_err(|error| self.wrong(line, error.to_string(), None))?;
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

    fn wrong(&self, line: Option<usize>, message: String, column: Option<usize>) -> Error {
        let column = column.map(|column| format!("column `{}`: ", &self.header[column])).unwrap_or_default();
        Error::content(self.path, line, format!("{column}{message}{}", self.hint))
    }
}

/// The unit cube whose axes are called as the columns.
fn of_columns(path: &Path, header: &csv::StringRecord) -> Result<Space, Error> {
    let mut axes = Space::unit_cube(header.len()).parameters().to_vec();
    for (axis, name) in axes.iter_mut().zip(header) {
        name.clone_into(&mut axis.name);
    }
    Space::new(axes).map_err(|error| Error::content(path, 1, error.to_string()))
}

/// In which column each coordinate stands.
fn columns(path: &Path, space: &Space, header: &csv::StringRecord) -> Result<Vec<usize>, Error> {
    let column = |name: &str| {
        header.iter().position(|column| column == name).ok_or_else(|| {
            let hint = nearest(name, header).map(|column| format!(" (is it `{column}`?)")).unwrap_or_default();
            Error::content(path, 1, format!("no column is called `{name}`{hint}"))
        })
    };
    space.coordinates().map(|coordinate| column(&coordinate.name())).collect()
}

fn broken(path: &Path, error: &csv::Error) -> Error {
    let line = error.position().map(|position| position.line() as usize);
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            Error::content(path, line, format!("found {len} fields, expected {expected_len}"))
        }
        csv::ErrorKind::Utf8 { .. } => Error::content(path, line, "found bytes that are no UTF-8"),
        _ => Error::content(path, line, error.to_string()),
    }
}
