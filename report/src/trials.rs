//! Writes the trials of a campaign as one flat table.

use crate::write_up::as_text;
use paracosm_campaign::{Artefact, Error, Log, Metric, Trial};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::hash::Hash;

/// The table `trials.csv` of the trials of a campaign. Its columns are index, parameters, verdict, robustness, metrics,
/// ticks, hash of the trace, and error.
#[derive(Debug, Clone, Copy)]
pub struct TrialTable<'l>(pub &'l Log);

impl TrialTable<'_> {
    /// Returns the ids of the requirements, each with a column of robustness, in the order of the columns.
    pub fn requirements(&self) -> Vec<String> {
        let (study, trials) = (self.0.study(), self.0.trials());
        let stated = study.requirements().iter().map(|requirement| requirement.id.as_str());
        each_once(stated.chain(trials.iter().flat_map(Trial::requirements))).into_iter().map(str::to_owned).collect()
    }

    /// Returns the names of the metrics, each with a column, in the order of the columns.
    pub fn metrics(&self) -> Vec<String> {
        // The metrics of all trials at once would take more memory than the trials.
        each_once(self.0.trials().iter().flat_map(Trial::metrics).map(|(name, _)| name))
    }
}

impl Artefact for TrialTable<'_> {
    fn files(&self) -> Vec<&'static str> {
        vec!["trials.csv"]
    }

    fn contents(&self, _: &str) -> Result<Vec<u8>, Error> {
        Ok(csv(self))
    }
}

fn csv(table: &TrialTable) -> Vec<u8> {
    let (study, trials) = (table.0.study(), table.0.trials());
    let (ids, metrics) = (table.requirements(), table.metrics());
    let parameters = study.space().coordinates().map(|coordinate| coordinate.name());
    let requirements = ids.iter().map(|id| format!("robustness.{id}"));
    let header = ["index".to_owned()].into_iter().chain(parameters).chain(["verdict".to_owned()]);
    let header = header.chain(requirements).chain(metrics.iter().map(|name| as_text(&format!("metric.{name}"))));
    let header = header.chain(["ticks", "trace_hash", "error"].map(str::to_owned));
    let row = |trial: &Trial| {
        let measured: BTreeMap<String, Metric> = trial.metrics().into_iter().collect();
        let mut row = vec![trial.index.to_string()];
        row.extend(trial.test.iter().flat_map(|(_, value)| value.scalars()).map(ToString::to_string));
        row.push(trial.verdict.to_string());
        row.extend(ids.iter().map(|id| trial.robustness(id).map_or(String::new(), |value| value.to_string())));
        row.extend(
            metrics.iter().map(|name| measured.get(name).map_or(String::new(), |metric| as_text(&metric.to_string()))),
        );
        row.push(trial.ticks.to_string());
        row.push(trial.trace_hash.clone().unwrap_or_default());
        row.push(as_text(trial.error().unwrap_or_default()));
        row
    };
    let parts = trials.par_chunks(TOGETHER).map(|trials| written(trials.iter().map(row)));
    let parts: Vec<Vec<u8>> = parts.collect();
    [written([header.collect()]), parts.concat()].concat()
}

/// The number of rows that a thread writes together.
const TOGETHER: usize = 4096;

/// Writes rows of one length.
fn written(rows: impl IntoIterator<Item = Vec<String>>) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.into_iter().for_each(|row| csv.write_record(row).expect("rows of one length fit into memory"));
    csv.into_inner().expect("memory does not fail to flush")
}

/// Returns the names without repetitions, in the order of their first occurrence.
fn each_once<N: Clone + Eq + Hash>(names: impl Iterator<Item = N>) -> Vec<N> {
    let mut seen = HashSet::new();
    names.filter(|name| seen.insert(name.clone())).collect()
}
