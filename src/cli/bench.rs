//! `paracosm-fuzz bench`: compares strategies by the failures that they find, and shows the progress.

use super::arguments::{COMPARED, OUTPUT, RUNNING};
use super::given;
use super::output::{Format, FormatOption, json, plural};
use super::subject::Subject;
use super::usage;
use super::{Failure, Status, Verbosity, on_interrupt, print, program};
use crate::generators::Strategy;
use crate::generators::functions::Function;
use crate::notes::notes_before;
use crate::space::{did_you_mean, nearest};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use paracosm_analysis::bench::{Bench, ReferenceMap, Row, Rows, Target, USUAL};
use paracosm_campaign::files::create_folder;
use paracosm_campaign::{Catalogue, Error, Study};
use paracosm_report::shell_word;
use serde_json::json;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz bench
      eight strategies on pedestrian-crossing
  paracosm-fuzz bench --scenarios cut-in,pedestrian-crossing+friction+fog --strategies random,halton,greedy,auto
  paracosm-fuzz bench --scenarios ball5,decoy5,valley2 --reference-tests 0
      functions whose failures are known
  paracosm-fuzz bench --system 'python3 model.py' --space SPACE.toml --spec 'G (rpm < 4750)' --strategies random,auto

Every strategy runs on every scenario with every seed, to the end of the budget. Runs with the same seed are \
    compared as pairs. NAME+PARAMETER+PARAMETER names a scenario and parameters to open. The functions corner5 ball5 \
    decoy5 errors5 valley2 ring2 rough3 few20 words2 needle2 can be named like scenarios; each seed puts their \
    failures elsewhere. random0, random1, random2 and so on are random functions with decoys. `auto` was chosen on \
    random0 to random199: compare searches on others.

Open-loop strategies draw discrete values for every test, uniformly among the valid values. `run` uses the rows \
    of a covering array instead. A test that repeats an earlier test costs nothing. A run without a failure is \
    censored at the budget. If the strategy had nothing more to test, the run is exhausted: there was no failure to \
    find.

A map of many random tests measures how well a run knows where tests fail. A test of the map is predicted to \
    fail if the nearest test of the run fails. Recall is the share of the failing tests of the map that are \
    predicted to fail. Precision is the share of the predicted failures that do fail. Maps are read from \
    --reference, or made and kept there if they are missing.

DIR gets runs.csv (a row for each run), summary.csv (success rates with Wilson's interval; restricted means of \
    the tests to the first failure with bootstrap intervals; against the baseline their ratio, Vargha and Delaney's \
    A12, Wilcoxon's p over pairs, the log-rank test's p and Holm's correction of both), survival.csv (Kaplan and \
    Meier's curves), correlations.csv (dispersion and recall), standings.csv, table.tex, and for each scenario \
    figures as SVG and PNG.";

