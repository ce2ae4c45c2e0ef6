//! `paracosm-cover generate`: tests by a strategy, as CSV.

use super::{check_size, read_space};
use crate::cli::{Failure, Verbosity};
use crate::coverage::{Point, Space};
use crate::generators::{Aim, Generator, Request, Strategy};
use crate::{Error, Tests};
use clap::{ArgGroup, Args};
use indicatif::{ProgressBar, ProgressStyle};
use std::io;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover generate --dims 3 --strategy sobol --budget 256 > points.csv
  paracosm-cover generate --space SPACE.toml --budget 500 > tests.csv
  paracosm-cover generate --space SPACE.toml --extend tests.csv --budget 20      the 20 tests to add
  paracosm-cover generate --dims 20 --strategy greedy --measure k-wise-dispersion --k 2 --budget 200";

/// Of how many tests are written between two looks at the progress bar.
const BATCH: usize = 64;

/// What `generate` takes.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, group = ArgGroup::new("of").required(true).multiple(true))]
pub(super) struct Options {
    /// The space of the tests
    #[arg(long, value_name = "SPACE.toml", conflicts_with = "dims", group = "of")]
    space: Option<PathBuf>,
    /// The unit cube of that many dimensions
    #[arg(long, value_name = "D", group = "of")]
    dims: Option<usize>,
    /// How tests are chosen; `paracosm-fuzz list` shows all strategies [default: halton; greedy with --extend]
    #[arg(long, value_name = "S")]
    strategy: Option<String>,
    /// How many tests to make [default: 500; all rows where no parameter is continuous]
    #[arg(long, value_name = "N")]
    budget: Option<usize>,
    /// The source of all chance; sequences without it are plain, with it randomly shifted
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// The index of a sequence's first point [default: 1 for halton, 0 for the others]
    #[arg(long, value_name = "N")]
    skip: Option<u64>,
    /// How discrete parameters are covered: random (Proposition 3.2) or cross (all combinations) [default: random]
    #[arg(long, value_name = "FAMILY")]
    discrete: Option<String>,
    /// How many parameters are covered together [default: 2]
    #[arg(long, value_name = "K")]
    k: Option<usize>,
    /// What greedy makes small: dispersion or k-wise-dispersion [default: dispersion of continuous spaces and for each
    /// row of --discrete, k-wise-dispersion of others]
    #[arg(long, value_name = "MEASURE")]
    measure: Option<String>,
    /// Tests that are there already; those printed are the ones to add. Without a space its columns are in [0,1]
    #[arg(long, value_name = "TESTS.csv", group = "of")]
    extend: Option<PathBuf>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<(), Failure> {
        let space = match (&self.space, self.dims) {
            (Some(path), _) => Some(read_space(path)?),
            (None, Some(dims)) => {
                check_size(1, dims)?;
                Some(Space::unit_cube(dims))
            }
            (None, None) => None,
        };
        let (space, existing) = match (space, &self.extend) {
            (space, Some(path)) => {
                let tests = Tests::read(path, space)?;
                (tests.space, tests.points)
            }
            (Some(space), None) => (space, Vec::new()),
            (None, None) => return Err(Error::Usage("expected --space, --dims or --extend".into()).into()),
        };
        let strategy = match &self.strategy {
            Some(name) => name.parse::<Strategy>().map_err(Error::from)?,
            None if self.extend.is_some() => Strategy::Greedy,
            None => Strategy::Halton,
        };
        let generator = self.generator(&space, strategy, &existing)?;
        let most = self.budget.unwrap_or(if space.dims() == 0 { usize::MAX } else { DEFAULT_BUDGET });
        let written = write(generator, &space, most, verbosity)?;
        let after = self.extend.as_ref().map(|path| format!(" after the {} in {}", existing.len(), path.display()));
        verbosity.note(format_args!("{written} tests by {strategy}{}", after.unwrap_or_default()));
        Ok(())
    }

    fn generator(&self, space: &Space, strategy: Strategy, existing: &[Point]) -> Result<Box<dyn Generator>, Error> {
        let mut request = Request {
            seed: self.seed,
            skip: self.skip,
            k: self.k,
            existing,
            ..Request::new(space, self.budget.unwrap_or(DEFAULT_BUDGET))
        };
        if let Some(family) = &self.discrete {
            request.discrete = family.parse()?;
        }
        request.aim = match &self.measure {
            Some(measure) => Some(measure.parse()?),
            // Who names a family wants its rows.
            None => self.discrete.as_ref().filter(|_| strategy == Strategy::Greedy).map(|_| Aim::Dispersion),
        };
        Ok(strategy.build(&request)?)
    }
}

const DEFAULT_BUDGET: usize = 500;

/// Writes at most that many tests as they are made; how many there were.
fn write(
    mut generator: Box<dyn Generator>,
    space: &Space,
    most: usize,
    verbosity: Verbosity,
) -> Result<usize, io::Error> {
    let bar = if verbosity.quiet || most == usize::MAX { ProgressBar::hidden() } else { ProgressBar::new(most as u64) };
    let template = "{bar:40.blue/white} {human_pos}/{human_len} tests  {eta} left";
    let bar = bar.with_style(ProgressStyle::with_template(template).expect("the template is one"));
    let mut csv = csv::Writer::from_writer(io::stdout().lock());
    csv.write_record(space.coordinates().map(|coordinate| coordinate.name())).map_err(plain)?;
    let mut written = 0;
    while written < most {
        let tests = generator.ask(BATCH.min(most - written));
        if tests.is_empty() {
            break;
        }
        for test in &tests {
            let values = space.decode(test);
            let values = values.iter().flat_map(|(_, value)| value.scalars());
            csv.write_record(values.map(ToString::to_string)).map_err(plain)?;
        }
        written += tests.len();
        bar.inc(tests.len() as u64);
    }
    bar.finish_and_clear();
    csv.flush()?;
    Ok(written)
}

/// What the system said, so that a closed pipe is known as one.
fn plain(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}
