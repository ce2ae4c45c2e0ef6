//! `paracosm-fuzz run`: runs a campaign, shows its progress and prints its summary.

use super::arguments::{CHOSEN, OUTPUT, REQUIRED, RUNNING};
use super::gate::gate;
use super::github::StepSummary;
use super::output::{Format, FormatOption, Table, broken, broken_words, json, plural};
use super::progress::{Progress, bar};
use super::sampling::Sampling;
use super::subject::Subject;
use super::usage;
use super::{Failure, Status, Verbosity, on_interrupt, print, program, report};
use crate::generators::{GeneratorError, Purpose, Strategy};
use crate::notes::notes_before;
use crate::oracles::Verdict;
use crate::space::{did_you_mean, nearest};
use crate::{Report, Runner};
use clap::Args;
use paracosm_campaign::{
    Catalogue, Error, Extension, Failure as Breakdown, Finish, Shard, Study, StudyBuilder, Supervision, Trial,
};
use serde_json::{Map, json};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A campaign that was run to its end.
pub(super) struct Conducted {
    pub report: Report,
    pub found: Status,
    /// The flag that an interrupt sets.
    pub stop: Arc<AtomicBool>,
}

/// The options of `run`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    pub subject: Subject,
    /// The strategy that chooses tests [default: halton]
    ///
    /// `paracosm-fuzz list strategies` shows all strategies. The default is greedy with --extend, and auto with
    /// --stop-at-first.
    #[arg(long, value_name = "S", help_heading = CHOSEN)]
    strategy: Option<String>,
    /// The number of tests
    #[arg(long, value_name = "N", default_value_t = 500, help_heading = CHOSEN)]
    budget: usize,
    #[command(flatten)]
    sampling: Sampling,
    /// The tests that are proposed at a time
    ///
    /// This is the number of tests that an adaptive strategy proposes at a time: with fewer it learns from more outcomes,
    /// with more it keeps more cores busy [default: 16].
    #[arg(long, value_name = "N", help_heading = CHOSEN, hide_short_help = true)]
    batch: Option<usize>,
    /// Run the tests of a file
    ///
    /// The campaign runs the tests in this file, in their order, in place of the tests of a strategy. The columns of the file are the open
    /// parameters. Tests that break a constraint are left out.
    #[arg(long, value_name = "TESTS.csv", help_heading = CHOSEN, hide_short_help = true,
        conflicts_with_all = ["extend", "strategy", "budget", "batch", "seed", "skip", "discrete", "delta", "k", "epsilon", "measure"])]
    tests: Option<PathBuf>,
    /// Add to the tests of a file
    ///
    /// The tests in this file count as done. Only the tests that complete them are run, and the coverage of all tests is
    /// measured together. The columns of the file are the open parameters.
    #[arg(long, value_name = "TESTS.csv", help_heading = CHOSEN, hide_short_help = true)]
    extend: Option<PathBuf>,
    /// The tests that run at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N", help_heading = RUNNING)]
    jobs: Option<NonZeroUsize>,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "paracosm-out", help_heading = OUTPUT)]
    pub out: PathBuf,
    /// Continue the campaign in the folder
    #[arg(long, help_heading = RUNNING)]
    resume: bool,
    /// Run only one shard of the campaign
    ///
    /// The tests are divided into N shards of the same size, and shard I is run, such as 2/64. `merge` puts the shards together. The strategy must
    /// not learn from outcomes.
    #[arg(long, value_name = "I/N", help_heading = RUNNING, hide_short_help = true)]
    shard: Option<Shard>,
    /// Excuse violations that no driver avoids
    ///
    /// A violation that none of these drivers avoids in the same test gets the verdict `unpreventable`; such a test is no
    /// failure. `paracosm-fuzz list drivers` shows all drivers.
    #[arg(long, value_name = "A,B,..", value_delimiter = ',', help_heading = REQUIRED)]
    reference: Vec<String>,
    /// Find combinations of values that fail
    ///
    /// The combinations of discrete values behind the failures are found with at most N further tests, and written to
    /// located.json [default: 200].
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "200", help_heading = RUNNING, hide_short_help = true)]
    locate: Option<usize>,
    /// End with the first failing test
    ///
    /// Tests count in the order of their indices.
    #[arg(long, help_heading = RUNNING)]
    stop_at_first: bool,
    /// Exit with status 1 if a test fails
    ///
    /// A test fails if it violates a requirement. The status is 2 if a test ends in an error, if no test passes or fails, or if there is no
    /// requirement.
    #[arg(long, help_heading = OUTPUT)]
    fail_on_violation: bool,
    /// Also write junit.xml, for CI systems
    ///
    /// The report is written to the folder.
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    junit: bool,
    /// Add a summary to the page of a GitHub workflow
    ///
    /// The summary has the verdict, the worst test, the failure map, the requirements and the failure modes in Markdown. It is added to the file that
    /// GitHub names in GITHUB_STEP_SUMMARY.
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    github: bool,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        match self.shard {
            Some(shard) => self.run_shard(shard, catalogue, verbosity),
            None => self.conduct(catalogue, verbosity, Ok).map(|conducted| conducted.found),
        }
    }

    /// Runs the campaign and prints its summary. `prepare` may open more parameters.
    pub fn conduct(
        &self,
        catalogue: &Catalogue,
        verbosity: Verbosity,
        prepare: impl FnOnce(StudyBuilder) -> Result<StudyBuilder, Error>,
    ) -> Result<Conducted, Failure> {
        if self.resume {
            self.is_no_folder(catalogue)?;
        }
        if self.shard.is_some() {
            return Err(usage("--shard is for `run`".to_owned()).into());
        }
        let (study, extension) = self.study(catalogue, verbosity, prepare)?;
        let done_before = extension.as_ref().filter(|_| !study.runs_given_tests());
        if let Some(extension) = &extension {
            let (source, of_strategy) = (&extension.record().name, done_before.is_some());
            let note = match of_strategy {
                true => broken(study.space(), &extension.points(study.space())?, source),
                false => broken_words(&extension.broken(study.space())?, extension.record().tests, source),
            };
            if let Some(note) = note {
                let end = if of_strategy { "" } else { "; the campaign runs only tests that break none" };
                verbosity.note(format!("{note}{end}"));
            }
        }
        note_outlasting(&study, verbosity)?;
        let step = self.github.then(StepSummary::of_environment).transpose()?;
        let supervision = Supervision::default();
        let program = program::called();
        let runner = self.runner(&study, extension.as_ref()).until(supervision.clone()).program(&program);
        let mut progress = Progress::new(&study, done_before, verbosity)?;
        on_interrupt(supervision.stop.clone());
        if verbosity.verbose {
            supervision.output.listen(progress.show_output());
        }
        let ran = runner.run_into(&self.out, &mut [&mut progress]);
        progress.bar.finish_and_clear();
        if ran.is_err() {
            supervision.doubts.notes().iter().for_each(|note| verbosity.note(note));
        }
        let report = ran.map_err(|error| match progress.begun {
            true => cut_short(error, &self.out, progress.summary.tests()),
            false => error.into(),
        })?;
        self.note_end(&report, done_before, verbosity);
        let printed =
            report::Printed { report: &report, out: &self.out, program: &program, locate: self.locate.is_some() };
        print(&match self.form.format {
            Format::Table => printed.table(),
            Format::Json => json(&printed.json()),
        })?;
        if let Some(step) = step {
            step.add(&report, &self.out, &program)?;
        }
        let (log, summary) = (&report.log, &report.summary);
        for judged in summary.requirements().iter().filter(|judged| judged.undecided > 0) {
            let given = log.study().given().find(|requirement| requirement.id == judged.id);
            if let Some(formula) = given.and_then(|requirement| requirement.formula.as_ref()) {
                let (id, tests) = (&judged.id, plural(judged.undecided, "test"));
                verbosity.note(format!("{id} stayed undecided in {tests}: too short for `{formula}`"));
            }
        }
        if summary.tests() == 0 && report.finish == Finish::Exhausted && done_before.is_none() {
            let strategy = self.strategy()?;
            return Err(format!("{strategy} found no test that keeps the constraints; use another strategy").into());
        }
        if summary.tests() > 0 && summary.count(Verdict::Error) == summary.tests() {
            let first = log.trials()[0].error().unwrap_or_default();
            let more = self.output_of_programs();
            return Err(format!("every test ended in an error; the first error: {first}{more}").into());
        }
        let found = gate(&report, self.fail_on_violation)?;
        Ok(Conducted { report, found, stop: supervision.stop })
    }

    /// Returns the study, with the tests of a file that it runs or extends.
    fn study(
        &self,
        catalogue: &Catalogue,
        verbosity: Verbosity,
        prepare: impl FnOnce(StudyBuilder) -> Result<StudyBuilder, Error>,
    ) -> Result<(Study, Option<Extension>), Failure> {
        let study = prepare(self.subject.study(catalogue, verbosity)?)?.sampling(self.sampling()?);
        let study = self.reference.iter().fold(study, |study, name| study.reference(name)).maybe_one_test().build()?;
        note_one_test(&study, verbosity);
        notes_before(&study)?.iter().for_each(|note| verbosity.note(note));
        let file = self.tests.as_ref().or(self.extend.as_ref());
        let extension = file.map(|path| Extension::read(path, &study)).transpose()?;
        let study = match extension.as_ref().filter(|_| study.runs_given_tests()) {
            Some(given) => study.sampled(paracosm_campaign::Sampling {
                budget: given.record().tests.max(1),
                ..study.sampling().clone()
            })?,
            None => study,
        };
        Ok((study, extension))
    }

    /// Runs a shard of the campaign.
    fn run_shard(&self, shard: Shard, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let whole = [
            ("--locate", self.locate.is_some()),
            ("--junit", self.junit),
            ("--github", self.github),
            ("--fail-on-violation", self.fail_on_violation),
        ];
        if let Some((option, _)) = whole.into_iter().find(|(_, is_given)| *is_given) {
            let message = format!("{option} is for a whole campaign, and --shard {shard} runs a part of it");
            return Err(usage(message).into());
        }
        if self.resume {
            self.is_no_folder(catalogue)?;
        }
        let (study, extension) = self.study(catalogue, verbosity, Ok)?;
        Shard::check(&study).map_err(Error::from)?;
        let supervision = verbosity.supervision();
        on_interrupt(supervision.stop.clone());
        let runner = self.runner(&study, extension.as_ref()).until(supervision.clone());
        let progress = bar(verbosity, shard.range(study.sampling().budget).len());
        let summary = runner.run_shard_into(shard, &self.out, &mut [&mut |_: &Trial| progress.inc(1)]);
        progress.finish_and_clear();
        supervision.doubts.notes().iter().for_each(|note| verbosity.note(note));
        let summary = summary?;
        let counts = Verdict::ALL.map(|verdict| (verdict, summary.count(verdict)));
        print(&match self.form.format {
            Format::Table => {
                let mut table = Table::default();
                let tests = plural(summary.tests(), "test");
                table.heading(&format!("{}, strategy {}: shard {shard}, {tests}", study.title(), study.sampling()));
                for (verdict, count) in counts.iter().filter(|(_, count)| *count > 0) {
                    table.row(&verdict.to_string(), &count.to_string());
                }
                table.row("written to", &self.out.display().to_string());
                table.row("then", "`merge` puts all shards together");
                table.finish()
            }
            Format::Json => {
                let verdicts = counts.map(|(verdict, count)| (verdict.to_string(), count.into()));
                json(
                    &json!({"shard": shard, "tests": summary.tests(), "verdicts": Map::from_iter(verdicts), "out": self.out}),
                )
            }
        })?;
        Ok(Status::Nothing)
    }

    fn runner<'a>(&self, study: &'a Study, extension: Option<&'a Extension>) -> Runner<'a> {
        let runner = extension.into_iter().fold(Runner::new(study), Runner::extending);
        let runner = self.jobs.into_iter().fold(runner, Runner::jobs);
        let runner = self.locate.into_iter().fold(runner, Runner::locating);
        let runner = if self.resume { runner.resuming() } else { runner };
        if self.junit { runner.with_junit() } else { runner }
    }

    /// Reads the options that choose tests.
    fn sampling(&self) -> Result<paracosm_campaign::Sampling, Error> {
        let Sampling { seed, skip, k, epsilon, .. } = self.sampling;
        let strategy = self.strategy()?;
        Ok(paracosm_campaign::Sampling {
            own: None,
            strategy,
            discrete: self.sampling.family()?,
            k,
            epsilon,
            aim: self.sampling.aim(strategy)?,
            skip,
            seed,
            batch: self.batch,
            budget: self.budget,
            stop_at_first: self.stop_at_first,
        })
    }

    /// Notes why the campaign has fewer tests than its budget, and why it has no map.
    fn note_end(&self, report: &Report, extension: Option<&Extension>, verbosity: Verbosity) {
        if report.log.study().is_one_test() {
            return;
        }
        let ran = report.log.trials().len();
        // Another note has the tests of a file that break a constraint.
        if !report.log.study().runs_given_tests()
            && ran < self.budget
            && report.finish != Finish::Stopped
            && (ran > 0 || extension.is_some())
        {
            verbosity.note(self.shortfall(report, extension));
        }
        if report.map.is_none() && report.log.trials().iter().any(Trial::covers) {
            verbosity.note("no failure map: a map needs two open continuous parameters");
        }
    }

    /// Says why the campaign has fewer tests than its budget.
    fn shortfall(&self, report: &Report, extension: Option<&Extension>) -> String {
        let beside = extension.map(|known| format!(" beside the {} in {}", known.record().tests, known.record().name));
        let beside = beside.unwrap_or_default();
        let ran = report.log.trials().len();
        if ran == 0 {
            return format!("no test was run: nothing is missing{beside}");
        }
        let (ran, study) = (plural(ran, "test"), report.log.study());
        let why = match self.sampling.epsilon {
            Some(epsilon) => format!("after {ran}{beside} no row has an empty box above {epsilon}"),
            None if study.space().checks_each_test() => {
                format!("after {ran}{beside} the strategy found no other that keeps the constraints")
            }
            None => format!("the strategy has only {ran} for these parameters{beside}"),
        };
        let more = match study.sampling().stronger(study.space()) {
            Some(k) => {
                format!("; `--k {k}` covers combinations of {k} values, and `--discrete random` uses the whole budget")
            }
            None => String::new(),
        };
        format!("the campaign ended before its budget: {why}{more}")
    }

    /// Says where the output of the campaign's programs is, if they have printed anything.
    fn output_of_programs(&self) -> String {
        let logs = ["driver.log", "perceiver.log", "system.log"].map(|name| self.out.join(name));
        let there = logs.iter().filter(|log| log.exists()).map(|log| log.display().to_string()).collect::<Vec<_>>();
        if there.is_empty() { String::new() } else { format!("\n  the output is in {}", there.join(", ")) }
    }

    /// Checks that the scenario to resume is not the name of a folder.
    fn is_no_folder(&self, catalogue: &Catalogue) -> Result<(), Error> {
        let name = self.subject.name();
        if self.subject.is_system() || catalogue.knows(name) {
            return Ok(());
        }
        let folder = Path::new(name);
        let said = "--resume takes no folder; --out names the folder";
        if is_campaign(folder) {
            let message = format!("{name} is the folder of a campaign, not a scenario: {said}: --out {name} --resume");
            return Err(usage(message));
        }
        let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty());
        let there = std::fs::read_dir(parent.unwrap_or(Path::new("."))).into_iter().flatten().flatten();
        let there = there.map(|entry| parent.map_or(entry.file_name().into(), |_| entry.path()));
        let mut there: Vec<PathBuf> = there.filter(|folder| is_campaign(folder)).collect();
        there.sort();
        let names: Vec<String> = there.iter().map(|folder| folder.display().to_string()).collect();
        let meant = nearest(name, names.iter().map(String::as_str)).map(|folder| format!("--out {folder} --resume"));
        let scenario =
            nearest(name, catalogue.programs().iter().map(paracosm_engine::Program::name)).map(str::to_owned);
        let meant = did_you_mean(&meant.or(scenario));
        Err(usage(format!("{name} is neither a campaign folder nor a scenario; {said}{meant}")))
    }

    fn strategy(&self) -> Result<Strategy, Error> {
        let strategy = self.strategy.as_ref().map(|name| name.parse::<Strategy>()).transpose()?;
        if strategy == Some(Strategy::GIVEN) && self.tests.is_none() {
            return Err(GeneratorError::NoTests { strategy: Strategy::GIVEN.name() }.into());
        }
        Ok(match (&self.strategy, &self.extend) {
            _ if self.tests.is_some() => Strategy::GIVEN,
            (Some(name), _) => name.parse()?,
            (None, Some(_)) => Strategy::usual(Purpose::Complete),
            (None, None) if self.stop_at_first && !self.sampling.says_how_to_cover() => {
                Strategy::usual(Purpose::FirstFailure)
            }
            (None, None) => Strategy::usual(Purpose::Cover),
        })
    }
}

