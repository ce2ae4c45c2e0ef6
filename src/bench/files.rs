//! The folder of a bench: `bench.json` says what is run, `runs.csv` grows by a row with every run, and the rest is derived
//! from the rows at the end.

use super::{Bench, Benched, Row, figures, latex};
use crate::Error;
use crate::folder::{differing_key, write_whole};
use crate::write_up::{make_folder, maybe, new_folder, write_csv, write_pictures};
use paracosm_generators::Strategy;
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

const BENCH: &str = "bench.json";
const RUNS: &str = "runs.csv";

/// The rows of a bench in its folder, open for appending.
#[derive(Debug)]
pub struct Rows {
    path: PathBuf,
    file: File,
}

impl Rows {
    /// Begins a bench in a folder that is empty or not there; `maps` says against which maps its runs are held.
    ///
    /// # Errors
    /// The folder cannot be written, or has something in it.
    pub fn create(folder: &Path, bench: &Bench, maps: &Value) -> Result<Self, Error> {
        new_folder(folder)?;
        Self::begin(folder, bench, maps)
    }

    fn begin(folder: &Path, bench: &Bench, maps: &Value) -> Result<Self, Error> {
        let mut text = serde_json::to_string_pretty(&description(bench, maps)).expect("a description is always JSON");
        text.push('\n');
        write_whole(&folder.join(BENCH), text.as_bytes())?;
        let mut rows = Self::open(folder)?;
        rows.write(&Row::COLUMNS.map(str::to_owned))?;
        Ok(rows)
    }

    /// Continues this bench in its folder, or begins it if there is nothing yet; the rows that are there.
    ///
    /// # Errors
    /// The folder holds something else, or a row that is broken or none of this bench.
    pub fn resume(folder: &Path, bench: &Bench, maps: &Value) -> Result<(Self, Vec<Row>), Error> {
        make_folder(folder)?;
        let (file, runs) = (folder.join(BENCH), folder.join(RUNS));
        if !file.exists() {
            return Self::create(folder, bench, maps).map(|rows| (rows, Vec::new()));
        }
        let text = fs::read_to_string(&file).map_err(Error::file("read", &file))?;
        let there: Value =
            serde_json::from_str(&text).map_err(|error| Error::content(&file, error.line(), error.to_string()))?;
        if let Some(key) = differing_key(&there, &description(bench, maps)) {
            return Err(Error::Usage(format!("{} holds a different bench: its `{key}` differs", folder.display())));
        }
        let text =
            if runs.exists() { fs::read_to_string(&runs).map_err(Error::file("read", &runs))? } else { String::new() };
        // What a kill leaves behind has no end.
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        if whole == 0 {
            write_whole(&runs, b"")?;
            return Self::begin(folder, bench, maps).map(|rows| (rows, Vec::new()));
        }
        let known = parse(&runs, &text[..whole], bench)?;
        let rows = Self::open(folder)?;
        rows.file.set_len(whole as u64).map_err(Error::file("write", &runs))?;
        Ok((rows, known))
    }

    fn open(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(RUNS);
        let file = File::options().append(true).create(true).open(&path).map_err(Error::file("write", &path))?;
        Ok(Self { path, file })
    }

    /// Appends the next row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append(&mut self, row: &Row) -> Result<(), Error> {
        self.write(&row.fields())
    }

    fn write(&mut self, fields: &[String]) -> Result<(), Error> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        csv.write_record(fields).expect("a row fits into memory");
        let line = csv.into_inner().expect("memory does not fail to flush");
        self.file.write_all(&line).map_err(Error::file("write", &self.path))
    }
}

/// What makes a bench this one.
fn description(bench: &Bench, maps: &Value) -> Value {
    json!({
        "format": 2,
        "version": env!("CARGO_PKG_VERSION"),
        "strategies": bench.strategies.iter().map(|strategy| strategy.name()).collect::<Vec<_>>(),
        "budget": bench.budget,
        "seeds": bench.seeds,
        "first_seed": bench.first_seed,
        "batch": bench.batch,
        "scenarios": bench.targets.iter().map(super::Target::description).collect::<Vec<_>>(),
        "maps": maps,
    })
}

