//! `paracosm-fuzz blame`: shows which failures other drivers could have avoided.

use super::map::Axes;
use super::output::{Format, FormatOption, Table, digits, json, percent, plural};
use super::progress::bar;
use super::report::in_words;
use super::{Failure, Status, Verbosity, on_interrupt, print, trust};
use clap::Args;
use paracosm_analysis::blame::{Blame, Blamed, Inquiry, Preventability, REFERENCES};
use paracosm_campaign::files::write_whole_here;
use paracosm_campaign::{Artefact, Catalogue, Log, Study, Trial};
use paracosm_report::plot::MapFiles;
use paracosm_report::{BlameTable, FailureMap};
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz blame paracosm-out
  paracosm-fuzz blame paracosm-out --driver ideal,reg157

Every failing test is run again with each reference driver, in its standard settings. A driver prevents a \
    failure if the violated requirements hold in its run, and no other requirement is violated instead. The failure \
    is
  unpreventable: if no reference driver prevents it. Reference drivers brake; they do not steer around anybody and \
    do not drive slower beforehand. So another driver may still prevent the failure
  preventable: if a reference driver prevents it
  induced: if `cruise` prevents it, which never brakes for others: braking has caused the failure
  unknown: if no reference driver prevents it, and a run with a reference driver broke or could not be built

Blame writes blame.json and blame.csv to DIR, and blame-map.svg and .png if two continuous parameters are open.";

/// The options of `blame`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    /// The reference drivers
    ///
    /// `paracosm-fuzz list drivers` shows all drivers.
    #[arg(long, value_name = "A,B,..", value_delimiter = ',', default_values_t = REFERENCES.map(str::to_owned))]
    driver: Vec<String>,
    #[command(flatten)]
    axes: Axes,
    /// The number of failing tests in the table
    #[arg(long, value_name = "N", default_value_t = 10)]
    limit: usize,
    /// The tests that run at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    trust: trust::OfDrivers,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let log = trust::read_log(&self.dir, catalogue, &self.trust.trust(), verbosity)?;
        let study = log.study();
        let references: Vec<&str> = self.driver.iter().map(String::as_str).collect();
        let mut inquiry = Inquiry::new(study, &references)?;
        if let Some(jobs) = self.jobs {
            inquiry = inquiry.jobs(jobs);
        }
        let axes = self.axes.find(&log)?;
        if !study.is_of_this_software() {
            verbosity
                .note("the campaign was run by another version of this software; its failures are taken as logged");
        }
        let stop = verbosity.supervision().stop;
        on_interrupt(stop.clone());
        inquiry = inquiry.until(stop);
        let bar = bar(verbosity, log.trials().iter().filter(|trial| trial.is_failure()).count());
        let blame = inquiry.run(&log, |_| bar.inc(1));
        bar.finish_and_clear();
        let blame = blame?;
        self.write(&log, &blame, axes, verbosity)?;
        print(&match self.form.format {
            Format::Table => self.table(&log, &blame),
            Format::Json => json(&blame),
        })?;
        Ok(Status::Nothing)
    }

    fn write(&self, log: &Log, blame: &Blame, axes: Option<[String; 2]>, verbosity: Verbosity) -> Result<(), Failure> {
        let map = match axes {
            _ if blame.failures.is_empty() => None,
            None => {
                verbosity.note("no map: a map needs two open continuous parameters");
                None
            }
            Some([x, y]) => Some(FailureMap::of_blame(log, blame, [&x, &y])?),
        };
        let map = map.as_ref().map(MapFiles::Blame);
        let table = BlameTable { blame, study: log.study() };
        let artefacts: [Option<&dyn Artefact>; 3] = [Some(blame), Some(&table), map.as_ref().map(|map| map as _)];
        let mut written = Vec::new();
        for artefact in artefacts.into_iter().flatten() {
            for file in artefact.files() {
                let path = self.dir.join(file);
                write_whole_here(&path, &artefact.contents(file)?)?;
                written.push(path.display().to_string());
            }
        }
        verbosity.note(format_args!("written to {}", written.join(", ")));
        Ok(())
    }

    fn table(&self, log: &Log, blame: &Blame) -> String {
        let study = log.study();
        let mut table = Table::default();
        let Blame { references, tests, failures } = blame;
        let title = study.title();
        if failures.is_empty() {
            table.heading(&format!("{title}: {}, no failure, so nobody is to blame", plural(*tests, "test")));
            return table.finish();
        }
        table.heading(&format!("{title}: {} in {}", plural(failures.len(), "failure"), plural(*tests, "test")));
        let share = |count: usize| percent(count as f64 / failures.len() as f64);
        // A failure that is not judged has no fault; there is a line only if there is such a failure.
        for fault in Preventability::ALL {
            let count = blame.count(fault);
            if fault == Preventability::Unknown && count == 0 {
                continue;
            }
            let meaning = meaning(fault, references);
            table.row(&fault.to_string(), &format!("{count:<5} {:>7}  {meaning}", share(count)));
        }
        for (i, name) in references.iter().enumerate() {
            let count = blame.prevented_by(name);
            let label = if i == 0 { "prevented by" } else { "" };
            table.row(label, &format!("{count:<5} {:>7}  {name}", share(count)));
        }
        for failure in failures.iter().take(self.limit) {
            table.row(&format!("test {}", failure.index), &line(study, &log.trials()[failure.index], failure));
        }
        if failures.len() > self.limit {
            let more = plural(failures.len() - self.limit, "more failing test");
            table.row("", &format!("and {more} in {}", self.dir.join("blame.csv").display()));
        }
        table.finish()
    }
}

fn meaning(fault: Preventability, references: &[String]) -> String {
    match fault {
        Preventability::Unpreventable => format!("prevented by none of {}", references.join(", ")),
        Preventability::Preventable => "prevented by a reference driver, by braking".to_owned(),
        Preventability::Induced if references.iter().any(|name| name == "cruise") => {
            "prevented by cruise, which never brakes for others".to_owned()
        }
        Preventability::Induced => "unknown: only the driver cruise could show it, and cruise was not run".to_owned(),
        Preventability::Unknown => "not judged: a run with a reference driver broke or could not be built".to_owned(),
    }
}

/// Describes a failing test in a line: its fault, its violated requirements and its values.
fn line(study: &Study, trial: &Trial, failure: &Blamed) -> String {
    let by = if failure.prevented_by.is_empty() {
        String::new()
    } else {
        format!(", prevented by {}", failure.prevented_by.join(", "))
    };
    let worth = |id: &String| {
        let unit = study.requirement(id).map_or("", |requirement| requirement.unit.as_str());
        let worth = digits(trial.robustness(id).unwrap_or(f64::NAN));
        format!("{id} {worth} {unit}").trim_end().to_owned()
    };
    let violated: Vec<String> = failure.violates.iter().map(worth).collect();
    format!("{}{by}; {}; {}", failure.fault, violated.join(", "), in_words(study, trial))
}
