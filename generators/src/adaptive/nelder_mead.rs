//! The simplex search of Nelder and Mead (1965), by argmin: quick if the robustness slopes towards the failure.
//!
//! A simplex has one corner at its start. The others are a quarter of an axis away, towards the middle. It may wander
//! beyond the cube, which is mirrored there: the function stays continuous, and a failure in a corner of the box can
//! be surrounded. A simplex gives way to the next when its costs have become alike or it has had its share of tests.
//! Discrete coordinates move along their axes like others. If they make steps, a simplex ends early; the opening and
//! the next start then find the right level.

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
    /// The strategy "nelder-mead", which searches for a failure by simplices of Nelder and Mead on the robustness.
    pub const NELDER_MEAD: Self = Self::of(&Descriptor {
        name: "nelder-mead",
        about: "simplices move downhill to a failure: for few parameters and a robustness that slopes towards it",
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

/// The number of simplices that move at a time.
const SIMPLICES: usize = 4;

/// The length of the first edges, as a share of the axis.
const EDGE: f64 = 0.25;

/// The number of tests, per corner, for which costs may be alike before the simplex ends.
const PATIENCE: usize = 2;

/// The greatest number of moves of a simplex, per corner.
const MOVES: u64 = 50;

/// Makes the search by simplices of Nelder and Mead.
pub(super) fn nelder_mead(axes: Vec<Axis>, rng: Pcg64) -> Chains {
    Chains::new(axes, simplex, SIMPLICES, rng)
}

fn simplex(start: Start) -> Solver {
    let Start { at, mut rng, .. } = start;
    let mut corners = vec![at.clone()];
    for axis in 0..at.len() {
        let mut corner = at.clone();
        // A random factor, because simplices from neighbouring starts would otherwise see the same.
        let edge = EDGE * (0.8 + 0.4 * rng.random::<f64>());
        corner[axis] += if corner[axis] < 0.5 { edge } else { -edge };
        corners.push(corner);
    }
    let (moves, patience) = (MOVES * corners.len() as u64, PATIENCE * corners.len());
    Solver::start(move |cost| {
        // All corners are one batch. The solver asks for them one by one.
        let places: Vec<Vec<f64>> = corners.iter().map(|at| at.iter().copied().map(mirrored).collect()).collect();
        let Ok(known) = cost.bulk_cost(&places) else { return };
        let known = Mutex::new(known.into_iter());
        // The run ends by itself or with the generator. Everything that it found has been tested.
        let cost = cost.with_patience(patience);
        let executor = Executor::new(Mirrored { cost, known }, NelderMead::new(corners));
        let _ = executor.configure(|state: IterState<Vec<f64>, (), (), (), (), f64>| state.max_iters(moves)).run();
    })
}

/// The cost function, continued beyond the cube.
struct Mirrored {
    cost: Cost,
    /// The costs that the first calls ask for.
    known: Mutex<IntoIter<f64>>,
}

impl CostFunction for Mirrored {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        if let Some(known) = lock(&self.known).next() {
            return Ok(known);
        }
        // Only in the first calls would the solver not accept an error.
        self.cost.cost(&at.iter().copied().map(mirrored).collect())
    }
}
