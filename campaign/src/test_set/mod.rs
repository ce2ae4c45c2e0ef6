//! Reads tests from a CSV file whose header names the parameters of a space, or from a file of numbers.

mod flaws;
mod layout;

pub use self::flaws::{CellFlaw, HeaderFlaw, IsFolder, TooManyTests, WrongCell};
use self::layout::Layout;
use crate::Error;
use crate::files::Lines;
use paracosm_space::demand::Demand;
use paracosm_space::pict::Aliases;
use paracosm_space::{Coordinate, Parameter, Point, Space, Value, Values, nearest};
use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

/// A set of tests, with the space to which the tests belong.
#[derive(Debug, Clone, PartialEq)]
pub struct TestSet {
    /// The space to which the tests belong.
    pub space: Space,
    /// The coordinates of the tests in the space.
    pub points: Vec<Point>,
    /// The number of discrete parameters whose combinations the tests should cover; `None` if the number is not known.
    pub k: Option<usize>,
    /// The combinations of values that the tests should cover in addition to all combinations of values of any k
    /// parameters. Negative values matter only to the combinations of discrete values; all tests count for the
    /// continuous parameters.
    pub demand: Demand,
}

impl TestSet {
    /// Makes a set of tests from a space and the coordinates of the tests.
    pub fn new(space: Space, points: Vec<Point>) -> Self {
        Self { space, points, k: None, demand: Demand::default() }
    }

    /// Checks that the given number of tests, each with the given number of parameters, fits in memory.
    ///
    /// # Errors
    /// The tests are more than 50 million numbers.
    pub fn check_size(tests: usize, parameters: usize) -> Result<(), TooManyTests> {
        if parameters.saturating_mul(tests) <= flaws::MOST_NUMBERS {
            return Ok(());
        }
        Err(TooManyTests { tests, parameters })
    }

    /// Reads a set of tests from a CSV file.
    ///
    /// Commas separate the columns, or tabs as in files of PICT. A cell may hold an alias of a value, and the sign `~`
    /// of a negative value. Without a space, all columns are continuous coordinates in `[0,1]`. With a space, columns
    /// that are not parameters of the space are ignored, and so are tests of a campaign with the verdict `error` or
    /// `invalid`.
    ///
    /// A file may also consist of numbers between spaces, tabs or commas, and of comments that begin with `#`, as
    /// `numpy.savetxt` writes. The columns are the coordinates of the space in its order, unless a comment before the numbers
    /// names coordinates: the last such comment then has a name for each column.
    ///
    /// # Errors
    /// The file cannot be read, or does not hold tests of the space: the error says in which line and why.
    pub fn read(path: &Path, space: Option<Space>, aliases: &Aliases) -> Result<Self, Error> {
        Self::read_from(Lines::open(path)?, path, space, aliases)
    }

    /// Reads a set of tests as [`TestSet::read`] from an input; `path` is the name of the input in errors.
    ///
    /// # Errors
    /// The same errors as [`TestSet::read`].
    pub fn read_from(
        source: Lines<impl Read + 'static>,
        path: &Path,
        space: Option<Space>,
        aliases: &Aliases,
    ) -> Result<Self, Error> {
        TestsFile::of(source, path, space, aliases)?.all()
    }

    /// Reads points of the unit cube, whose coordinates are the columns of the file.
    ///
    /// # Errors
    /// The file cannot be read, or a value is not in `[0,1]`.
    pub fn read_points(path: &Path) -> Result<Self, Error> {
        TestsFile { is_made_up: false, ..TestsFile::open(path, None, &Aliases::default())? }.all()
    }

    /// Reads tests whose cells may be empty from a CSV file, for a space without continuous parameters. An empty cell
    /// is `None`. Each test comes with its line.
    ///
    /// # Errors
    /// The same errors as [`TestSet::read`].
    pub fn read_partial(path: &Path, space: &Space, aliases: &Aliases) -> Result<Vec<(usize, PartialRow)>, Error> {
        let mut file = TestsFile::open(path, Some(space.clone()), aliases)?;
        let mut rows = Vec::new();
        while let Some((line, record)) = file.next(rows.len())? {
            let level = |(position, (coordinate, column)): (usize, (Coordinate, &usize))| {
                let text = &record[*column];
                if is_open(text, coordinate.parameter) {
                    return Ok(None);
                }
                // A cell of a signal is a coordinate, and takes the same values as a constant parameter of this choice.
                let constant = Parameter { signal: None, ..coordinate.parameter.clone() };
                let value = file.value(text, position, &constant);
                constant.check(&value).map_err(|error| file.wrong(line, CellFlaw::Parameter(error), None))?;
                Ok(constant.level(&value))
            };
            let levels = space.discrete().zip(&file.columns).enumerate().map(level).collect::<Result<_, Error>>()?;
            rows.push((line.unwrap_or_default(), levels));
        }
        Ok(rows)
    }
}

