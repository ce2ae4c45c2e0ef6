//! `paracosm-fuzz repeat`: runs a whole campaign again, and says whether every test ended as before.

use super::arguments::{OUTPUT, RUNNING};
use super::output::{Format, FormatOption, Table, json, plural};
use super::progress::Progress;
use super::{Failure, Status, Verbosity, on_interrupt, print, trust};
use crate::Runner;
use crate::analysis::{Repetition, repetition::Differing};
use clap::Args;
use paracosm_campaign::{Catalogue, Supervision};
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz repeat paracosm-out --out again
      a reviewer gets the same tests with the same results, or sees which tests differ

The study of the campaign is run from its beginning, with the same scenario, driver, strategy, seed and budget. A test is the same if \
    its values, its verdict, its robustness, its trace and its measurements are the same.

Exit status: 0 all tests are the same; 1 a test differs, or only one of both campaigns has it; 2 the campaign cannot be run.";

/// The number of tests in a table.
const SHOWN: usize = 10;

/// The options of `repeat`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "repeated", help_heading = OUTPUT)]
    out: PathBuf,
    /// The tests that run at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N", help_heading = RUNNING)]
    jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    trust: trust::Options,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let (log, _) = self.trust.read(&self.dir, catalogue, verbosity)?;
        let supervision = Supervision::default();
        let runner = log.extension().into_iter().fold(Runner::new(log.study()), Runner::extending);
        let runner = self.jobs.into_iter().fold(runner, Runner::jobs).until(supervision.clone());
        let mut progress = Progress::new(log.study(), log.done_before(), verbosity)?;
        on_interrupt(supervision.stop.clone());
        let ran = runner.run_into(&self.out, &mut [&mut progress]);
        progress.bar.finish_and_clear();
        supervision.doubts.notes().iter().for_each(|note| verbosity.note(note));
        let repetition = Repetition::of(&log, &ran?.log);
        print(&match self.form.format {
            Format::Table => self.table(&repetition),
            Format::Json => json(&repetition),
        })?;
        Ok(if repetition.is_exact() { Status::Nothing } else { Status::Violation })
    }

    fn table(&self, repetition: &Repetition) -> String {
        let Repetition { tests, same, differing, only } = repetition;
        let mut table = Table::default();
        table.heading(&format!("{} again, in {}", self.dir.display(), self.out.display()));
        table.row("the same", &format!("{same} of {}", plural(*tests, "test")));
        for Differing { index, what, verdicts: [before, after] } in differing.iter().take(SHOWN) {
            let verdicts = if before == after { before.clone() } else { format!("{before}, now {after}") };
            table.row(&format!("test {index}"), &format!("another {}: {verdicts}", what.name()));
        }
        if differing.len() > SHOWN {
            table.row("", &format!("and {} more", plural(differing.len() - SHOWN, "test")));
        }
        for (count, folder) in only.iter().zip([&self.dir, &self.out]).filter(|(count, _)| **count > 0) {
            table.row("without a pair", &format!("{} in {}", plural(*count, "test"), folder.display()));
        }
        table.finish()
    }
}
