//! Clauses: the form of constraints that the rules work with. A constraint is a conjunction of clauses over levels.

/// The statement that a discrete parameter has a level from a set of levels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Literal {
    /// The position of the parameter among the discrete coordinates of the space.
    pub parameter: usize,
    /// The levels at which the literal holds, in ascending order, each once.
    pub levels: Vec<usize>,
}

/// A disjunction of literals, as a part of a constraint. A test keeps the clause if at least one literal holds. No test
/// keeps the empty clause.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Clause {
    /// The literals of the clause, with at most one literal for each parameter.
    pub literals: Vec<Literal>,
}