/// A test of discrete parameters, as the index of each parameter's level; `None` if the level is not chosen yet.
pub type PartialRow = Vec<Option<usize>>;

/// Returns `true` if a cell leaves a parameter open. The cell is empty then, and the empty word is not a level of the
/// parameter.
fn is_open(text: &str, parameter: &Parameter) -> bool {
    let takes_it = || parameter.levels().is_some_and(|levels| levels.contains(&Value::Word(String::new())));
    text.trim().is_empty() && !takes_it()
}

/// Writes tests as CSV, with a column for every coordinate of the space.
pub fn tests_as_csv(space: &Space, tests: &[Values]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
    write(space.coordinates().map(|coordinate| coordinate.name()).collect());
    for test in tests {
        write(test.iter().flat_map(|(_, value)| value.scalars()).map(ToString::to_string).collect());
    }
    csv.into_inner().expect("memory does not fail to flush")
}

/// Reads tests from a CSV file as values of the parameters of a space. If a column has the name of a fixed parameter
/// (which is not part of the space), the values in the column must be the fixed value.
///
/// # Errors
/// The same errors as [`TestSet::read`], or a column differs from a fixed value.
pub fn read_values(path: &Path, space: &Space, fixed: &Values) -> Result<Vec<Values>, Error> {
    if path.is_dir() {
        return Err(IsFolder { path: path.to_owned() }.into());
    }
    let aliases = Aliases::default();
    let mut file = TestsFile::open(path, Some(space.clone()), &aliases)?;
    let fixed: Vec<(usize, &str, &Value)> = file.columns_of(fixed);
    let mut tests = Vec::new();
    while let Some((line, record)) = file.next(tests.len())? {
        for &(column, name, value) in &fixed {
            let found = Value::parse(&record[column]);
            if found != *value && record[column] != value.to_string() {
                let flaw = CellFlaw::Fixed { found, name: name.to_owned(), value: value.clone() };
                return Err(file.wrong(line, flaw, Some(column)));
            }
        }
        tests.push(file.test(line, &record)?.0);
    }
    Ok(tests)
}

/// A file of tests whose columns are known.
struct TestsFile<'p> {
    path: &'p Path,
    aliases: &'p Aliases,
    reader: csv::Reader<Box<dyn Read>>,
    /// The names of the columns.
    header: csv::StringRecord,
    space: Space,
    /// For each discrete parameter by its name, the positions of its levels by their texts.
    texts: HashMap<String, HashMap<String, usize>>,
    /// The index of the column of each coordinate.
    columns: Vec<usize>,
    /// The index of the column of a campaign's verdicts.
    verdict: Option<usize>,
    /// True if the space was made from the columns, so that the tests may belong to another one.
    is_made_up: bool,
}

impl<'p> TestsFile<'p> {
    fn open(path: &'p Path, space: Option<Space>, aliases: &'p Aliases) -> Result<Self, Error> {
        Self::of(Lines::open(path)?, path, space, aliases)
    }

    fn of(
        source: Lines<impl Read + 'static>,
        path: &'p Path,
        space: Option<Space>,
        aliases: &'p Aliases,
    ) -> Result<Self, Error> {
        let (layout, source) = Layout::of(source).map_err(Error::io("read", path))?;
        let mut reader = layout.reader(source);
        let header = match &layout {
            Layout::Empty => return Err(Error::in_file(path, None, HeaderFlaw::Empty)),
            Layout::Header { .. } => reader.headers().map_err(|error| Error::in_csv(path, error))?.clone(),
            Layout::Numbers { first, comments, .. } => {
                names(first, comments, space.as_ref()).map_err(|flaw| Error::in_file(path, None, flaw))?
            }
        };
        if header.len() == 1 && header[0].contains(';') {
            return Err(Error::in_file(path, 1, HeaderFlaw::Semicolons));
        }
        let (space, is_made_up) = match space {
            Some(space) => (space, false),
            None => (of_columns(path, &header)?, true),
        };
        let columns = columns(path, &space, &header)?;
        let verdict = header.iter().position(|name| name == "verdict").filter(|column| !columns.contains(column));
        let texts = |parameter: &Parameter| {
            let levels = parameter.levels()?.iter().enumerate().rev();
            Some((parameter.name.clone(), levels.map(|(level, value)| (value.to_string(), level)).collect()))
        };
        let texts = space.parameters().iter().filter_map(texts).collect();
        Ok(Self { path, aliases, texts, reader, header, space, columns, verdict, is_made_up })
    }

    /// Reads all tests of the file.
    fn all(mut self) -> Result<TestSet, Error> {
        let mut points = Vec::new();
        while let Some((line, record)) = self.next(points.len())? {
            points.push(self.test(line, &record)?.1);
        }
        Ok(TestSet::new(self.space, points))
    }

    /// Returns the next record with its line; `known` is the number of tests that were read before. Skips tests of a
    /// campaign that ended in an error or whose world could not be built, because they cover nothing.
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

