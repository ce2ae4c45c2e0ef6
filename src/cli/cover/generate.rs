//! `paracosm-cover generate`: makes tests by a strategy, as CSV.

use super::array::ArrayOptions;
use super::reached::Reached;
use super::{open_loop, strength, time_limit};
use crate::cli::interrupt::Interruptible;
use crate::cli::output::{broken, plural};
use crate::cli::sampling::Sampling;
use crate::cli::usage;
use crate::cli::{Failure, Strict, Verbosity, complain, output_error};
use crate::coverage::Deadline;
use crate::generators::{DiscreteFamily, Generator, Purpose, Request, Strategy};
use crate::notes::capped_strength;
use crate::space::demand::Demand;
use crate::space::{Point, Space};
use clap::{ArgGroup, Args};
use indicatif::{ProgressBar, ProgressStyle};
use paracosm_analysis::Promise;
use paracosm_campaign::{Catalogue, Error, SpaceFile, TestSet};
use std::collections::HashSet;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover generate --dims 3 --strategy sobol --budget 256 > points.csv
  paracosm-cover generate --space SPACE.toml --budget 500 > tests.csv
  paracosm-cover generate --space SPACE.toml --extend tests.csv --budget 20
      the 20 tests to add
  paracosm-cover generate --space MODEL.pict --k 3 --strength Type,Size,Format=4 --optimise 10
  paracosm-cover generate --space SPACE.toml --k 2 --epsilon 0.1
      as many tests as needed
  paracosm-cover generate --dims 20 --strategy greedy --measure k-wise-dispersion --k 2 --budget 200";

/// The number of tests that are written between two updates of the progress bar.
const BATCH: usize = 64;

