//! `paracosm-cover compare`: compares strategies by their point sets, and shows the progress.

use super::{open_loop, time_limit};
use crate::cli::given;
use crate::cli::output::{Format, FormatOption, json};
use crate::cli::{Failure, Verbosity, print};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use paracosm_analysis::Limit;
use paracosm_analysis::compare::SamplerComparison;
use paracosm_campaign::{Error, TestSet};
use paracosm_coverage::Measure;
use serde_json::json;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::thread::available_parallelism;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover compare --strategies random,halton,greedy --out compared
  paracosm-cover compare --strategies halton,mine=folder/*.csv --dims 2 --budgets 64
      with the sets of points of another program, a file for each set
  paracosm-cover compare --strategies halton,sobol-owen,lhs --dims 2,4 --budgets 64,256 --measures dispersion,star

Every strategy makes a set of points for every dimension, budget and seed; those that have one add their plain \
    set, made without a seed. All measures are better the lower they are. DIR gets sets.csv (a row for each set), \
    summary.csv (medians, quartiles; against the baseline the median ratio with its 95 % bootstrap interval, Vargha \
    and Delaney's A12, Wilcoxon's p and Holm's correction of it), slopes.csv, table.tex, and for each measure and \
    dimension a figure as SVG and PNG.";

/// The options of `compare`.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Options {
    /// The strategies, or NAME=FILES for points of others
    ///
    /// `paracosm-fuzz list strategies` shows all strategies. NAME=FILES takes the sets of points of other programs, a set in each file: mine=folder/*.csv. The columns of a file are in
    /// [0,1], as `estimate` reads them. The sets of a size count as the seeds 1, 2 and so on, in the order of the names of their files.
    #[arg(long, value_name = "LIST", value_delimiter = ',', required = true)]
    strategies: Vec<String>,
    /// The numbers of dimensions
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "2,3,5")]
    dims: Vec<usize>,
    /// The numbers of points
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "50,100,500")]
    budgets: Vec<usize>,
    /// The number of seeds of each strategy
    ///
    /// [default: 30; with NAME=FILES at most the number of their sets of a size]
    #[arg(long, value_name = "N")]
    seeds: Option<usize>,
    /// The first seed; the others follow it
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[arg(long, value_name = "LIST", value_delimiter = ',', help = measures_of_points())]
    measures: Vec<Measure>,
    /// The coordinates that k-wise dispersion combines
    #[arg(long, value_name = "K", default_value_t = 2)]
    k: usize,
    /// The strategy to compare with
    ///
    /// [default: halton if it is among them, else the first]
    #[arg(long, value_name = "S")]
    baseline: Option<String>,
    /// Limit the seconds of a measure of a set
    ///
    /// A measure that does not finish gives a bracket [default: a limit of work, the same on every machine, of some
    /// 20 s].
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<f64>,
    /// The sets that are measured at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// The folder to write to, empty or new
    #[arg(long, value_name = "DIR", default_value = "paracosm-compare")]
    out: PathBuf,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<(), Failure> {
        let plan = self.comparison()?.plan()?;
        paracosm_analysis::asked::new_folder(&self.out)?;
        let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new(plan.sets() as u64) };
        let template = "{bar:40.blue/white} {human_pos}/{human_len} sets  {elapsed} gone  {eta} left  {msg}";
        let bar = bar.with_style(ProgressStyle::with_template(template).expect("the template is one"));
        let jobs = self.jobs.or(available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN);
        let compared = plan.run(jobs, |set| {
            bar.set_message(format!("{}, d = {}, n = {}", set.strategy, set.dims, set.budget));
            bar.inc(1);
            Ok(())
        });
        bar.finish_and_clear();
        let compared = compared?;
        paracosm_report::compare::write(&compared, &self.out)?;
        for note in &compared.notes {
            verbosity.note(note);
        }
        verbosity.note(format_args!("written to {}", self.out.display()));
        print(&match self.form.format {
            Format::Table => paracosm_report::compare::table(&compared),
            Format::Json => json(&json!({"sets": compared.sets.len(), "baseline": compared.comparison.baseline.name(),
                "summary": compared.cells, "slopes": compared.slopes, "notes": compared.notes, "out": self.out})),
        })
    }

    fn comparison(&self) -> Result<SamplerComparison, Error> {
        let seconds = self.time_limit.map(|seconds| time_limit("--time-limit", seconds)).transpose()?;
        let limit = seconds.map_or(Limit::LONG, Limit::Time);
        let most = |numbers: &[usize]| numbers.iter().copied().max().unwrap_or_default();
        let (dims, budget) = (most(&self.dims), most(&self.budgets));
        TestSet::check_size(budget, dims)?;
        let strategies = given::strategies(&self.strategies, &[], open_loop)?;
        let defaults = SamplerComparison::of(&strategies)?;
        let named = |name: &String| {
            let known = strategies.iter().copied().find(|strategy| strategy.name() == name);
            known.map_or_else(|| open_loop(name), Ok)
        };
        let baseline = self.baseline.as_ref().map(named).transpose()?;
        Ok(SamplerComparison {
            dims: self.dims.clone(),
            budgets: self.budgets.clone(),
            seeds: self.seeds.unwrap_or(defaults.seeds),
            first_seed: self.seed,
            measures: (!self.measures.is_empty()).then(|| self.measures.clone()),
            k: self.k,
            baseline: baseline.unwrap_or(defaults.baseline),
            limit,
            ..defaults
        })
    }
}

/// The help of `--measures`.
fn measures_of_points() -> String {
    let is_for_points = |measure: &Measure| measure.is_of_points() || *measure == Measure::K_WISE_DISPERSION;
    let names: Vec<&str> = Measure::all().filter(is_for_points).map(Measure::name).collect();
    format!("The measures, some of {} [default: all but fill; extreme only for small sets]", names.join(", "))
}
