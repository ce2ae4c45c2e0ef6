//! The arguments of `paracosm-fuzz`.

use super::{
    Failure, Status, Verbosity, arguments, audit, bench, blame, describe, diff, doctor, export, likelihood, list, map,
    merge, monitor, page, perceive, record, repeat, replay, roads, run, sensitivity, shrink, trace, usage, view,
};
use clap::{CommandFactory, Parser, Subcommand};
use paracosm_campaign::Catalogue;

const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz --strategy halton --budget 500
      the pedestrian study of the paper, into paracosm-out/
  paracosm-fuzz pedestrian-crossing --driver aeb --open friction=0.3..0.8 --out slippery
  paracosm-fuzz --open friction:piecewise-linear:3
      the friction varies while a test runs
  paracosm-fuzz --spec 'always[0,10] (car.speed > 1)'
      require more of every run
  paracosm-fuzz follow-leader --driver-command 'python3 my_driver.py'
      a driver of your own, in its own process
  paracosm-fuzz --system 'python3 model.py' --space SPACE.toml --spec 'G (rpm < 4750)'
      a system of your own
  paracosm-fuzz map paracosm-out --x speed --y friction
      the failure map over other parameters
  paracosm-fuzz replay paracosm-out 17
      test 17 again, with its trace as CSV
  paracosm-fuzz shrink paracosm-out 17
      the simplest test near test 17 that still fails
  paracosm-fuzz blame paracosm-out
      which failures other drivers could have avoided
  paracosm-fuzz sensitivity paracosm-out
      how much each open parameter matters
  paracosm-fuzz diff before after
      new failures, mended ones and changed margins under another driver or version
  paracosm-fuzz trace paracosm-out
      requirements by tests, and the untested rest
  paracosm-fuzz audit cut-in --tests halton:40
      what these tests would have missed
  paracosm-fuzz monitor trace-17.csv --spec 'always (car.speed < 17)'
      evaluate formulas on a recorded trace
  paracosm-fuzz record pedestrian-crossing --budget 20 --out images
      labelled camera images of tests
  paracosm-fuzz perceive highway-traffic --perceiver detector.onnx
      a perception network on trial
  paracosm-fuzz roads town.xodr --draw town.svg
      the roads of a file (ASAM OpenDRIVE)
  paracosm-fuzz repeat paracosm-out --out again
      run a whole campaign again: does every test end as before?
  paracosm-fuzz list
      scenarios, strategies, drivers

Exit status: 0 done; 1 a test failed (with --fail-on-violation); 2 wrong use, bad input, a failed run, \
    or tests that show nothing (with --fail-on-violation).";

