//! Writes the failing tests, and whose fault each failure is, as a flat table.

use paracosm_analysis::blame::{Blame, Rerun};
use paracosm_campaign::{Artefact, Error, Study};

/// The table `blame.csv` of the failing tests of a study, with the blame for each failure.
#[derive(Debug, Clone, Copy)]
pub struct BlameTable<'b> {
    /// The failing tests, with the results of the reference drivers.
    pub blame: &'b Blame,
    /// The study to which the failing tests belong.
    pub study: &'b Study,
}

impl Artefact for BlameTable<'_> {
    fn files(&self) -> Vec<&'static str> {
        vec!["blame.csv"]
    }

    fn contents(&self, _: &str) -> Result<Vec<u8>, Error> {
        Ok(csv(self.blame, self.study))
    }
}

/// Returns the failing tests of a study as CSV. The columns are the index, the parameters, the violated requirements,
/// whose fault the failure is, and for each reference driver the verdict and the robustness of every requirement that
/// the study states.
fn csv(blame: &Blame, study: &Study) -> Vec<u8> {
    let ids: Vec<&str> = study.requirements().iter().map(|requirement| requirement.id.as_str()).collect();
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
    let mut header = vec!["index".to_owned()];
    header.extend(study.space().coordinates().map(|coordinate| coordinate.name()));
    header.extend(["violates", "fault", "prevented_by"].map(str::to_owned));
    for name in &blame.references {
        header.push(format!("verdict.{name}"));
        header.extend(ids.iter().map(|id| format!("robustness.{id}.{name}")));
    }
    write(header);
    for failure in &blame.failures {
        let mut row = vec![failure.index.to_string()];
        row.extend(failure.test.iter().flat_map(|(_, value)| value.scalars()).map(ToString::to_string));
        row.extend([failure.violates.join(" "), failure.fault.to_string(), failure.prevented_by.join(" ")]);
        for (_, run) in failure.runs.iter() {
            row.push(run.verdict.to_string());
            row.extend(ids.iter().map(|id| worth(run, id)));
        }
        write(row);
    }
    csv.into_inner().expect("memory does not fail to flush")
}

fn worth(run: &Rerun, id: &str) -> String {
    run.robustness(id).map_or(String::new(), |value| value.to_string())
}
