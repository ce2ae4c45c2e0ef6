//! Converts a condition into clauses.
//!
//! Disjunctions are distributed over conjunctions, which gives few clauses for most constraints that people write. For
//! others, such as a list of the allowed combinations, this gives too many clauses. Then the clauses are the paths of
//! a decision tree that end where the condition fails: one parameter after the other gets its level, and levels that
//! leave the same condition share a branch (Shannon's expansion). No auxiliary parameters are introduced. So some
//! conditions would need too many clauses; they are refused.

use super::ConstraintFlaw;
use super::condition::Condition;
use crate::rules::{Clause, Literal};

/// The greatest number of clauses from distribution. With more, the decision tree is used.
const MOST_DISTRIBUTED: usize = 64;

/// The greatest number of clauses that are compared with each other. The time grows as the square of this number.
const MOST_COMPARED: usize = 256;

/// The greatest number of clauses of a constraint.
const MOST_CLAUSES: usize = 1 << 14;

/// The greatest number of levels in all literals of a constraint together.
const MOST_LEVELS: usize = 1 << 22;

/// The greatest number of branches of a decision tree.
const MOST_BRANCHES: usize = 1 << 17;

/// Returns the clauses of a condition over parameters with these numbers of levels.
pub(super) fn clauses(condition: &Condition, sizes: &[usize]) -> Result<Vec<Clause>, ConstraintFlaw> {
    let parts = match condition {
        Condition::Many { all: true, parts } => parts.as_slice(),
        part => std::slice::from_ref(part),
    };
    let mut clauses = Vec::new();
    for part in parts {
        let found = distribute(part, sizes).or_else(|| tree(part, sizes)).filter(|found| {
            clauses.len() + found.len() <= MOST_CLAUSES && levels(&clauses) + levels(found) <= MOST_LEVELS
        });
        clauses.extend(found.ok_or(ConstraintFlaw::TooManyClauses)?);
    }
    Ok(if clauses.len() <= MOST_COMPARED { irredundant(clauses) } else { clauses })
}

fn levels(clauses: &[Clause]) -> usize {
    clauses.iter().flat_map(|clause| &clause.literals).map(|literal| literal.levels.len()).sum()
}

/// Makes the literal that holds at the marked levels.
fn literal(parameter: usize, marked: impl Iterator<Item = bool>) -> Literal {
    Literal { parameter, levels: marked.enumerate().filter_map(|(level, marked)| marked.then_some(level)).collect() }
}

/// Returns the clauses of a condition by distribution, or `None` if there are too many clauses.
fn distribute(condition: &Condition, sizes: &[usize]) -> Option<Vec<Clause>> {
    match condition {
        Condition::Among { parameter, levels } => {
            Some(vec![Clause { literals: vec![literal(*parameter, levels.iter().copied())] }])
        }
        // The tree of a relation has two layers, and one branch for each set of partners.
        Condition::Pair { .. } => tree(condition, sizes).filter(|clauses| clauses.len() <= MOST_DISTRIBUTED),
        Condition::Many { all: true, parts } => {
            let mut clauses = Vec::new();
            for part in parts {
                clauses.extend(distribute(part, sizes)?);
            }
            within(irredundant(clauses))
        }
        Condition::Many { all: false, parts } => {
            let mut clauses = vec![Clause::default()];
            for part in parts {
                let other = distribute(part, sizes)?;
                if clauses.len() * other.len() > MOST_COMPARED {
                    return None;
                }
                let both = clauses.iter().flat_map(|a| other.iter().filter_map(|b| either(a, b, sizes)));
                clauses = within(irredundant(both.collect()))?;
            }
            Some(clauses)
        }
    }
}

fn within(clauses: Vec<Clause>) -> Option<Vec<Clause>> {
    (clauses.len() <= MOST_DISTRIBUTED).then_some(clauses)
}

/// Returns the clause that holds if `a` or `b` holds, or `None` if this clause always holds.
fn either(a: &Clause, b: &Clause, sizes: &[usize]) -> Option<Clause> {
    let mut literals = a.literals.clone();
    for literal in &b.literals {
        match literals.binary_search_by_key(&literal.parameter, |known| known.parameter) {
            Ok(i) => {
                let levels = &mut literals[i].levels;
                levels.extend(&literal.levels);
                levels.sort_unstable();
                levels.dedup();
                if levels.len() == sizes[literal.parameter] {
                    return None;
                }
            }
            Err(i) => literals.insert(i, literal.clone()),
        }
    }
    Some(Clause { literals })
}

