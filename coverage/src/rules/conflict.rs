//! Which constraints cannot hold together.
//!
//! A conflict of the smallest size meets every set of constraints whose removal ends all conflicts. So the
//! smallest set that meets those known so far is taken; either it is a conflict, then no conflict is smaller, or
//! it can be kept, and what remains after adding all constraints that can be kept with it is one more set to
//! meet (Ignatiev, Previti, Liffiton, Marques-Silva, *Smallest MUS extraction with minimal hitting set
//! dualization*, CP 2015).

use super::clause::Clause;
use super::encoding::Encoding;
use super::group::{ClassClause, Model};
use thiserror::Error;

/// How many rounds and how many steps of choosing are taken for the smallest conflict; after them the conflict is
/// one of which no constraint can be spared, though there may be another with fewer.
const ROUNDS: usize = 200;
const STEPS: usize = 100_000;

/// Constraints that no test keeps together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no test keeps the constraints {constraints:?} together")]
pub struct Conflict {
    /// The constraints' positions, in ascending order. Any of them can be kept without one of the others.
    pub constraints: Vec<usize>,
}

impl Conflict {
    /// A smallest conflict among constraints that have one.
    pub(super) fn smallest(levels: &[usize], constraints: &[Vec<Clause>]) -> Self {
        let whole = Model::new(levels, constraints.iter().flatten());
        let mut encoding = Encoding::new(whole.sizes.iter().map(Vec::len), constraints.len());
        let constraints: Vec<Vec<ClassClause>> =
            constraints.iter().map(|clauses| whole.over_classes(clauses)).collect();
        for (index, clauses) in constraints.iter().enumerate() {
            for clause in clauses {
                encoding.demand(clause, Some(index), |parameter| parameter);
            }
        }
        let nothing = vec![None; levels.len()];
        let mut solution = |set: &[usize]| encoding.solve(&nothing, set);

        let mut to_meet: Vec<Vec<usize>> = Vec::new();
        let mut steps = STEPS;
        for _ in 0..ROUNDS {
            let Some(mut set) = smallest_meeting(&to_meet, &mut steps) else { break };
            let Some(mut solved) = solution(&set) else {
                set.sort_unstable();
                return Self { constraints: set };
            };
            let mut rest = Vec::new();
            for (constraint, clauses) in constraints.iter().enumerate() {
                let keeps = |solved: &[usize]| {
                    clauses.iter().all(|clause| clause.literals.iter().any(|l| l.holds[solved[l.parameter]]))
                };
                if set.contains(&constraint) {
                    continue;
                }
                set.push(constraint);
                if !keeps(&solved) {
                    match solution(&set) {
                        Some(other) => solved = other,
                        None => rest.extend(set.pop()),
                    }
                }
            }
            to_meet.push(rest);
        }
        let mut conflict: Vec<usize> = (0..constraints.len()).collect();
        for constraint in 0..constraints.len() {
            let without: Vec<usize> = conflict.iter().copied().filter(|&c| c != constraint).collect();
            if solution(&without).is_none() {
                conflict = without;
            }
        }
        Self { constraints: conflict }
    }
}

/// A smallest set that has a member of each of the given sets; none if that takes too long.
fn smallest_meeting(sets: &[Vec<usize>], steps: &mut usize) -> Option<Vec<usize>> {
    /// Whether `chosen` can be completed with at most `more` members; none after too many steps.
    fn complete(sets: &[Vec<usize>], chosen: &mut Vec<usize>, more: usize, steps: &mut usize) -> Option<bool> {
        *steps = steps.checked_sub(1)?;
        let unmet = sets.iter().filter(|set| !set.iter().any(|member| chosen.contains(member)));
        let Some(set) = unmet.min_by_key(|set| set.len()) else { return Some(true) };
        if more == 0 {
            return Some(false);
        }
        for &member in set {
            chosen.push(member);
            if complete(sets, chosen, more - 1, steps)? {
                return Some(true);
            }
            chosen.pop();
        }
        Some(false)
    }
    for size in 0..=sets.len() {
        let mut chosen = Vec::new();
        if complete(sets, &mut chosen, size, steps)? {
            return Some(chosen);
        }
    }
    unreachable!("a member of each set meets all")
}
