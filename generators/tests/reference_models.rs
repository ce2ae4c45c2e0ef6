//! Covering arrays of published models: sizes at most as published, every array checked by plain search.
//!
//! The constrained models are read from `../shared/reference/covering_models.json` beside the repository, or from
//! the folder `$PARACOSM_REFERENCE`; where there is no such file they are skipped, and the tests say so.

use paracosm_coverage::Deadline;
use paracosm_generators::covering::{CoveringRequest, covering_array, optimise};
use paracosm_space::rules::{Clause, Literal, Rules};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A literal: a parameter is at a level, or is not.
type Plain = (usize, usize, bool);

struct Model {
    levels: Vec<usize>,
    clauses: Vec<Vec<Plain>>,
}

/// A model by its name; none where the file with it is absent.
fn model(name: &str) -> Option<Model> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let reference = std::env::var_os("PARACOSM_REFERENCE").map(PathBuf::from);
    let folders = [root.join("tests/data"), reference.unwrap_or_else(|| root.join("../shared/reference"))];
    let texts = folders.iter().filter_map(|f| std::fs::read_to_string(f.join("covering_models.json")).ok());
    let mut models = texts.map(|text| serde_json::from_str::<Value>(&text).unwrap());
    let found = models.find_map(|models| models["models"].get(name).cloned());
    let Some(found) = found else {
        eprintln!("skipped: the model {name} is not in this checkout");
        return None;
    };
    let levels: Vec<usize> = serde_json::from_value(found["levels"].clone()).unwrap();
    let clauses: Vec<Vec<(usize, usize, u8)>> = serde_json::from_value(found["constraints"].clone()).unwrap();
    let plain = |clause: Vec<(usize, usize, u8)>| clause.into_iter().map(|(p, l, sign)| (p, l, sign == 1)).collect();
    Some(Model { levels, clauses: clauses.into_iter().map(plain).collect() })
}

impl Model {
    fn rules(&self) -> Rules {
        let literal = |&(parameter, level, is): &Plain| Literal {
            parameter,
            levels: (0..self.levels[parameter]).filter(|&other| (other == level) == is).collect(),
        };
        let constraint = |clause: &Vec<Plain>| vec![Clause { literals: clause.iter().map(literal).collect() }];
        Rules::new(&self.levels, &self.clauses.iter().map(constraint).collect::<Vec<_>>()).unwrap()
    }

    /// Whether the levels fixed so far can be completed: the clause with the fewest ways to keep it is kept by one
    /// of them.
    fn can_hold(&self, fixed: &mut [Option<usize>]) -> bool {
        let keeps = |&(p, level, is): &Plain, fixed: &[Option<usize>]| fixed[p].is_some_and(|l| (l == level) == is);
        let open = self.clauses.iter().filter(|clause| !clause.iter().any(|l| keeps(l, fixed)));
        let ways = |clause: &&Vec<Plain>| {
            let free = clause.iter().filter(|literal| fixed[literal.0].is_none());
            free.map(|&(p, _, is)| if is { 1 } else { self.levels[p] - 1 }).sum::<usize>()
        };
        let Some(clause) = open.min_by_key(ways) else { return true };
        for &(parameter, level, is) in clause {
            if fixed[parameter].is_some() {
                continue;
            }
            for chosen in (0..self.levels[parameter]).filter(|&chosen| (chosen == level) == is) {
                fixed[parameter] = Some(chosen);
                if self.can_hold(fixed) {
                    fixed[parameter] = None;
                    return true;
                }
            }
            fixed[parameter] = None;
        }
        false
    }

    /// Asserts that every test keeps the clauses, and that a combination which no test has cannot be had.
    fn check(&self, tests: &[Vec<usize>], k: usize) {
        for test in tests {
            let kept = |clause: &Vec<Plain>| clause.iter().any(|&(p, level, is)| (test[p] == level) == is);
            assert!(self.clauses.iter().all(kept), "{test:?} violates a constraint");
        }
        self.check_sets(tests, k, &mut Vec::new());
    }

    fn check_sets(&self, tests: &[Vec<usize>], k: usize, set: &mut Vec<usize>) {
        if set.len() < k {
            for parameter in set.last().map_or(0, |last| last + 1)..self.levels.len() {
                set.push(parameter);
                self.check_sets(tests, k, set);
                set.pop();
            }
            return;
        }
        let mut had = vec![false; set.iter().map(|&p| self.levels[p]).product()];
        tests.iter().for_each(|test| had[set.iter().fold(0, |index, &p| index * self.levels[p] + test[p])] = true);
        for index in (0..had.len()).filter(|&index| !had[index]) {
            let mut fixed = vec![None; self.levels.len()];
            let mut rest = index;
            for &parameter in set.iter().rev() {
                fixed[parameter] = Some(rest % self.levels[parameter]);
                rest /= self.levels[parameter];
            }
            assert!(!self.can_hold(&mut fixed), "{set:?} lacks {fixed:?}");
        }
    }
}

fn at_most(name: &str, k: usize, size: usize) {
    let Some(model) = model(name) else { return };
    let rules = model.rules();
    let array = covering_array(&CoveringRequest::new(&rules, k)).unwrap();
    model.check(&array.rows, k);
    assert!(array.rows.len() <= size, "{name} at {k}: {} rows", array.rows.len());
}

#[test]
fn free_models_are_covered_with_no_more_rows_than_published() {
    for (k, size) in [(2, 100), (3, 400), (4, 1361), (5, 4220)] {
        at_most("tcas_free", k, size);
    }
    at_most("UNIFORM_ALL_18", 3, 3053);
    at_most("2^100", 3, 48);
    at_most("3^4", 2, 9);
    at_most("10^20", 2, 183);
}

#[test]
fn uniform_models_of_many_combinations_are_covered_with_no_more_rows_than_published() {
    at_most("UNIFORM_ALL_18", 4, 42_439);
}

#[test]
fn constrained_models_are_covered_with_no_more_rows_than_published() {
    for (name, k, size) in [
        ("spinv", 2, 45),
        ("gcc", 2, 23),
        ("apache", 2, 33),
        ("spins", 3, 98),
        ("spinv", 3, 286),
        ("bugzilla", 3, 68),
        ("spins", 4, 393),
    ] {
        at_most(name, k, size);
    }
}

#[test]
fn models_of_many_parameters_are_covered_with_no_more_rows_than_published() {
    at_most("apache", 3, 173);
    at_most("gcc", 3, 108);
}

#[test]
fn optimised_models_stay_covered() {
    for (name, k) in [("spinv", 2), ("spins", 3), ("3^13", 3), ("4^10", 3)] {
        let Some(model) = model(name) else { continue };
        let rules = model.rules();
        let request = CoveringRequest::new(&rules, k);
        let array = covering_array(&request).unwrap();
        let before = array.rows.len();
        let smaller = optimise(&request, array, Deadline::after(Duration::from_millis(300)), &|_| ());
        model.check(&smaller.rows, k);
        assert!(smaller.rows.len() <= before);
    }
}