    /// Returns the value of a cell for a parameter. It is the level with exactly this text, with or without its spaces,
    /// with or without the sign `~` of negative values, or the level with this alias. If there is none, it is the value
    /// that the text has by itself. `discrete` is the position of the parameter among the discrete parameters.
    fn value(&self, text: &str, discrete: usize, parameter: &Parameter) -> Value {
        let levels = parameter.levels().unwrap_or_default();
        let texts = self.texts.get(&parameter.name);
        let written = |text: &str| texts.and_then(|texts| texts.get(text)).map(|level| &levels[*level]);
        let text = text.trim_end_matches('\r');
        let plain = text.trim().strip_prefix('~').map(str::trim);
        let alias = |text: &str| self.aliases.level(discrete, text).and_then(|level| levels.get(level));
        let found = written(text).or_else(|| written(text.trim())).or_else(|| plain.and_then(written));
        let found = found.or_else(|| alias(plain.unwrap_or(text)));
        found.cloned().unwrap_or_else(|| Value::parse(text))
    }

    /// Returns the test in a record.
    fn test(&self, line: Option<usize>, record: &csv::StringRecord) -> Result<(Values, Point), Error> {
        let mut test = Values::default();
        let mut columns = self.columns.iter();
        let mut discrete = 0;
        for parameter in self.space.parameters() {
            let mut values = Vec::new();
            for column in columns.by_ref().take(parameter.coordinates()) {
                if is_open(&record[*column], parameter) {
                    let is_mixed = self.space.dims() > 0 && self.space.discrete().next().is_some();
                    return Err(self.wrong(line, CellFlaw::Open { is_mixed }, Some(*column)));
                }
                let value = self.value(&record[*column], discrete, parameter);
                discrete += usize::from(parameter.levels().is_some());
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

    /// Returns the columns of these values, each with the name and the value, or with one value of a list.
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

/// Returns the names of the columns of a file of numbers. They are the words of the last comment that names a coordinate of the space; without a
/// space, those of the last comment with as many words as columns. Otherwise the columns are the coordinates in their order.
fn names(first: &[String], comments: &[Vec<String>], space: Option<&Space>) -> Result<csv::StringRecord, HeaderFlaw> {
    let columns = first.len();
    // A table of numbers in pandas has the numbers of its columns as a header.
    if [0, 1].iter().any(|begin| first.iter().enumerate().all(|(i, cell)| *cell == (begin + i).to_string())) {
        return Err(HeaderFlaw::ColumnNumbers { line: first.join(",") });
    }
    let Some(space) = space else {
        let named = comments.iter().rev().find(|words| words.len() == columns);
        let unnamed = || Space::unit_cube(columns).coordinates().map(|of| of.name()).collect();
        return Ok(named.map_or_else(unnamed, |words| words.iter().collect()));
    };
    let expected: Vec<String> = space.coordinates().map(|of| of.name()).collect();
    let known = |word: &String| expected.iter().find(|name| name.eq_ignore_ascii_case(word));
    if let Some(words) = comments.iter().rev().find(|words| words.iter().any(|word| known(word).is_some())) {
        let names: Vec<&String> = words.iter().map(|word| known(word).unwrap_or(word)).collect();
        if names.len() == columns && expected.iter().all(|name| names.iter().filter(|word| **word == name).count() == 1)
        {
            return Ok(names.into_iter().collect());
        }
        return Err(HeaderFlaw::Comment { found: words.join(", "), columns, expected });
    }
    if columns == expected.len() {
        Ok(expected.iter().collect())
    } else {
        Err(HeaderFlaw::Columns { found: columns, expected })
    }
}

/// Returns the unit cube whose axes have the names of the columns.
fn of_columns(path: &Path, header: &csv::StringRecord) -> Result<Space, Error> {
    let mut axes = Space::unit_cube(header.len()).parameters().to_vec();
    for (axis, name) in axes.iter_mut().zip(header) {
        name.clone_into(&mut axis.name);
    }
    Space::new(axes).map_err(|error| Error::in_file(path, 1, error))
}

/// Returns the index of the column of each coordinate.
fn columns(path: &Path, space: &Space, header: &csv::StringRecord) -> Result<Vec<usize>, Error> {
    let column = |name: &str| {
        header.iter().position(|column| column == name).ok_or_else(|| {
            let nearest = nearest(name, header).map(str::to_owned);
            Error::in_file(
                path,
                1,
                HeaderFlaw::NoColumn {
                    name: name.to_owned(),
                    nearest,
                    found: header.iter().collect::<Vec<_>>().join(", "),
                },
            )
        })
    };
    let columns: Vec<usize> =
        space.coordinates().map(|coordinate| column(&coordinate.name())).collect::<Result<_, _>>()?;
    let twice = columns.iter().find(|column| header.iter().skip(**column + 1).any(|name| name == &header[**column]));
    match twice {
        Some(column) => Err(Error::in_file(path, 1, HeaderFlaw::Twice { name: header[*column].to_owned() })),
        None => Ok(columns),
    }
}
