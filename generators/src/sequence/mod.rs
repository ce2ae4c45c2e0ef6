//! Point sets of the unit cube, by index.
//!
//! A sequence computes its points from their index alone and remembers nothing. So it does not matter in what
//! portions points are asked for, a campaign resumes where it stopped without going through what came before,
//! and every row of a discrete family can be given a stretch of its own.

mod halton;
mod lhs;
mod sobol;
mod uniform;

pub(crate) use halton::Halton;
pub(crate) use lhs::Lhs;
pub(crate) use sobol::Sobol;
pub(crate) use uniform::Uniform;

/// Points of `[0,1)^d`, numbered from 0.
pub(crate) trait Sequence: Send {
    /// How many points there are.
    fn len(&self) -> u64;

    /// The point at `index`, which is below [`Sequence::len`].
    fn point(&self, index: u64) -> Vec<f64>;
}