/// The options of `generate`.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES, group = ArgGroup::new("of").required(true).multiple(true))]
pub(super) struct Options {
    /// The space of the tests
    ///
    /// For a scenario file or the folder of a campaign, the space has the open parameters.
    #[arg(long, value_name = "SPACE", conflicts_with = "dims", group = "of")]
    space: Option<PathBuf>,
    #[command(flatten)]
    strict: Strict,
    /// The number of dimensions, if the space is a unit cube
    #[arg(long, value_name = "D", group = "of")]
    dims: Option<usize>,
    /// The strategy [default: halton]
    ///
    /// `paracosm-fuzz list strategies` shows all strategies. The default is greedy with --extend.
    #[arg(long, value_name = "S")]
    strategy: Option<String>,
    /// The number of tests
    ///
    /// [default: 500; all rows if no parameter is continuous]
    #[arg(long, value_name = "N")]
    budget: Option<usize>,
    #[command(flatten)]
    sampling: Sampling,
    /// Cover combinations of K in a group
    ///
    /// A group of discrete parameters whose combinations of K are covered, too. K is more than --k.
    #[arg(long, value_name = "NAME,..=K")]
    strength: Vec<String>,
    /// Seconds for a smaller covering array
    #[arg(long, value_name = "SECONDS")]
    optimise: Option<f64>,
    /// Limit the seconds for --epsilon
    ///
    /// The time counts from the first test on. Tests made within this time are printed [default: 60].
    #[arg(long, value_name = "SECONDS", requires = "epsilon")]
    time_limit: Option<f64>,
    /// Print the tests to add to a file
    ///
    /// Without a space the columns are in [0,1].
    #[arg(long, value_name = "TESTS.csv", group = "of")]
    extend: Option<PathBuf>,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<(), Failure> {
        let file = match (&self.space, self.dims) {
            (Some(path), _) => Some(self.strict.read(path, catalogue, verbosity)?),
            (None, Some(dims)) => {
                TestSet::check_size(1, dims)?;
                Some(SpaceFile::from(Space::unit_cube(dims)))
            }
            (None, None) => None,
        };
        let (space, mut demand, aliases) = match file {
            Some(SpaceFile { space, demand, aliases, .. }) => (Some(space), demand, aliases),
            None => Default::default(),
        };
        let (space, existing, existing_rows) = match (space, &self.extend) {
            // Rows of a covering array may be begun and left for us to complete.
            (Some(space), Some(path)) if space.dims() == 0 => {
                let rows = TestSet::read_partial(path, &space, &aliases)?;
                let complete = rows.iter().filter_map(|(_, row)| row.iter().copied().collect());
                let existing: Vec<Point> =
                    complete.map(|discrete| Point { continuous: Vec::new(), discrete }).collect();
                let named = |(line, levels)| (format!("line {line}"), levels);
                (space, existing, rows.into_iter().map(named).collect())
            }
            (space, Some(path)) => {
                let TestSet { space, points, .. } = TestSet::read(path, space, &aliases)?;
                let row = |(number, test): (usize, &Point)| {
                    (format!("test {}", number + 1), test.discrete.iter().copied().map(Some).collect())
                };
                let rows = points.iter().enumerate().map(row).collect();
                (space, points, rows)
            }
            (Some(space), None) => (space, Vec::new(), Vec::new()),
            (None, None) => return Err(usage("expected --space, --dims or --extend".into()).into()),
        };
        demand.groups.extend(strength::groups(&self.strength, &space)?);
        let strategy = match &self.strategy {
            Some(name) => open_loop(name)?,
            None if self.extend.is_some() => Strategy::usual(Purpose::Complete),
            None => Strategy::usual(Purpose::Cover),
        };
        let request = self.request(&space, strategy, &existing)?;
        if let Some(path) = self.extend.as_ref().filter(|_| space.dims() > 0) {
            broken(&space, &existing, &path.display().to_string()).into_iter().for_each(|note| verbosity.note(note));
        }
        if strategy.has_rows(&request) {
            capped_strength(self.sampling.k, &space).into_iter().for_each(|note| verbosity.note(note));
        }
        let limit = time_limit("--time-limit", self.time_limit.unwrap_or(TIME_LIMIT))?;
        let uses_array =
            request.discrete == DiscreteFamily::Ipog && !space.levels().is_empty() && strategy.has_rows(&request);
        let options =
            ArrayOptions { strict: self.strict, k: self.sampling.k, seed: self.sampling.seed, optimise: self.optimise };
        // Errors of the rest are reported before an array is made, which may take long.
        let any_row = [vec![0; space.levels().len()]];
        strategy.build(&Request { rows: Some(&any_row), ..request }).map_err(Error::from)?;
        let rows = match uses_array {
            true => Some(options.rows(&space, &demand, existing_rows, verbosity)?),
            false if !self.strength.is_empty() || self.optimise.is_some() => {
                let message = "--strength and --optimise change the rows of a covering array, and these tests have no covering array";
                return Err(usage(message.into()).into());
            }
            false => None,
        };
        let is_random = matches!(request.discrete, DiscreteFamily::Random { .. });
        if is_random && !space.levels().is_empty() && demand != Demand::default() {
            let message = "random rows guarantee nothing for sub-models and negative values (`~`); use --discrete ipog";
            return Err(usage(message.into()).into());
        }
        let most = match self.budget {
            Some(budget) => budget,
            None if space.dims() == 0 || self.sampling.epsilon.is_some() => usize::MAX,
            None => DEFAULT_BUDGET,
        };
        let search = self.sampling.epsilon.map(|_| Interruptible::new(Deadline::after(limit)));
        if let Some(epsilon) = self.sampling.epsilon {
            let seconds = limit.as_secs_f64();
            verbosity.note(format_args!(
                "searching for epsilon {epsilon}, at most {seconds} s; Ctrl-C prints the tests so far"
            ));
        }
        let deadline = search.as_ref().map_or(Deadline::never(), |search| search.deadline);
        let request = Request { rows: rows.as_deref(), deadline, ..request };
        let generator = strategy.build(&request).map_err(Error::from)?;
        // A note says how many rows of the array the budget covers, even if nobody asked.
        let has_rows = !space.levels().is_empty() && strategy.has_rows(&request);
        let is_noted = has_rows && (self.budget.is_some() || space.dims() > 0) && most <= MOST_UNASKED;
        let mut points = existing.clone();
        let written = write(generator, &space, &demand, most, verbosity, |tests| {
            if self.sampling.epsilon.is_some() || is_random || is_noted {
                points.extend(tests);
            }
        })?;
        let cut_short = deadline.passed() && written < most;
        let interrupted = search.is_some_and(Interruptible::end);
        let after = self.extend.as_ref().map(|path| format!(" after the {} in {}", existing.len(), path.display()));
        let by = match strategy.replacement(&request) {
            _ if space.dims() == 0 => String::new(),
            None => format!(" by {strategy}"),
            Some(other) => {
                format!(" by {other}, which takes the place of {strategy} under constraints on continuous parameters")
            }
        };
        verbosity.note(format_args!("{}{by}{}", plural(written, "test"), after.unwrap_or_default()));
        if self.sampling.epsilon.is_none() && space.checks_each_test() && written < most {
            if written == 0 {
                return Err(format!("{strategy} found no test that keeps the constraints; use another strategy").into());
            }
            complain(&format!("{strategy} found no other test that keeps the constraints; use another strategy"));
        }
        let measuring = match self.sampling.epsilon {
            Some(_) => REPORT_LIMIT,
            None if is_noted => UNASKED_LIMIT,
            None => Duration::ZERO,
        };
        let tests = TestSet { k: self.sampling.k, demand, ..TestSet::new(space.clone(), points) };
        let reached = Reached::of(tests, existing.len(), measuring)?;
        // The tests decide if the time was enough: the limit may have passed just after the last test.
        let end = if interrupted { "an interrupt" } else { &format!("the --time-limit of {} s", limit.as_secs_f64()) };
        let missed = self.sampling.epsilon.filter(|_| cut_short).and_then(|epsilon| reached.missed(epsilon, end));
        let promise = Promise::of(strategy, &request, if missed.is_some() { written } else { most } as u64)?;
        if let Some(promise) = promise {
            verbosity.note(reached.kept(&promise)?);
        }
        if let Some(note) =
            rows.as_deref().filter(|_| is_noted).map(|rows| reached.cut_short(rows)).transpose()?.flatten()
        {
            verbosity.note(note);
        }
        if let Some(missed) = missed {
            // The set does not reach epsilon: the user has to know.
            complain(&missed);
        }
        if self.sampling.epsilon.is_some() || (is_noted && space.dims() > 0) {
            verbosity.note(reached.words()?);
        }
        Ok(())
    }

