//! A group of parameters that constraints join. A decision diagram answers questions about the group or, if the
//! diagram would be too large, a satisfiability solver.

use super::classes::{ClassClause, Classes};
use super::diagram::{Chain, Diagram};
use super::encoding::Undecided;
use super::satisfiability::Satisfiability;
use std::sync::Arc;

/// The method that answers questions about a group.
#[derive(Debug)]
enum Engine {
    Diagram(Arc<Diagram>),
    Solver(Box<Satisfiability>),
}

/// A set of parameters that clauses join.
#[derive(Debug)]
pub(super) struct Group {
    members: Vec<usize>,
    /// The class of each level, and the number of levels in each class, for each member.
    class_of: Vec<Vec<usize>>,
    pub(super) sizes: Vec<Vec<usize>>,
    clauses: Vec<ClassClause>,
    /// The clauses that name each member.
    clauses_of: Vec<Vec<usize>>,
    engine: Engine,
}

impl Group {
    /// Makes the group of these parameters, or returns `None` if its clauses cannot be kept together.
    ///
    /// # Errors
    /// It takes too long to find out whether the clauses can be kept together, or which classes the members can have.
    pub(super) fn new(classes: &Classes, members: Vec<usize>) -> Result<Option<Self>, Undecided> {
        let place = |parameter: usize| members.binary_search(&parameter).ok();
        let (sizes, clauses) = classes.of(&members);
        let mut clauses_of = vec![Vec::new(); members.len()];
        for (index, clause) in clauses.iter().enumerate() {
            for place in clause.literals.iter().filter_map(|literal| place(literal.parameter)) {
                clauses_of[place].push(index);
            }
        }
        let engine = match Diagram::new(&members, &sizes, &clauses) {
            Some(diagram) if diagram.is_empty() => return Ok(None),
            Some(diagram) => Engine::Diagram(Arc::new(diagram)),
            None => match Satisfiability::new(&members, &sizes, &clauses)? {
                Some(solver) => Engine::Solver(Box::new(solver)),
                None => return Ok(None),
            },
        };
        let class_of = members.iter().map(|&member| classes.class_of[member].clone()).collect();
        Ok(Some(Self { members, class_of, sizes, clauses, clauses_of, engine }))
    }

    pub(super) fn members(&self) -> &[usize] {
        &self.members
    }

    /// Returns the position of a parameter among the members, if it is a member.
    pub(super) fn place(&self, parameter: usize) -> Option<usize> {
        self.members.binary_search(&parameter).ok()
    }

    fn keeps(&self, clause: usize, test: &[usize]) -> bool {
        self.clauses[clause].literals.iter().any(|literal| {
            let place = self.place(literal.parameter).expect("clauses do not leave their group");
            literal.holds[self.class_of[place][test[literal.parameter]]]
        })
    }

    pub(super) fn allows(&self, test: &[usize]) -> bool {
        match &self.engine {
            Engine::Diagram(diagram) => diagram.has(|place| self.class_of[place][test[self.members[place]]]),
            Engine::Solver(_) => (0..self.clauses.len()).all(|clause| self.keeps(clause, test)),
        }
    }

    /// Returns `true` if a test keeps the clauses that name a member.
    pub(super) fn allows_at(&self, parameter: usize, test: &[usize]) -> bool {
        let place = self.place(parameter).expect("the parameter is a member");
        self.clauses_of[place].iter().all(|&clause| self.keeps(clause, test))
    }

    fn classes(&self, fixed: impl Fn(usize) -> Option<usize>) -> Vec<Option<usize>> {
        let members = self.members.iter().zip(&self.class_of);
        members.map(|(&member, class_of)| fixed(member).map(|level| class_of[level])).collect()
    }

    pub(super) fn holds(&self, fixed: impl Fn(usize) -> Option<usize>) -> bool {
        let fixed = self.classes(fixed);
        match &self.engine {
            Engine::Diagram(diagram) => match fixed.iter().copied().collect::<Option<Vec<usize>>>() {
                Some(all) => diagram.has(|place| all[place]),
                None => diagram.holds(&fixed),
            },
            Engine::Solver(solver) => solver.holds(&fixed),
        }
    }

    /// Returns, for each member and each of its classes, `true` if the class is valid together with the fixed classes.
    pub(super) fn supported_classes(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        match &self.engine {
            Engine::Diagram(diagram) => diagram.supported(fixed),
            Engine::Solver(solver) => solver.supported(fixed),
        }
    }

    pub(super) fn supported(&self, fixed: impl Fn(usize) -> Option<usize>) -> Vec<Vec<bool>> {
        let fixed_levels: Vec<Option<usize>> = self.members.iter().map(|&member| fixed(member)).collect();
        let supported = self.supported_classes(&self.classes(fixed));
        let members = self.class_of.iter().zip(&supported).zip(fixed_levels);
        members
            .map(|((class_of, supported), fixed)| {
                let levels = class_of.iter().enumerate();
                levels.map(|(level, &class)| supported[class] && fixed.is_none_or(|fixed| fixed == level)).collect()
            })
            .collect()
    }

    /// Returns, for each level of one member, `true` if the level is valid together with the fixed levels. Nothing
    /// else is searched for.
    pub(super) fn supported_at(&self, parameter: usize, fixed: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
        let place = self.place(parameter).expect("the parameter is a member");
        let (classes, level) = (self.classes(&fixed), fixed(parameter));
        let supported = match &self.engine {
            Engine::Diagram(diagram) => diagram.supported(&classes).swap_remove(place),
            Engine::Solver(solver) => solver.supported_at(place, &classes),
        };
        let levels = self.class_of[place].iter().enumerate();
        levels.map(|(other, &class)| supported[class] && level.is_none_or(|level| level == other)).collect()
    }

    /// Returns the number of ways to choose the members, or `None` if the engine cannot count them.
    pub(super) fn tests(&self) -> Option<f64> {
        match &self.engine {
            Engine::Diagram(diagram) => Some(diagram.tests(&self.sizes)),
            Engine::Solver(_) => None,
        }
    }

    /// Returns a chain that draws all ways to choose the members with the same probability, or `None` if the engine
    /// cannot count them.
    pub(super) fn chain(&self) -> Option<Chain> {
        match &self.engine {
            Engine::Diagram(diagram) => Some(Chain::new(diagram.clone(), &self.sizes)),
            Engine::Solver(_) => None,
        }
    }

    /// Returns the levels of each member in the order of their classes.
    pub(super) fn levels_by_class(&self) -> Vec<Vec<usize>> {
        let by_class = |class_of: &Vec<usize>| {
            let mut levels: Vec<usize> = (0..class_of.len()).collect();
            levels.sort_by_key(|&level| class_of[level]);
            levels
        };
        self.class_of.iter().map(by_class).collect()
    }
}