const REPLAYS: &str = "\
Examples:
  paracosm-fuzz replay paracosm-out 17 --trace trace-17.csv
  paracosm-fuzz replay paracosm-out 17 --draw test-17.gif
  paracosm-fuzz replay paracosm-out 17 --camera front-17.mp4
  paracosm-fuzz shrink paracosm-out 17 --save regressions/late-brake.json
  paracosm-fuzz replay regressions/*.json
      the failures are still the same
  paracosm-fuzz replay regressions/*.json --fail-on-unexpected
      in CI: known failures still fail, and mended failures stay mended
  paracosm-fuzz replay regressions/*.json --junit report.xml
      also writes a report that CI systems read

A regression file says how its test should end. `shrink --save` writes `\"expect\": \"fail\"`. After you have \
    mended the failure, change it to `\"pass\"`. Every file is run. A line for each file says how its test ended, \
    and whether this was expected.

Exit status: 0 all tests were run; 1 a test violated a requirement, expected or not (with --fail-on-violation), or \
    did not end as expected (with --fail-on-unexpected); 2 a file cannot be run, a test broke, or a test that should \
    fail had another trace than the trace that the same version of the software recorded, without a driver in a process of \
    its own.";

/// Tests a driver over the open parameters of a scenario.
#[derive(Debug, Parser)]
#[command(name = "paracosm-fuzz", version, after_long_help = EXAMPLES, args_conflicts_with_subcommands = true)]
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
    /// Run a campaign; this is the default command
    #[command(after_long_help = EXAMPLES)]
    Run(Box<run::Options>),
    /// Estimate the probability that a test fails
    ///
    /// The parameters have given distributions.
    #[command(after_long_help = likelihood::EXAMPLES)]
    Likelihood(Box<likelihood::Options>),
    /// Put the shards of a campaign together
    ///
    /// Each shard has run a part of the tests, on any machine (`run --shard`).
    #[command(after_long_help = merge::EXAMPLES)]
    Merge(merge::Options),
    /// Put a suite of tests on trial: what would it have missed?
    ///
    /// The audit shows what the suite does not cover, and which defects of a driver it does not notice.
    #[command(after_long_help = audit::EXAMPLES)]
    Audit(Box<audit::Options>),
    /// Compare strategies by the failures that they find
    ///
    /// The bench measures how soon each strategy finds a failure, and how well each strategy knows where tests fail.
    #[command(after_long_help = bench::EXAMPLES)]
    Bench(Box<bench::Options>),
    /// Show everything that has a name
    ///
    /// These are scenarios, strategies, drivers, measures, sensors and settings of cameras.
    #[command(after_long_help = "Example:\n  paracosm-fuzz list")]
    List(list::Options),
    /// Show a scenario: parameters, streams, the world from above
    #[command(
        after_long_help = "Examples:\n  paracosm-fuzz describe pedestrian-crossing --dot | dot -Tsvg > streams.svg\n  \
                            paracosm-fuzz describe pedestrian-crossing --set friction=0.3 --open lanes\n  \
                            paracosm-fuzz describe pedestrian-crossing --draw world.svg\n  \
                            paracosm-fuzz describe grid-traffic --roads city.xodr"
    )]
    Describe(Box<describe::Options>),
    /// Draw the failure map of a campaign again
    ///
    /// The map may have other parameters as its axes.
    #[command(after_long_help = "Examples:\n  paracosm-fuzz map paracosm-out --x speed --y friction\n  \
                            paracosm-fuzz map paracosm-out --x distance --y friction --out slippery.svg")]
    Map(map::Options),
    /// Show a campaign as one HTML file, in which tests are played
    ///
    /// The file opens anywhere, without a server and without a network.
    #[command(after_long_help = page::EXAMPLES)]
    Report(page::Options),
    /// Explore a campaign in a browser: play tests, and run new ones
    #[command(after_long_help = view::EXAMPLES)]
    View(view::Options),
    /// Run a logged test again, or run regression files
    ///
    /// The trace hash of a logged test is compared with the hash in the log.
    #[command(
        override_usage = "paracosm-fuzz replay DIR INDEX [OPTIONS]\n       paracosm-fuzz replay FILE... [OPTIONS]"
    )]
    #[command(after_long_help = REPLAYS)]
    Replay(replay::Options),
    /// Run a whole campaign again: does every test end as before?
    #[command(after_long_help = repeat::EXAMPLES)]
    Repeat(repeat::Options),
    /// Write a logged test as OpenSCENARIO and OpenDRIVE
    ///
    /// Other simulators play the scenario (ASAM OpenSCENARIO) on its roads (ASAM OpenDRIVE).
    #[command(after_long_help = export::EXAMPLES)]
    Export(export::Options),
    /// Find the simplest test near a failing one that still fails
    #[command(after_long_help = "Examples:\n  paracosm-fuzz shrink paracosm-out 17\n  \
                            paracosm-fuzz shrink paracosm-out 17 --save regressions/late-brake.json")]
    Shrink(shrink::Options),
    /// Find out which failures other drivers avoid
    ///
    /// Each failing test is run again with reference drivers.
    #[command(after_long_help = blame::EXAMPLES)]
    Blame(blame::Options),
    /// Show how much each open parameter matters
    ///
    /// The shares of the variance of the failure and of the robustness are Sobol indices.
    #[command(after_long_help = sensitivity::EXAMPLES)]
    Sensitivity(sensitivity::Options),
    /// Compare two campaigns with the same tests: new failures, mended ones
    ///
    /// The campaigns have two drivers, or were run by two versions of the software.
    #[command(after_long_help = diff::EXAMPLES)]
    Diff(diff::Options),
    /// Show requirements by tests, and what is untested
    ///
    /// The matrix shows for each requirement which tests passed and failed.
    #[command(after_long_help = trace::EXAMPLES)]
    Trace(trace::Options),
    /// Evaluate formulas on a trace, also while it is recorded
    #[command(after_long_help = monitor::EXAMPLES)]
    Monitor(monitor::Options),
    /// Record the tests of a campaign with cameras
    ///
    /// The record has images, masks, depths, boxes and controls.
    #[command(after_long_help = record::EXAMPLES)]
    Record(Box<record::Options>),
    /// Put a perception network on trial
    ///
    /// A campaign is run. The network sees the images of a camera.
    #[command(after_long_help = perceive::examples())]
    Perceive(Box<perceive::Options>),
    /// Show and draw the roads of a file (ASAM OpenDRIVE)
    #[command(after_long_help = roads::EXAMPLES)]
    Roads(roads::Options),
    /// Show the graphics adapter of this machine, and its speed
    #[command(after_long_help = "Example:\n  paracosm-fuzz doctor")]
    Doctor(doctor::Options),
}

impl Command {
    /// Reads the arguments of the program. Ends the program if they are wrong, or if only help was asked for.
    ///
    /// # Errors
    /// A scenario of the catalogue has the name of a command, so that nobody could test it by its name.
    pub fn of(catalogue: &Catalogue) -> Result<Self, Failure> {
        let commands = <Self as CommandFactory>::command();
        let is_command = |name: &str| name == "help" || commands.find_subcommand(name).is_some();
        match catalogue.programs().iter().find(|program| is_command(program.name())) {
            Some(program) => Err(usage(format!(
                "scenario `{0}` (\"{1}\") has the name of the command `{0}`; give the scenario another name",
                program.name(),
                program.about()
            ))
            .into()),
            None => Ok(arguments::parse()),
        }
    }

    pub fn execute(self, catalogue: &Catalogue) -> Result<Status, Failure> {
        match self.verb {
            None => self.run.execute(catalogue, self.verbosity),
            Some(Verb::Run(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Merge(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Likelihood(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Audit(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Bench(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::List(options)) => options.execute(catalogue),
            Some(Verb::Describe(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Map(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Report(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::View(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Replay(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Repeat(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Export(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Shrink(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Blame(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Sensitivity(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Diff(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Trace(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Monitor(options)) => options.execute(self.verbosity),
            Some(Verb::Record(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Perceive(options)) => options.execute(catalogue, self.verbosity),
            Some(Verb::Roads(options)) => options.execute(self.verbosity),
            Some(Verb::Doctor(options)) => options.execute(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_engine::Program;

    #[test]
    fn a_scenario_with_the_name_of_a_command_is_refused() {
        for name in ["replay", "help", "run"] {
            let catalogue = Catalogue::default().with(Program::of(name, "a car follows a log", |_| ()));
            let error = Command::of(&catalogue).expect_err("the name is taken").to_string();
            assert_eq!(
                error,
                format!(
                    "scenario `{name}` (\"a car follows a log\") has the name of the command `{name}`; give the scenario another name"
                )
            );
        }
    }
}
