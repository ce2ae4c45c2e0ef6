//! `paracosm-cover estimate`: measures how well tests cover their space.

use super::{certificate, open_loop, strength, time_limit};
use crate::cli::draw::{has_folder, is_ours_to_write};
use crate::cli::output::{Format, FormatOption, Table, broken, json, plural, short_bracket};
use crate::cli::usage;
use crate::cli::{Failure, Strict, Verbosity, print};
use crate::coverage::Bracket;
use crate::generators::Request;
use crate::notes::capped_strength;
use crate::space::{Parameter, Space};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use paracosm_analysis::{Coverage, Limit};
use paracosm_campaign::files::Lines;
use paracosm_campaign::{Catalogue, Error, TestSet, read_tests, read_tests_from};
use paracosm_coverage::Measure;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover estimate
      the campaign in paracosm-out/
  paracosm-cover estimate points.csv
      columns in [0,1], a row for each test; also points.txt of numpy.savetxt
  paracosm-cover estimate tests.csv --space SPACE.toml --k 2
  paracosm-cover estimate tests.csv --space SPACE.toml --strength lanes,weather,surface=3
  paracosm-cover estimate --strategy halton --dims 3 --budget 500
  paracosm-cover estimate tests.csv --certificate proof.json

Dispersion is the largest volume of an axis-parallel box that no test has entered, as a share of the space.";

