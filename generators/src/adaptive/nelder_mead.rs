//! The simplex search of Nelder and Mead (1965), by argmin: quick where the robustness slopes towards the failure.
//!
//! A simplex has a corner at its start and the others a quarter of the axis away, towards the middle. It may wander beyond
//! the cube, which is mirrored there: the function stays continuous, and a failure in a corner of the box can be surrounded.
//! A simplex whose costs have become alike, or that had its share of tests, gives way to the next. Discrete coordinates
//! move along their axes like others; where they make steps a simplex ends early, and what finds the right level is the
//! opening and the next start.

use super::Adaptive;
use super::chains::{Chains, Start};
use super::cube::{Axis, mirrored};
use super::solver::{Cost, Solver, lock};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use argmin::core::{CostFunction, Error, Executor, IterState};
use argmin::solver::neldermead::NelderMead;
use rand::Rng;
use rand_pcg::Pcg64;
use std::sync::Mutex;
use std::vec::IntoIter;

impl Strategy {
    /// Nelder and Mead's simplices on the robustness.
    pub const NELDER_MEAD: Self = Self::of(&Descriptor {
        name: "nelder-mead",
        about: "simplices downhill to a failure: few parameters and a robustness that slopes",
        dims: ANY,
        look: Look::hollow(0xf0_8080, MarkShape::Triangle),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| {
                Adaptive::build(it, request, rules, |axes, rng| Box::new(nelder_mead(axes, rng)))
            },
        }),
    });
}

/// How many simplices move at a time.
const SIMPLICES: usize = 4;

/// The first edge, as a share of the axis.
const EDGE: f64 = 0.25;

/// For how many tests, for each of its corners, costs may be alike before it ends.
const PATIENCE: usize = 2;

/// How often a simplex moves for each of its corners.
const MOVES: u64 = 50;

/// The search.
pub(super) fn nelder_mead(axes: Vec<Axis>, rng: Pcg64) -> Chains {
    Chains::new(axes, simplex, SIMPLICES, rng)
}

fn simplex(start: Start) -> Solver {
    let Start { at, mut rng, .. } = start;
    let mut corners = vec![at.clone()];
    for axis in 0..at.len() {
        let mut corner = at.clone();
        // A little chance, or simplices from neighbouring starts would see the same.
        let edge = EDGE * (0.8 + 0.4 * rng.random::<f64>());
        corner[axis] += if corner[axis] < 0.5 { edge } else { -edge };
        corners.push(corner);
    }
    let (moves, patience) = (MOVES * corners.len() as u64, PATIENCE * corners.len());
    Solver::start(move |cost| {
        // All corners are one batch; the solver asks for them one by one.
        let places: Vec<Vec<f64>> = corners.iter().map(|at| at.iter().copied().map(mirrored).collect()).collect();
        let Ok(known) = cost.bulk_cost(&places) else { return };
        let known = Mutex::new(known.into_iter());
        // It ends by itself or with the generator; what it found has been tested.
        let cost = cost.with_patience(patience);
        let executor = Executor::new(Mirrored { cost, known }, NelderMead::new(corners));
        let _ = executor.configure(|state: IterState<Vec<f64>, (), (), (), (), f64>| state.max_iters(moves)).run();
    })
}

/// The cost function beyond the cube.
struct Mirrored {
    cost: Cost,
    /// What the first calls will ask for.
    known: Mutex<IntoIter<f64>>,
}

impl CostFunction for Mirrored {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        if let Some(known) = lock(&self.known).next() {
            return Ok(known);
        }
        // The first calls are those where the solver takes no failure for an answer.
        self.cost.cost(&at.iter().copied().map(mirrored).collect())
    }
}
