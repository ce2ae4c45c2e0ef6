//! Writes a flat table of requirements by tests.

use crate::write_up::as_text;
use paracosm_analysis::Traceability;

/// Returns the traceability matrix of requirements and tests as CSV. Each row is a requirement. The first columns hold
/// the description of the requirement and its results over all tests. Then each test has a column `test.INDEX`:
/// `passed`, `failed`, `undecided`, `not reached` or `not judged`.
pub fn csv(traceability: &Traceability) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |row: Vec<String>| csv.write_record(row).expect("rows of one length fit into memory");
    let header = "requirement text source severity formula unit tests passed failed undecided not_reached worst \
                  worst_test violated_in";
    let tests = traceability.indices.iter().map(|index| format!("test.{index}"));
    write(header.split_whitespace().map(str::to_owned).chain(tests).collect());
    for traced in &traceability.requirements {
        let worst = traced.worst();
        let indices: Vec<String> = traced.violated_in.iter().map(ToString::to_string).collect();
        let mut row = vec![
            as_text(&traced.id),
            as_text(&traced.text),
            as_text(traced.source.as_deref().unwrap_or_default()),
            as_text(traced.severity.as_deref().unwrap_or_default()),
            as_text(&traced.formula),
            as_text(&traced.unit),
            traceability.tests.to_string(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_campaign::{BlackBox, Learned, Log, Problem, ProblemKind, Study, Trial};
    use paracosm_engine::{Judgement, Measurements};
    use paracosm_oracles::Verdict;
    use paracosm_space::{Space, Value, Values};

    fn study() -> Study {
        let space =
            "parameter = [{ name = \"x\", interval = [0, 20], unit = \"m\" }, { name = \"lanes\", choice = [2, 4] }]";
        let system = BlackBox::new("none", None).unwrap();
        Study::of_system(system, Space::from_toml(space).unwrap()).build().unwrap()
    }

    /// Makes a trial on two lanes at `x`, with the given verdict and the robustness of the requirements `a` and `b`.
    /// `triggered` is `true` if the premise occurred.
    fn trial(index: usize, x: f64, verdict: Verdict, [a, b]: [Option<f64>; 2], triggered: Option<bool>) -> Trial {
        let test: Values = [("x".to_owned(), Value::Number(x)), ("lanes".to_owned(), 2.into())].into_iter().collect();
        let judgements = vec![Judgement::new("a", a), Judgement::new("b", b)];
        let mut trial = Trial::judged(index, test, verdict, judgements);
        trial.measured = triggered.map(|triggered| Measurements { travelled: 0.0, contact: None, triggered });
        trial
    }

    #[test]
    fn the_matrix_says_of_every_test_what_became_of_every_requirement() {
        let trials = [
            trial(0, 1.0, Verdict::Pass, [Some(1.0), Some(2.0)], Some(true)),
            trial(1, 3.0, Verdict::Fail, [Some(-1.0), None], Some(true)),
            trial(2, 5.0, Verdict::Inconclusive, [Some(0.5), Some(0.2)], Some(false)),
            Trial::broken(7, Values::default(), Problem::new(ProblemKind::System, "it broke")),
        ];
        let log = Log::new(study(), Learned::new(), None, trials.to_vec());
        let table = csv(&Traceability::of(&log).unwrap());
        let mut rows = ::csv::Reader::from_reader(&table[..]);
        let tests = ["test.0", "test.1", "test.2", "test.7"];
        assert_eq!(rows.headers().unwrap().iter().skip(14).collect::<Vec<_>>(), tests);
        let rows: Vec<Vec<String>> =
            rows.records().map(|row| row.unwrap().iter().skip(14).map(str::to_owned).collect()).collect();
        assert_eq!(rows[0], ["passed", "failed", "not reached", "not judged"]);
        assert_eq!(rows[1], ["passed", "undecided", "not reached", "not judged"]);
    }
}
