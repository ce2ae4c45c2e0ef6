//! `paracosm-fuzz trace`: shows each requirement with its tests, and what is untested.

use super::draw::{FileKind, Target};
use super::output::{Format, FormatOption, Table, column, digits, json, plural};
use super::trust::read_results;
use super::{Failure, Status, Verbosity, odd, print};
use clap::Args;
use paracosm_analysis::{Effects, Gap, Traceability, Traced};
use paracosm_campaign::{Catalogue, JsonArtefact, Study};
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz trace paracosm-out
  paracosm-fuzz trace paracosm-out --csv matrix.csv
      a row for each requirement, a column for each test

A requirement passed in a test if it holds and the situation of the test came about. If the situation never came \
    about, the requirement was not reached. If the test ended too early, the requirement is undecided. The untested \
    list has requirements that no test decided, levels and tenths of ranges without a test, parameters with the same \
    value in all tests or without an effect, and the exclusions of the operational design domain.";

/// The options of `trace`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    /// Write the matrix to this file
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let target = self.csv.as_ref().map(|file| Target::new("--csv", file, &[FileKind::Csv], &[])).transpose()?;
        let log = read_results(&self.dir, catalogue, verbosity)?;
        let effects = Effects::read(&self.dir)?;
        let traceability = effects.iter().fold(Traceability::of(&log)?, Traceability::with_effects);
        if let Some(target) = &target {
            target.write(|_| Ok(paracosm_report::traceability::csv(&traceability)))?;
        }
        print(&match self.form.format {
            Format::Table => table(log.study(), &traceability, effects.as_ref()),
            Format::Json => json(&traceability),
        })?;
        Ok(Status::Nothing)
    }
}

/// The number of tests in a line.
const PER_LINE: usize = 20;

const HEADER: [&str; 8] =
    ["requirement", "passed", "failed", "undecided", "not reached", "worst", "severity", "source"];

fn table(study: &Study, traceability: &Traceability, effects: Option<&Effects>) -> String {
    let mut table = Table::default();
    let Traceability { tests, broken, requirements, untested, .. } = traceability;
    let title = study.title();
    let broke = if *broken > 0 { format!(", {broken} of them broke or could not be built") } else { String::new() };
    table.heading(&format!("{title}: {}{broke}", plural(*tests, "test")));
    let rows: Vec<[String; 8]> = [HEADER.map(str::to_owned)].into_iter().chain(requirements.iter().map(row)).collect();
    let width = |index: usize| column(rows.iter().map(|row| row[index].chars().count()).max().unwrap_or(0));
    let widths: [usize; 8] = std::array::from_fn(width);
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        table.line(cells.join("  ").trim_end());
    }
    if requirements.iter().any(|traced| traced.failed > 0) {
        table.heading("failed in these tests");
    }
    for traced in requirements.iter().filter(|traced| traced.failed > 0) {
        for (i, line) in indices(&traced.violated_in).into_iter().enumerate() {
            table.row(if i == 0 { &traced.id } else { "" }, &line);
        }
    }
    table.heading("texts of the requirements");
    for Traced { id, text, .. } in requirements {
        table.row(id, if text.is_empty() { "(no text: the system judges it)" } else { text });
    }
    table.heading(if untested.is_empty() { "untested: nothing found" } else { "untested" });
    for Gap { what, why } in untested {
        table.row(what, why);
    }
    let domain = odd::lines(study, effects);
    if !domain.is_empty() {
        table.heading("operational design domain, as stated");
    }
    for (name, words) in domain {
        table.row(&name, &words);
    }
    table.finish()
}

/// Lists indices of tests in lines.
fn indices(all: &[usize]) -> Vec<String> {
    let line = |some: &[usize]| some.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    all.chunks(PER_LINE).map(line).collect()
}

fn row(traced: &Traced) -> [String; 8] {
    let Traced { id, unit, severity, source, passed, failed, undecided, not_reached, .. } = traced;
    let worst = traced.worst().map(|(worth, index)| {
        let space = if unit.is_empty() { "" } else { " " };
        format!("{}{space}{unit} (test {index})", digits(worth))
    });
    let counts = [passed, failed, undecided, not_reached].map(ToString::to_string);
    let [passed, failed, undecided, not_reached] = counts;
    let word = |word: &Option<String>| word.clone().unwrap_or_else(|| "-".to_owned());
    [id.clone(), passed, failed, undecided, not_reached, word(&worst), word(severity), word(source)]
}
