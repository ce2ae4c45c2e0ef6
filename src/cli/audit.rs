//! `paracosm-fuzz audit`: puts a suite of tests on trial.

use super::arguments::{OUTPUT, RUNNING, SUITES};
use super::cover::time_limit;
use super::draw::FileKind;
use super::export;
use super::output::{Format, FormatOption, Table, digits, json, percent, plural, short_bracket, value_words};
use super::progress::bar;
use super::replay::draw;
use super::subject::Subject;
use super::{Failure, Status, Verbosity, on_interrupt, print, usage};
use crate::notes::notes_before;
use crate::standards::openscenario::value_sets;
use clap::Args;
use paracosm_analysis::audit::{
    Additions, Audit, AuditFolder, Audited, Better, Estimate, Kept, Report, Runs, Score, Screen, Share, Source, Suite,
    SuiteFlaw, Witness,
};
use paracosm_analysis::estimate::Discrete;
use paracosm_campaign::files::write_whole_here;
use paracosm_campaign::{Artefact, Catalogue, Error, Study, Worker, tests_as_csv};
use paracosm_report::birds_eye::MotionRecord;
use paracosm_report::hole;
use paracosm_space::{Record, Values};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz audit pedestrian-crossing --tests my-tests.csv --driver planner
  paracosm-fuzz audit cut-in --tests halton:40 --tests lhs:40 --tests grid:4x3x3x2
  paracosm-fuzz audit alks_4_4_1_variation.xosc --driver fsm --out audit
      its own values are the suite

An audit says what a suite of tests would have missed:
  coverage: the k-wise coverage, and for each row of discrete values the largest box that no test has entered
  witness: a driver that drives like the given one, but does not brake in such a box. It has the same verdict as \
    the given driver in every test of the suite, and fails in the box
  mutants: drivers with defects of many kinds and sizes, always on or on under conditions. A suite kills a mutant \
    if a test of the suite violates a requirement with the mutant, and keeps it with the given driver. The mutants \
    are fixed before: each is noticed in one of the random tests of --screen
  additions: the fewest tests of the screen that kill the mutants which the suite misses, and a test that kills \
    the witness
  better: a suite with fewer tests than the first suite and smaller holes that kills as many mutants, if one is \
    found. No mutant chooses a test, but they say how many tests there are. Grade it with other mutants: --seed 1

The audit writes audit.json, mutants.jsonl, which has a line for each mutant, and for the first suite \
    certificate-1.json, a proof of its holes that tests/check_certificate.py checks, hole-1.png, \
    additions-1.csv, better-1.csv and witness-1.gif, and so on, to the folder --out. If the scenario is a file, additions-1.xosc and better-1.xosc \
    list the same tests.";

/// The number of rows with the largest holes in the table.
const ROWS: usize = 5;