/// The options of `estimate`.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Options {
    /// Tests, or the folder of a campaign [default: paracosm-out]
    ///
    /// TESTS is a CSV, a file of numbers such as numpy.savetxt writes, or `-` for standard input. Columns of numbers
    /// without a header are in the order of the space.
    #[arg(value_name = "TESTS|DIR", conflicts_with = "strategy")]
    tests: Option<PathBuf>,
    /// The space of the tests in a CSV
    ///
    /// Without a space the columns are in [0,1]. SPACE is a SPACE.toml, a PICT model, a scenario file, or the folder of a
    /// campaign.
    #[arg(long, value_name = "SPACE", conflicts_with = "strategy")]
    space: Option<PathBuf>,
    #[command(flatten)]
    strict: Strict,
    /// Count combinations of K values [default: 2]
    ///
    /// If fewer parameters are discrete, k-wise combines all discrete parameters.
    #[arg(long, value_name = "K")]
    k: Option<usize>,
    /// Count combinations of K in a group
    ///
    /// The group has discrete parameters.
    #[arg(long, value_name = "NAME,..=K")]
    strength: Vec<String>,
    #[arg(long, value_name = "LIST", value_delimiter = ',', help = measures_of_tests())]
    measures: Vec<Measure>,
    /// Limit the seconds of all measures
    ///
    /// A measure that does not finish gives a bracket [default: a limit of work, the same on every machine: about 3 s of
    /// one core, and ten times as much with --certificate].
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<f64>,
    /// Write a certificate of the dispersions
    ///
    /// The file has witnesses and proofs of the dispersion and the k-wise dispersion as JSON.
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// Measure a point set of this strategy
    #[arg(long, value_name = "S", requires_all = ["dims", "budget"])]
    strategy: Option<String>,
    /// The dimensions of the point set
    #[arg(long, value_name = "D", requires = "strategy")]
    dims: Option<usize>,
    /// The number of points of the point set
    #[arg(long, value_name = "N", requires = "strategy")]
    budget: Option<usize>,
    /// The seed of the strategy
    #[arg(long, value_name = "N", requires = "strategy")]
    seed: Option<u64>,
    /// The first index of a sequence
    ///
    /// [default: 1 for halton, 0 for the others]
    #[arg(long, value_name = "N", requires = "strategy")]
    skip: Option<u64>,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<(), Failure> {
        let usual = if self.certificate.is_some() { Limit::LONG } else { Limit::USUAL };
        let seconds = self.time_limit.map(|seconds| time_limit("--time-limit", seconds)).transpose()?;
        let limit = seconds.map_or(usual, Limit::Time);
        let inputs: Vec<&Path> = [&self.tests, &self.space].into_iter().flatten().map(PathBuf::as_path).collect();
        if let Some(file) = &self.certificate {
            is_ours_to_write("--certificate", file, &inputs)?;
            has_folder("--certificate", file)?;
        }
        let (mut tests, source) = match &self.strategy {
            Some(name) => (self.generated(name)?, format!("strategy {name}")),
            None => self.read(catalogue, verbosity)?,
        };
        if tests.space.dims() > 0 {
            broken(&tests.space, &tests.points, &source).into_iter().for_each(|note| verbosity.note(note));
        }
        let asked = |measure: &Measure| self.measures.is_empty() || self.measures.contains(measure);
        let measures: Vec<Measure> = Measure::all().filter(asked).collect();
        if !self.strength.is_empty() && !measures.contains(&Measure::K_WISE) {
            let message = "--strength belongs to the measure k-wise, which is not among --measures";
            return Err(usage(message.into()).into());
        }
        tests.demand.groups.extend(strength::groups(&self.strength, &tests.space)?);
        if measures.contains(&Measure::K_WISE) {
            capped_strength(self.k, &tests.space).into_iter().for_each(|note| verbosity.note(note));
        }
        if verbosity.verbose {
            let names: Vec<&str> = measures.iter().map(|measure| measure.name()).collect();
            verbosity.note(format_args!("measuring {} of {}", names.join(", "), plural(tests.points.len(), "test")));
        }
        let bar = spinner(verbosity);
        let mut watch = |measure: Measure, closing: Option<Bracket>| {
            let closing = closing.filter(|bracket| !bracket.is_exact());
            let between = closing.map(|bracket| format!("  {}", short_bracket(&bracket)));
            bar.set_message(format!("{}{}", measure.name(), between.unwrap_or_default()));
        };
        let coverage = match &self.certificate {
            None => Coverage::watched(&tests, &measures, self.k, limit, &mut watch),
            Some(file) => certificate::write(file, &tests, &measures, self.k, limit, &mut watch, verbosity),
        };
        bar.finish_and_clear();
        let coverage = coverage?;
        print(&match self.form.format {
            Format::Json => json(&coverage),
            Format::Table => {
                let mut table = Table::default();
                let names: Vec<&str> = tests.space.parameters().iter().map(|p: &Parameter| p.name.as_str()).collect();
                table.heading(&format!("{source}: {} over {}", plural(coverage.tests, "test"), names.join(", ")));
                table.coverage(&coverage);
                table.finish()
            }
        })
    }

    fn read(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<(TestSet, String), Error> {
        let path = self.tests.clone().unwrap_or_else(|| "paracosm-out".into());
        let space = self.space.as_deref().map(|path| self.strict.read(path, catalogue, verbosity)).transpose()?;
        if path.as_os_str() == "-" {
            let name = "standard input";
            return Ok((read_tests_from(Lines::of(io::stdin()), Path::new(name), space)?, name.to_owned()));
        }
        Ok((read_tests(&path, space)?, path.display().to_string()))
    }

    fn generated(&self, name: &str) -> Result<TestSet, Error> {
        let (Some(dims), Some(budget)) = (self.dims, self.budget) else {
            return Err(usage("--strategy needs --dims and --budget".into()));
        };
        TestSet::check_size(budget, dims)?;
        let space = Space::unit_cube(dims);
        let request = Request { seed: self.seed, skip: self.skip, ..Request::new(&space, budget) };
        let points = open_loop(name)?.build(&request)?.ask(budget);
        Ok(TestSet::new(space, points))
    }
}

/// Makes a spinner that moves while measures are computed.
fn spinner(verbosity: Verbosity) -> ProgressBar {
    let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    let style = ProgressStyle::with_template("{spinner} {elapsed}  {msg}").expect("the template is one");
    bar.enable_steady_tick(Duration::from_millis(100));
    bar.with_style(style)
}

/// The help of `--measures`.
fn measures_of_tests() -> String {
    let names: Vec<&str> = Measure::all().map(Measure::name).collect();
    format!(
        "The measures, some of {} [default: all]. With k-wise the result also says for which epsilon the tests are \
         (k, epsilon)-covering: `k_epsilon` in JSON",
        names.join(", ")
    )
}
