//! The R-sequence: a Kronecker sequence that generalises the golden section (Roberts, "The Unreasonable
//! Effectiveness of Quasirandom Sequences", 2018).
//!
//! Point i is 1/2 + i a modulo 1, where a = (1/g, 1/g^2, ..., 1/g^d) and g is the root above 1 of x^(d+1) = x + 1:
//! the golden ratio for d = 1, the plastic number for d = 2. Roberts' program starts with index 1 of this sequence.
//! Index 0 is the centre of the cube.
//!
//! A coordinate is an integer in units of 2^-64, and wraps round as integers do. So no precision is lost at large
//! indices: a stretch of the sequence is its beginning, shifted. The steps have the precision of a double, which
//! begins to matter after some 2^26 points.

use super::{Sequence, radical::INDICES, unit};
use crate::seeded::{Purpose, seeded};
use crate::strategy::{ANY, Descriptor, Endless, Look, MarkShape, Method, MethodKind, Strategy};
use rand::Rng;

impl Strategy {
    /// The strategy "kronecker", which takes the R-sequence; with a seed the sequence starts at a random point.
    pub const KRONECKER: Self = Self::of(&Descriptor {
        name: "kronecker",
        about: "golden steps on every axis: a sequence of any length, for few parameters",
        dims: ANY,
        look: Look::filled(0x00_9e73, MarkShape::Square),
        method: Method(MethodKind::Sequence(Endless {
            first: Some(0),
            plain: true,
            fills: true,
            build: |dims, seed| Box::new(Kronecker::new(dims, seed)),
        })),
    });
}

/// The R-sequence, a Kronecker sequence, from a start point on.
pub(crate) struct Kronecker {
    /// The start and the step of each axis.
    axes: Vec<(u64, u64)>,
}

impl Kronecker {
    /// Makes the R-sequence that starts at the centre of the cube, or with a seed at a random point.
    pub(crate) fn new(dims: usize, seed: Option<u64>) -> Self {
        let mut rng = seed.map(|seed| seeded(seed, Purpose::Shift, 0));
        let mut start = || rng.as_mut().map_or(1 << 63, Rng::random);
        Self { axes: steps(dims).map(|step| (start(), step)).collect() }
    }
}

impl Sequence for Kronecker {
    fn len(&self) -> u64 {
        INDICES
    }

    fn point(&self, index: u64) -> Vec<f64> {
        self.axes.iter().map(|&(start, step)| unit(start.wrapping_add(index.wrapping_mul(step)))).collect()
    }
}

/// The steps of the axes, in units of 2^-64.
fn steps(dims: usize) -> impl Iterator<Item = u64> {
    let ratio = ratio(dims);
    let unit = libm::ldexp(1.0, 64);
    std::iter::successors(Some(1.0 / ratio), move |power| Some(power / ratio))
        .take(dims)
        .map(move |a| (a * unit) as u64)
}

/// The root above 1 of x^(dims+1) = x + 1.
fn ratio(dims: usize) -> f64 {
    let exponent = 1.0 / (dims as f64 + 1.0);
    // Each iteration reduces the error by a factor of at least 3.
    (0..64).fold(2.0, |x, _| libm::pow(1.0 + x, exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratios_are_the_published_ones() {
        let published = [1.618_033_988_749_895, 1.324_717_957_244_746, 1.220_744_084_605_759_5];
        for (dims, published) in (1..).zip(published) {
            assert!((ratio(dims) - published).abs() < 1e-15);
        }
    }
}
