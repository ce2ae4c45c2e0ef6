//! Requirement by test as a flat table.

use super::Traceability;

impl Traceability {
    /// The matrix as CSV: a row for each requirement, with what is known of it in all and then a column for each test,
    /// `test.INDEX`, that says what became of it there: `passed`, `failed`, `undecided`, `not reached` or `not judged`.
    pub fn csv(&self) -> Vec<u8> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
        let header = "requirement text source severity formula unit tests passed failed undecided not_reached worst \
                      worst_test violated_in";
        let tests = self.indices.iter().map(|index| format!("test.{index}"));
        write(header.split_whitespace().map(str::to_owned).chain(tests).collect());
        for traced in &self.requirements {
            let worst = traced.worst();
            let indices: Vec<String> = traced.violated_in.iter().map(ToString::to_string).collect();
            let mut row = vec![
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
            ];
            row.extend(traced.by_test.iter().map(ToString::to_string));
            write(row);
        }
        csv.into_inner().expect("memory does not fail to flush")
    }
}
