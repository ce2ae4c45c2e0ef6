//! `paracosm-fuzz merge`: puts the shards of a campaign together.

use super::gate::gate;
use super::output::{Format, FormatOption, json};
use super::{Failure, Status, Verbosity, on_interrupt, print, program, report, trust};
use crate::Runner;
use clap::Args;
use paracosm_campaign::{Catalogue, merge};
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz run highway-traffic --budget 100000 --shard 1/64 --out shard-1
      one of 64 shards, each on any machine
  paracosm-fuzz merge highway shard-*
      the whole campaign, as if one machine had run it

The results in the new folder are the results of a campaign that one machine has run, byte for byte. The output of programs stays in the folders of the shards. Each shard is given once, in any order. The last \
    test of each verdict runs again, to check that this machine gets the same results.";

/// The options of `merge`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The new folder of the whole campaign
    out: PathBuf,
    /// The folders of the shards
    #[arg(required = true, value_name = "SHARD")]
    shards: Vec<PathBuf>,
    /// Exit with status 1 if a test fails, as `run` does
    #[arg(long)]
    fail_on_violation: bool,
    /// Also write junit.xml, for CI systems
    #[arg(long)]
    junit: bool,
    #[command(flatten)]
    trust: trust::OfDrivers,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let (folder, log) = merge(&self.out, &self.shards, catalogue, &self.trust.trust())?;
        let (study, extension) = (log.study().clone(), log.extension().cloned());
        let supervision = verbosity.supervision();
        on_interrupt(supervision.stop.clone());
        let program = program::called();
        let runner = Runner::new(&study).until(supervision).program(&program);
        let runner = extension.iter().fold(runner, Runner::extending);
        let runner = if self.junit { runner.with_junit() } else { runner };
        let report = runner.complete(folder, log.into_trials())?;
        let printed = report::Printed { report: &report, out: &self.out, program: &program, locate: false };
        print(&match self.form.format {
            Format::Table => printed.table(),
            Format::Json => json(&printed.json()),
        })?;
        gate(&report, self.fail_on_violation)
    }
}
