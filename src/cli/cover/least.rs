//! `paracosm-cover least`: how small the dispersion of a number of points can be, with proofs.

use super::spinner;
use super::time_limit;
use crate::cli::draw::{has_folder, is_ours_to_write};
use crate::cli::interrupt::Interruptible;
use crate::cli::output::{Table, digits, plural};
use crate::cli::{Failure, Verbosity, complain, print, usage};
use crate::coverage::least::{self, Least, PRECISION, least_dispersion, most_points};
use crate::coverage::{Deadline, PointSet};
use crate::generators::optimised::{Objective, optimised};
use clap::Args;
use paracosm_campaign::files::Draft;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  paracosm-cover least --dims 2 --budget 6
  paracosm-cover least --dims 3 --budget 4 --certificate least.json";

/// The options of `least`.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Options {
    /// The number of dimensions
    #[arg(long, value_name = "D")]
    dims: usize,
    /// The most points: each number from 1 on has a row
    #[arg(long, value_name = "N")]
    budget: usize,
    /// The seconds for all proofs together; the bounds depend on the time
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    time: f64,
    /// Write the points and the proofs to this file
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
}

/// The share of the time of a row for the search for good points.
const SEARCHING: f64 = 0.02;

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<(), Failure> {
        let limit = time_limit("--time", self.time)?;
        let most = most_points(self.dims);
        if most == 0 {
            let most = (1..).take_while(|&dims| most_points(dims) > 0).last().unwrap_or(1);
            return Err(usage(format!("--dims is {}, expected a number from 1 to {most}", self.dims)).into());
        }
        if !(1..=most).contains(&self.budget) {
            let of = plural(self.dims, "dimension");
            return Err(
                usage(format!("--budget is {}, expected a number from 1 to {most} in {of}", self.budget)).into()
            );
        }
        let certificate = self.certificate.as_deref().map(begun).transpose()?;
        let work = Interruptible::new(Deadline::after(limit));
        let bar = spinner(String::new(), verbosity);
        let mut table = least::Table::new(self.dims);
        for n in 1..=self.budget {
            bar.set_message(plural(n, "point"));
            let row = self.row(n, &table, work.deadline);
            table.add(&row);
        }
        bar.finish_and_clear();
        if work.end() {
            complain(&"interrupted: these are the bounds so far");
        }
        print(&shown(&table))?;
        let Some((path, (draft, mut file))) = self.certificate.as_deref().zip(certificate) else { return Ok(()) };
        let json = serde_json::to_string(&table).expect("a table has numbers and text");
        file.write_all((json + "\n").as_bytes()).map_err(paracosm_campaign::Error::io("write", path))?;
        Ok(draft.finish()?)
    }

    /// Finds the bounds for a number of points. The more points, the longer a proof takes, so a row may take half of the rest of the time.
    fn row(&self, n: usize, table: &least::Table, deadline: Deadline) -> Least {
        let share = if n == self.budget { 1.0 } else { 0.5 };
        let deadline = deadline.part(share);
        let value = |points: &PointSet| Objective::Dispersion.measured(points, Deadline::never()).upper;
        let size = (n, self.dims);
        let start = optimised(Objective::Dispersion, size, None, 0, deadline.part(SEARCHING), &|_| ()).points;
        // Without time for a search, the points of the row before may be better.
        let next = table.next_points().filter(|next| value(next) < value(&start));
        least_dispersion(&next.unwrap_or(start), &table.levels(), deadline)
    }
}

/// Begins the file of a certificate. This comes before all slow work, so that no proof is lost because nothing can be written there.
fn begun(file: &Path) -> Result<(Draft, File), Failure> {
    is_ours_to_write("--certificate", file, &[])?;
    has_folder("--certificate", file)?;
    Ok(Draft::new(file)?)
}

/// Returns the table as text.
fn shown(table: &least::Table) -> String {
    let mut lines = Table::default();
    lines.heading(&format!("least dispersion in {}", plural(table.dims, "dimension")));
    for (n, row) in (1..).zip(&table.rows) {
        let value = match row.is_proved() {
            true => format!("{} (proved)", digits(row.dispersion)),
            false => format!("between {} and {}", digits(row.level), digits(row.dispersion)),
        };
        lines.row(&plural(n, "point"), &value);
    }
    if table.rows.iter().any(least::Row::is_proved) {
        lines.line(&format!("A proved value is the least dispersion, except for a share of {PRECISION}."));
    }
    lines.finish()
}
