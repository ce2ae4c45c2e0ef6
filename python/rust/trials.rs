//! The trials of a campaign as a table, with the columns of `trials.csv`.

use crate::table::{Column, Table};
use crate::test_table::columns;
use paracosm::Log;
use paracosm::campaign::Metric;
use paracosm::report::TrialTable;
use paracosm::space::{Record, Values};

/// Returns a row for each trial.
pub fn table(log: &Log) -> Table {
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
