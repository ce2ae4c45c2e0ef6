//! Rank-1 lattices for any number of coordinates and any number of points.
//!
//! Point i of n points is (i z_1 / n, .., i z_d / n) modulo 1. The generating vector z decides how even the lattice is. We take the vector
//! with the least wraparound discrepancy (Hickernell, A generalized discrepancy and quadrature error bound, Math. Comp. 67, 1998) of two
//! kinds: vectors of powers of one step (Korobov, Doklady Akademii Nauk SSSR 132, 1960), and the vector that is built component by component
//! (Sloan, Reztsov, Component-by-component construction of good lattice rules, Math. Comp. 71, 2002). The powers of a step repeat if n has many divisors:
//! with 60 points, the fifth component of each such vector equals the first one. A component may share a factor with n. Then fewer than n values
//! of this coordinate differ.
//!
//! For a lattice, the double sum of the discrepancy is a single sum, so one vector takes O(n d) time. The measure is the classical criterion
//! P_2 of lattices with weights.

use super::Sequence;
use super::per_row::PerRow;
use super::{per_row::RowSet, radical::ratio, shift::Shift};
use crate::GeneratorError;
use crate::deal::Deal;
use crate::strategy::{ANY, Descriptor, Look, MOST_COORDINATES, MarkShape, Method, MethodKind, Strategy};

/// The most factors that a search for a vector multiplies. If all vectors take more, it tries some that are evenly spread.
const MOST_FACTORS: u64 = 200_000_000;

impl Strategy {
    /// The strategy "lattice", which takes a rank-1 lattice with a low wraparound discrepancy; a seed shifts the lattice.
    pub const LATTICE: Self = Self::of(&Descriptor {
        name: "lattice",
        about: "a rank-1 lattice that is searched for, made for exactly the budget",
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
    let first = generator(dims, sizes[0]);
    let second = if sizes[1] == sizes[0] { first.clone() } else { generator(dims, sizes[1]) };
    let generators = [first, second];
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

/// Returns the better one of the best vector of powers and the vector that is built component by component.
fn generator(dims: usize, size: u64) -> Vec<u64> {
    if size < 2 {
        return vec![1; dims];
    }
    let kernel: Vec<f64> = (0..size).map(|i| ratio(i.into(), size.into())).map(|x| 1.5 - x * (1.0 - x)).collect();
    let ones = vec![1.0; kernel.len()];
    let sum = |generator: &[u64]| -> f64 {
        generator.iter().fold(ones.clone(), |of, z| times(&of, *z, &kernel)).iter().sum()
    };
    let powers =
        candidates(size, dims as u64).filter(|step| divisor(*step, size) == 1).map(|step| powers(dims, step, size));
    let powers = least(powers, |generator| sum(generator)).unwrap_or_else(|| vec![1; dims]);
    let built = by_components(dims, &kernel);
    let rank = |generator: &[u64]| (repeats(generator, size), sum(generator));
    if rank(&built) < rank(&powers) { built } else { powers }
}

/// Returns the number of components that an earlier component equals, up to a mirror image.
fn repeats(generator: &[u64], size: u64) -> usize {
    let folded: Vec<u64> = generator.iter().map(|z| *z.min(&(size - z))).collect();
    (1..folded.len()).filter(|&i| folded[..i].contains(&folded[i])).count()
}

/// Builds a vector. Each component gives the least discrepancy together with the components before it. A component does not repeat an
/// earlier one while others are left.
fn by_components(dims: usize, kernel: &[f64]) -> Vec<u64> {
    let size = kernel.len() as u64;
    let mut generator = vec![1];
    let mut products = times(&vec![1.0; kernel.len()], 1, kernel);
    for _ in 1..dims {
        let sum = |z: &u64| -> f64 { times(&products, *z, kernel).iter().sum() };
        let fresh = candidates(size, dims as u64).filter(|z| !generator.contains(z));
        let z = least(fresh, sum).or_else(|| least(candidates(size, dims as u64), sum)).unwrap_or(1);
        products = times(&products, z, kernel);
        generator.push(z);
    }
    generator
}

/// Iterates over the components that are tried. Each takes `per_candidate` times as many steps as there are points. The components z and n - z give
/// mirror images, so half of them are enough.
fn candidates(size: u64, per_candidate: u64) -> impl Iterator<Item = u64> {
    let half = size / 2;
    let tries = (MOST_FACTORS / (size * per_candidate)).clamp(1, half);
    (0..tries).map(move |i| 1 + i * half / tries)
}

/// Returns the first candidate with the least sum.
fn least<T>(candidates: impl Iterator<Item = T>, sum: impl Fn(&T) -> f64) -> Option<T> {
    let summed = candidates.map(|candidate| (sum(&candidate), candidate));
    summed.reduce(|best, next| if next.0 < best.0 { next } else { best }).map(|best| best.1)
}

/// The powers 0 to d - 1 of a step, modulo `size`.
fn powers(dims: usize, step: u64, size: u64) -> Vec<u64> {
    std::iter::successors(Some(1), |z| Some(z * step % size)).take(dims).collect()
}

/// Multiplies the products of all points by the factors of a further component. The sum of the products of all components orders
/// lattices of a size by their wraparound discrepancy.
fn times(products: &[f64], z: u64, kernel: &[f64]) -> Vec<f64> {
    let size = kernel.len() as u64;
    let mut place = 0;
    let factor = |product: &f64| {
        let product = product * kernel[place as usize];
        place = (place + z) % size;
        product
    };
    products.iter().map(factor).collect()
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

    fn lattice(dims: usize, size: usize) -> Vec<Vec<f64>> {
        let space = Space::unit_cube(dims);
        let set = Strategy::LATTICE.build(&Request::new(&space, size)).unwrap().ask(size);
        set.into_iter().map(|point| point.continuous).collect()
    }

    #[test]
    fn no_step_of_korobov_gives_a_lower_wraparound_discrepancy() {
        for (dims, size) in [(1, 7), (2, 1), (2, 2), (2, 12), (3, 30), (5, 64), (4, 97)] {
            let ours = measured(lattice(dims, size));
            let n = size as u64;
            for step in (1..=n).filter(|step| divisor(*step, n) == 1) {
                let of = |i: u64| (0..dims as u32).map(|j| ((i * step.pow(j)) % n) as f64 / n as f64).collect();
                let other = measured((0..n).map(of).collect());
                assert!(ours <= other * (1.0 + 1e-12), "{size} points in {dims} dimensions: {ours}, {other} by {step}");
            }
        }
    }

    #[test]
    fn no_two_coordinates_are_the_same_if_the_number_of_points_has_many_divisors() {
        for (dims, size) in [(5, 60), (5, 240), (7, 60), (10, 240), (5, 20), (7, 20), (10, 20)] {
            let points = lattice(dims, size);
            for axis in 0..dims {
                for other in 0..axis {
                    let same = points.iter().all(|point| (point[axis] - point[other]).abs() < 1e-12);
                    let mirrored = points.iter().all(|point| (point[axis] + point[other]).fract().abs() < 1e-12);
                    assert!(!same && !mirrored, "{size} points: axes {other} and {axis} of {dims}");
                }
            }
        }
    }

    #[test]
    fn a_large_lattice_tries_some_components_only() {
        let (dims, size) = (5, 200_000);
        assert!(candidates(size, dims as u64).count() <= 200);
        let mut generator: Vec<u64> = generator(dims, size);
        generator.dedup();
        assert_eq!(generator.len(), dims);
    }
}
