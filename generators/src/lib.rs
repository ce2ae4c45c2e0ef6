//! Builds the strategies that propose tests.
//!
//! A [`Generator`] proposes tests and is told their results; a [`Strategy`] is the name of a method that a generator
//! uses. The proposals follow section 3.2 of the paper (Majumdar et al., arXiv 1902.01084). A family of rows covers
//! the discrete parameters k-wise. Every row gets its own set of points, which leaves no large hole in the continuous
//! parameters.
//!
//! The same request always gives the same tests, on every machine: all chance comes from the seed. The tests of
//! adaptive strategies also depend on the results, their order, and the number of tests in each request. Strategies
//! with a model (`gp-cmaes bayes boundary auto`) repeat their tests to the last bit only on the same kind of
//! processor. `anneal` repeats them only if the mathematical library of the system is the same, because argmin uses
//! it.
//!
//! ```
//! use paracosm_space::Space;
//! use paracosm_generators::{Request, Strategy};
//!
//! let space = Space::unit_cube(2);
//! let mut generator = Strategy::HALTON.build(&Request::new(&space, 500))?;
//! let tests = generator.ask(2);
//! assert_eq!(tests[0].continuous, [1.0 / 2.0, 1.0 / 3.0]);
//! assert_eq!(tests[1].continuous, [1.0 / 4.0, 2.0 / 3.0]);
//! # Ok::<(), paracosm_generators::GeneratorError>(())
//! ```

mod adaptive;
mod aim;
mod all;
mod bandit;
mod best;
mod build;
pub mod covering;
mod deal;
mod discrete;
mod error;
mod family;
pub mod functions;
mod given;
mod greedy;
mod independent;
mod keeping;
mod mixed;
pub mod optimised;

mod own;
mod point_sets;
mod request;
mod seeded;
mod sequence;
mod spread;
mod strategy;

pub use adaptive::{FailingShare, FailureModel};
pub use aim::Aim;
pub use all::Purpose;
pub use bandit::Bandit;
pub use discrete::DiscreteFamily;
pub use error::GeneratorError;
pub use point_sets::PointSets;
pub use request::{OwnStrategy, Request};
pub use strategy::{BuildOwn, Descriptor, Look, MarkShape, Method, Strategy};

use paracosm_space::Point;

/// A source of tests that may learn from the results of the tests.
pub trait Generator: Send {
    /// Returns at most `n` new tests.
    ///
    /// There may be fewer than `n`. There are none once the strategy has nothing more to propose. Continuous
    /// coordinates are in `[0,1)`.
    fn ask(&mut self, n: usize) -> Vec<Point>;

    /// Takes the results of tests, with a robustness for each test. A robustness is below 0 if a requirement was
    /// violated, and `None` if the test ended in an error.
    ///
    /// Open-loop strategies ignore the results. Adaptive strategies use every result, whatever it is. A test may
    /// remain without a result.
    fn tell(&mut self, _tests: &[Point], _robustness: &[Option<f64>]) {}

    /// Returns the reason why the generator can propose no more tests, if it broke. The strategies of this crate do not break.
    fn failure(&self) -> Option<String> {
        None
    }
}
