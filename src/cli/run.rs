//! `paracosm-fuzz run`: a campaign with everything that watches it.

use super::map;
use super::output::{Format, json, plural};
use super::progress::Progress;
use super::report::Report;
use super::sampling::Sampling;
use super::subject::Subject;
use super::suspects::Guilt;
use super::{Failure, Found, Verbosity, on_interrupt, print};
use crate::coverage::{did_you_mean, nearest};
use crate::generators::Strategy;
use crate::oracles::Verdict;
use crate::scenarios;
use crate::{Campaign, Coverage, Error, Explanation, Folder, Measure, Modes, Study, Tests, Trial};
use clap::Args;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// The time that `coverage.json` may take, as `estimate --time-limit 5`.
const COVERAGE_LIMIT: Duration = Duration::from_secs(5);

/// A campaign that was run to its end.
pub(super) struct Conducted {
    pub study: Study,
    pub trials: Vec<Trial>,
    pub found: Found,
    /// What an interrupt sets.
    pub stop: Arc<AtomicBool>,
}

/// What `run` takes.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    pub subject: Subject,
    /// How tests are chosen; `paracosm-fuzz list` shows all strategies [default: halton; greedy with
    /// --extend; auto with --stop-at-first]
    #[arg(long, value_name = "S")]
    strategy: Option<String>,
    /// How many tests to run
    #[arg(long, value_name = "N", default_value_t = 500)]
    budget: usize,
    #[command(flatten)]
    sampling: Sampling,
    /// How many tests an adaptive strategy is asked for at a time: fewer learn from more, more keep more cores busy
    /// [default: 16]
    #[arg(long, value_name = "N")]
    batch: Option<usize>,
    /// Count the tests in this file as done: run only tests that complete them, and measure the coverage of all together.
    /// Its columns are the open parameters
    #[arg(long, value_name = "TESTS.csv")]
    extend: Option<PathBuf>,
    /// How many tests run at a time; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "paracosm-out")]
    pub out: PathBuf,
    /// Continue the campaign in the folder
    #[arg(long)]
    resume: bool,
    /// Find the combinations of discrete values behind the failures with at most N further tests, into located.json
    /// [default: 200]
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "200")]
    locate: Option<usize>,
    /// End with the first test that violates a requirement, in the order of their indices
    #[arg(long)]
    stop_at_first: bool,
    /// Exit with status 1 if a test violates a requirement
    #[arg(long)]
    fail_on_violation: bool,
    /// Write the tests to junit.xml in the folder as well, as CI systems read them
    #[arg(long)]
    junit: bool,
    /// How to print the summary [default: table on a terminal, json elsewhere]
    #[arg(long)]
    format: Option<Format>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<Found, Failure> {
        self.conduct(verbosity, Ok).map(|conducted| conducted.found)
    }

    /// Runs the campaign and prints its summary. `prepare` may open more of what is tested, or have something against it.
    pub fn conduct(
        &self,
        verbosity: Verbosity,
        prepare: impl FnOnce(Study) -> Result<Study, Error>,
    ) -> Result<Conducted, Failure> {
        if self.resume {
            self.is_no_folder()?;
        }
        let study = self.study(prepare(self.subject.study(verbosity)?)?)?;
        if self.locate.is_some() && study.space.levels().is_empty() {
            let message = "--locate is for discrete parameters, of which none is open; --open NAME=A,B,C opens one";
            return Err(Error::Usage(message.into()).into());
        }
        for (id, part) in study.outlasting()? {
            let duration = study.subject.scenario()?.duration();
            verbosity.note(format_args!(
                "{id} may stay undecided, and tests inconclusive: `{part}` looks past the {duration} s of a test"
            ));
        }
        let mut campaign = Campaign::new(&study)?;
        if let Some(jobs) = self.jobs {
            campaign = campaign.jobs(jobs);
        }
        let (mut folder, known) = if self.resume {
            Folder::resume(&self.out, &study)?
        } else {
            (Folder::create(&self.out, &study)?, Vec::new())
        };
        let mut progress = Progress::new(&study, verbosity, known.len())?;
        let mut trials = known.clone();
        trials.iter().for_each(|trial| progress.count(&study, trial));
        let stop = campaign.stop();
        on_interrupt(stop.clone());
        let mut scales = BTreeMap::new();
        let watch = |trial: &Trial| {
            folder.append(trial)?;
            progress.show(&study, trial);
            trials.push(trial.clone());
            Ok(())
        };
        let run = campaign.resume(known).run_learning(watch, |learned| {
            scales.clone_from(learned);
            Folder::write_study(&self.out, &study.clone().with_scales(scales.clone(), &[]))
        });
        if let Err(error) = run {
            progress.bar.finish_and_clear();
            return Err(cut_short(&error, &self.out, trials.len()));
        }
        let study = study.with_scales(scales, &trials);
        if !study.learned_scales().is_empty() {
            Folder::write_study(&self.out, &study)?;
        }
        let stopped = study.stops_at_first() && trials.last().is_some_and(Trial::is_failure);
        if trials.len() < study.budget && !stopped {
            let beside = study.extends.as_ref().map(|known| format!(" beside the {} in {}", known.tests, known.name));
            let beside = beside.unwrap_or_default();
            verbosity.note(match (self.sampling.epsilon, trials.len()) {
                (_, 0) => format!("nothing is missing{beside}: no test was run"),
                (Some(epsilon), ran) => {
                    let ran = plural(ran, "test");
                    format!("no row has an empty box above {epsilon} after {ran}{beside}, fewer than the budget")
                }
                (None, ran) => {
                    format!(
                        "the strategy has no more tests for these parameters than {ran}{beside}, fewer than the budget"
                    )
                }
            });
        }
        progress.bar.set_message("measuring coverage");
        let coverage = self.write_results(&folder, &study, &trials, verbosity);
        progress.bar.finish_and_clear();
        let coverage = coverage?;
        let guilt = Guilt::of(&study, &trials, &folder, self.locate)?;
        let modes = Modes::of(&study, &trials);
        folder.write("modes.json", json(&modes).as_bytes())?;
        let explanation = Explanation::of(&study, &trials)?;
        if let Some(explanation) = &explanation {
            folder.write("explanation.json", json(explanation).as_bytes())?;
        }
        // What rows promise that were not run came to nothing.
        let promise = if stopped { None } else { study.promise()? };
        let report = Report {
            study: &study,
            trials: &trials,
            summary: &progress.summary,
            coverage: &coverage,
            promise: promise.as_ref(),
            guilt: &guilt,
            modes: &modes,
            explanation: explanation.as_ref(),
            out: &self.out,
        };
        if self.junit {
            folder.write("junit.xml", report.junit().as_bytes())?;
        }
        print(&match Format::or_fitting(self.format) {
            Format::Table => report.table(),
            Format::Json => json(&report.json()),
        })?;
        let summary = &progress.summary;
        for judged in summary.requirements().iter().filter(|judged| judged.undecided > 0) {
            if let Some(spec) = study.requirement(&judged.id).filter(|requirement| requirement.given) {
                let (id, tests) = (&judged.id, plural(judged.undecided, "test"));
                verbosity
                    .note(format!("{id} stayed undecided in {tests}, which ended too early for `{}`", spec.formula));
            }
        }
        if summary.tests() > 0 && summary.count(Verdict::Error) == summary.tests() {
            let first = trials[0].error.as_deref().unwrap_or_default();
            return Err(format!("every test ended in an error; the first: {first}").into());
        }
        let violated = self.fail_on_violation && summary.count(Verdict::Fail) > 0;
        let found = if violated { Found::Violation } else { Found::Nothing };
        Ok(Conducted { study, trials, found, stop })
    }

    /// A study of what is tested, with the strategy that is asked for.
    fn study(&self, tested: Study) -> Result<Study, Error> {
        let sampling = &self.sampling;
        let mut study = tested
            .strategy(self.strategy())?
            .batch(self.batch)?
            .delta(sampling.delta)
            .k(sampling.k)
            .epsilon(sampling.epsilon)
            .budget(self.budget)?
            .stop_at_first(self.stop_at_first)
            .seed(sampling.seed)
            .skip(sampling.skip);
        if let Some(family) = &sampling.discrete {
            study = study.discrete(family)?;
        }
        if let Some(measure) = sampling.measure(self.strategy()) {
            study = study.measure(measure)?;
        }
        match &self.extend {
            Some(path) => study.extend(path),
            None => Ok(study),
        }
    }

    /// Checks that what is to be resumed is no folder in the place of a scenario.
    fn is_no_folder(&self) -> Result<(), Error> {
        let name = self.subject.name();
        if self.subject.is_system() || scenarios::ALL.iter().any(|program| program.name == name) {
            return Ok(());
        }
        let is_campaign = |folder: &Path| folder.join("campaign.json").exists();
        let folder = Path::new(name);
        let said = "--resume takes no folder, --out does";
        if is_campaign(folder) {
            let message = format!("{name} is no scenario but the folder of a campaign: {said}: --out {name} --resume");
            return Err(Error::Usage(message));
        }
        let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty());
        let there = std::fs::read_dir(parent.unwrap_or(Path::new("."))).into_iter().flatten().flatten();
        let there = there.map(|entry| parent.map_or(entry.file_name().into(), |_| entry.path()));
        let mut there: Vec<PathBuf> = there.filter(|folder| is_campaign(folder)).collect();
        there.sort();
        let names: Vec<String> = there.iter().map(|folder| folder.display().to_string()).collect();
        let meant = nearest(name, names.iter().map(String::as_str)).map(|folder| format!("--out {folder} --resume"));
        let scenario = nearest(name, scenarios::ALL.iter().map(|program| program.name)).map(str::to_owned);
        let meant = did_you_mean(&meant.or(scenario));
        Err(Error::Usage(format!("{name} is neither a campaign folder nor a scenario; {said}{meant}")))
    }

    fn strategy(&self) -> &str {
        let default = match (self.extend.is_some(), self.stop_at_first && !self.sampling.says_how_to_cover()) {
            (true, _) => Strategy::Greedy,
            (false, true) => Strategy::Auto,
            (false, false) => Strategy::Halton,
        };
        self.strategy.as_deref().unwrap_or(default.name())
    }

    fn write_results(
        &self,
        folder: &Folder,
        study: &Study,
        trials: &[Trial],
        verbosity: Verbosity,
    ) -> Result<Coverage, Error> {
        folder.write_table(study, trials)?;
        let tests = Tests::of_trials(study, trials)?;
        let coverage = tests.measure(&Measure::ALL, None, Some(COVERAGE_LIMIT))?;
        folder.write("coverage.json", json(&coverage).as_bytes())?;
        match map::of_campaign(study, trials)? {
            None => verbosity.note("no failure map: it needs two continuous open parameters"),
            Some(failures) => map::write(&self.out, &failures)?,
        }
        Ok(coverage)
    }
}

/// An error that ended the campaign, with what is left of it.
fn cut_short(error: &Error, out: &Path, safe: usize) -> Failure {
    if let Error::Unanswered { .. } = error {
        return format!("{error}\n  they are in {}", out.display()).into();
    }
    format!("{error}\n  the first {safe} trials are safe in {}; --resume goes on from there", out.display()).into()
}
