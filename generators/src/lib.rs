//! Strategies that propose tests.
//!
//! A [`Generator`] is asked for tests and told how they went; a [`Strategy`] is one by name. What it proposes
//! follows section 3.2 of the paper (Majumdar et al., arXiv 1902.01084): a family of rows covers the discrete
//! parameters k-wise, and every row gets a set of points of its own that leaves no large hole in the continuous
//! ones.
//!
//! The same request always gives the same tests, on every machine: all chance comes from the seed. Adaptive strategies
//! also go by what they are told, in which order, and how many tests they are asked for at a time. Those with a model
//! (`bayes boundary auto`) repeat their tests to the last bit on processors of one kind only, and those by argmin
//! (`anneal`) where the mathematical library of the system is the same.
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
mod build;
pub mod covering;
mod deal;
mod discrete;
mod error;
mod family;
pub mod functions;
mod greedy;
mod independent;
mod mixed;
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
pub use request::Request;
pub use strategy::{BuildOwn, Descriptor, Look, MarkShape, Method, Strategy};

use paracosm_space::Point;

/// A source of tests that may learn from how they went.
pub trait Generator: Send {
    /// The next tests, at most `n`.
    ///
    /// There may be fewer, and there are none once the strategy has nothing more to propose. Continuous
    /// coordinates are in `[0,1)`.
    fn ask(&mut self, n: usize) -> Vec<Point>;

    /// How tests went: one robustness for each, below 0 where a requirement was violated, `None` where the test
    /// ended in an error.
    ///
    /// Open-loop strategies ignore it; adaptive ones go by it, whatever it is. A test may stay untold.
    fn tell(&mut self, _tests: &[Point], _robustness: &[Option<f64>]) {}
}
