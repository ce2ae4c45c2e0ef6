//! Translates clauses over classes into clauses over truth values, for the satisfiability solver.
//!
//! The class of a parameter has the regular encoding (Ansótegui, Manyà, *Mapping problems with finite-domain variables
//! into problems with Boolean variables*, SAT 2004): a truth value for "the class is at least j", and one for each
//! class except the first and the last. A parameter with two classes needs only one truth value. The size grows
//! linearly, while pairwise exclusion grows quadratically. A literal that holds at the lowest or the highest classes
//! needs only one truth value for all of them.

use super::classes::ClassClause;
use batsat::{Callbacks, Lit, Solver, SolverInterface, lbool};
use std::cell::Cell;

/// The greatest number of steps of a search that may end without an answer. It takes some seconds.
pub(super) const PATIENCE: u64 = 1 << 19;

/// The error that a search was given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Undecided;

/// The number of steps that the solver has left. The solver asks after each decision. It takes the same steps on every
/// machine.
#[derive(Default)]
struct Steps(Cell<u64>);

impl Callbacks for Steps {
    fn stop(&self) -> bool {
        let left = self.0.get();
        self.0.set(left.saturating_sub(1));
        left == 0
    }
}

/// The solver, and the meaning of its truth values. Only this module names the solver.
pub(super) struct Encoding {
    solver: Solver<Steps>,
    /// For each parameter and each class but the first, the truth value of "the class is at least this class".
    at_least: Vec<Vec<Lit>>,
    /// For each parameter and each class, the truth value of "the class is this class".
    is: Vec<Vec<Lit>>,
    /// The truth values that switch clauses on.
    switches: Vec<Lit>,
}

impl Encoding {
    /// Makes the encoding of parameters with these numbers of classes, with this number of switches.
    pub(super) fn new(classes: impl Iterator<Item = usize>, switches: usize) -> Self {
        let mut solver = Solver::<Steps>::default();
        let fresh = |solver: &mut Solver<Steps>| Lit::new(solver.new_var_default(), true);
        let (mut is, mut bounds) = (Vec::new(), Vec::new());
        for classes in classes {
            let at_least: Vec<Lit> = (1..classes).map(|_| fresh(&mut solver)).collect();
            for pair in at_least.windows(2) {
                solver.add_clause_reuse(&mut vec![!pair[1], pair[0]]);
            }
            let class = |class: usize| match (class.checked_sub(1).map(|i| at_least[i]), at_least.get(class)) {
                (None, None) => {
                    let always = fresh(&mut solver);
                    solver.add_clause_reuse(&mut vec![always]);
                    always
                }
                (None, Some(&above)) => !above,
                (Some(reached), None) => reached,
                (Some(reached), Some(&above)) => {
                    let is = fresh(&mut solver);
                    solver.add_clause_reuse(&mut vec![!is, reached]);
                    solver.add_clause_reuse(&mut vec![!is, !above]);
                    solver.add_clause_reuse(&mut vec![is, !reached, above]);
                    is
                }
            };
            is.push((0..classes).map(class).collect());
            bounds.push(at_least);
        }
        let switches = (0..switches).map(|_| fresh(&mut solver)).collect();
        Self { solver, at_least: bounds, is, switches }
    }

    /// Adds a clause, for always or for the time that a switch is on. `place` gives the position of a parameter.
    pub(super) fn demand(&mut self, clause: &ClassClause, switch: Option<usize>, place: impl Fn(usize) -> usize) {
        let mut truths: Vec<Lit> = switch.map(|switch| !self.switches[switch]).into_iter().collect();
        for literal in &clause.literals {
            let (at_least, is) = (&self.at_least[place(literal.parameter)], &self.is[place(literal.parameter)]);
            let Some(lowest) = literal.holds.iter().position(|holds| !holds) else { return };
            let highest = literal.holds.iter().rposition(|holds| !holds).expect("a class where it does not hold");
            truths.extend((lowest > 0).then(|| !at_least[lowest - 1]));
            truths.extend(at_least.get(highest));
            let between = (lowest..highest).filter(|&class| literal.holds[class]);
            truths.extend(between.map(|class| is[class]));
        }
        self.solver.add_clause_reuse(&mut truths);
    }

    /// Returns the classes of a solution that has the fixed classes and keeps the clauses of these switches, if one
    /// exists. Each step of the search reduces `steps`. The search is given up when no steps are left.
    pub(super) fn solve(
        &mut self,
        fixed: &[Option<usize>],
        on: &[usize],
        steps: &mut u64,
    ) -> Result<Option<Vec<usize>>, Undecided> {
        let fixed = self.is.iter().zip(fixed).filter_map(|(is, class)| class.map(|class| is[class]));
        let assumed: Vec<Lit> = fixed.chain(on.iter().map(|&switch| self.switches[switch])).collect();
        self.solver.cb().0.set(*steps);
        let answer = self.solver.solve_limited(&assumed);
        *steps = self.solver.cb().0.get();
        if answer == lbool::UNDEF {
            return Err(Undecided);
        }
        if answer == lbool::FALSE {
            return Ok(None);
        }
        let class = |is: &Vec<Lit>| is.iter().position(|&is| self.solver.value_lit(is) == lbool::TRUE);
        Ok(Some(self.is.iter().map(|is| class(is).expect("a parameter is in one of its classes")).collect()))
    }
}