/// The options of `audit`. An audit mutates the driver, which therefore runs in this process.
#[derive(Debug, Args)]
#[command(mut_arg("driver_command", |option| option.hide(true)), mut_arg("system", |option| option.hide(true)))]
#[command(mut_arg("space", |option| option.hide(true)))]
pub(super) struct Options {
    #[command(flatten)]
    subject: Subject,
    /// A suite of tests
    ///
    /// A CSV file of tests, the folder of a campaign, a folder of concrete files .xosc of the scenario, STRATEGY:N for the
    /// first N tests of a strategy, or grid:AxB for an even grid. The option can be repeated [default: the values of the
    /// parameters in a scenario file].
    #[arg(long, value_name = "SUITE", help_heading = SUITES)]
    tests: Vec<String>,
    /// The number of mutants
    #[arg(long, value_name = "N", default_value_t = 200, help_heading = SUITES)]
    mutants: usize,
    /// The random tests that notice the mutants
    ///
    /// Each mutant is noticed in one of these random tests.
    #[arg(long, value_name = "N", default_value_t = Screen::TESTS, help_heading = SUITES)]
    screen: usize,
    /// The seed of the screen and of the mutants
    ///
    /// Another seed gives other mutants.
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = SUITES)]
    seed: u64,
    /// Compare with suites of each strategy
    ///
    /// The first suite is compared with suites of as many tests, one by each strategy that does not learn from outcomes.
    #[arg(long, help_heading = SUITES)]
    compare: bool,
    /// Limit the seconds for each suite
    ///
    /// The limit is for the coverage and the certificate of each suite, and for the better suite. Holes are brackets if the
    /// time is too short [default: no limit].
    #[arg(long, value_name = "SECONDS", help_heading = RUNNING)]
    time_limit: Option<f64>,
    /// The tests that run at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N", help_heading = RUNNING)]
    jobs: Option<NonZeroUsize>,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "paracosm-audit", help_heading = OUTPUT)]
    out: PathBuf,
    /// Continue the audit in the folder
    #[arg(long, help_heading = RUNNING)]
    resume: bool,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let sources = self.tests.iter().map(|text| text.parse()).collect::<Result<Vec<Source>, SuiteFlaw>>();
        let sources = sources.map_err(Error::from)?;
        if self.mutants > 0 && self.screen == 0 {
            return Err(
                usage("--screen is 0, expected at least 1 test: mutants come from the screen".to_owned()).into()
            );
        }
        let limit = self.time_limit.map(|seconds| time_limit("--time-limit", seconds)).transpose()?;
        AuditFolder::check(&self.out, self.resume).map_err(Error::from)?;
        let (study, mut suites) = self.suites(&sources, catalogue, verbosity)?;
        if self.compare {
            let (others, refusals) = suites[0].rivals(&study, &sources);
            refusals.iter().for_each(|refusal| verbosity.note(format_args!("not compared: {refusal}")));
            suites.extend(others);
        }
        let mut runs = Runs::default();
        if let Some(jobs) = self.jobs {
            runs.jobs = jobs;
        }
        on_interrupt(runs.stop.clone());
        let audit = Audit::of(&study, suites).map_err(Error::from)?;
        AuditFolder::check_same(&self.out, &audit)?;
        runs.kept = Some(Arc::new(Kept::open(&self.out)?));
        let mut audit = limit.into_iter().fold(audit, Audit::time_limit);
        if self.mutants > 0 {
            audit = audit.mutants(Screen::of(&study, self.mutants, self.screen, self.seed, &runs)?);
        }
        let audit = audit.runs(runs);
        notes_before(&study)?.iter().for_each(|note| verbosity.note(note));
        let (mut folder, mut tried) = AuditFolder::open(&self.out, &audit, self.resume)?;
        let bar = bar(verbosity, self.mutants);
        bar.inc(tried.len() as u64);
        let report = audit.run(&mut tried, |one| {
            bar.inc(1);
            folder.add(one)
        });
        bar.finish_and_clear();
        let report = report?;
        for file in report.files() {
            write_whole_here(&self.out.join(file), &report.contents(file)?)?;
        }
        let mut drawn = Vec::new();
        for (number, suite) in (1..).zip(&report.suites) {
            write_whole_here(&self.out.join(certificate_file(number)), &suite.certificate.to_json())?;
            if let Some(additions) = suite.additions.as_ref().filter(|additions| !additions.tests.is_empty()) {
                self.write_tests(&study, &additions_file(number), &additions.tests, verbosity)?;
            }
            if let Some(better) = &suite.better {
                self.write_tests(&study, &better.file, &better.suite, verbosity)?;
            }
            if let Some(picture) = hole::picture(study.space(), &audit.suites()[number - 1], suite) {
                write_whole_here(&self.out.join(hole_file(number)), &picture.png()?)?;
                drawn.push(number);
            }
            if let Some(witness) = &suite.witness {
                write_whole_here(&self.out.join(film_file(number)), &film(witness, &study)?)?;
            }
        }
        verbosity.note(format_args!("written to {}", self.out.display()));
        print(&match self.form.format {
            Format::Table => table(&report, &drawn),
            Format::Json => json(&report),
        })?;
        Ok(Status::Nothing)
    }

    /// Writes tests to a table in the folder, and if the scenario is a file, also to a distribution of its parameters beside it.
    fn write_tests(&self, study: &Study, file: &str, tests: &[Values], verbosity: Verbosity) -> Result<(), Failure> {
        let table = self.out.join(file);
        write_whole_here(&table, &tests_as_csv(study.space(), tests))?;
        let Some(scenario) = export::file_of(study)? else { return Ok(()) };
        match value_sets(&scenario, &self.out, tests, study.fixed()) {
            Ok(text) => write_whole_here(&table.with_extension(export::XOSC), text.as_bytes())?,
            Err(flaw) => verbosity.note(format_args!("the tests of {file} are not written as .xosc, too: {flaw}")),
        }
        Ok(())
    }

    /// Returns the study and its suites. Without a named suite, the suite is that of the scenario's listed values, and the study has
    /// their intervals open.
    fn suites(
        &self,
        sources: &[Source],
        catalogue: &Catalogue,
        verbosity: Verbosity,
    ) -> Result<(Study, Vec<Suite>), Error> {
        let builder = self.subject.study(catalogue, verbosity)?;
        if !sources.is_empty() {
            let study = builder.build()?;
            let suites =
                sources.iter().map(|source| Suite::of(source, &study, catalogue)).collect::<Result<_, Error>>()?;
            return Ok((study, suites));
        }
        let (study, suite) = Suite::of_listed(&builder)?;
        Ok((study, vec![suite]))
    }
}

