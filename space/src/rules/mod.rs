//! Rules: the combinations of levels that the constraints of a discrete space allow.
//!
//! A combination of levels is *valid* if a complete test contains it and keeps every constraint. Deriving all
//! combinations that the constraints exclude together, as resolution does, takes exponential effort, so nothing is
//! derived in advance. The parameters fall apart into groups, so that no constraint joins parameters of two groups.
//! Each group is compiled into a decision diagram, which answers every question in one pass. If a diagram would be too
//! large, a satisfiability solver answers instead; it is slower, but also exact. The solver must first find out,
//! within a bounded number of steps, whether there is a test and which levels tests have. If it cannot, there are no
//! rules.

mod classes;
mod clause;
mod companions;
mod conflict;
mod count;
mod diagram;
mod encoding;
mod group;
mod satisfiability;
mod uniform;

pub use clause::{Clause, Literal};
pub use companions::Companions;
pub use conflict::Conflict;
pub use count::TupleCount;
pub use uniform::{Alike, UniformTests};

use classes::Classes;
use encoding::Undecided;
use group::Group;
use std::sync::Arc;
use thiserror::Error;

/// The reason why no rules can be derived from constraints.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RulesError {
    /// No test keeps all constraints.
    #[error(transparent)]
    Conflict(#[from] Conflict),
    /// The search for the levels that the given parameters can have exceeded its greatest number of steps.
    #[error("the search for the levels that the constraints allow for the parameters {0:?} exceeded its bounds")]
    Undecided(Vec<usize>),
}

/// The combinations of levels that the constraints of a space allow.
#[derive(Debug, Clone)]
pub struct Rules {
    levels: Vec<usize>,
    groups: Arc<[Group]>,
    group_of: Vec<Option<usize>>,
}

impl Rules {
    /// Derives the rules of the given constraints on parameters with the given numbers of levels. Each constraint is
    /// the conjunction of its clauses.
    ///
    /// # Errors
    /// No test keeps all constraints, or the search for a test, or for the levels that tests can have, takes too long.
    /// Time is counted in steps: the same constraints have the same result on every machine.
    ///
    /// # Panics
    /// A literal names a parameter or a level that does not exist.
    pub fn new(levels: &[usize], constraints: &[Vec<Clause>]) -> Result<Self, RulesError> {
        let classes = Classes::new(levels, constraints.iter().flatten());
        let mut kept = classes.clauses.iter().all(|clause| !clause.literals.is_empty());
        let (mut groups, mut undecided) = (Vec::new(), None);
        for members in classes.groups() {
            match Group::new(&classes, members.clone()) {
                Ok(Some(group)) => groups.push(group),
                Ok(None) => kept = false,
                Err(Undecided) => undecided = undecided.or(Some(members)),
            }
        }
        if !kept {
            return Err(Conflict::smallest(levels, constraints).into());
        }
        if let Some(members) = undecided {
            return Err(RulesError::Undecided(members));
        }
        let mut group_of = vec![None; levels.len()];
        for (index, group) in groups.iter().enumerate() {
            for &member in group.members() {
                group_of[member] = Some(index);
            }
        }
        Ok(Self { levels: levels.to_vec(), groups: groups.into(), group_of })
    }

    /// Makes the rules of parameters that have the given numbers of levels and no constraints.
    pub fn free(levels: &[usize]) -> Self {
        Self { levels: levels.to_vec(), groups: Arc::new([]), group_of: vec![None; levels.len()] }
    }

    /// Returns the number of levels of each parameter.
    pub fn levels(&self) -> &[usize] {
        &self.levels
    }

    /// Returns the number of groups of parameters that constraints join with each other.
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// Returns the parameters of a group, in ascending order.
    ///
    /// # Panics
    /// The group does not exist.
    pub fn members(&self, group: usize) -> &[usize] {
        self.groups[group].members()
    }

    /// Returns the index of a parameter's group, or `None` if no constraint restricts the parameter.
    ///
    /// # Panics
    /// The parameter does not exist.
    pub fn group_of(&self, parameter: usize) -> Option<usize> {
        self.group_of[parameter]
    }

    /// Returns `true` if a complete test keeps all constraints. `test` has a level for each parameter.
    pub fn allows(&self, test: &[usize]) -> bool {
        self.groups.iter().all(|group| group.allows(test))
    }

    /// Returns `true` if a complete test keeps all clauses that name `parameter`.
    pub fn allows_at(&self, parameter: usize, test: &[usize]) -> bool {
        self.group_of[parameter].is_none_or(|group| self.groups[group].allows_at(parameter, test))
    }

    /// Returns `true` if a test exists that has all given (parameter, level) pairs and keeps all constraints.
    pub fn is_valid(&self, tuple: &[(usize, usize)]) -> bool {
        let fixed = |parameter: usize| tuple.iter().find(|pair| pair.0 == parameter).map(|pair| pair.1);
        let agrees = |&(parameter, level): &(usize, usize)| fixed(parameter) == Some(level);
        tuple.iter().all(agrees)
            && (0..self.groups.len())
                .filter(|&group| tuple.iter().any(|&(parameter, _)| self.group_of[parameter] == Some(group)))
                .all(|group| self.holds(group, fixed))
    }

    /// Returns `true` if a test exists that has the `fixed` levels and keeps the constraints of a group.
    ///
    /// # Panics
    /// The group or a level does not exist.
    pub fn holds(&self, group: usize, fixed: impl Fn(usize) -> Option<usize>) -> bool {
        self.groups[group].holds(fixed)
    }

    /// Returns `true` for each level of each member of a group if a test exists that has the level and the `fixed`
    /// levels and keeps the constraints.
    ///
    /// # Panics
    /// The group or a level does not exist.
    pub fn supported(&self, group: usize, fixed: impl Fn(usize) -> Option<usize>) -> Vec<Vec<bool>> {
        self.groups[group].supported(fixed)
    }

    /// Returns `true` for each level of a parameter if a test exists that has the level and the `fixed` levels and
    /// keeps the constraints.
    ///
    /// # Panics
    /// The parameter or a level does not exist.
    pub fn supported_at(&self, parameter: usize, fixed: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
        match self.group_of[parameter] {
            Some(group) => self.groups[group].supported_at(parameter, fixed),
            None => {
                let chosen = fixed(parameter);
                (0..self.levels[parameter]).map(|level| chosen.is_none_or(|chosen| chosen == level)).collect()
            }
        }
    }

    /// Returns the first test in lexicographic order that has the levels in `partial` and keeps all constraints, or
    /// `None` if no test does. In each group the order is that of the parameters.
    pub fn completes(&self, partial: &[Option<usize>]) -> Option<Vec<usize>> {
        let mut test: Vec<usize> = partial.iter().map(|level| level.unwrap_or(0)).collect();
        for group in self.groups.iter() {
            let mut fixed: Vec<Option<usize>> = group.members().iter().map(|&member| partial[member]).collect();
            for (place, &member) in group.members().iter().enumerate() {
                let levels = partial[member].map_or(0..self.levels[member], |level| level..level + 1);
                test[member] = levels.into_iter().find(|&level| {
                    fixed[place] = Some(level);
                    group.holds(|parameter| group.place(parameter).and_then(|place| fixed[place]))
                })?;
            }
        }
        Some(test)
    }
}
