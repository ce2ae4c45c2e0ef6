//! The trials of a campaign as a table, with the columns of `trials.csv`.

use crate::table::{Column, Table};
use crate::test_table::columns;
use paracosm::campaign::Metric;
use paracosm::space::{Record, Values};
use paracosm::{Log, Trial};
use std::collections::HashSet;

/// Returns a row for each trial.
pub fn table(log: &Log) -> Table {
    let trials = log.trials();
    let tests: Vec<Values> = trials.iter().map(|trial| trial.test.clone()).collect();
    let mut all = vec![("index".to_owned(), Column::Counts(trials.iter().map(|trial| trial.index as i64).collect()))];
    all.extend(columns(log.study().space(), &tests));
    all.push(("verdict".into(), Column::Words(trials.iter().map(|trial| Some(trial.verdict.to_string())).collect())));
    let stated = log.study().requirements().iter().map(|requirement| requirement.id.as_str());
    for id in each_once(stated.chain(trials.iter().flat_map(Trial::requirements))) {
        let robustness = trials.iter().map(|trial| trial.robustness(&id).unwrap_or(f64::NAN));
        all.push((format!("robustness.{id}"), Column::Numbers(robustness.collect())));
    }
    let metrics: Vec<Record<Metric>> = trials.iter().map(|trial| trial.metrics().into_iter().collect()).collect();
    for name in each_once(metrics.iter().flat_map(|metrics| metrics.iter().map(|(name, _)| name))) {
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

/// Returns the names without repetitions, in the order of their first occurrence.
fn each_once<'n>(names: impl Iterator<Item = &'n str>) -> Vec<String> {
    let mut seen = HashSet::new();
    names.filter(|name| seen.insert(*name)).map(str::to_owned).collect()
}
