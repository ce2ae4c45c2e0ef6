//! The progress bar of a campaign.

use super::output::short_bracket;
use super::report::in_words;
use super::{Verbosity, complain};
use crate::oracles::Verdict;
use crate::{Error, LiveCoverage, Study, Summary, Trial};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

/// A bar of so many tests, hidden where nothing is to be said.
pub(super) fn bar(verbosity: Verbosity, tests: usize) -> ProgressBar {
    let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new(tests as u64) };
    let template = "{bar:40.blue/white} {human_pos}/{human_len} tests  {rate} tests/s  {eta} left  {msg}";
    let style = ProgressStyle::with_template(template).expect("the template is one");
    bar.with_style(style.with_key("rate", |state: &ProgressState, text: &mut dyn std::fmt::Write| {
        let _ = write!(text, "{:.0}", state.per_sec());
    }))
}

/// The progress bar, with the counts that it shows.
pub(super) struct Progress {
    pub(super) bar: ProgressBar,
    pub(super) summary: Summary,
    coverage: Option<LiveCoverage>,
    quiet: bool,
    verbose: bool,
}

impl Progress {
    pub(super) fn new(study: &Study, verbosity: Verbosity, known: usize) -> Result<Self, Error> {
        let bar = bar(verbosity, study.budget).with_position(known as u64);
        // The rate is that of this session, not of what was there before.
        bar.reset_eta();
        let mut coverage = LiveCoverage::new(&study.space, study.strength()).ok();
        if let Some(coverage) = coverage.as_mut().filter(|_| !bar.is_hidden()) {
            study.existing()?.iter().try_for_each(|test| coverage.add(test))?;
        }
        let Verbosity { quiet, verbose } = verbosity;
        Ok(Self { bar, summary: Summary::default(), coverage, quiet, verbose })
    }

    pub(super) fn count(&mut self, study: &Study, trial: &Trial) {
        self.summary.add(trial);
        // Where nobody sees the bar, it need not be known.
        if trial.covers()
            && !self.bar.is_hidden()
            && let Some(coverage) = &mut self.coverage
            && let Ok(point) = study.space.encode(&trial.test)
        {
            coverage.add(&point).expect("a point of the space");
        }
    }

    pub(super) fn show(&mut self, study: &Study, trial: &Trial) {
        self.count(study, trial);
        let coverage = self.coverage.as_ref();
        let dispersion = coverage.and_then(LiveCoverage::dispersion);
        let dispersion =
            dispersion.map(|volume| format!("  dispersion {}", short_bracket(&volume))).unwrap_or_default();
        let combinations = coverage.and_then(LiveCoverage::combinations);
        let combinations = combinations.map(|(covered, valid)| format!("  {covered}/{valid} combinations"));
        let combinations = combinations.unwrap_or_default();
        self.bar.set_message(format!("{} fail{dispersion}{combinations}", self.summary.count(Verdict::Fail)));
        self.bar.inc(1);
        // What is wrong with one test may be wrong with all, and whoever looks on can stop them.
        let is_first = trial.verdict == Verdict::Error && self.summary.count(Verdict::Error) == 1;
        if let Some(error) = trial.error.as_ref().filter(|_| is_first && !self.verbose && !self.quiet) {
            self.bar.suspend(|| complain(&format!("test {} ended in an error: {error}", trial.index)));
        }
        if self.verbose && trial.verdict != Verdict::Pass {
            let line = format!("test {}: {}, {}", trial.index, trial.verdict, in_words(study, trial));
            self.bar.suspend(|| complain(&line));
        }
    }
}
