//! Explains inconclusive tests: what never came about, and in which part of the space.

use super::{Accuracy, FOLDS, LEAST_TESTS, Question, chosen, left_out, table};
use paracosm_campaign::{Error, Log};
use paracosm_oracles::Verdict;
use paracosm_space::plural;
use serde::Serialize;

/// An explanation of the inconclusive tests of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inconclusive {
    /// The number of inconclusive tests.
    pub tests: usize,
    /// The number of inconclusive tests whose situation never came about. The other ones ended before a requirement was decided.
    pub never_began: usize,
    /// The event that begins the situation, as a formula; `None` if the scenario waits for none or is not known.
    pub premise: Option<String>,
    /// The parts of the space in which a larger share of the tests is inconclusive. There are none if a tree does not find inconclusive tests
    /// outside its own data better than chance by at least two standard errors.
    pub places: Vec<Place>,
}

/// A part of the space with many inconclusive tests.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Place {
    /// The conditions in words, all of which have to hold.
    pub conditions: Vec<String>,
    /// The number of tests in the part.
    pub tests: usize,
    /// The number of inconclusive tests in the part.
    pub inconclusive: usize,
}

impl Inconclusive {
    /// Explains the inconclusive tests of a campaign; `None` if there are none.
    ///
    /// # Errors
    /// A trial does not fit into the study's space.
    pub fn of(log: &Log) -> Result<Option<Self>, Error> {
        let inconclusive = || log.trials().iter().filter(|trial| trial.verdict == Verdict::Inconclusive);
        let tests = inconclusive().count();
        if tests == 0 {
            return Ok(None);
        }
        let has_begun = |trial: &paracosm_campaign::Trial| trial.measured.as_ref().is_none_or(|run| run.triggered);
        let never_began = inconclusive().filter(|trial| !has_begun(trial)).count();
        let declared = log.study().program().ok().and_then(|program| program.declare().ok());
        let premise = declared.and_then(|declared| declared.premise);
        Ok(Some(Self { tests, never_began, premise, places: places(log)? }))
    }

    /// Returns the explanation in words, in lines.
    pub fn in_words(&self) -> Vec<String> {
        let Self { tests, never_began, premise, places } = self;
        let mut lines = Vec::new();
        let event = premise.as_ref().map(|event| format!(": `{event}` never held")).unwrap_or_default();
        if *never_began > 0 {
            lines.push(format!("in {} the situation never came about{event}", plural(*never_began, "test")));
        }
        if tests > never_began {
            lines.push(format!("{} ended before a requirement was decided", plural(tests - never_began, "test")));
        }
        lines.extend(places.iter().map(|Place { conditions, tests, inconclusive }| {
            format!("{inconclusive} of {} where {}", plural(*tests, "test"), conditions.join(" and "))
        }));
        lines
    }
}

/// Returns the parts of the space with many inconclusive tests, as far as a tree finds them better than chance.
fn places(log: &Log) -> Result<Vec<Place>, Error> {
    let (table, names) = table(log, Question::Inconclusive)?;
    let count = table.failed.iter().filter(|is| **is).count();
    let others = table.failed.len() - count;
    if count.min(others) < LEAST_TESTS {
        return Ok(Vec::new());
    }
    let rows: Vec<usize> = (0..table.failed.len()).collect();
    let told = left_out(&table, &rows, FOLDS, |rows| vec![chosen(&table, rows)]);
    if !Accuracy::of(&told[0], &table.failed).is_better_than_chance(count, others) {
        return Ok(Vec::new());
    }
    let tree = chosen(&table, &rows);
    let places = tree.failing().into_iter().map(|(path, leaf)| Place {
        conditions: names.conditions(&path),
        tests: leaf.tests,
        inconclusive: leaf.failures,
    });
    Ok(places.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_campaign::{BlackBox, Learned, Study, Trial};
    use paracosm_engine::{Judgement, Measurements};
    use paracosm_space::{Space, Value, Values};

    /// A log of 100 tests over `x`, of which those from 16 on are inconclusive. The situation of every second of these never came about.
    fn log(from: f64) -> Log {
        let space = "parameter = [{ name = \"x\", interval = [0, 20], unit = \"m\" }]";
        let system = BlackBox::new("none", None).unwrap();
        let study = Study::of_system(system, Space::from_toml(space).unwrap()).build().unwrap();
        let trial = |index: usize| {
            let x = 0.2 * index as f64;
            let test: Values = [("x".to_owned(), Value::Number(x))].into_iter().collect();
            let verdict = if x >= from { Verdict::Inconclusive } else { Verdict::Pass };
            let mut trial = Trial::judged(index, test, verdict, vec![Judgement::new("a", Some(1.0))]);
            trial.measured = Some(Measurements { travelled: 0.0, contact: None, triggered: index.is_multiple_of(2) });
            trial
        };
        Log::new(study, Learned::new(), None, (0..100).map(trial).collect())
    }

    #[test]
    fn inconclusive_tests_are_explained_by_what_never_began_and_by_their_place() {
        let found = Inconclusive::of(&log(16.0)).unwrap().expect("some are inconclusive");
        assert_eq!((found.tests, found.never_began), (20, 10));
        let words = [
            "in 10 tests the situation never came about",
            "10 tests ended before a requirement was decided",
            "20 of 20 tests where x > 15.9 m",
        ];
        assert_eq!(found.in_words(), words);
        assert_eq!(Inconclusive::of(&log(30.0)).unwrap(), None);
    }

    #[test]
    fn no_place_is_named_if_all_tests_are_inconclusive() {
        let found = Inconclusive::of(&log(0.0)).unwrap().expect("all are inconclusive");
        assert_eq!((found.tests, found.places), (100, vec![]));
    }
}
