//! Simulated annealing (Kirkpatrick, Gelatt and Vecchi 1983), by argmin: a walk that goes downhill, and sometimes
//! uphill.
//!
//! A step changes each coordinate with some probability. The change is a normally distributed number that shrinks
//! with the temperature. It stops at the ends of the axis, so that these are tested too; a word is drawn again. The
//! temperature starts at half the spread of the costs so far and falls as one over the number of steps. A walk that
//! finds nothing better for a long time ends, and another starts.

use super::Adaptive;
use super::chains::{Chains, Start};
use super::cube::{Axis, mirrored};
use super::normal;
use super::solver::{Cost, Solver, lock};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use argmin::core::{CostFunction, Error, Executor, IterState};
use argmin::solver::simulatedannealing::{Anneal, SATempFunc, SimulatedAnnealing};
use rand::Rng;
use rand_pcg::Pcg64;
use std::borrow::Borrow;
use std::sync::Mutex;

impl Strategy {
    /// The strategy "anneal", which searches for a failure by simulated annealing on the robustness.
    pub const ANNEAL: Self = Self::of(&Descriptor {
        name: "anneal",
        about: "random walks towards failures, uphill now and then: for a rough robustness and cheap tests",
        dims: ANY,
        look: Look::hollow(0xf0_8080, MarkShape::Tip),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| Adaptive::build(it, request, rules, |axes, rng| Box::new(anneal(axes, rng))),
        }),
    });
}

/// The number of walks at a time.
const WALKS: usize = 4;

/// The number of steps without anything better after which a walk is heated up again, and after which it ends.
const REHEATED: u64 = 60;
const STALLED: u64 = 150;

/// The standard deviation of the first steps and of the last steps.
const FIRST_STEP: f64 = 0.3;
const LAST_STEP: f64 = 0.01;

/// Makes the search by simulated annealing.
pub(super) fn anneal(axes: Vec<Axis>, rng: Pcg64) -> Chains {
    Chains::new(axes, walk, WALKS, rng)
}

fn walk(start: Start) -> Solver {
    let Start { axes, at, trials, mut rng } = start;
    let costs: Vec<f64> = trials.iter().filter_map(|trial| trial.robustness).collect();
    let spread = costs.last().zip(costs.get(costs.len() / 4)).map_or(1.0, |(last, first)| last - first);
    let temperature = (0.5 * spread).max(1e-6);
    let steps = Mutex::new(seeded_from(&mut rng));
    let axes = axes.to_vec();
    Solver::start(move |cost| {
        let Ok(solver) = SimulatedAnnealing::new_with_rng(temperature, rng) else { return };
        let solver = solver.with_temp_func(SATempFunc::TemperatureFast);
        let solver = solver.with_reannealing_best(REHEATED).with_stall_best(STALLED);
        let walk = Walk { cost, axes, temperature, steps };
        // The run ends by itself or with the generator. Everything that it found has been tested.
        let _ = Executor::new(walk, solver).configure(|state: IterState<_, _, _, _, _, _>| state.param(at)).run();
    })
}

fn seeded_from(rng: &mut Pcg64) -> Pcg64 {
    crate::seeded::seeded(rng.random(), crate::seeded::Purpose::Search, 0)
}

/// The cost function with the steps of the walk.
struct Walk {
    cost: Cost,
    axes: Vec<Axis>,
    temperature: f64,
    steps: Mutex<Pcg64>,
}

impl CostFunction for Walk {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        self.cost.cost(at)
    }

    fn bulk_cost<P: Borrow<Vec<f64>>>(&self, places: &[P]) -> Result<Vec<f64>, Error> {
        self.cost.bulk_cost(places)
    }
}

impl Anneal for Walk {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Float = f64;

    fn anneal(&self, from: &Vec<f64>, temperature: f64) -> Result<Vec<f64>, Error> {
        let rng = &mut *lock(&self.steps);
        let heat = (temperature / self.temperature).clamp(0.0, 1.0);
        let length = LAST_STEP + (FIRST_STEP - LAST_STEP) * heat.sqrt();
        let one = rng.random_range(0..from.len());
        let share = (2.0 / from.len() as f64).max(0.3);
        let step = |(index, (&x, axis)): (usize, (&f64, &Axis))| {
            if index != one && rng.random::<f64>() >= share {
                return x;
            }
            match *axis {
                Axis::Continuous => (x + length * normal(rng)).clamp(0.0, 1.0),
                // At least to another level.
                Axis::Ordered(levels) => {
                    let by = length.max(1.0 / levels as f64);
                    mirrored(x + by * normal(rng))
                }
                Axis::Nominal(_) => rng.random(),
            }
        };
        Ok(from.iter().zip(&self.axes).enumerate().map(step).collect())
    }
}
