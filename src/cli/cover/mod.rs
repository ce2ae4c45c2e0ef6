//! The program `paracosm-cover`: measures how well tests cover a space, and makes tests that cover a space well.

mod array;
mod certificate;
mod compare;
mod estimate;
mod generate;
mod least;
mod optimise;
mod plan;
mod reached;
mod strength;

use super::{Failure, Verbosity};
use crate::cli::usage;
use crate::generators::Strategy;
use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use paracosm_campaign::{Catalogue, Error};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover estimate
      the campaign in paracosm-out/
  paracosm-cover estimate --strategy halton --dims 3 --budget 500
  paracosm-cover generate --dims 3 --strategy sobol --budget 256 > points.csv
  paracosm-cover generate --dims 3 --extend points.csv --budget 20
  paracosm-cover generate --space MODEL.pict --k 3 --optimise 10 > tests.csv
  paracosm-cover optimise --measure star --dims 2 --budget 100 --time 30 > points.csv
  paracosm-cover least --dims 2 --budget 6
  paracosm-cover plan --dims 5 --epsilon 0.1
  paracosm-cover compare --strategies random,halton,greedy --out compared

Dispersion is the largest volume of an axis-parallel box that no test has entered, as a share of the space.";

/// Measures how well a set of tests covers its space, and makes sets that cover a space well.
#[derive(Debug, Parser)]
#[command(name = "paracosm-cover", version, after_long_help = EXAMPLES)]
pub(super) struct Command {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    verbosity: Verbosity,
}

/// Returns the open-loop strategy of this name. Adaptive strategies need outcomes, and this program runs no tests.
fn open_loop(name: &str) -> Result<Strategy, Error> {
    match name.parse::<Strategy>()? {
        strategy if strategy.is_adaptive() => {
            let message = "is adaptive: it needs the outcomes of tests, and paracosm-cover runs none; use it with `paracosm-fuzz run`";
            Err(usage(format!("`{strategy}` {message}")))
        }
        strategy => Ok(strategy),
    }
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Measure how well tests cover their space
    Estimate(estimate::Options),
    /// Make tests: CSV on standard output
    Generate(generate::Options),
    /// Search for points with a small measure: CSV on standard output
    Optimise(optimise::Options),
    /// Prove how small the dispersion of a few points can be
    Least(least::Options),
    /// Compare strategies over dimensions, budgets and seeds
    Compare(compare::Options),
    /// Show how many tests each guarantee needs
    Plan(plan::Options),
}

impl Command {
    pub fn execute(self, catalogue: &Catalogue) -> Result<(), Failure> {
        match self.verb {
            Verb::Estimate(estimate) => estimate.execute(catalogue, self.verbosity),
            Verb::Generate(generate) => generate.execute(catalogue, self.verbosity),
            Verb::Optimise(optimise) => optimise.execute(self.verbosity),
            Verb::Least(least) => least.execute(self.verbosity),
            Verb::Compare(compare) => compare.execute(self.verbosity),
            Verb::Plan(plan) => plan.execute(catalogue, self.verbosity),
        }
    }
}

/// Reads the number of seconds of an option.
pub(super) fn time_limit(option: &str, seconds: f64) -> Result<Duration, Error> {
    Duration::try_from_secs_f64(seconds)
        .map_err(|_| usage(format!("{option} {seconds}: expected a number of seconds, 0 or more")))
}

/// Makes a spinner with the time so far.
fn spinner(message: String, verbosity: Verbosity) -> ProgressBar {
    let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    bar.enable_steady_tick(Duration::from_millis(100));
    let style = ProgressStyle::with_template("{spinner} {elapsed}  {msg}").expect("the template is one");
    bar.with_style(style).with_message(message)
}
