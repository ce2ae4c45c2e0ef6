//! Particle swarm optimisation (Kennedy and Eberhart 1995; the weights of Clerc's standard), by argmin.
//!
//! Every particle is drawn to the best place that it has seen and to the best place that any particle has seen. A
//! whole swarm is one batch. The first swarm starts at the best tests so far, which are not tested again. A swarm
//! whose moves bring nothing better gives way to the next; later swarms start at random places. A discrete coordinate
//! moves along its axis, and its value is the level whose slice it is in.

use super::Adaptive;
use super::chains::{Chains, Start};
use super::cube::Axis;
use super::solver::{Cost, Solver};
use super::{anywhere, normal};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use argmin::core::{CostFunction, Executor, PopulationState};
use argmin::solver::particleswarm::{Particle, ParticleSwarm};
use rand_pcg::Pcg64;

impl Strategy {
    /// The strategy "pso", which searches for a failure by particle swarms on the robustness.
    pub const PSO: Self = Self::of(&Descriptor {
        name: "pso",
        about: "swarms drawn to the worst tests so far: for a rough robustness and many tests at a time",
        dims: ANY,
        look: Look::hollow(0xf0_8080, MarkShape::Square),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| Adaptive::build(it, request, rules, |axes, rng| Box::new(pso(axes, rng))),
        }),
    });
}

/// The number of moves of a swarm before the next starts: by then it has come to rest or never will.
const MOVES: u64 = 40;

/// The number of moves for which the best costs may be alike before the next swarm starts.
const PATIENCE: usize = 5;

/// The standard deviation of the first velocities.
const FIRST_STEP: f64 = 0.2;

/// Makes the search by particle swarms. It runs one swarm at a time, of `10 + 2 sqrt(d)` particles, of which 16 are
/// about a batch.
pub(super) fn pso(axes: Vec<Axis>, rng: Pcg64) -> Chains {
    Chains::new(axes, swarm, 1, rng)
}

fn swarm(start: Start) -> Solver {
    let Start { axes, at, trials, mut rng } = start;
    let size = 10 + (2.0 * (axes.len() as f64).sqrt()) as usize;
    let mut velocity = || -> Vec<f64> { axes.iter().map(|_| FIRST_STEP * normal(&mut rng)).collect() };
    // The first swarm starts at the best tests. The start of a later swarm is a random place.
    let is_first = trials.first().is_some_and(|best| best.at == at);
    let known = trials.iter().filter(|_| is_first).take(size);
    let known: Vec<_> = known.map(|trial| Particle::new(trial.at.clone(), trial.cost(), velocity())).collect();
    let velocities: Vec<Vec<f64>> = (known.len()..size).map(|_| velocity()).collect();
    let places: Vec<Vec<f64>> = (known.len()..size).map(|_| anywhere(axes, &mut rng)).collect();
    let bounds = (vec![0.0; axes.len()], vec![1.0; axes.len()]);
    Solver::start(move |cost: Cost| {
        let mut particles = known;
        if !places.is_empty() {
            let Ok(costs) = cost.bulk_cost(&places) else { return };
            let new = places.into_iter().zip(costs).zip(velocities);
            particles.extend(new.map(|((at, cost), velocity)| Particle::new(at, cost, velocity)));
        }
        let solver = ParticleSwarm::new(bounds, size).with_rng_generator(rng);
        // The run ends by itself or with the generator. Everything that it found has been tested.
        let executor = Executor::new(cost.with_patience(PATIENCE), solver);
        let _ = executor.configure(|state: PopulationState<_, _>| state.population(particles).max_iters(MOVES)).run();
    })
}
