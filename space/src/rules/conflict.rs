//! Which constraints cannot hold together.
//!
//! A conflict of the smallest size meets every set of constraints whose removal ends all conflicts. So the
//! smallest set that meets those known so far is taken; either it is a conflict, then no conflict is smaller, or
//! it can be kept, and what remains after adding all constraints that can be kept with it is one more set to
//! meet (Ignatiev, Previti, Liffiton, Marques-Silva, *Smallest MUS extraction with minimal hitting set
//! dualization*, CP 2015).

use super::classes::{ClassClause, Classes};
use super::clause::Clause;
use super::diagram::Diagram;
use super::encoding::{Encoding, PATIENCE, Undecided};
use thiserror::Error;

/// How many rounds and how many steps of choosing are taken for the smallest conflict.
const ROUNDS: usize = 200;
const STEPS: usize = 100_000;

/// How many steps the solver takes before diagrams have a try, and for how many of its steps these count.
const BRIEF: u64 = 1 << 14;
const DIAGRAM: u64 = 1 << 16;

/// Constraints that no test keeps together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no test keeps the constraints {constraints:?} together{}", if *.smallest { "" } else { Self::CAVEAT })]
pub struct Conflict {
    /// The constraints' positions, in ascending order.
    pub constraints: Vec<usize>,
    /// Whether no conflict has fewer constraints. Where finding that out takes too long there may be one, even
    /// among these.
    pub smallest: bool,
}

/// Constraints and what is known of which can be kept together.
struct Subsets<'a> {
    levels: &'a [usize],
    constraints: &'a [Vec<Clause>],
    encoding: Encoding,
    /// The steps that the solver may still take.
    steps: u64,
}

impl Subsets<'_> {
    /// Classes with which these constraints are kept, if there are any and the solver found them.
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

    /// Whether the diagram of a group of parameters shows that these constraints cannot be kept.
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
    /// What is said of a conflict that is perhaps not the smallest.
    pub(crate) const CAVEAT: &str = " (a conflicting set, perhaps not the smallest)";

    /// A smallest conflict among constraints that have one, or one that is as small as could be found.
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
                    // A conflict meets the rest of any set that can be kept, if not all was found that can.
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
