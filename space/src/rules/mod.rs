//! Which tests of a discrete space make sense: what constraints allow.
//!
//! A combination of levels is *valid* when some complete test that keeps every constraint contains it. Deriving
//! all combinations that the constraints exclude together, as resolution does, explodes; so nothing is derived
//! up front. The parameters fall apart into groups that no constraint joins, and each group is compiled into a
//! decision diagram on which every question takes one pass. Where a diagram would grow beyond bounds,
//! a satisfiability solver answers instead; it is slower, and as exact. Whether there is a test at all, and which
//! levels tests have, it has to find out within bounds too, or there are no rules.

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

/// Why there are no rules.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RulesError {
    /// No test keeps all constraints.
    #[error(transparent)]
    Conflict(#[from] Conflict),
    /// Which levels some parameters can have was not found out within bounds.
    #[error("what the constraints allow of the parameters {0:?} was not found out within the bounds of the search")]
    Undecided(Vec<usize>),
}

/// The discrete parameters of a space, and the constraints on them.
#[derive(Debug, Clone)]
pub struct Rules {
    levels: Vec<usize>,
    groups: Arc<[Group]>,
    group_of: Vec<Option<usize>>,
}

impl Rules {
    /// Parameters with so many levels each, and constraints; a constraint is the conjunction of its clauses.
    ///
    /// # Errors
    /// No test keeps all constraints, or whether any does, and at which levels, takes too long to find out. How
    /// long is counted in steps: the same constraints have the same outcome on every machine.
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

    /// Parameters with so many levels each that go together in any way.
    pub fn free(levels: &[usize]) -> Self {
        Self { levels: levels.to_vec(), groups: Arc::new([]), group_of: vec![None; levels.len()] }
    }

    /// The number of levels of each parameter.
    pub fn levels(&self) -> &[usize] {
        &self.levels
    }

    /// How many groups of parameters the constraints join.
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// The parameters of a group, in ascending order.
    ///
    /// # Panics
    /// There are not as many groups.
    pub fn members(&self, group: usize) -> &[usize] {
        self.groups[group].members()
    }

    /// The group a parameter belongs to; none where no constraint speaks of it.
    ///
    /// # Panics
    /// There are not as many parameters.
    pub fn group_of(&self, parameter: usize) -> Option<usize> {
        self.group_of[parameter]
    }

    /// Whether a complete test, a level for each parameter, keeps all constraints.
    pub fn allows(&self, test: &[usize]) -> bool {
        self.groups.iter().all(|group| group.allows(test))
    }

    /// Whether a complete test keeps the constraints that join a parameter with others.
    pub fn allows_at(&self, parameter: usize, test: &[usize]) -> bool {
        self.group_of[parameter].is_none_or(|group| self.groups[group].allows_at(parameter, test))
    }

    /// Whether some test that keeps all constraints has these (parameter, level) pairs.
    pub fn is_valid(&self, tuple: &[(usize, usize)]) -> bool {
        let fixed = |parameter: usize| tuple.iter().find(|pair| pair.0 == parameter).map(|pair| pair.1);
        let agrees = |&(parameter, level): &(usize, usize)| fixed(parameter) == Some(level);
        tuple.iter().all(agrees)
            && (0..self.groups.len())
                .filter(|&group| tuple.iter().any(|&(parameter, _)| self.group_of[parameter] == Some(group)))
                .all(|group| self.holds(group, fixed))
    }

    /// Whether the parameters of a group that are not `fixed` can be chosen so that its constraints are kept.
    ///
    /// # Panics
    /// There are not as many groups, or a level does not exist.
    pub fn holds(&self, group: usize, fixed: impl Fn(usize) -> Option<usize>) -> bool {
        self.groups[group].holds(fixed)
    }

    /// For each member of a group and each of its levels, whether a test that keeps the constraints has it
    /// together with what is `fixed`.
    ///
    /// # Panics
    /// There are not as many groups, or a level does not exist.
    pub fn supported(&self, group: usize, fixed: impl Fn(usize) -> Option<usize>) -> Vec<Vec<bool>> {
        self.groups[group].supported(fixed)
    }

    /// For each level of a parameter, whether a test that keeps the constraints has it together with what is
    /// `fixed`.
    ///
    /// # Panics
    /// There is no such parameter, or a level does not exist.
    pub fn supported_at(&self, parameter: usize, fixed: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
        match self.group_of[parameter] {
            Some(group) => self.groups[group].supported_at(parameter, fixed),
            None => {
                let chosen = fixed(parameter);
                (0..self.levels[parameter]).map(|level| chosen.is_none_or(|chosen| chosen == level)).collect()
            }
        }
    }

    /// The first test in lexicographic order that keeps all constraints and has what is fixed; none if there is
    /// no such test. The order is the parameters' within each group.
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
