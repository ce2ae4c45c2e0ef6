//! `paracosm-fuzz report`: shows a campaign as one HTML file.

use super::draw::is_ours_to_write;
use super::output::plural;
use super::progress::bar;
use super::trust;
use super::usage;
use super::{Failure, Status, Verbosity, on_interrupt, print, program};
use crate::analysis::Difference;
use crate::report::html::{MEGABYTES, Runs};
use crate::{Beside, Report};
use clap::Args;
use paracosm_campaign::files::write_whole;
use paracosm_campaign::{Catalogue, Error, Supervision};
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz report paracosm-out --out report.html
      one file for a colleague: it opens anywhere, and asks nothing of a network
  paracosm-fuzz report after --baseline before --out report.html
      also what changed since an earlier campaign

The page runs tests of the campaign again, to show how they went: the worst test, the worst and the typical test of each failure mode, up \
    to 300 failing tests, and some 60 others. Tests and runs that do not fit into --max-mb are left out, and the page says so.";

/// The options of `report`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign, which may still run
    dir: PathBuf,
    /// The file to write to
    #[arg(long, value_name = "FILE.html", default_value = "report.html")]
    out: PathBuf,
    /// Also show what changed since the campaign in this folder
    #[arg(long, value_name = "DIR")]
    baseline: Option<PathBuf>,
    /// Also show the results of the audit in this folder
    #[arg(long, value_name = "DIR")]
    audit: Option<PathBuf>,
    /// The greatest size of the page in megabytes
    #[arg(long, value_name = "MB", default_value_t = MEGABYTES)]
    max_mb: f64,
    #[command(flatten)]
    trust: trust::Options,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        is_ours_to_write("--out", &self.out, &[])?;
        if self.out.extension().is_none_or(|ending| ending != "html") {
            return Err(usage(format!("--out {}: expected FILE.html", self.out.display())).into());
        }
        if !(self.max_mb > 0.0 && self.max_mb <= 1000.0) {
            return Err(usage(format!("--max-mb is {}, expected a number above 0, at most 1000", self.max_mb)).into());
        }
        let (log, is_other) = self.trust.read(&self.dir, catalogue, verbosity)?;
        if is_other {
            let message =
                "a page shows the results of the campaign's own command: give the same command, or leave it out";
            return Err(usage(message.into()).into());
        }
        let before =
            self.baseline.as_deref().map(|folder| trust::read_results(folder, catalogue, verbosity)).transpose()?;
        let changes = before.map(|before| Difference::of(&before, &log)).transpose()?;
        let report = verbosity.noting_if_slow("deriving the results from the log", || Report::read(log, &self.dir))?;
        let beside = Beside { changes: changes.as_ref(), audit: self.audit.as_deref() };
        let page = report.page(&self.dir, program::name(), beside)?;
        let supervision = Supervision::default();
        on_interrupt(supervision.stop.clone());
        let progress = bar(verbosity, 0);
        let runs = Runs::of(&page, &supervision, |done, all| {
            progress.set_length(all as u64);
            progress.set_position(done as u64);
        });
        progress.finish_and_clear();
        let runs = match runs {
            // The page is worth something without runs, for example if the driver is not trusted or cannot be started.
            Err(error) if !matches!(error, Error::Interrupted) => {
                verbosity.note(format_args!("the page has no runs: {error}"));
                Runs::none(error.to_string())
            }
            runs => runs?,
        };
        if runs.differing() > 0 {
            let tests = plural(runs.differing(), "test");
            verbosity.note(format_args!("the page does not show {tests}, which did not end as in the log: did the driver or the scenario change?"));
        }
        let html = verbosity
            .noting_if_slow("estimating the probability of failure over pairs of parameters", || {
                page.html(&runs, self.max_mb)
            })?;
        write_whole(&self.out, html.as_bytes())?;
        print(&format!("{}\n", self.out.display()))?;
        verbosity.note(format_args!("page of {:.2} MB", html.len() as f64 / 1e6));
        Ok(Status::Nothing)
    }
}
