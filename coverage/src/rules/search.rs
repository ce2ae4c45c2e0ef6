//! Answers for groups whose diagram would be too large: by conflict-driven search.
//!
//! A solution answers many questions at once: those that were found are kept, and the solver is asked only what
//! none of them shows. The answers do not depend on which solutions those are.

use super::encoding::Encoding;
use super::group::ClassClause;
use std::fmt;
use std::sync::Mutex;

/// How many solutions are kept.
const POOL: usize = 1 << 10;

struct State {
    encoding: Encoding,
    /// Solutions as classes of the members.
    pool: Vec<Vec<usize>>,
    /// How many solutions were found.
    found: usize,
}

impl State {
    fn solve(&mut self, fixed: &[Option<usize>]) -> Option<Vec<usize>> {
        let solution = self.encoding.solve(fixed, &[])?;
        if self.pool.len() < POOL {
            self.pool.push(solution.clone());
        } else {
            self.pool[self.found % POOL] = solution.clone();
        }
        self.found += 1;
        Some(solution)
    }
}

/// A group as a satisfiability problem.
pub(super) struct Search {
    sizes: Vec<usize>,
    state: Mutex<State>,
}

impl fmt::Debug for Search {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Search").field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

fn agrees(solution: &[usize], fixed: &[Option<usize>]) -> bool {
    solution.iter().zip(fixed).all(|(class, fixed)| fixed.is_none_or(|fixed| fixed == *class))
}

impl Search {
    /// The clauses among members with so many classes; none if they cannot be kept.
    pub(super) fn new(members: &[usize], sizes: &[Vec<usize>], clauses: &[ClassClause]) -> Option<Self> {
        let sizes: Vec<usize> = sizes.iter().map(Vec::len).collect();
        let mut encoding = Encoding::new(sizes.iter().copied(), 0);
        let place = |parameter: usize| members.binary_search(&parameter).expect("clauses are among the members");
        for clause in clauses {
            encoding.demand(clause, None, place);
        }
        let mut state = State { encoding, pool: Vec::new(), found: 0 };
        state.solve(&vec![None; sizes.len()])?;
        Some(Self { sizes, state: Mutex::new(state) })
    }

    /// Whether a solution has the fixed classes.
    pub(super) fn holds(&self, fixed: &[Option<usize>]) -> bool {
        let mut state = self.state.lock().expect("no question panics");
        state.pool.iter().any(|solution| agrees(solution, fixed)) || state.solve(fixed).is_some()
    }

    /// For each member and class, whether a solution has it with the fixed ones.
    pub(super) fn supported(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        let mut state = self.state.lock().expect("no question panics");
        let mut supported: Vec<Vec<bool>> = self.sizes.iter().map(|&classes| vec![false; classes]).collect();
        let show = |supported: &mut Vec<Vec<bool>>, solution: &[usize]| {
            supported.iter_mut().zip(solution).for_each(|(supported, &class)| supported[class] = true);
        };
        let mut some = false;
        for solution in state.pool.iter().filter(|solution| agrees(solution, fixed)) {
            some = true;
            show(&mut supported, solution);
        }
        if !some {
            let Some(solution) = state.solve(fixed) else { return supported };
            show(&mut supported, &solution);
        }
        let mut asked = fixed.to_vec();
        for place in (0..fixed.len()).filter(|&place| fixed[place].is_none()) {
            for class in 0..self.sizes[place] {
                if !supported[place][class] {
                    asked[place] = Some(class);
                    if let Some(solution) = state.solve(&asked) {
                        show(&mut supported, &solution);
                    }
                }
            }
            asked[place] = None;
        }
        supported
    }
}

#[cfg(test)]
mod tests {
    use super::super::diagram::Diagram;
    use super::super::group::ClassLiteral;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn search_and_diagram_answer_alike(
            sizes in prop::collection::vec(1..=4usize, 2..=6),
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
            let search = Search::new(&members, &weights, &clauses);
            prop_assert_eq!(diagram.is_empty(), search.is_none());
            if let Some(search) = search {
                let fixed: Vec<Option<usize>> =
                    sizes.iter().zip(&fixed).map(|(&classes, f)| f.map(|f| f as usize % classes)).collect();
                prop_assert_eq!(diagram.holds(&fixed), search.holds(&fixed));
                prop_assert_eq!(diagram.supported(&fixed), search.supported(&fixed));
            }
        }
    }
}
