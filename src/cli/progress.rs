//! The progress bar of a campaign.

use super::output::short_bracket;
use super::report::in_words;
use super::{Verbosity, complain};
use crate::oracles::Verdict;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use paracosm_analysis::{LiveCoverage, Summary};
use paracosm_campaign::{Error, Extension, Observer, Study, Trial};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// The time between two messages beside the bar. The bar is drawn at most 20 times a second anyway.
const BETWEEN_MESSAGES: Duration = Duration::from_millis(50);

/// The time between two drawings of the bar after the last test.
const BETWEEN_TICKS: Duration = Duration::from_millis(200);

/// Makes a progress bar for `tests` tests; `--quiet` hides the bar.
pub(super) fn bar(verbosity: Verbosity, tests: usize) -> ProgressBar {
    let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new(tests as u64) };
    let template = "{bar:40.blue/white} {human_pos}/{human_len} tests  {rate} tests/s  {eta} left  {msg}";
    let style = ProgressStyle::with_template(template).expect("the template is one");
    bar.with_style(style.with_key("rate", |state: &ProgressState, text: &mut dyn std::fmt::Write| {
        let _ = write!(text, "{:.0}", state.per_sec());
    }))
}

/// The progress bar, with the counts that it shows.
pub(super) struct Progress<'a> {
    study: &'a Study,
    pub bar: ProgressBar,
    pub summary: Summary,
    /// True if the campaign has begun, so that its folder exists.
    pub begun: bool,
    coverage: Option<LiveCoverage>,
    /// The time at which the message beside the bar was last written.
    shown: Option<Instant>,
    quiet: bool,
    verbose: bool,
}

impl<'a> Progress<'a> {
    pub fn new(study: &'a Study, extension: Option<&Extension>, verbosity: Verbosity) -> Result<Self, Error> {
        let bar = bar(verbosity, study.sampling().budget);
        let mut coverage = LiveCoverage::new(study.space(), study.sampling().k).ok();
        if let (Some(coverage), Some(extension), false) = (&mut coverage, extension, bar.is_hidden()) {
            extension.points(study.space())?.iter().try_for_each(|test| coverage.add(test))?;
        }
        let Verbosity { quiet, verbose } = verbosity;
        Ok(Self { study, bar, summary: Summary::default(), begun: false, coverage, shown: None, quiet, verbose })
    }

    /// Returns a function that shows a line of the output of a program above the bar.
    pub fn show_output(&self) -> impl Fn(&str, &[u8]) + Send + 'static {
        let bar = self.bar.clone();
        move |role, line| {
            let line = String::from_utf8_lossy(line);
            bar.suspend(|| complain(&format!("{role}: {}", line.trim_end())));
        }
    }

    fn count(&mut self, trial: &Trial) {
        self.summary.add(trial);
        // A hidden bar needs no coverage.
        if trial.covers()
            && !self.bar.is_hidden()
            && let Some(coverage) = &mut self.coverage
            && let Ok(point) = self.study.space().encode(&trial.test)
        {
            coverage.add(&point).expect("a point of the space");
        }
    }

    /// Returns the counts beside the bar.
    fn message(&self) -> String {
        let coverage = self.coverage.as_ref();
        let dispersion = coverage.and_then(LiveCoverage::dispersion);
        let dispersion =
            dispersion.map(|volume| format!("  dispersion {}", short_bracket(&volume))).unwrap_or_default();
        let combinations = coverage.and_then(LiveCoverage::combinations);
        let combinations = combinations.map(|(covered, valid)| format!("  {covered}/{valid} combinations"));
        let combinations = combinations.unwrap_or_default();
        format!("{} fail{dispersion}{combinations}", self.summary.count(Verdict::Fail))
    }

    fn show(&mut self, trial: &Trial) {
        if !self.bar.is_hidden() && self.shown.is_none_or(|at| at.elapsed() >= BETWEEN_MESSAGES) {
            self.bar.set_message(self.message());
            self.shown = Some(Instant::now());
        }
        self.bar.inc(1);
        // The error of a test may be the error of all tests, and a user who sees it can stop the campaign.
        let is_first = trial.verdict == Verdict::Error && self.summary.count(Verdict::Error) == 1;
        if let Some(error) = trial.error().filter(|_| is_first && !self.verbose && !self.quiet) {
            self.bar.suspend(|| complain(&format!("test {} ended in an error: {error}", trial.index)));
        }
        if self.verbose && trial.verdict != Verdict::Pass {
            let line = format!("test {}: {}, {}", trial.index, trial.verdict, in_words(self.study, trial));
            self.bar.suspend(|| complain(&line));
        }
    }
}

impl Observer for Progress<'_> {
    fn begun(&mut self) -> Result<(), Error> {
        self.begun = true;
        Ok(())
    }

    fn trial(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        self.count(trial);
        self.show(trial);
        Ok(ControlFlow::Continue(()))
    }

    fn known(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        self.count(trial);
        self.bar.inc(1);
        // The rate counts tests of this session only.
        self.bar.reset_eta();
        Ok(ControlFlow::Continue(()))
    }

    fn ended(&mut self) -> Result<(), Error> {
        self.bar.set_message("measuring coverage");
        // Without ticks, the last count may never be drawn: the bar is drawn at most 20 times a second.
        self.bar.enable_steady_tick(BETWEEN_TICKS);
        Ok(())
    }
}
