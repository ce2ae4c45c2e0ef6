//! The trials of a campaign: a table with the columns of `trials.csv`, whose rows are the lines of `trials.jsonl`.

use crate::json::to_dict;
use crate::table::{Column, Table};
use crate::test_table::columns;
use paracosm::campaign::Metric;
use paracosm::report::TrialTable;
use paracosm::space::{Record, Values};
use paracosm::{Log, Trial};
use pyo3::prelude::*;
use pyo3::types::PyList;

/// The trials of a campaign, in the order of their indices.
///
/// `trials["speed"]` is a column of `trials.csv`, and `to_pandas()` and `to_polars()` make data frames of these columns. `trials[3]` and `for trial in trials` give
/// dictionaries with the keys of a line of `trials.jsonl`, such as `trial["test"]["speed"]`.
#[pyclass(frozen, extends = Table, module = "paracosm")]
pub struct Trials {
    lines: Vec<String>,
}

impl Trials {
    /// Makes the table of the trials in a log.
    pub fn new(log: &Log) -> PyClassInitializer<Self> {
        let lines = log.trials().iter().map(Trial::as_line).collect();
        PyClassInitializer::from(table(log)).add_subclass(Self { lines })
    }

    fn trial<'py>(&self, py: Python<'py>, line: &str) -> PyResult<Bound<'py, PyAny>> {
        to_dict(py, &serde_json::from_str::<serde_json::Value>(line).expect("a line of the log is JSON"))
    }
}

#[pymethods]
impl Trials {
    fn __getitem__<'py>(slf: &Bound<'py, Self>, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let lines = &slf.get().lines;
        let index =
            key.extract::<isize>().ok().map(|index| if index < 0 { index + lines.len() as isize } else { index });
        match index.and_then(|index| lines.get(usize::try_from(index).ok()?)) {
            Some(line) => slf.get().trial(slf.py(), line),
            // A name, or an index without a trial.
            None => slf.as_super().get().item(slf.py(), key),
        }
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let trials = self.lines.iter().map(|line| self.trial(py, line)).collect::<PyResult<Vec<_>>>()?;
        Ok(PyList::new(py, trials)?.try_iter()?.into_any())
    }
}

/// Returns a row for each trial.
fn table(log: &Log) -> Table {
    let (names, trials) = (TrialTable(log), log.trials());
    let tests: Vec<Values> = trials.iter().map(|trial| trial.test.clone()).collect();
    let mut all = vec![("index".to_owned(), Column::Counts(trials.iter().map(|trial| trial.index as i64).collect()))];
    all.extend(columns(log.study().space(), &tests));
    all.push(("verdict".into(), Column::Words(trials.iter().map(|trial| Some(trial.verdict.to_string())).collect())));
    for id in names.requirements() {
        let robustness = trials.iter().map(|trial| trial.robustness(&id).unwrap_or(f64::NAN));
        all.push((format!("robustness.{id}"), Column::Numbers(robustness.collect())));
    }
    let metrics: Vec<Record<Metric>> = trials.iter().map(|trial| trial.metrics().into_iter().collect()).collect();
    for name in names.metrics() {
        let found: Vec<Option<&Metric>> = metrics.iter().map(|metrics| metrics.get(&name)).collect();
        all.push((format!("metric.{name}"), column(&found)));
    }
    all.push(("ticks".into(), Column::Counts(trials.iter().map(|trial| trial.ticks as i64).collect())));
    all.push(("trace_hash".into(), Column::Words(trials.iter().map(|trial| trial.trace_hash.clone()).collect())));
    all.push(("error".into(), Column::Words(trials.iter().map(|trial| trial.error().map(str::to_owned)).collect())));
    Table::new(all, trials.len())
}

fn column(metrics: &[Option<&Metric>]) -> Column {
    let number = |metric: &Option<&Metric>| match metric {
        Some(Metric::Number(number)) => Some(*number),
        None => Some(f64::NAN),
        Some(_) => None,
    };
    match metrics.iter().map(number).collect::<Option<Vec<f64>>>() {
        Some(numbers) => Column::Numbers(numbers),
        None => Column::Words(
            metrics.iter().map(|metric| metric.map(ToString::to_string).filter(|w| !w.is_empty())).collect(),
        ),
    }
}
