//! `paracosm-fuzz shrink`: finds the simplest test near a failing test that still fails.

use super::output::{Format, FormatOption, Table, digits, json, plural, value_words};
use super::replay::logged;
use super::{Failure, Status, Verbosity, on_interrupt, print, trust};
use clap::Args;
use paracosm_analysis::{Change, Sameness, Shrunk};
use paracosm_campaign::{Catalogue, Regression, Study};
use std::path::PathBuf;

/// The options of `shrink`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    /// The index of a failing test
    index: usize,
    /// The most tests to run
    #[arg(long, value_name = "N", default_value_t = Shrunk::BUDGET)]
    budget: usize,
    /// Keep the failure mode: the same violated requirements, the same contact, braking or not. Otherwise the simpler
    /// test violates the same requirements, perhaps in another way; the output says so
    #[arg(long)]
    same_mode: bool,
    /// Write the simplest test to a new regression file, which `replay` runs
    #[arg(long, value_name = "FILE.json")]
    save: Option<PathBuf>,
    #[command(flatten)]
    trust: trust::Options,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        self.save.as_deref().map_or(Ok(()), Regression::check_path)?;
        let (log, _) = self.trust.read(&self.dir, catalogue, verbosity)?;
        let study = log.study();
        let same = if self.same_mode { Sameness::Mode } else { Sameness::Requirements };
        let supervision = verbosity.supervision();
        on_interrupt(supervision.stop.clone());
        let failing = logged(&self.dir, &log, self.index)?;
        let shrunk = Shrunk::until(&log, failing, same, self.budget, &supervision)?;
        supervision.doubts.notes().iter().for_each(|note| verbosity.note(note));
        if let Some(path) = &self.save {
            let about = format!("{}: {}", study.title(), shrunk.sentence());
            Regression::new(about, study, &shrunk.trial).write(path)?;
            verbosity.note(format_args!("regression test written to {}", path.display()));
        }
        print(&match self.form.format {
            Format::Table => table(study, &shrunk),
            Format::Json => {
                let mut printed = serde_json::json!(shrunk);
                printed["sentence"] = shrunk.sentence().into();
                json(&printed)
            }
        })?;
        Ok(Status::Nothing)
    }
}

fn table(study: &Study, shrunk: &Shrunk) -> String {
    let mut table = Table::default();
    table.heading(&format!("test {} {}", shrunk.index, shrunk.sentence()));
    for change in &shrunk.parameters {
        table.row(&change.name, &before_and_after(change));
    }
    for requirement in study.requirements().iter().filter(|requirement| shrunk.violates.contains(&requirement.id)) {
        let value = shrunk.trial.robustness(&requirement.id).map(digits).unwrap_or_default();
        table.row(&requirement.id, &format!("{value} {}", requirement.unit));
    }
    if !shrunk.same_mode {
        let [before, after] = &shrunk.failures;
        table.row("fails in another way", after);
        table.row("  before", &format!("{before}; --same-mode keeps this mode"));
    }
    let left = match shrunk.minimal {
        true => "no simpler failing test is within two steps",
        false => "a larger --budget may find a simpler failing test",
    };
    table.row("found in", &format!("{}; {left}", plural(shrunk.runs, "run")));
    table.finish()
}

fn before_and_after(change: &Change) -> String {
    let Change { before, after, nominal, unit, .. } = change;
    let unit = unit.as_deref().map(|unit| format!(" {unit}")).unwrap_or_default();
    let nominal = if *nominal { ", nominal" } else { "" };
    match before == after {
        true => format!("{}{unit}{nominal}, as before", value_words(after)),
        false => format!("{} -> {}{unit}{nominal}", value_words(before), value_words(after)),
    }
}