    fn request<'a>(&self, space: &'a Space, strategy: Strategy, existing: &'a [Point]) -> Result<Request<'a>, Error> {
        // Epsilon decides how many tests are enough.
        let budget = if self.sampling.epsilon.is_some() { usize::MAX } else { DEFAULT_BUDGET };
        let mut request = Request {
            seed: self.sampling.seed,
            skip: self.sampling.skip,
            k: self.sampling.k,
            epsilon: self.sampling.epsilon,
            existing,
            ..Request::new(space, self.budget.unwrap_or(budget))
        };
        request.discrete = self.sampling.family()?;
        request.aim = self.sampling.aim(strategy)?;
        Ok(request)
    }
}

const DEFAULT_BUDGET: usize = 500;

/// The seconds that the search for epsilon may take.
const TIME_LIMIT: f64 = 60.0;

/// The time for measuring after `--epsilon`, and the time for measuring without `--epsilon`.
const REPORT_LIMIT: Duration = Duration::from_secs(10);
const UNASKED_LIMIT: Duration = Duration::from_secs(2);

/// The most tests that are kept and measured without `--epsilon`.
const MOST_UNASKED: usize = 100_000;

/// Writes at most `most` tests, each as soon as it is made. Negative values have their sign `~`, as in models of PICT.
fn write(
    mut generator: Box<dyn Generator>,
    space: &Space,
    demand: &Demand,
    most: usize,
    verbosity: Verbosity,
    mut keep: impl FnMut(Vec<Point>),
) -> Result<usize, io::Error> {
    let bar = if verbosity.quiet || most == usize::MAX { ProgressBar::hidden() } else { ProgressBar::new(most as u64) };
    let template = "{bar:40.blue/white} {human_pos}/{human_len} tests  {eta} left";
    let bar = bar.with_style(ProgressStyle::with_template(template).expect("the template is one"));
    let mut csv = csv::Writer::from_writer(io::stdout().lock());
    csv.write_record(space.coordinates().map(|coordinate| coordinate.name())).map_err(plain)?;
    let negatives: HashSet<(usize, usize)> = demand.negatives.iter().copied().collect();
    let mut written = 0;
    while written < most {
        let tests = generator.ask(BATCH.min(most - written));
        if tests.is_empty() {
            break;
        }
        for test in &tests {
            let values = space.decode(test);
            let values = values.iter().flat_map(|(_, value)| value.scalars());
            // Only spaces without continuous parameters have negative values, so positions among all are positions
            // among the discrete parameters.
            let written = values.enumerate().map(|(position, value)| {
                let is_negative =
                    test.discrete.get(position).is_some_and(|level| negatives.contains(&(position, *level)));
                if is_negative { format!("~{value}") } else { value.to_string() }
            });
            csv.write_record(written).map_err(plain)?;
        }
        written += tests.len();
        bar.inc(tests.len() as u64);
        keep(tests);
    }
    bar.finish_and_clear();
    csv.flush().map_err(output_error)?;
    Ok(written)
}

/// Returns the error of the operating system, so that a closed pipe is recognised.
fn plain(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => output_error(error),
        other => io::Error::other(format!("{other:?}")),
    }
}
