//! Finds a smallest set of constraints that no test keeps together.
//!
//! A correction set is a set of constraints whose removal ends all conflicts. Every conflict has a member of every
//! correction set. So the search takes a smallest set with a member of each correction set that it knows. If no test
//! keeps this set, it is a smallest conflict. Otherwise all constraints that can be kept with it are added to the set.
//! The remaining constraints are one more correction set (Ignatiev, Previti, Liffiton, Marques-Silva, *Smallest MUS
//! extraction with minimal hitting set dualization*, CP 2015).

use super::classes::{ClassClause, Classes};
use super::clause::Clause;
use super::diagram::Diagram;
use super::encoding::{Encoding, PATIENCE, Undecided};
use thiserror::Error;

/// The greatest numbers of rounds, and of steps of choosing sets, in the search for the smallest conflict.
const ROUNDS: usize = 200;
const STEPS: usize = 100_000;

/// The number of steps that the solver takes before a diagram is tried, and the number of steps that a diagram counts
/// as.
const BRIEF: u64 = 1 << 14;
const DIAGRAM: u64 = 1 << 16;

/// A set of constraints that no test keeps together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no test keeps the constraints {constraints:?} together{}", if *.smallest { "" } else { Self::CAVEAT })]
pub struct Conflict {
    /// The positions of the conflicting constraints in the list of constraints, in ascending order.
    pub constraints: Vec<usize>,
    /// `true` if no other conflict has fewer constraints. If proving this takes too long, it is `false`. Then a smaller
    /// conflict may exist, even within this one.
    pub smallest: bool,
}

/// Constraints, and a search for tests that keep some of them.
struct Subsets<'a> {
    levels: &'a [usize],
    constraints: &'a [Vec<Clause>],
    encoding: Encoding,
    /// The number of steps that the solver may still take.
    steps: u64,
}

impl Subsets<'_> {
    /// Returns classes with which these constraints are kept, or `None` if they cannot be kept together.
    fn solution(&mut self, set: &[usize]) -> Result<Option<Vec<usize>>, Undecided> {
        if set.len() == self.constraints.len() {
            return Ok(None);
        }
        let mut brief = self.steps.min(BRIEF);
        self.steps -= brief;
        let found = self.encoding.solve(&vec![None; self.levels.len()], set, &mut brief);
        self.steps += brief;
        match found {
            Err(Undecided) if self.diagrams_exclude(set) => Ok(None),
            found => found,
        }
    }

    /// Returns `true` if the diagram of a group of parameters shows that no test keeps these constraints.
    fn diagrams_exclude(&mut self, set: &[usize]) -> bool {
        if self.steps < DIAGRAM {
            return false;
        }
        self.steps -= DIAGRAM;
        let classes = Classes::new(self.levels, set.iter().flat_map(|&constraint| &self.constraints[constraint]));
        classes.groups().into_iter().any(|members| {
            let (sizes, clauses) = classes.of(&members);
            Diagram::new(&members, &sizes, &clauses).is_some_and(|diagram| diagram.is_empty())
        })
    }
}

impl Conflict {
    /// The part of a message that says that a conflict is perhaps not the smallest.
    pub(crate) const CAVEAT: &str = " (a smaller set of constraints may be in conflict, too)";

    /// Returns a smallest conflict among constraints that are in conflict, or the smallest that the search found in
    /// time.
    pub(super) fn smallest(levels: &[usize], constraints: &[Vec<Clause>]) -> Self {
        let whole = Classes::new(levels, constraints.iter().flatten());
        let mut encoding = Encoding::new(whole.sizes.iter().map(Vec::len), constraints.len());
        let over_classes: Vec<Vec<ClassClause>> =
            constraints.iter().map(|clauses| whole.over_classes(clauses)).collect();
        for (index, clauses) in over_classes.iter().enumerate() {
            for clause in clauses {
                encoding.demand(clause, Some(index), |parameter| parameter);
            }
        }
        let mut subsets = Subsets { levels, constraints, encoding, steps: PATIENCE };

        let mut to_meet: Vec<Vec<usize>> = Vec::new();
        let mut steps = STEPS;
        for _ in 0..ROUNDS {
            let Some(mut set) = smallest_meeting(&to_meet, &mut steps) else { break };
            let Ok(found) = subsets.solution(&set) else { break };
            let Some(mut solved) = found else {
                set.sort_unstable();
                return Self { constraints: set, smallest: true };
            };
            let mut rest = Vec::new();
            for (constraint, clauses) in over_classes.iter().enumerate() {
                let keeps = |solved: &[usize]| {
                    clauses.iter().all(|clause| clause.literals.iter().any(|l| l.holds[solved[l.parameter]]))
                };
                if set.contains(&constraint) {
                    continue;
                }
                set.push(constraint);
                if !keeps(&solved) {
                    // Every conflict has a member of the rest, even if the set lacks constraints that could be kept.
                    match subsets.solution(&set) {
                        Ok(Some(other)) => solved = other,
                        Ok(None) | Err(Undecided) => rest.extend(set.pop()),
                    }
                }
            }
            to_meet.push(rest);
        }
        subsets.steps = PATIENCE;
        let mut conflict: Vec<usize> = (0..constraints.len()).collect();
        for constraint in 0..constraints.len() {
            let without: Vec<usize> = conflict.iter().copied().filter(|&c| c != constraint).collect();
            if subsets.solution(&without) == Ok(None) {
                conflict = without;
            }
        }
        Self { constraints: conflict, smallest: false }
    }
}

/// Returns a smallest set that has a member of each of the given sets, or `None` if that takes too long.
fn smallest_meeting(sets: &[Vec<usize>], steps: &mut usize) -> Option<Vec<usize>> {
    /// Returns `true` if `chosen` can be completed with at most `more` members, or `None` after too many steps.
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
