//! The form in which constraints are reasoned about: conjunctions of clauses over levels.

/// A parameter being at one of some levels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Literal {
    /// The position of the parameter among the discrete ones.
    pub parameter: usize,
    /// The levels at which the literal holds, in ascending order, each once.
    pub levels: Vec<usize>,
}

/// A disjunction: a test keeps the clause if some of its literals hold. The empty clause is never kept.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Clause {
    /// At most one literal for each parameter.
    pub literals: Vec<Literal>,
}
