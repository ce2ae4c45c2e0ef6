//! Answers questions about groups with too large diagrams, by conflict-driven search.
//!
//! One solution answers many questions, so the solutions found are kept. Each solution also shows the single changes
//! that keep it a solution. The solver searches only if no known solution gives the answer. The answers do not depend
//! on the solutions that were found.

use super::classes::ClassClause;
use super::encoding::{Encoding, PATIENCE, Undecided};
use std::fmt;
use std::ops::Range;
use std::sync::Mutex;

/// The number of solutions that are kept.
const POOL: usize = 1 << 10;

/// The reason why a search with `u64::MAX` steps always ends with an answer.
const ENOUGH: &str = "nobody takes 2^64 steps";

struct State {
    encoding: Encoding,
    /// The solutions, as classes of the members.
    pool: Vec<Vec<usize>>,
    /// The number of solutions found so far.
    found: usize,
}

impl State {
    fn solve(&mut self, fixed: &[Option<usize>], steps: &mut u64) -> Result<Option<Vec<usize>>, Undecided> {
        let solution = self.encoding.solve(fixed, &[], steps)?;
        if let Some(solution) = &solution {
            if self.pool.len() < POOL {
                self.pool.push(solution.clone());
            } else {
                self.pool[self.found % POOL] = solution.clone();
            }
            self.found += 1;
        }
        Ok(solution)
    }
}

/// A group of parameters as a satisfiability problem.
pub(super) struct Satisfiability {
    sizes: Vec<usize>,
    /// The clauses, each as positions of members with the classes at which the clause is kept.
    clauses: Vec<Vec<(usize, Vec<bool>)>>,
    state: Mutex<State>,
}

impl fmt::Debug for Satisfiability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Satisfiability").field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

fn agrees(solution: &[usize], fixed: &[Option<usize>]) -> bool {
    solution.iter().zip(fixed).all(|(class, fixed)| fixed.is_none_or(|fixed| fixed == *class))
}

impl Satisfiability {
    /// Makes the problem of these clauses among members with these classes, or returns `None` if they cannot be kept
    /// together.
    ///
    /// # Errors
    /// It takes too long to find out which classes the members can have.
    pub(super) fn new(
        members: &[usize],
        sizes: &[Vec<usize>],
        clauses: &[ClassClause],
    ) -> Result<Option<Self>, Undecided> {
        let sizes: Vec<usize> = sizes.iter().map(Vec::len).collect();
        let mut encoding = Encoding::new(sizes.iter().copied(), 0);
        let place = |parameter: usize| members.binary_search(&parameter).expect("clauses are among the members");
        for clause in clauses {
            encoding.demand(clause, None, place);
        }
        let over_places =
            |clause: &ClassClause| clause.literals.iter().map(|l| (place(l.parameter), l.holds.clone())).collect();
        let clauses = clauses.iter().map(over_places).collect();
        let state = Mutex::new(State { encoding, pool: Vec::new(), found: 0 });
        let solver = Self { sizes, clauses, state };
        let nothing = vec![None; members.len()];
        let supported = solver.supported_within(0..members.len(), &nothing, PATIENCE)?;
        Ok(supported[0].contains(&true).then_some(solver))
    }

    /// Returns `true` if a solution has the fixed classes.
    pub(super) fn holds(&self, fixed: &[Option<usize>]) -> bool {
        let mut state = self.state.lock().expect("no question panics");
        let mut steps = u64::MAX;
        state.pool.iter().any(|solution| agrees(solution, fixed))
            || state.solve(fixed, &mut steps).expect(ENOUGH).is_some()
    }

    /// Returns, for each member and class, `true` if a solution has this class and the fixed classes.
    pub(super) fn supported(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        self.supported_within(0..fixed.len(), fixed, u64::MAX).expect(ENOUGH)
    }

    /// Returns, for each class of one member, `true` if a solution has this class and the fixed classes.
    pub(super) fn supported_at(&self, place: usize, fixed: &[Option<usize>]) -> Vec<bool> {
        self.supported_within(place..place + 1, fixed, u64::MAX).expect(ENOUGH).swap_remove(place)
    }

