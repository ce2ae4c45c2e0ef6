//! `paracosm-fuzz run`: a campaign with everything that watches it.

use super::map;
use super::output::{Format, json, plural};
use super::progress::Progress;
use super::report::Report;
use super::sampling::Sampling;
use super::suspects::Guilt;
use super::{Failure, Found, Verbosity, print};
use crate::coverage::{Domain, Shape, Value};
use crate::generators::Strategy;
use crate::oracles::Verdict;
use crate::{Campaign, Coverage, Error, Explanation, Folder, Measure, Study, Tests, Trial};
use clap::Args;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The time that `coverage.json` may take, as `estimate --time-limit 5`.
const COVERAGE_LIMIT: Duration = Duration::from_secs(5);

/// What `run` takes.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The world to test in; `paracosm-fuzz list` shows them all
    #[arg(default_value = "pedestrian-crossing")]
    scenario: String,
    /// How tests are chosen; `paracosm-fuzz list` shows all strategies [default: halton; greedy with --extend]
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
    /// Open a parameter that the scenario leaves at its nominal value, or narrow an open one. With a SHAPE each test
    /// lets it vary over time: polynomial:DEGREE, piecewise-linear:PIECES, piecewise-constant:PIECES, per-tick,
    /// constant
    #[arg(long, value_name = "NAME[:SHAPE][=LO..HI|=A,B,C]")]
    open: Vec<String>,
    /// Fix a parameter, a signal at one value or at A,B,C; or change a setting of the driver with driver.NAME=VALUE
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// The system under test
    #[arg(long, value_name = "NAME", default_value = "aeb")]
    driver: String,
    /// Count the tests in this file as done: run only tests that complete them, and measure the coverage of all together.
    /// Its columns are the open parameters
    #[arg(long, value_name = "TESTS.csv")]
    extend: Option<PathBuf>,
    /// How many tests run at a time; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "paracosm-out")]
    out: PathBuf,
    /// Continue the campaign in the folder
    #[arg(long)]
    resume: bool,
    /// Find the combinations of discrete values behind the failures with at most N further tests, into located.json
    /// [default: 200]
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "200")]
    locate: Option<usize>,
    /// Exit with status 1 if a test violates a requirement
    #[arg(long)]
    fail_on_violation: bool,
    /// How to print the summary [default: table on a terminal, json elsewhere]
    #[arg(long)]
    format: Option<Format>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<Found, Failure> {
        let study = self.study()?;
        if self.locate.is_some() && study.space.levels().is_empty() {
            let message = "--locate is for discrete parameters, of which none is open; --open NAME=A,B,C opens one";
            return Err(Error::Usage(message.into()).into());
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
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = interrupted.clone();
        // Where there can be no handler, an interrupt ends the program at once, which the log survives as well.
        let _ = ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed));
        let run = campaign.resume(known).run(|trial| {
            if interrupted.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            folder.append(trial)?;
            progress.show(&study, trial);
            trials.push(trial.clone());
            Ok(())
        });
        if let Err(error) = run {
            progress.bar.finish_and_clear();
            return Err(cut_short(&error, &self.out, trials.len()));
        }
        if trials.len() < study.budget {
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
        let explanation = Explanation::of(&study, &trials)?;
        if let Some(explanation) = &explanation {
            folder.write("explanation.json", json(explanation).as_bytes())?;
        }
        let promise = study.promise()?;
        let report = Report {
            study: &study,
            trials: &trials,
            summary: &progress.summary,
            coverage: &coverage,
            promise: promise.as_ref(),
            guilt: &guilt,
            explanation: explanation.as_ref(),
            out: &self.out,
        };
        print(&match Format::or_fitting(self.format) {
            Format::Table => report.table(),
            Format::Json => json(&report.json()),
        })?;
        let summary = &progress.summary;
        if summary.tests() > 0 && summary.count(Verdict::Error) == summary.tests() {
            let first = trials[0].error.as_deref().unwrap_or_default();
            return Err(format!("every test ended in an error; the first: {first}").into());
        }
        let violated = self.fail_on_violation && summary.count(Verdict::Fail) > 0;
        Ok(if violated { Found::Violation } else { Found::Nothing })
    }

    fn study(&self) -> Result<Study, Error> {
        let mut driver_settings = Vec::new();
        let mut fixed = Vec::new();
        let mut vehicle = None;
        for text in &self.set {
            let (name, value) = text.split_once('=').ok_or_else(|| {
                Error::Usage(format!("--set {text}: expected NAME=VALUE, driver.NAME=VALUE or vehicle=MODEL"))
            })?;
            match name.strip_prefix("driver.") {
                None if name == "vehicle" => vehicle = Some(value),
                None if value.contains(',') => fixed.push((name, value.split(',').map(Value::parse).collect())),
                None => fixed.push((name, Value::parse(value))),
                Some(setting) => {
                    let number = value
                        .parse()
                        .map_err(|_| Error::Usage(format!("--set {text}: found `{value}`, expected a number")))?;
                    driver_settings.push((setting.to_owned(), number));
                }
            }
        }
        let sampling = &self.sampling;
        let mut study = Study::of(&self.scenario)?
            .driver(&self.driver, &driver_settings)?
            .strategy(self.strategy())?
            .batch(self.batch)?
            .delta(sampling.delta)
            .k(sampling.k)
            .epsilon(sampling.epsilon)
            .budget(self.budget)?
            .seed(sampling.seed)
            .skip(sampling.skip);
        if let Some(model) = vehicle {
            study = study.vehicle(model)?;
        }
        if let Some(family) = &sampling.discrete {
            study = study.discrete(family)?;
        }
        if let Some(measure) = sampling.measure(self.strategy()) {
            study = study.measure(measure)?;
        }
        for text in &self.open {
            let (name, over) = match text.split_once('=') {
                None => (text.as_str(), None),
                Some((name, over)) => (name, Some(domain(text, over)?)),
            };
            let (name, shape) = match name.split_once(':') {
                None => (name, None),
                Some((name, shape)) => (name, Some(signal(text, shape, &study)?)),
            };
            study = study.open(name, over)?;
            if let Some(shape) = shape {
                study = study.vary(name, shape)?;
            }
        }
        for (i, (name, value)) in fixed.iter().enumerate() {
            let opened = self.open.iter().any(|text| text.split(['=', ':']).next() == Some(name));
            if opened || fixed[..i].iter().any(|(other, _)| other == name) {
                return Err(Error::Usage(format!("parameter `{name}` is set and opened, or set twice")));
            }
            study = study.set(name, value.clone())?;
        }
        match &self.extend {
            Some(path) => study.extend(path),
            None => Ok(study),
        }
    }

    fn strategy(&self) -> &str {
        let default = if self.extend.is_some() { Strategy::Greedy } else { Strategy::Halton };
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

/// Part of a parameter's domain as `--open` takes it: LO..HI or A,B,C.
fn domain(text: &str, over: &str) -> Result<Domain, Error> {
    let Some((lo, hi)) = over.split_once("..") else {
        return Ok(Domain::Choice(over.split(',').map(Value::parse).collect()));
    };
    match (lo.parse(), hi.parse()) {
        (Ok(lo), Ok(hi)) => Ok(Domain::Interval { lo, hi }),
        _ => Err(Error::Usage(format!("--open {text}: found `{over}`, expected numbers LO..HI or values A,B,C"))),
    }
}

/// How a parameter varies over time, as `--open` takes it.
fn signal(text: &str, shape: &str, study: &Study) -> Result<Option<Shape>, Error> {
    match shape {
        "constant" => Ok(None),
        "per-tick" => Ok(Some(Shape::PiecewiseConstant { pieces: study.ticks() })),
        shape => shape.parse().map(Some).map_err(|message| Error::Usage(format!("--open {text}: {message}"))),
    }
}

/// An error that ended the campaign, with what is left of it.
fn cut_short(error: &Error, out: &Path, safe: usize) -> Failure {
    format!("{error}\n  the first {safe} trials are safe in {}; --resume goes on from there", out.display()).into()
}