fn parse(path: &Path, text: &str, bench: &Bench) -> Result<Vec<Row>, Error> {
    let mut csv = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    let mut rows = Vec::new();
    let cases = bench.cases();
    for (index, fields) in csv.records().enumerate() {
        let line = index + 1;
        let fields = fields.map_err(|error| Error::content(path, line, error.to_string()))?;
        if index == 0 {
            if fields != Row::COLUMNS[..] {
                return Err(Error::content(path, line, "found another header than this version writes"));
            }
            continue;
        }
        let row = Row::parse(path, line, &fields)?;
        let expected = cases.get(index - 1).map(|case| (bench.targets[case.target].name(), case.strategy, case.seed));
        if expected != Some((row.scenario.as_str(), row.strategy, row.seed)) {
            return Err(Error::content(
                path,
                line,
                "the row is not that of the run in its place; was the file edited?",
            ));
        }
        rows.push(row);
    }
    Ok(rows)
}

impl Benched {
    /// Writes what the rows say to the folder: `summary.csv`, `correlations.csv`, `standings.csv`, `survival.csv`,
    /// `table.tex`, and for each scenario the curves of Kaplan and Meier and recall over dispersion as SVG and PNG.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Error> {
        write_csv(&folder.join("summary.csv"), &self.summary_rows())?;
        write_csv(&folder.join("correlations.csv"), &self.correlation_rows())?;
        write_csv(&folder.join("standings.csv"), &self.standing_rows())?;
        write_csv(&folder.join("survival.csv"), &self.survival_rows())?;
        write_whole(&folder.join("table.tex"), latex::table(self).as_bytes())?;
        write_pictures(folder, &figures::all(self))
    }

    fn summary_rows(&self) -> Vec<Vec<String>> {
        let header = [
            "scenario",
            "strategy",
            "runs",
            "found",
            "exhausted",
            "rate",
            "rate_low",
            "rate_high",
            "mean_found",
            "median",
            "restricted_mean",
            "restricted_low",
            "restricted_high",
            "over_best",
            "baseline",
            "ratio",
            "ratio_low",
            "ratio_high",
            "a12_better",
            "wilcoxon_p",
            "holm_p",
            "log_rank_p",
            "log_rank_holm_p",
            "modes",
            "recall",
            "precision",
            "dispersion",
        ];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for cell in &self.cells {
            let mut row = vec![cell.scenario.clone(), cell.strategy.to_string(), cell.runs.to_string()];
            row.extend([cell.found.to_string(), cell.exhausted.to_string(), cell.rate.to_string()]);
            row.extend(cell.rate_interval.map(|end| end.to_string()));
            row.extend([maybe(cell.mean_found), maybe(cell.median), cell.restricted_mean.to_string()]);
            row.extend(cell.restricted_interval.map(|end| end.to_string()));
            row.extend([maybe(cell.over_best), self.bench.baseline.to_string()]);
            let versus = cell.versus.as_ref().map(|v| [v.ratio, v.interval[0], v.interval[1], v.better, v.p, v.p_holm]);
            row.extend((0..6).map(|i| maybe(versus.map(|numbers| numbers[i]))));
            row.extend(
                [cell.log_rank.map(|log_rank| log_rank.p), cell.log_rank.map(|log_rank| log_rank.p_holm)].map(maybe),
            );
            row.extend([cell.modes, cell.recall, cell.precision, cell.dispersion].map(maybe));
            rows.push(row);
        }
        rows
    }

    fn correlation_rows(&self) -> Vec<Vec<String>> {
        let header = ["scenario", "among", "runs", "spearman", "low", "high"];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for correlation in &self.correlations {
            let [low, high] = correlation.interval;
            let numbers = [correlation.spearman, low, high].map(|number| number.to_string());
            let names = [correlation.scenario.clone(), correlation.among.to_owned(), correlation.runs.to_string()];
            rows.push(names.into_iter().chain(numbers).collect());
        }
        rows
    }

    fn standing_rows(&self) -> Vec<Vec<String>> {
        let header = ["strategy", "worst", "worst_scenario", "geometric_mean"];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for standing in &self.standings {
            let (worst, at) = (standing.worst.to_string(), standing.worst_scenario.clone());
            rows.push(vec![standing.strategy.to_string(), worst, at, standing.geometric_mean.to_string()]);
        }
        rows
    }

    fn survival_rows(&self) -> Vec<Vec<String>> {
        let header = ["scenario", "strategy", "tests", "without_failure"];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for target in &self.bench.targets {
            for &strategy in &self.bench.strategies {
                for (tests, share) in self.survival(target.name(), strategy).steps {
                    rows.push(vec![target.name().into(), strategy.to_string(), tests.to_string(), share.to_string()]);
                }
            }
        }
        rows
    }

    /// The rows of a strategy on a target.
    pub(super) fn rows_of<'a>(&'a self, scenario: &'a str, strategy: Strategy) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.scenario == scenario && row.strategy == strategy)
    }
}
