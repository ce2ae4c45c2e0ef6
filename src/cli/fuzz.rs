//! The arguments of `paracosm-fuzz`.

use super::{Failure, Found, Verbosity, describe, doctor, list, record, replay, run};
use clap::{Parser, Subcommand};

const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz --strategy halton --budget 500       the pedestrian study of the paper, into paracosm-out/
  paracosm-fuzz pedestrian-crossing --driver aeb --open friction=0.3..0.8 --out slippery
  paracosm-fuzz --open friction:piecewise-linear:3   the friction varies while a test runs
  paracosm-fuzz --spec 'always[0,10] (car.speed > 1)'           ask more of every run
  paracosm-fuzz --system 'python3 model.py' --space SPACE.toml --spec 'G (rpm < 4750)'    a system of your own
  paracosm-fuzz replay paracosm-out 17               test 17 again, with its trace as CSV
  paracosm-fuzz record pedestrian-crossing --budget 20 --out images      what cameras see of tests, labelled
  paracosm-fuzz list                                 scenarios, strategies, drivers

Exit status: 0 done, 1 a violation was found (with --fail-on-violation), 2 wrong use, bad input or a failed run.";

/// Tests a driver over the open parameters of a scenario.
#[derive(Debug, Parser)]
#[command(name = "paracosm-fuzz", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
#[command(override_usage = "paracosm-fuzz [run] [SCENARIO] [OPTIONS]\n       \
    paracosm-fuzz [run] --system COMMAND --space SPACE.toml [OPTIONS]\n       paracosm-fuzz <COMMAND>")]
pub(super) struct Command {
    #[command(subcommand)]
    verb: Option<Verb>,
    #[command(flatten)]
    run: run::Options,
    #[command(flatten)]
    verbosity: Verbosity,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Run one campaign; what is done when no command is named
    #[command(after_help = EXAMPLES)]
    Run(Box<run::Options>),
    /// Show scenarios, strategies and drivers with their parameters
    #[command(after_help = "Example:\n  paracosm-fuzz list")]
    List(list::Options),
    /// Show a scenario: its parameters and requirements, the graph of its streams, or its world from above
    #[command(
        after_help = "Examples:\n  paracosm-fuzz describe pedestrian-crossing --dot | dot -Tsvg > streams.svg\n  \
                            paracosm-fuzz describe pedestrian-crossing --draw world.svg"
    )]
    Describe(describe::Options),
    /// Run a logged test again and compare its trace hash with the log's
    #[command(after_help = "Examples:\n  paracosm-fuzz replay paracosm-out 17 --trace trace-17.csv\n  \
                            paracosm-fuzz replay paracosm-out 17 --draw test-17.gif\n  \
                            paracosm-fuzz replay paracosm-out 17 --camera front-17.gif")]
    Replay(replay::Options),
    /// Run a campaign and record what cameras see of its tests: images, masks, depths, boxes and controls
    #[command(after_help = record::EXAMPLES)]
    Record(Box<record::Options>),
    /// Show what this machine draws with, and how fast
    #[command(after_help = "Example:\n  paracosm-fuzz doctor")]
    Doctor(doctor::Options),
}

impl Command {
    pub fn execute(self) -> Result<Found, Failure> {
        match self.verb {
            None => self.run.execute(self.verbosity),
            Some(Verb::Run(options)) => options.execute(self.verbosity),
            Some(Verb::List(options)) => options.execute(),
            Some(Verb::Describe(options)) => options.execute(self.verbosity),
            Some(Verb::Replay(options)) => options.execute(self.verbosity),
            Some(Verb::Record(options)) => options.execute(self.verbosity),
            Some(Verb::Doctor(options)) => options.execute(),
        }
    }
}
