//! Random small constrained models, and what they mean test by test.

use paracosm_space::rules::{Clause, Literal};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// A space of few levels and constraints of one to three clauses.
pub fn models() -> impl Strategy<Value = (Vec<usize>, Vec<Vec<Clause>>)> {
    prop::collection::vec(1..=4usize, 1..=5).prop_flat_map(|levels| {
        let literals: Vec<_> =
            levels.iter().map(|&v| prop::option::of(prop::collection::btree_set(0..v, 0..=v))).collect();
        let clause = literals.prop_map(|literals| {
            let literals = literals.into_iter().enumerate();
            let literal = |(parameter, levels): (usize, Option<BTreeSet<usize>>)| {
                levels.map(|levels| Literal { parameter, levels: levels.into_iter().collect() })
            };
            Clause { literals: literals.filter_map(literal).collect() }
        });
        let constraint = prop::collection::vec(clause, 1..=2);
        (Just(levels), prop::collection::vec(constraint, 0..=5))
    })
}

/// Whether a test keeps a constraint.
pub fn keeps(constraint: &[Clause], test: &[usize]) -> bool {
    constraint.iter().all(|clause| clause.literals.iter().any(|l| l.levels.contains(&test[l.parameter])))
}

/// Every choice of levels.
pub fn all_tests(levels: &[usize]) -> Vec<Vec<usize>> {
    levels.iter().fold(vec![vec![]], |heads: Vec<Vec<usize>>, &v| {
        heads.iter().flat_map(|head| (0..v).map(|level| [head.as_slice(), &[level]].concat())).collect()
    })
}
