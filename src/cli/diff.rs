//! `paracosm-fuzz diff`: compares two campaigns with the same tests.

use super::arguments::OUTPUT;
use super::output::{Format, FormatOption, Table, digits, json, percent, plural};
use super::trust::read_results;
use super::{Failure, Status, Verbosity, print};
use clap::Args;
use paracosm_analysis::Difference;
use paracosm_analysis::difference::{Changed, Loss, MarginChange, ModeCount};
use paracosm_campaign::Catalogue;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz cut-in --driver rss --out before
  paracosm-fuzz cut-in --driver planner --out after
  paracosm-fuzz diff before after
  paracosm-fuzz diff before after --fail-on-new-failure
      in CI: no test may fail that did not fail before

Tests with the same values in both campaigns are pairs. A new failure fails in AFTER and does not fail in BEFORE; a mended test is \
    the other way round. The modes are the failure modes of the campaign in which the tests fail. McNemar's test says whether more \
    tests were mended than became failures by more than chance.

Exit status: 0 done; 1 there is a new failure (with --fail-on-new-failure); 2 wrong use, campaigns that have no test in common, \
    or no new failure but a test or a requirement of BEFORE that AFTER does not have (with --fail-on-new-failure).";

/// The number of modes in a table.
const MODES_SHOWN: usize = 5;

/// The options of `diff`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the first campaign
    before: PathBuf,
    /// The folder of the second campaign
    after: PathBuf,
    /// Exit with status 1 if a test fails that did not fail before
    #[arg(long, help_heading = OUTPUT)]
    fail_on_new_failure: bool,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let [before, after] = [&self.before, &self.after].map(|folder| read_results(folder, catalogue, verbosity));
        let difference = Difference::of(&before?, &after?)?;
        let [only_before, only_after] = difference.unpaired;
        if only_before + only_after > 0 {
            verbosity.note(format_args!(
                "{only_before} of the tests in {} and {only_after} of the tests in {} have no pair, and do not count",
                self.before.display(),
                self.after.display()
            ));
        }
        print(&match self.form.format {
            Format::Table => self.table(&difference),
            Format::Json => json(&difference),
        })?;
        let fails = self.fail_on_new_failure && !difference.new_failures.is_empty();
        // A gate that compares less than the first campaign has would be false assurance.
        if self.fail_on_new_failure && !fails && (difference.missing > 0 || !difference.dropped.is_empty()) {
            let what = match difference.dropped.as_slice() {
                [] => {
                    let tests = plural(difference.missing, "test");
                    format!("{} does not have {tests} of {}", self.after.display(), self.before.display())
                }
                dropped => format!(
                    "the requirement {} of {} is not the same in {}",
                    dropped.join(", "),
                    self.before.display(),
                    self.after.display()
                ),
            };
            return Err(format!(
                "--fail-on-new-failure compares campaigns with the same tests and requirements, but {what}"
            )
            .into());
        }
        Ok(if fails { Status::Violation } else { Status::Nothing })
    }

    fn table(&self, difference: &Difference) -> String {
        let mut table = Table::default();
        let [before, after] = &difference.titles;
        table.heading(&format!("{} in both campaigns", plural(difference.tests, "test")));
        for (folder, title, failing) in
            [(&self.before, before, difference.failing[0]), (&self.after, after, difference.failing[1])]
        {
            let share = percent(failing as f64 / difference.tests as f64);
            table.row(&folder.display().to_string(), &format!("{title}: {failing} fail ({share})"));
        }
        for (i, words) in difference.otherwise.iter().enumerate() {
            table.row(if i == 0 { "also different" } else { "" }, words);
        }
        changes(&mut table, "new failures", &difference.new_failures, &difference.new_modes, 1);
        changes(&mut table, "mended", &difference.mended, &difference.mended_modes, 0);
        table.row("fail in both", &difference.still_failing.to_string());
        if let Some([before, after]) = &difference.points {
            table.row("points before", &before.in_words());
            table.row("points after", &after.in_words());
            table.row("  protocol", before.protocol);
        }
        table.row("McNemar's test", &format!("p = {}", digits(difference.mcnemar_p)));
        for (i, margin) in difference.margins.iter().enumerate() {
            table.row(if i == 0 { "margins" } else { "" }, &in_words(margin));
        }
        table.finish()
    }
}

/// Adds the number of changed tests and their failure modes. `of` is the campaign in which the tests fail.
fn changes(table: &mut Table, label: &str, changed: &[Changed], modes: &[ModeCount], of: usize) {
    let first = changed.first().map(|changed| changed.index[of]);
    let example = first.map(|index| format!(", such as test {index}")).unwrap_or_default();
    table.row(label, &format!("{}{}", changed.len(), if modes.is_empty() { example.as_str() } else { "" }));
    for mode in modes.iter().take(MODES_SHOWN) {
        // The sentence has the ranges of all tests with this mode.
        let tests = match (&mode.tests[..], mode.of) {
            ([one], 1) => format!("test {one}"),
            ([one], of) => format!("test {one}, one of {of} in which"),
            (tests, of) if tests.len() == of => format!("{}, such as test {}", plural(of, "test"), tests[0]),
            (tests, of) => format!("{} (such as test {}) of {of} in which", plural(tests.len(), "test"), tests[0]),
        };
        let colon = if tests.ends_with("which") { "" } else { ":" };
        table.row("", &format!("{tests}{colon} {}", mode.words));
    }
    if modes.len() > MODES_SHOWN {
        table.row("", &format!("and {} in --format json", plural(modes.len() - MODES_SHOWN, "more mode")));
    }
}

/// Describes the changes of the margins for a requirement.
fn in_words(margin: &MarginChange) -> String {
    let MarginChange { requirement, unit, pairs, smaller, larger, median, worst, .. } = margin;
    let number = |number: f64| format!("{} {unit}", digits(number)).trim_end().to_owned();
    let sign = if *median > 0.0 { "+" } else { "" };
    let mut text = format!(
        "{requirement}: smaller in {smaller} and larger in {larger} of {pairs}, median change {sign}{}",
        number(*median)
    );
    if let Some(Loss { index, change }) = worst {
        text.push_str(&format!("; at worst {} (test {index})", number(*change)));
    }
    text
}
