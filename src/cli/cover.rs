//! The program `paracosm-cover`: how well tests cover a space.

use super::output::{Format, Table, json};
use super::{Failure, Verbosity, compare, print};
use crate::coverage::{Parameter, Space};
use crate::generators::{Request, Strategy};
use crate::{Error, Measure, Tests};
use clap::{Args, Parser, Subcommand};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover estimate                            the campaign in paracosm-out/
  paracosm-cover estimate points.csv                 columns in [0,1], one row a test
  paracosm-cover estimate tests.csv --space SPACE.toml --k 2
  paracosm-cover estimate --strategy halton --dims 3 --budget 500

Dispersion is the largest volume of an axis-parallel box that no test has entered, as a share of the space.";

/// The largest point set that is made in memory: 1.6 GB of coordinates.
pub(super) const MOST_COORDINATES: usize = 200_000_000;

/// Says how well a set of tests covers its space.
#[derive(Debug, Parser)]
#[command(name = "paracosm-cover", version, after_help = EXAMPLES)]
pub(super) struct Command {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    verbosity: Verbosity,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Measure how well tests cover their space
    #[command(after_help = EXAMPLES)]
    Estimate(Estimate),
    /// Compare strategies over dimensions, budgets and seeds
    #[command(after_help = compare::EXAMPLES)]
    Compare(compare::Options),
}

/// What `estimate` takes.
#[derive(Debug, Args)]
struct Estimate {
    /// A CSV of tests, or the folder of a campaign [default: paracosm-out]
    #[arg(value_name = "TESTS.csv|DIR", conflicts_with = "strategy")]
    tests: Option<PathBuf>,
    /// The space of the tests in a CSV; without it its columns are in [0,1]
    #[arg(long, value_name = "SPACE.toml", conflicts_with = "strategy")]
    space: Option<PathBuf>,
    /// How many parameters are looked at together [default: 2]
    #[arg(long, value_name = "K")]
    k: Option<usize>,
    /// What to measure, of dispersion, star, extreme, l2_star, centered, wraparound, mixture, k-wise,
    /// k-wise-dispersion [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    measures: Vec<Measure>,
    /// Time that the measuring may take, all together; what does not finish comes back as a bracket
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    time_limit: f64,
    /// Measure a point set of this strategy instead of tests in a file
    #[arg(long, value_name = "S", requires_all = ["dims", "budget"])]
    strategy: Option<String>,
    /// The number of dimensions of the strategy's point set
    #[arg(long, value_name = "D", requires = "strategy")]
    dims: Option<usize>,
    /// The number of points of the strategy's point set
    #[arg(long, value_name = "N", requires = "strategy")]
    budget: Option<usize>,
    /// The seed of the strategy
    #[arg(long, value_name = "N", requires = "strategy")]
    seed: Option<u64>,
    /// The index of the first point of the strategy's sequence [default: 1 for halton, 0 for the others]
    #[arg(long, value_name = "N", requires = "strategy")]
    skip: Option<u64>,
    /// How to print it [default: table on a terminal, json elsewhere]
    #[arg(long)]
    format: Option<Format>,
}

impl Command {
    pub fn execute(self) -> Result<(), Failure> {
        match self.verb {
            Verb::Estimate(estimate) => estimate.execute(self.verbosity),
            Verb::Compare(compare) => compare.execute(self.verbosity),
        }
    }
}

impl Estimate {
    fn execute(&self, verbosity: Verbosity) -> Result<(), Failure> {
        let limit = Duration::try_from_secs_f64(self.time_limit).map_err(|_| {
            Error::Usage(format!("--time-limit {}: expected a number of seconds from 0 on", self.time_limit))
        })?;
        let (tests, source) = match &self.strategy {
            Some(name) => (self.generated(name)?, format!("strategy {name}")),
            None => self.read()?,
        };
        let measures = if self.measures.is_empty() { Measure::ALL.to_vec() } else { self.measures.clone() };
        if verbosity.verbose {
            let names: Vec<&str> = measures.iter().map(|measure| measure.name()).collect();
            verbosity.note(format_args!("measuring {} of {} tests", names.join(", "), tests.points.len()));
        }
        let coverage = tests.measure(&measures, self.k, Some(limit))?;
        print(&match Format::or_fitting(self.format) {
            Format::Json => json(&coverage),
            Format::Table => {
                let mut table = Table::default();
                let names: Vec<&str> = tests.space.parameters().iter().map(|p: &Parameter| p.name.as_str()).collect();
                table.heading(&format!("{source}: {} tests over {}", coverage.tests, names.join(", ")));
                table.coverage(&coverage);
                table.finish()
            }
        })
    }

    fn read(&self) -> Result<(Tests, String), Error> {
        let path = self.tests.clone().unwrap_or_else(|| "paracosm-out".into());
        let space = self.space.as_deref().map(read_space).transpose()?;
        Ok((Tests::read(&path, space)?, path.display().to_string()))
    }

    fn generated(&self, name: &str) -> Result<Tests, Error> {
        let (Some(dims), Some(budget)) = (self.dims, self.budget) else {
            return Err(Error::Usage("--strategy needs --dims and --budget".into()));
        };
        if dims.saturating_mul(budget) > MOST_COORDINATES {
            let message = format!(
                "{budget} points in {dims} dimensions are more than fit: at most {MOST_COORDINATES} coordinates"
            );
            return Err(Error::Usage(message));
        }
        let space = Space::unit_cube(dims);
        let request = Request { seed: self.seed, skip: self.skip, ..Request::new(&space, budget) };
        let points = name.parse::<Strategy>()?.build(&request)?.ask(budget);
        Ok(Tests { space, points, k: None })
    }
}

fn read_space(path: &Path) -> Result<Space, Error> {
    let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
    Space::from_toml(&text).map_err(|error| match error {
        paracosm_coverage::SpaceError::Syntax { message, at: Some((line, column)) } => {
            Error::content(path, line, format!("column {column}: {message}"))
        }
        error => Error::content(path, None, error.to_string()),
    })
}
