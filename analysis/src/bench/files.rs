//! Reads and writes the folder of a bench: `bench.json` describes the bench, `runs.csv` gains a row with every run,
//! and all other files are derived from the rows at the end.

use super::row::RowFlaw;
use super::{Bench, BenchFlaw, Row};
use crate::asked::{make_folder, new_folder};
use paracosm_campaign::files::{read_text, write_whole};
use paracosm_campaign::{Error, differing_key};
use paracosm_generators::PointSets;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_128;

const BENCH: &str = "bench.json";
const RUNS: &str = "runs.csv";

/// The file `runs.csv` of a bench, open for appending a row for each run.
#[derive(Debug)]
pub struct Rows {
    path: PathBuf,
    file: File,
}

impl Rows {
    /// Makes the files of a new bench, in a folder that is empty or does not exist. `maps` describes the reference maps
    /// that the runs are compared with.
    ///
    /// # Errors
    /// The folder cannot be written, or is not empty.
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

    /// Opens the files of a bench in order to continue the bench, or makes the files if the folder has no `bench.json`.
    /// Returns also the rows that the folder already has.
    ///
    /// # Errors
    /// The folder holds a different bench; or it is not empty, but has no `bench.json`; or a row is broken or does
    /// not belong to this bench.
    pub fn resume(folder: &Path, bench: &Bench, maps: &Value) -> Result<(Self, Vec<Row>), Error> {
        make_folder(folder)?;
        let (file, runs) = (folder.join(BENCH), folder.join(RUNS));
        if !file.exists() {
            return Self::create(folder, bench, maps).map(|rows| (rows, Vec::new()));
        }
        let text = read_text(&file)?;
        let there: Value = serde_json::from_str(&text).map_err(|error| Error::in_file(&file, error.line(), error))?;
        if let Some(key) = differing_key(&there, &description(bench, maps)) {
            return Err(BenchFlaw::Other { folder: folder.to_owned(), key: key.to_owned() }.into());
        }
        let text = if runs.exists() { read_text(&runs)? } else { String::new() };
        // A program that was killed can leave a last line without a line end. Such a line does not count.
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        if whole == 0 {
            write_whole(&runs, b"")?;
            return Self::begin(folder, bench, maps).map(|rows| (rows, Vec::new()));
        }
        let known = parse(&runs, &text[..whole], bench)?;
        let rows = Self::open(folder)?;
        rows.file.set_len(whole as u64).map_err(Error::io("write", &runs))?;
        Ok((rows, known))
    }

    fn open(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(RUNS);
        let file = File::options().append(true).create(true).open(&path).map_err(Error::io("write", &path))?;
        Ok(Self { path, file })
    }

    /// Appends the row of the next run to `runs.csv`.
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
        self.file.write_all(&line).map_err(Error::io("write", &self.path))
    }
}

/// Returns the content of `bench.json`, which distinguishes the bench from other benches.
fn description(bench: &Bench, maps: &Value) -> Value {
    let given = bench.strategies.iter().filter_map(|strategy| Some((strategy.name(), hash_of(strategy.given()?))));
    let given: BTreeMap<&str, String> = given.collect();
    let mut description = json!({
        "format": 3,
        "version": env!("CARGO_PKG_VERSION"),
        "strategies": bench.strategies.iter().map(|strategy| strategy.name()).collect::<Vec<_>>(),
        "budget": bench.budget,
        "seeds": bench.seeds,
        "first_seed": bench.first_seed,
        "batch": bench.batch,
        "scenarios": bench.targets.iter().map(super::Target::description).collect::<Vec<_>>(),
        "maps": maps,
    });
    // A bench with other points is another bench.
    if !given.is_empty() {
        description["points"] = json!(given);
    }
    description
}

/// Returns a hash of given points.
fn hash_of(sets: &PointSets) -> String {
    let mut bytes = Vec::new();
    for (dims, points) in sets.sizes() {
        bytes.extend([dims, points, sets.count(dims, points)].into_iter().flat_map(|size| (size as u64).to_le_bytes()));
        for set in (1..).map_while(|number| sets.set(dims, points, number)) {
            bytes.extend(set.iter().flat_map(|point| &point.continuous).flat_map(|number| number.to_le_bytes()));
        }
    }
    format!("{:032x}", xxh3_128(&bytes))
}

fn parse(path: &Path, text: &str, bench: &Bench) -> Result<Vec<Row>, Error> {
    let mut csv = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    let mut rows = Vec::new();
    let cases = bench.cases();
    for (index, fields) in csv.records().enumerate() {
        let line = index + 1;
        let fields = fields.map_err(|error| Error::in_csv(path, error))?;
        if index == 0 {
            if fields != Row::COLUMNS[..] {
                return Err(Error::in_file(path, line, RowFlaw::Header));
            }
            continue;
        }
        let row = Row::parse(path, line, &fields)?;
        let expected = cases.get(index - 1).map(|case| (bench.targets[case.target].name(), case.strategy, case.seed));
        if expected != Some((row.scenario.as_str(), row.strategy, row.seed)) {
            return Err(Error::in_file(path, line, RowFlaw::Foreign));
        }
        rows.push(row);
    }
    Ok(rows)
}
