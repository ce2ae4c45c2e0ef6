//! The Sobol sequence: more even than Halton in many dimensions, best in powers of two.
//!
//! The direction numbers are those of Joe and Kuo (SIAM J. Sci. Comput. 30, 2008; file new-joe-kuo-6.21201), from the
//! crate `sobol`. Nothing else of that crate is used, because it can only go from a point to the next. Point i uses
//! the bits of i in Gray code (Antonov and Saleev, 1979), which is the order of scipy and most other implementations.
//! For every m the first 2^m points are the same as without Gray code. A coordinate is a 64-bit word. An index below
//! 2^53 uses its upper 53 bits, so that the plain points are exact.
//!
//! The origin belongs to the net of the first 2^m points, so that the sequence starts with it (Owen, "On dropping the
//! first Sobol' point", 2020). A seed shifts the sequence digitally: it flips the same random bits in all points.

use super::{Sequence, owen, radical::INDICES, unit};
use crate::seeded::{Purpose, seeded};
use crate::strategy::{Descriptor, Endless, Look, MarkShape, Method, MethodKind, Strategy};
use rand::Rng;
use sobol::params::{JoeKuoD6, JoeKuoD6Dim};

impl Strategy {
    /// The strategy "sobol", which takes the Sobol sequence; a seed shifts the sequence digitally.
    pub const SOBOL: Self = Self::of(&Descriptor {
        name: "sobol",
        about: "digital sequence for many parameters; best with a power of two of tests",
        dims: 1..=MOST_DIMS,
        look: Look::filled(0xd5_5e00, MarkShape::Diamond),
        method: Method(MethodKind::Sequence(Endless {
            first: Some(0),
            plain: true,
            fills: true,
            build: |dims, seed| Box::new(Sobol::new(dims, seed)),
        })),
    });
}

impl Strategy {
    /// The strategy "sobol-owen", which takes the Sobol sequence with Owen's nested uniform scrambling.
    pub const SOBOL_OWEN: Self = Self::of(&Descriptor {
        name: "sobol-owen",
        about: "sobol with Owen's nested scrambling: repetitions that are as even as sobol",
        dims: 1..=MOST_DIMS,
        look: Look::hollow(0xe6_9f00, MarkShape::Diamond),
        method: Method(MethodKind::Sequence(Endless {
            first: Some(0),
            plain: false,
            fills: true,
            build: |dims, seed| Box::new(Sobol::owen(dims, seed.unwrap_or(0))),
        })),
    });
}

/// The greatest number of dimensions of the Sobol sequence, for which direction numbers are known.
pub(crate) const MOST_DIMS: usize = 21_201;

/// The number of bits of an index.
const BITS: usize = 53;

/// For each bit of an index, the bits that it flips in a coordinate.
type Directions = [u64; BITS];

/// The Sobol sequence, with or without a random change.
pub(crate) struct Sobol {
    axes: Vec<Directions>,
    randomisation: Randomisation,
}

/// The random change of the sequence, with a word for each axis.
enum Randomisation {
    /// The bits to flip.
    Shift(Vec<u64>),
    /// The keys of the trees of an Owen scrambling.
    Owen(Vec<u64>),
}

impl Sobol {
    /// Makes the Sobol sequence in at most [`MOST_DIMS`] dimensions, which is digitally shifted if a seed is given.
    pub(crate) fn new(dims: usize, seed: Option<u64>) -> Self {
        let shift = seed.map_or_else(|| vec![0; dims], |seed| words(dims, seed, Purpose::Shift));
        Self { axes: directions(dims), randomisation: Randomisation::Shift(shift) }
    }

    /// Makes the Sobol sequence with Owen scrambling of a seed in at most [`MOST_DIMS`] dimensions.
    pub(crate) fn owen(dims: usize, seed: u64) -> Self {
        Self { axes: directions(dims), randomisation: Randomisation::Owen(words(dims, seed, Purpose::Scramble)) }
    }
}

impl Sequence for Sobol {
    fn len(&self) -> u64 {
        INDICES
    }

    fn point(&self, index: u64) -> Vec<f64> {
        let words = self.axes.iter().map(|directions| word(directions, index));
        match &self.randomisation {
            Randomisation::Shift(shift) => words.zip(shift).map(|(word, shift)| unit(word ^ shift)).collect(),
            Randomisation::Owen(keys) => words.zip(keys).map(|(word, &key)| unit(owen::scramble(word, key))).collect(),
        }
    }
}

/// One coordinate of the plain sequence.
fn word(directions: &Directions, index: u64) -> u64 {
    let mut gray = index ^ (index >> 1);
    let mut word = 0;
    while gray > 0 {
        word ^= directions[gray.trailing_zeros() as usize];
        gray &= gray - 1;
    }
    word
}

/// A random word for each axis.
fn words(dims: usize, seed: u64, purpose: Purpose) -> Vec<u64> {
    let mut rng = seeded(seed, purpose, 0);
    (0..dims).map(|_| rng.random()).collect()
}

/// The directions of all axes.
fn directions(dims: usize) -> Vec<Directions> {
    // The tables are packed, and the longest takes a while to unpack.
    let table = match dims {
        ..=100 => JoeKuoD6::minimal(),
        101..=1000 => JoeKuoD6::standard(),
        _ => JoeKuoD6::extended(),
    };
    // The first axis mirrors the bits and is not in the table.
    let first = std::array::from_fn(|k| 1 << (63 - k));
    [first].into_iter().chain(table.dim_params.iter().map(of_polynomial)).take(dims).collect()
}

/// The directions that follow from a primitive polynomial and its initial numbers (Joe and Kuo, equation 2).
fn of_polynomial(JoeKuoD6Dim { a, m, .. }: &JoeKuoD6Dim) -> Directions {
    let degree = m.len();
    let mut directions = [0; BITS];
    for k in 0..BITS {
        directions[k] = match m.get(k) {
            Some(&m) => u64::from(m) << (63 - k),
            None => {
                let begin = directions[k - degree] ^ (directions[k - degree] >> degree);
                // The coefficients between the first and the last coefficient, which are both 1.
                let inner = (1..degree).filter(|i| (a >> (degree - 1 - i)) & 1 == 1);
                inner.fold(begin, |word, i| word ^ directions[k - i])
            }
        };
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sixteen_bits_are_those_of_sobol_burley_in_all_its_dimensions() {
        let axes = directions(sobol_burley::NUM_DIMENSIONS as usize);
        for index in (0..1_u32 << 16).step_by(7).chain([0xffff]) {
            let gray = index ^ (index >> 1);
            for (axis, directions) in (0..).zip(&axes) {
                let theirs = sobol_burley::parts::sobol_rev(gray.reverse_bits(), axis).reverse_bits();
                assert_eq!(word(directions, index.into()) >> 32, theirs.into(), "index {index}, axis {axis}");
            }
        }
    }

    #[test]
    fn every_axis_takes_each_of_two_to_the_m_values_once() {
        // Each direction begins a bit further down: all prefixes of the matrix are triangular.
        for directions in directions(MOST_DIMS) {
            assert!((0..BITS).all(|k| directions[k].trailing_zeros() as usize == 63 - k));
        }
    }

    #[test]
    fn the_tables_continue_each_other() {
        let all = directions(MOST_DIMS);
        assert_eq!(all.len(), MOST_DIMS);
        for dims in [1, 2, 100, 101, 1000, 1001] {
            assert!(directions(dims) == all[..dims], "{dims} dimensions");
        }
    }
}