/// Returns the name of the certificate of a suite's holes.
fn certificate_file(number: usize) -> String {
    format!("certificate-{number}.json")
}

/// Returns the name of the picture of a suite's largest hole.
fn hole_file(number: usize) -> String {
    format!("hole-{number}.png")
}

/// Returns the name of the film of a suite's witness.
fn film_file(number: usize) -> String {
    format!("witness-{number}.gif")
}

/// Returns a film of the test that the witness fails.
fn film(witness: &Witness, study: &Study) -> Result<Vec<u8>, Failure> {
    let blind = witness.study(study)?;
    let mut record = MotionRecord::default();
    let (trial, _) = Worker::new(&blind)?.watch(0, &witness.fails_at, |run| record.see(run));
    let caption = format!("{}, the witness: {}", study.subject().scenario()?.scenario(), trial.verdict);
    draw(&record, FileKind::Gif, &caption)
}

/// Returns the name of the file of the tests that a suite should have besides.
fn additions_file(number: usize) -> String {
    format!("additions-{number}.csv")
}

/// Prints a report. `drawn` has the numbers of the suites whose largest hole is drawn.
fn table(report: &Report, drawn: &[usize]) -> String {
    let mut table = Table::default();
    for (number, suite) in (1..).zip(&report.suites) {
        let left = if suite.left_out == 0 {
            String::new()
        } else {
            format!(" ({} left out: they break a constraint)", suite.left_out)
        };
        table.heading(&format!("{}: {}, {}{left}", report.title, suite.suite, plural(suite.tests, "test")));
        table.coverage(&suite.coverage);
        suite.k_wise.iter().for_each(|found| table.discrete(found));
        holes(&mut table, suite);
        if drawn.contains(&number) {
            table.row("  picture", &hole_file(number));
        }
        certificate(&mut table, suite, number);
        match &suite.witness {
            Some(witness) => self::witness(&mut table, witness, number),
            None => table.row(
                "witness",
                "none: a driver that does not brake failed in no test that was tried outside of the suite",
            ),
        }
        if let Some(score) = &suite.mutants {
            let screen = report.screen.as_ref().expect("mutants come from a screen");
            self::score(&mut table, screen, score);
            if let Some(additions) = suite.additions.as_ref().filter(|more| !more.tests.is_empty()) {
                let Additions { missed, tests, at_least } = additions;
                let witness = suite.witness.is_some();
                let killing = plural(tests.len() - usize::from(witness), "test");
                let last = if witness { ", and a test kills the witness" } else { "" };
                let missed = plural(*missed, "missed mutant");
                let file = additions_file(number);
                table.row("additions", &format!("{killing} (at least {at_least}) kill {missed}{last}: {file}"));
            }
        }
        if let Some(Better { tests, hole, mutation_score, file, .. }) = &suite.better {
            let score =
                mutation_score.map_or(String::new(), |score| format!(", mutation score {}", percent(score.value)));
            let (tests, hole) = (plural(*tests, "test"), short_bracket(hole));
            table.row("better suite", &format!("{tests}, largest hole {hole}{score}: {file}"));
        }
    }
    if report.suites.len() > 1 {
        compared(&mut table, report);
    }
    table.finish()
}

fn holes(table: &mut Table, suite: &Audited) {
    let Audited { holes, .. } = suite;
    if holes.rows.first().is_none_or(|hole| hole.row.iter().next().is_none()) {
        return;
    }
    for (rank, hole) in holes.rows.iter().take(ROWS).enumerate() {
        let label = if rank == 0 { "largest hole by row" } else { "" };
        let row: Vec<String> = hole.row.iter().map(|(name, value)| format!("{name} {value}")).collect();
        let tests = plural(hole.tests, "test");
        table.row(label, &format!("{} in {} with {tests}", short_bracket(&hole.volume), row.join(", ")));
    }
    if holes.rows.len() > ROWS {
        table.row("", &format!("and {}", plural(holes.rows.len() - ROWS, "more row")));
    }
    if holes.only_tested_rows {
        table.row("", "rows without a test were not looked at: there are too many");
    }
}