/// The options of `bench`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    subject: Subject,
    /// The scenarios, or functions
    ///
    /// Each is NAME, or NAME+PARAMETER+.. to open parameters.
    #[arg(long, value_name = "LIST", value_delimiter = ',', conflicts_with_all = ["scenario", "system"], help_heading = COMPARED)]
    scenarios: Vec<String>,
    /// The strategies, or NAME=FILES for points of others
    ///
    /// `paracosm-fuzz list` shows them all [default: random,halton,random-corners,nelder-mead,cmaes,gp-cmaes,bayes,auto].
    /// NAME=FILES takes sets of points in [0,1], a set of --budget points in each file: mine=folder/*.csv. The set of the seed 1 is in the
    /// first file.
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = COMPARED)]
    strategies: Vec<String>,
    /// The number of tests of a run
    #[arg(long, value_name = "N", default_value_t = 200, help_heading = COMPARED)]
    budget: usize,
    /// The number of seeds of each strategy
    #[arg(long, value_name = "N", default_value_t = 30, help_heading = COMPARED)]
    seeds: usize,
    /// The first seed; the others follow it
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = COMPARED, hide_short_help = true)]
    seed: u64,
    /// The tests that are proposed at a time
    ///
    /// This number changes the tests of an adaptive strategy.
    #[arg(long, value_name = "N", default_value_t = 16, help_heading = COMPARED, hide_short_help = true)]
    batch: usize,
    /// The strategy to compare with
    ///
    /// [default: random if it runs, else the first]
    #[arg(long, value_name = "S", help_heading = COMPARED)]
    baseline: Option<String>,
    /// The folder of the reference maps
    ///
    /// The folder has NAME.json for each scenario [default: the folder `maps` in DIR].
    #[arg(long, value_name = "FOLDER", help_heading = COMPARED)]
    reference: Option<PathBuf>,
    /// The tests of a new reference map
    ///
    /// 0 makes no maps.
    #[arg(long, value_name = "N", default_value_t = 20_000, help_heading = COMPARED)]
    reference_tests: usize,
    /// The runs that are made at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N", help_heading = RUNNING)]
    jobs: Option<NonZeroUsize>,
    /// The folder to write to, empty or new
    #[arg(long, value_name = "DIR", default_value = "paracosm-bench", help_heading = OUTPUT)]
    out: PathBuf,
    /// Continue the bench in the folder
    #[arg(long, help_heading = RUNNING)]
    resume: bool,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let bench = self.bench(catalogue, verbosity)?;
        bench.check()?;
        let kept = json!({"folder": self.reference, "tests": self.reference_tests});
        let (mut rows, known) = if self.resume {
            Rows::resume(&self.out, &bench, &kept)?
        } else {
            (Rows::create(&self.out, &bench, &kept)?, Vec::new())
        };
        let stop = Arc::new(AtomicBool::new(false));
        on_interrupt(stop.clone());
        let maps = self.maps(&bench, &stop, verbosity)?;
        let bar = bar(verbosity, bench.runs(), "runs").with_position(known.len() as u64);
        bar.reset_eta();
        let mut safe = known.len();
        let benched = bench.run(self.jobs(), &maps, known, &stop, |row: &Row| {
            rows.append(row)?;
            safe += 1;
            bar.set_message(format!("{} on {}", row.strategy, row.scenario));
            bar.inc(1);
            Ok(())
        });
        bar.finish_and_clear();
        let benched = benched.map_err(|error| {
            let (runs, out) = (plural(safe, "run"), self.out.display());
            Failure::from(format!("{error}\n  {runs} are safe in {out}; --resume continues from there"))
        })?;
        paracosm_report::bench::write(&benched, &self.out)?;
        for note in &benched.notes {
            verbosity.note(note);
        }
        verbosity.note(format_args!("written to {}", self.out.display()));
        print(&match self.form.format {
            Format::Table => paracosm_report::bench::table(&benched),
            Format::Json => json(&json!({"runs": benched.rows.len(), "baseline": bench.baseline.name(),
                "budget": bench.budget, "summary": benched.cells, "correlations": benched.correlations,
                "standings": benched.standings, "notes": benched.notes, "out": self.out})),
        })?;
        // Numbers of a system that never answered would look like a result.
        if !benched.rows.is_empty() && benched.rows.iter().all(|row| row.tests > 0 && row.errors == row.tests) {
            let message = "every test of every run ended in an error; a campaign with the same options (`paracosm-fuzz run`) shows the errors";
            return Err(message.into());
        }
        Ok(Status::Nothing)
    }

    fn bench(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Bench, Error> {
        let strategy = |name: &str| Ok(name.parse::<Strategy>()?);
        let targets = match self.scenarios.as_slice() {
            [] => vec![Target::study(self.subject.name(), self.study(&self.subject, catalogue, verbosity)?)],
            names => names.iter().map(|name| self.target(name, catalogue, verbosity)).collect::<Result<_, _>>()?,
        };
        let strategies: Vec<Strategy> = match self.strategies.as_slice() {
            [] => USUAL.to_vec(),
            names => {
                let continuous = |target: &Target| {
                    let space = target.space();
                    let names = space.coordinates().filter(|one| one.parameter.levels().is_none());
                    names.map(|coordinate| coordinate.name()).collect()
                };
                let columns: Vec<Vec<String>> = targets.iter().map(continuous).collect();
                given::strategies(names, &columns, strategy)?
            }
        };
        let usual = Bench::of(&strategies, targets)?;
        let baseline = self.baseline.as_ref().map(|name| {
            let known = strategies.iter().copied().find(|strategy| strategy.name() == name);
            known.map_or_else(|| strategy(name), Ok)
        });
        let baseline = baseline.transpose()?.unwrap_or(usual.baseline);
        let (budget, seeds, first_seed, batch) = (self.budget, self.seeds, self.seed, self.batch);
        Ok(Bench { budget, seeds, first_seed, batch, baseline, ..usual })
    }

    fn study(&self, subject: &Subject, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Study, Error> {
        let study = subject.study(catalogue, verbosity)?.build()?;
        notes_before(&study)?.iter().for_each(|note| verbosity.note(note));
        Ok(study)
    }

    /// Returns the scenario, with its parameters to open, or the function of this name.
    fn target(&self, text: &str, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Target, Error> {
        if let Some(function) = Function::named(text) {
            return Ok(Target::function(function));
        }
        let mut parts = text.split('+').map(str::to_owned);
        let scenario = parts.next().unwrap_or_default();
        let programs = catalogue.programs();
        if programs.iter().all(|program| program.name() != scenario) {
            let functions = Function::ALL;
            let functions = functions.iter().map(|function| &*function.name);
            let names = programs.iter().map(paracosm_engine::Program::name).chain(functions);
            let hint = did_you_mean(&nearest(&scenario, names));
            let random =
                scenario.strip_prefix("random").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
            let hint = if random { format!("; random functions are `random0` to `random{}`", u64::MAX) } else { hint };
            let message = format!("no scenario or function is called `{scenario}`{hint}");
            return Err(usage(format!("{message}; `paracosm-fuzz list` and `bench --help` show them all")));
        }
        Ok(Target::study(text, self.study(&self.subject.on(&scenario, parts), catalogue, verbosity)?))
    }

    /// Returns the maps of all scenarios. A map that does not exist is made and kept.
    fn maps(
        &self,
        bench: &Bench,
        stop: &AtomicBool,
        verbosity: Verbosity,
    ) -> Result<BTreeMap<String, ReferenceMap>, Failure> {
        let mut maps = BTreeMap::new();
        if self.reference_tests == 0 {
            return Ok(maps);
        }
        let folder = self.reference.clone().unwrap_or_else(|| self.out.join("maps"));
        create_folder(&folder)?;
        for target in &bench.targets {
            let Some(study) = target.as_study() else { continue };
            let path = folder.join(format!("{}.json", target.file_name()));
            let map = if path.exists() {
                ReferenceMap::read(&path, study)?
            } else {
                let bar = bar(verbosity, self.reference_tests, "tests");
                bar.set_message(format!("where tests of {} fail", target.name()));
                let map = ReferenceMap::make(study, self.reference_tests, self.jobs(), stop, |done| {
                    bar.set_position(done as u64);
                });
                bar.finish_and_clear();
                let map = map?;
                map.write(&path, &command())?;
                map
            };
            let (tests, failing) = map.counts();
            verbosity.note(format_args!("{}: {failing} of {} of the map fail", target.name(), plural(tests, "test")));
            maps.insert(target.name().to_owned(), map);
        }
        Ok(maps)
    }

    fn jobs(&self) -> NonZeroUsize {
        self.jobs.or(available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
    }
}

/// Returns the command line, which is kept in the files that the command writes.
fn command() -> String {
    let arguments: Vec<String> =
        program::words().iter().skip(1).map(|word| shell_word(&word.to_string_lossy())).collect();
    format!("{} {}", program::name(), arguments.join(" "))
}

/// Makes a progress bar for `of` things; `--quiet` hides the bar.
fn bar(verbosity: Verbosity, of: usize, what: &str) -> ProgressBar {
    let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new(of as u64) };
    let template = format!("{{bar:40.blue/white}} {{human_pos}}/{{human_len}} {what}  {{eta}} left  {{msg}}");
    bar.with_style(ProgressStyle::with_template(&template).expect("the template is one"))
}
