//! Requirement by test as a flat table.

use super::Traceability;

impl Traceability {
    /// A row for each requirement, as CSV.
    pub fn csv(&self) -> Vec<u8> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
        let header = "requirement text source severity formula unit tests passed failed undecided not_reached worst \
                      worst_test violated_in";
        write(header.split_whitespace().map(str::to_owned).collect());
        for traced in &self.requirements {
            let worst = traced.worst();
            let indices: Vec<String> = traced.violated_in.iter().map(ToString::to_string).collect();
            write(vec![
                traced.id.clone(),
                traced.text.clone(),
                traced.source.clone().unwrap_or_default(),
                traced.severity.clone().unwrap_or_default(),
                traced.formula.clone(),
                traced.unit.clone(),
                self.tests.to_string(),
                traced.passed.to_string(),
                traced.failed.to_string(),
                traced.undecided.to_string(),
                traced.not_reached.to_string(),
                worst.map(|(worth, _)| worth.to_string()).unwrap_or_default(),
                worst.map(|(_, index)| index.to_string()).unwrap_or_default(),
                indices.join(" "),
            ]);
        }
        csv.into_inner().expect("memory does not fail to flush")
    }
}
