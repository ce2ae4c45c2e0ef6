//! Clauses over classes as clauses over truth values, for the satisfiability solver.
//!
//! The class of a parameter is written in the regular encoding (Ansótegui, Manyà, *Mapping problems with
//! finite-domain variables into problems with Boolean variables*, SAT 2004): a truth value for "the class is at
//! least j", and one for each class between the ends. A parameter of two classes is a single truth value, and
//! the size grows linearly where pairwise exclusion grows quadratically.

use super::group::ClassClause;
use batsat::{Callbacks, Lit, Solver, SolverInterface, lbool};

/// The solver's own callbacks cannot be shared between threads.
#[derive(Default)]
struct Uninterrupted;

impl Callbacks for Uninterrupted {}

/// A solver and what its truth values mean. This is the one module that names the solver.
pub(super) struct Encoding {
    solver: Solver<Uninterrupted>,
    /// The truth value of each class of each parameter.
    is: Vec<Vec<Lit>>,
    /// Truth values that switch clauses on.
    switches: Vec<Lit>,
}

impl Encoding {
    /// Parameters with so many classes, and so many switches.
    pub(super) fn new(classes: impl Iterator<Item = usize>, switches: usize) -> Self {
        let mut solver = Solver::<Uninterrupted>::default();
        let fresh = |solver: &mut Solver<Uninterrupted>| Lit::new(solver.new_var_default(), true);
        let mut is = Vec::new();
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
        }
        let switches = (0..switches).map(|_| fresh(&mut solver)).collect();
        Self { solver, is, switches }
    }

    /// Demands a clause, always or while a switch is on; `place` says where a parameter stands.
    pub(super) fn demand(&mut self, clause: &ClassClause, switch: Option<usize>, place: impl Fn(usize) -> usize) {
        let mut truths: Vec<Lit> = switch.map(|switch| !self.switches[switch]).into_iter().collect();
        for literal in &clause.literals {
            let classes = self.is[place(literal.parameter)].iter().zip(&literal.holds);
            truths.extend(classes.filter(|(_, holds)| **holds).map(|(is, _)| *is));
        }
        self.solver.add_clause_reuse(&mut truths);
    }

    /// The classes of a solution with the fixed classes and these switches on, if there is one.
    pub(super) fn solve(&mut self, fixed: &[Option<usize>], on: &[usize]) -> Option<Vec<usize>> {
        let fixed = self.is.iter().zip(fixed).filter_map(|(is, class)| class.map(|class| is[class]));
        let assumed: Vec<Lit> = fixed.chain(on.iter().map(|&switch| self.switches[switch])).collect();
        if self.solver.solve_limited(&assumed) != lbool::TRUE {
            return None;
        }
        let class = |is: &Vec<Lit>| is.iter().position(|&is| self.solver.value_lit(is) == lbool::TRUE);
        Some(self.is.iter().map(|is| class(is).expect("a parameter is in one of its classes")).collect())
    }
}