    /// Returns, for each member and class, `true` if a solution has this class and the fixed classes. The answer is
    /// complete only for the members at `places`; for other members, solutions may be missing.
    fn supported_within(
        &self,
        places: Range<usize>,
        fixed: &[Option<usize>],
        mut steps: u64,
    ) -> Result<Vec<Vec<bool>>, Undecided> {
        let mut state = self.state.lock().expect("no question panics");
        let mut supported: Vec<Vec<bool>> = self.sizes.iter().map(|&classes| vec![false; classes]).collect();
        let known = state.pool.iter().find(|solution| agrees(solution, fixed)).cloned();
        let first = if known.is_some() { known } else { state.solve(fixed, &mut steps)? };
        let Some(first) = first else { return Ok(supported) };
        self.show(&first, fixed, &mut supported);
        for solution in state.pool.iter().filter(|solution| agrees(solution, fixed)) {
            supported.iter_mut().zip(solution).for_each(|(supported, &class)| supported[class] = true);
        }
        let mut asked = fixed.to_vec();
        for place in places.filter(|&place| fixed[place].is_none()) {
            for class in 0..self.sizes[place] {
                if !supported[place][class] {
                    asked[place] = Some(class);
                    if let Some(solution) = state.solve(&asked, &mut steps)? {
                        self.show(&solution, fixed, &mut supported);
                    }
                }
            }
            asked[place] = None;
        }
        Ok(supported)
    }

    /// Marks the classes of a solution, and the classes of the solutions that differ from it in one member.
    fn show(&self, solution: &[usize], fixed: &[Option<usize>], supported: &mut [Vec<bool>]) {
        let mut free: Vec<Vec<bool>> = self.sizes.iter().map(|&classes| vec![true; classes]).collect();
        for clause in &self.clauses {
            let mut keeping = clause.iter().filter(|(place, holds)| holds[solution[*place]]);
            if let (Some((place, holds)), None) = (keeping.next(), keeping.next()) {
                free[*place].iter_mut().zip(holds).for_each(|(free, holds)| *free &= holds);
            }
        }
        for (place, free) in free.iter_mut().enumerate() {
            if let Some(class) = fixed[place] {
                free.fill(false);
                free[class] = true;
            }
            supported[place].iter_mut().zip(free).for_each(|(supported, free)| *supported |= *free);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::classes::ClassLiteral;
    use super::super::diagram::Diagram;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solver_and_diagram_answer_alike(
            sizes in prop::collection::vec(1..=8usize, 2..=6),
            drawn in prop::collection::vec((prop::collection::vec(any::<u8>(), 6), any::<u8>()), 1..=8),
            fixed in prop::collection::vec(prop::option::of(any::<u8>()), 6),
        ) {
            let literal = |parameter: usize, bits: u8| ClassLiteral {
                parameter,
                holds: (0..sizes[parameter]).map(|class| bits >> class & 1 == 1).collect(),
            };
            let clauses = drawn.iter().map(|(bits, chosen)| {
                let with = (0..sizes.len()).filter(|parameter| chosen >> parameter & 1 == 1);
                ClassClause { literals: with.map(|parameter| literal(parameter, bits[parameter])).collect() }
            });
            let clauses: Vec<ClassClause> = clauses.filter(|clause| !clause.literals.is_empty()).collect();
            let members: Vec<usize> = (0..sizes.len()).collect();
            let weights: Vec<Vec<usize>> = sizes.iter().map(|&classes| vec![1; classes]).collect();
            let diagram = Diagram::new(&members, &weights, &clauses).unwrap();
            let solver = Satisfiability::new(&members, &weights, &clauses).unwrap();
            prop_assert_eq!(diagram.is_empty(), solver.is_none());
            if let Some(solver) = solver {
                let fixed: Vec<Option<usize>> =
                    sizes.iter().zip(&fixed).map(|(&classes, f)| f.map(|f| f as usize % classes)).collect();
                prop_assert_eq!(diagram.holds(&fixed), solver.holds(&fixed));
                let supported = diagram.supported(&fixed);
                for (place, supported) in supported.iter().enumerate() {
                    prop_assert_eq!(supported, &solver.supported_at(place, &fixed));
                }
                prop_assert_eq!(supported, solver.supported(&fixed));
            }
        }
    }
}
