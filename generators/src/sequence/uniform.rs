//! Independent uniformly random points: the baseline.
//!
//! PCG can jump ahead in logarithmic time, so that even random points are a sequence by index.

use super::Sequence;
use crate::seeded::{Purpose, seeded};
use crate::strategy::{ANY, Descriptor, Endless, Look, MarkShape, Method, MethodKind, Strategy};
use rand::Rng;
use rand_pcg::Pcg64;

impl Strategy {
    /// The strategy "random", which takes independent uniformly random points.
    pub const RANDOM: Self = Self::of(&Descriptor {
        name: "random",
        about: "independent uniform points, and with --discrete random all values: the baseline, and what statistics assume",
        dims: ANY,
        look: Look::filled(0x99_9999, MarkShape::Circle),
        method: Method(MethodKind::Sequence(Endless {
            first: None,
            plain: false,
            fills: true,
            build: |dims, seed| Box::new(Uniform::new(dims, seed.unwrap_or(0))),
        })),
    });
}

/// A sequence of uniformly random points with 53 bits per coordinate.
pub(crate) struct Uniform {
    dims: usize,
    start: Pcg64,
}

impl Uniform {
    pub(crate) fn new(dims: usize, seed: u64) -> Self {
        Self { dims, start: seeded(seed, Purpose::Points, 0) }
    }
}

impl Sequence for Uniform {
    fn len(&self) -> u64 {
        u64::MAX
    }

    fn point(&self, index: u64) -> Vec<f64> {
        let mut rng = self.start.clone();
        // A coordinate takes exactly one step of the generator.
        rng.advance(u128::from(index) * self.dims as u128);
        (0..self.dims).map(|_| rng.random()).collect()
    }
}
