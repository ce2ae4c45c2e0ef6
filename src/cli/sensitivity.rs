//! `paracosm-fuzz sensitivity`: shows how much each open parameter matters.

use super::arguments::{ESTIMATED, RUNNING};
use super::output::{Format, FormatOption, Table, json, percent, plural};
use super::progress::bar;
use super::{Failure, Status, Verbosity, on_interrupt, print, trust};
use clap::Args;
use paracosm_analysis::sensitivity::{Explained, Indices, Sensitivity, Source, of_model, of_tests, tests_within};
use paracosm_campaign::{Campaign, Catalogue, Log};
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz sensitivity paracosm-out
      from the model of the campaign's failures, without a test
  paracosm-fuzz sensitivity paracosm-out --budget 4000
      from 4,000 tests of its own

The first-order index of a parameter is the share of the variance that the parameter explains alone. The total \
    index is the share in which the parameter takes part, alone or together with others. A parameter with the total \
    index 0 has no effect. A first-order index far below the total index means that the parameter acts together \
    with others. Both are Sobol indices, with 95 % bootstrap intervals.

The indices need independent parameters. If constraints leave a part of the space, there are none.";

/// The options of `sensitivity`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    /// Run at most this number of tests
    ///
    /// The tests are those of a design for Sobol indices, and are not added to the campaign. The number of tests is a power of
    /// two times the number of parameters plus 2 [default: no test, but the model of the campaign's failures].
    #[arg(long, value_name = "N", help_heading = ESTIMATED)]
    budget: Option<usize>,
    /// The seed of all random choices
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = ESTIMATED)]
    seed: u64,
    /// The tests that run at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N", help_heading = RUNNING, requires = "budget")]
    jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    trust: trust::Options,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let (log, _) = self.trust.read(&self.dir, catalogue, verbosity)?;
        let sensitivity = match self.budget {
            Some(budget) => self.of_tests(&log, budget, verbosity)?,
            None => of_model(&log, self.seed)?,
        };
        print(&match self.form.format {
            Format::Table => table(&log, &sensitivity),
            Format::Json => json(&sensitivity),
        })?;
        Ok(Status::Nothing)
    }

    fn of_tests(&self, log: &Log, budget: usize, verbosity: Verbosity) -> Result<Sensitivity, Failure> {
        let study = log.study();
        if !study.is_of_this_software() {
            verbosity.note("the campaign was run by another version of this software; the tests are run by this one");
        }
        let supervision = verbosity.supervision();
        let mut campaign = Campaign::until(study, supervision.clone())?;
        if let Some(jobs) = self.jobs {
            campaign = campaign.jobs(jobs);
        }
        on_interrupt(campaign.stop());
        let bar = bar(verbosity, tests_within(budget, study.space().parameters().len())?);
        let mut failures = 0;
        let sensitivity = of_tests(log, &campaign, budget, self.seed, |trial| {
            failures += usize::from(trial.is_failure());
            bar.set_message(format!("{failures} fail"));
            bar.inc(1);
            Ok(())
        });
        bar.finish_and_clear();
        supervision.doubts.notes().iter().for_each(|note| verbosity.note(note));
        Ok(sensitivity?)
    }
}

fn table(log: &Log, sensitivity: &Sensitivity) -> String {
    let Sensitivity { source, evaluations, pairs, failure, robustness, notes } = sensitivity;
    let mut table = Table::default();
    let (share, title) = (percent(failure.mean), log.study().title());
    let (fail, quantity) = match source {
        Source::Tests => (format!("{share} of the tests fail"), "the failure (1 or 0)"),
        Source::FailureModel { .. } => (format!("about {share} of all tests fail"), "the probability of failure"),
    };
    table.heading(&format!("{title}: {fail}"));
    explained(&mut table, quantity, failure);
    if let Some(robustness) = robustness {
        explained(&mut table, "the robustness", robustness);
    }
    table.heading("How the shares were estimated:");
    match source {
        Source::Tests => {
            table.row(
                "source",
                &format!("{} of its own, {} of tests", plural(*evaluations, "test"), plural(*pairs, "pair")),
            );
        }
        Source::FailureModel { tests } => {
            let known = plural(*tests, "test");
            table.row("source", &format!("the model of the failures in {known}, evaluated {evaluations} times"));
        }
    }
    table.row("intervals", "95 %, by the bootstrap over the pairs");
    for note in notes {
        table.row("note", note);
    }
    table.finish()
}

/// Adds the shares of the variance of a quantity.
fn explained(table: &mut Table, quantity: &str, explained: &Explained) {
    if explained.parameters.is_empty() {
        table.heading(&format!("Nothing to explain: {quantity} is the same in all tests."));
        return;
    }
    table.heading(&format!("Shares of the variance of {quantity}:"));
    table.row("", &format!("{:<26}{}", "alone (first order)", "in all (total)"));
    for Indices { name, first_order, total } in &explained.parameters {
        table.row(name, &format!("{:<26}{total}", first_order.to_string()));
    }
}