/// Notes that there is one test, and how to vary parameters.
fn note_one_test(study: &Study, verbosity: Verbosity) {
    if study.is_one_test() {
        let names: Vec<&str> = study.fixed().iter().map(|(name, _)| name).collect();
        verbosity.note(format_args!(
            "no parameter is open, so there is one test; --open NAME=LO..HI varies one of {}",
            names.join(", ")
        ));
    }
}

/// Notes which formulas look further ahead than a test lasts.
fn note_outlasting(study: &Study, verbosity: Verbosity) -> Result<(), Error> {
    for (id, part) in study.outlasting() {
        let duration = study.subject().scenario()?.duration();
        verbosity.note(format_args!(
            "{id} may stay undecided, and tests may be inconclusive: `{part}` looks beyond the {duration} s of a test"
        ));
    }
    Ok(())
}

/// Returns `true` if a folder holds a campaign.
fn is_campaign(folder: &Path) -> bool {
    folder.join("campaign.json").exists()
}

/// Describes an error that ended the campaign, and says which trials are safe.
fn cut_short(error: Error, out: &Path, safe: usize) -> Failure {
    if let Error::Environment(Breakdown::Unanswered { .. }) = error {
        return format!("{error}\n  the tests are in {}", out.display()).into();
    }
    if matches!(error, Error::Environment(Breakdown::Removed { .. })) || !is_campaign(out) {
        let (trials, out) = (plural(safe, "trial"), out.display());
        let message = format!(
            "{error}\n  {out} is no longer there; if it was moved, it holds {trials}; if it was removed, they are lost"
        );
        return message.into();
    }
    format!("{error}\n  {} safe in {}; --resume continues from there", safe_words(safe), out.display()).into()
}

/// Says how many trials are safe.
fn safe_words(trials: usize) -> String {
    match trials {
        0 => "no trial is".to_owned(),
        1 => "the first trial is".to_owned(),
        trials => format!("the first {trials} trials are"),
    }
}
