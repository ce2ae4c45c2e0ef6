//! What each strategy and family promises beyond the conformance suite, and what is refused.

mod extension;
mod families;
mod refusals;
mod sets;

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::kwise::kwise_coverage;
use paracosm_coverage::kwise_dispersion::kwise_dispersion;
use paracosm_coverage::theory::rows::RandomRows;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Aim, DiscreteFamily, GeneratorError, Request, Strategy};
use paracosm_space::rules::Rules;
use paracosm_space::{Domain, Parameter, Point, Space, Value};
use std::collections::BTreeSet;

fn mixed(dims: usize, levels: &[usize]) -> Space {
    let choice = |(i, &levels): (usize, &usize)| {
        Parameter::new(format!("c{i}"), Domain::Choice((0..levels).map(|v| Value::Number(v as f64)).collect()))
    };
    let mut parameters = Space::unit_cube(dims).parameters().to_vec();
    parameters.extend(levels.iter().enumerate().map(choice));
    Space::new(parameters).expect("a valid space")
}

fn tests(strategy: Strategy, request: &Request) -> Vec<Point> {
    strategy.build(request).unwrap_or_else(|error| panic!("{strategy}: {error}")).ask(request.budget)
}

fn refusal(strategy: Strategy, request: &Request) -> GeneratorError {
    strategy.build(request).err().expect("a refusal")
}

/// The rows of the family: what is asked for where nothing is continuous.
fn rows(request: &Request) -> Vec<Vec<usize>> {
    let mut generator = Strategy::RANDOM.build(request).expect("a family");
    generator.ask(100_000).into_iter().map(|test| test.discrete).collect()
}
