//! Rank-1 lattices with the step of Korobov (Doklady Akademii Nauk SSSR 132, 1960), for any number of coordinates.
//!
//! Point i of n points is (i z_1 / n, .., i z_d / n) modulo 1, where z_j is the step to the power j - 1, modulo n. A step
//! without a common divisor with n gives every coordinate the values 0, 1/n, .., (n-1)/n. The step decides how even the
//! lattice is. We take the step with the least wraparound discrepancy (Hickernell, A generalized discrepancy and quadrature error
//! bound, Math. Comp. 67, 1998). For a lattice, the double sum of this measure is a single sum, so one step takes O(n d) time.
//! The measure is the classical criterion P_2 of lattices with weights.

use super::Sequence;
use super::per_row::PerRow;
use super::{per_row::RowSet, radical::ratio, shift::Shift};
use crate::GeneratorError;
use crate::deal::Deal;
use crate::strategy::{ANY, Descriptor, Look, MOST_COORDINATES, MarkShape, Method, MethodKind, Strategy};

/// The most factors that the search for a step multiplies. If all steps take more, it tries some that are evenly spread.
const MOST_FACTORS: u64 = 400_000_000;

impl Strategy {
    /// The strategy "lattice", which takes the Korobov lattice with the least wraparound discrepancy; a seed shifts the lattice.
    pub const LATTICE: Self = Self::of(&Descriptor {
        name: "lattice",
        about: "the rank-1 lattice with the best step, made for exactly the budget",
        dims: ANY,
        look: Look::filled(0x8c_510a, MarkShape::Diamond),
        method: Method(MethodKind::Sets { plain: true, in_a_part: None, build }),
    });
}

fn build(dims: usize, seed: Option<u64>, deal: Deal) -> Result<Box<dyn Sequence>, GeneratorError> {
    let points = deal.tests_of(0);
    if points.saturating_mul(dims as u64) > MOST_COORDINATES {
        return Err(GeneratorError::SetLimit { strategy: Strategy::LATTICE.name(), points, dims });
    }
    let sizes = [0, deal.rows - 1].map(|row| deal.tests_of(row));
    let generators = sizes.map(|size| generator(dims, size));
    Ok(Box::new(PerRow::new(deal, Lattice { sizes, generators, seed })))
}

/// The lattices of all rows, which have two sizes at most. The lattice of the first row is unshifted without a seed; all other
/// lattices are shifted.
struct Lattice {
    sizes: [u64; 2],
    /// The generating vector for each size.
    generators: [Vec<u64>; 2],
    seed: Option<u64>,
}

impl RowSet for Lattice {
    fn point(&self, row: u64, size: u64, index: u64) -> Vec<f64> {
        let generator = &self.generators[usize::from(size != self.sizes[0])];
        let point = generator.iter().map(|&z| ratio((index * z % size).into(), size.into()));
        Shift::of_row(generator.len(), self.seed, row).apply(point)
    }
}

/// Returns the generating vector of the best step for `size` points.
fn generator(dims: usize, size: u64) -> Vec<u64> {
    let kernel: Vec<f64> = (0..size).map(|i| ratio(i.into(), size.into())).map(|x| 1.5 - x * (1.0 - x)).collect();
    let mut best = (f64::INFINITY, powers(dims, 1, size));
    for step in steps(dims, size) {
        let generator = powers(dims, step, size);
        let sum = sum_of_products(&generator, &kernel);
        if sum < best.0 {
            best = (sum, generator);
        }
    }
    best.1
}

/// Iterates over the steps that are tried. The steps a and n - a give mirror images, so half of the steps are enough.
fn steps(dims: usize, size: u64) -> impl Iterator<Item = u64> {
    let half = size / 2;
    let tries = (MOST_FACTORS / (size * dims as u64).max(1)).clamp(1, half.max(1));
    let spread = (0..tries).map(move |i| 1 + i * half / tries);
    spread.filter_map(move |from| (from..=half.max(1)).find(|&step| divisor(step, size) == 1))
}

/// The powers 0 to d - 1 of a step, modulo `size`.
fn powers(dims: usize, step: u64, size: u64) -> Vec<u64> {
    let powers = std::iter::successors(Some(1), |z| Some(z * step % size.max(1)));
    powers.take(dims).collect()
}

/// The sum over all points of the product of the kernel's values. It orders lattices of a size by their wraparound discrepancy.
fn sum_of_products(generator: &[u64], kernel: &[f64]) -> f64 {
    let size = kernel.len() as u64;
    let mut places = vec![0; generator.len()];
    let mut sum = 0.0;
    for _ in 0..size {
        let mut product = 1.0;
        for (place, z) in places.iter_mut().zip(generator) {
            product *= kernel[*place as usize];
            *place += z;
            if *place >= size {
                *place -= size;
            }
        }
        sum += product;
    }
    sum
}

/// The greatest common divisor.
fn divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Request;
    use paracosm_coverage::l2::wraparound;
    use paracosm_coverage::{Deadline, PointSet};
    use paracosm_space::Space;

    fn measured(points: Vec<Vec<f64>>) -> f64 {
        wraparound(&PointSet::new(points[0].len(), points).unwrap(), Deadline::never()).unwrap()
    }

    #[test]
    fn no_other_step_gives_a_lower_wraparound_discrepancy() {
        for (dims, size) in [(1, 7), (2, 1), (2, 2), (2, 12), (3, 30), (5, 64), (4, 97)] {
            let space = Space::unit_cube(dims);
            let set = Strategy::LATTICE.build(&Request::new(&space, size)).unwrap().ask(size);
            let ours = measured(set.into_iter().map(|point| point.continuous).collect());
            let n = size as u64;
            for step in (1..=n).filter(|step| divisor(*step, n) == 1) {
                let of = |i: u64| (0..dims as u32).map(|j| ((i * step.pow(j)) % n) as f64 / n as f64).collect();
                let other = measured((0..n).map(of).collect());
                assert!(ours <= other * (1.0 + 1e-12), "{size} points in {dims} dimensions: {ours}, {other} by {step}");
            }
        }
    }

    #[test]
    fn a_large_lattice_tries_some_steps_and_each_coordinate_is_even() {
        let (dims, size) = (5, 200_000);
        assert!(steps(dims, size).count() <= 400);
        let mut firsts: Vec<u64> = generator(dims, size);
        assert!(firsts.iter().all(|&z| divisor(z, size) == 1), "{firsts:?}");
        firsts.dedup();
        assert_eq!(firsts.len(), dims);
    }
}