fn certificate(table: &mut Table, suite: &Audited, number: usize) {
    let Audited { certificate, .. } = suite;
    let largest = certificate.claims.iter().map(|claim| claim.upper).fold(0.0, f64::max);
    let file = certificate_file(number);
    table.row("certificate", &format!("{file} proves that no hole of a row is larger than {}", digits(largest)));
    let short = certificate.claims.iter().filter(|claim| claim.note.is_some()).count();
    if short > 0 {
        table.row("", &format!("in {} it proves less than was measured", plural(short, "row")));
    }
    if let Some(note) = &certificate.note {
        table.row("", note);
    }
}

fn place(sides: &Record<[f64; 2]>, row: &Record<paracosm_space::Value>) -> String {
    let sides = sides.iter().map(|(name, [lo, hi])| format!("{name} {}..{}", digits(*lo), digits(*hi)));
    sides.chain(row.iter().map(|(name, value)| format!("{name} {value}"))).collect::<Vec<_>>().join(", ")
}

fn witness(table: &mut Table, witness: &Witness, number: usize) {
    let Witness { tried, failing, fails_at, requirement, robustness, probability, .. } = witness;
    let which = if witness.is_largest_hole { "the largest hole" } else { "an empty box" };
    table.row("witness", &format!("does not brake within {which}, a box of {}", digits(witness.volume)));
    table.row("  box", &place(&witness.sides, &witness.row));
    table.row("  on in the suite", "in no test, so it gets every verdict of the given driver");
    table.row("  fails in the box", &format!("{failing} of {}", plural(*tried, "test")));
    let values: Vec<String> = fails_at.iter().map(|(name, value)| format!("{name} {}", value_words(value))).collect();
    table.row("  fails with", &format!("{}; {}", values.join(", "), film_file(number)));
    let [with, without] = robustness.map(|number| number.map_or("undecided".to_owned(), digits));
    table.row(&format!("  {requirement}"), &format!("{with}, with the given driver {without}"));
    let Estimate { value, lower, upper } = probability;
    let [value, lower, upper] = [value, lower, upper].map(|share| digits(*share));
    table.row("  probability", &format!("{value} of a test in the box ({lower} to {upper}, 95 %)"));
}

fn share(share: &Share) -> String {
    let Share { counted, killed, mutation_score } = share;
    mutation_score.map_or("no mutant".to_owned(), |Estimate { value, lower, upper }| {
        let [value, lower, upper] = [value, lower, upper].map(percent);
        format!("{value}: {killed} of {counted}, {lower} to {upper} (95 %)")
    })
}

fn score(table: &mut Table, screen: &Screen, score: &Score) {
    table.row("mutation score", &share(&score.all));
    let Screen { tests, defects, noticed, .. } = screen;
    table.row(
        "  mutants",
        &format!("with {noticed} of {defects} defects, which {} notice", plural(*tests, "random test")),
    );
    for (conditions, of) in score.by_conditions.iter().enumerate() {
        let label = if conditions == 0 {
            "  always on".to_owned()
        } else {
            format!("  on if {}", plural(conditions, "condition"))
        };
        table.row(&label, &share(of));
    }
    for kind in &score.by_kind {
        let noticed = match kind.noticed_from {
            Some(size) => format!("; from {} {} on if always on", digits(size), kind.unit),
            None => String::new(),
        };
        table.row(
            &format!("  {}", kind.kind),
            &format!("{} of {}{}", kind.all.killed, kind.all.counted, noticed.trim_end()),
        );
    }
}

fn compared(table: &mut Table, report: &Report) {
    let has_pairs = report.suites.iter().any(|suite| suite.k_wise.is_some());
    let pairs = if has_pairs { ", k-wise coverage" } else { "" };
    table.heading(&format!("compared: largest hole of a row{pairs}, mutation score"));
    for suite in &report.suites {
        let k_wise =
            suite.k_wise.as_ref().map(|Discrete { k, covered, valid, .. }| format!("{k}-wise {covered} of {valid}"));
        let score = suite.mutants.as_ref().map(|score| share(&score.all));
        let columns = [Some(short_bracket(&suite.holes.largest())), k_wise, score];
        table.row(&suite.suite, &columns.into_iter().flatten().collect::<Vec<_>>().join(", "));
    }
}