/// Removes clauses that other clauses imply, and joins clauses that differ in only one literal.
fn irredundant(clauses: Vec<Clause>) -> Vec<Clause> {
    let mut kept: Vec<Clause> = Vec::new();
    let mut queue = clauses;
    queue.reverse();
    while let Some(mut clause) = queue.pop() {
        if kept.iter().any(|other| implies(other, &clause)) {
            continue;
        }
        kept.retain(|other| !implies(&clause, other));
        let joint = kept.iter().enumerate().find_map(|(i, other)| Some((i, differing(other, &clause)?)));
        match joint {
            None => kept.push(clause),
            Some((i, literal)) => {
                let other = kept.remove(i);
                let levels = &mut clause.literals[literal].levels;
                levels.retain(|level| other.literals[literal].levels.binary_search(level).is_ok());
                if levels.is_empty() {
                    clause.literals.remove(literal);
                }
                queue.push(clause);
            }
        }
    }
    kept
}

/// Returns `true` if `a` implies `b`, so that every literal of `a` is contained in the literal of `b` for the same
/// parameter.
fn implies(a: &Clause, b: &Clause) -> bool {
    a.literals.iter().all(|literal| {
        let there = b.literals.binary_search_by_key(&literal.parameter, |other| other.parameter);
        there.is_ok_and(|i| literal.levels.iter().all(|level| b.literals[i].levels.binary_search(level).is_ok()))
    })
}

/// Returns the index of the only literal in which two clauses over the same parameters differ, if there is exactly
/// one.
fn differing(a: &Clause, b: &Clause) -> Option<usize> {
    let same_parameters = a.literals.len() == b.literals.len()
        && a.literals.iter().zip(&b.literals).all(|(a, b)| a.parameter == b.parameter);
    let mut differ = (0..a.literals.len()).filter(|&i| a.literals[i] != b.literals[i]);
    let literal = if same_parameters { differ.next() } else { None };
    literal.filter(|_| differ.next().is_none())
}

/// Returns the clauses of a condition as the paths of a decision tree, or `None` if there are too many clauses.
fn tree(condition: &Condition, sizes: &[usize]) -> Option<Vec<Clause>> {
    let mut tree = Tree { sizes, path: Vec::new(), clauses: Vec::new(), levels: 0, branches: 0 };
    tree.grow(condition)?;
    Some(tree.clauses)
}

struct Tree<'a> {
    sizes: &'a [usize],
    /// The literals of the path to this node. One of them holds if a row does not follow the path.
    path: Vec<Literal>,
    clauses: Vec<Clause>,
    levels: usize,
    branches: usize,
}

impl Tree<'_> {
    fn grow(&mut self, condition: &Condition) -> Option<()> {
        self.branches += 1;
        let Some(parameter) = first(condition) else {
            if *condition == Condition::NEVER {
                let mut literals = self.path.clone();
                literals.sort_by_key(|literal| literal.parameter);
                self.levels += literals.iter().map(|literal| literal.levels.len()).sum::<usize>();
                self.clauses.push(Clause { literals });
            }
            return self.fits().then_some(());
        };
        let mut branches: Vec<(Condition, Vec<bool>)> = Vec::new();
        for level in 0..self.sizes[parameter] {
            let left = condition.at(parameter, level);
            let branch = match branches.iter_mut().find(|(known, _)| *known == left) {
                Some((_, elsewhere)) => elsewhere,
                None => &mut branches.push_mut((left, vec![true; self.sizes[parameter]])).1,
            };
            branch[level] = false;
        }
        for (left, elsewhere) in branches {
            let literal = literal(parameter, elsewhere.into_iter());
            // A literal is not necessary if every level takes this path.
            let asks = !literal.levels.is_empty();
            self.path.extend(asks.then_some(literal));
            self.grow(&left)?;
            self.path.truncate(self.path.len() - usize::from(asks));
        }
        Some(())
    }

    fn fits(&self) -> bool {
        self.clauses.len() <= MOST_CLAUSES && self.levels <= MOST_LEVELS && self.branches <= MOST_BRANCHES
    }
}

/// Returns the first parameter that the condition names.
fn first(condition: &Condition) -> Option<usize> {
    match condition {
        Condition::Among { parameter, .. } => Some(*parameter),
        Condition::Pair { left, .. } => Some(*left),
        Condition::Many { parts, .. } => parts.iter().find_map(first),
    }
}
