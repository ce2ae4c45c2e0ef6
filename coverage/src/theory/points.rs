//! The number of points that a given dispersion needs.
//!
//! There are three kinds of answers, which must not be mixed up. No set of fewer points reaches the dispersion
//! ([`needed_by_any_set`]). So many points of a given set reach it ([`enough_of_halton`], [`enough_of_hammersley`],
//! [`enough_of_sobol`]). So many random points reach it with a given probability ([`enough_at_random`]). Above three
//! dimensions the latter two are far more than is needed: for 0.1 in five dimensions, the bound asks for 739,200 of
//! Halton's points, and by measurement 141 are enough.
//!
//! All functions take the number of dimensions and the dispersion `epsilon` that must not be exceeded. They return
//! `None` if the number of points does not fit in `u64`, and panic if `dims` is 0 or `epsilon` is not in `(0, 1)`.

/// Returns a lower bound on the number of points of every set of points whose dispersion is at most `epsilon`.
///
/// Any set of `n` points leaves an empty box of volume `1/(n+1)`. For `d >= 2` it also leaves a box of volume
/// `5/(4(n+5))` (Dumitrescu, Jiang, On the largest empty axis-parallel box amidst n points, Algorithmica 66, 2013)
/// and a box of volume `log2 d / (4(n + log2 d))` (Aistleitner, Hinrichs, Rudolf, On the size of the largest empty
/// box amidst a point set, Discrete Appl. Math. 230, 2017).
pub fn needed_by_any_set(dims: usize, epsilon: f64) -> Option<u64> {
    check(dims, epsilon);
    let log = libm::log2(dims as f64);
    // The least n at which no bound exceeds epsilon any more: each bound solved for n.
    let slabs = 1.0 / epsilon - 1.0;
    let plane = if dims >= 2 { 1.25 / epsilon - 5.0 } else { 0.0 };
    let many = if dims >= 2 { log / (4.0 * epsilon) - log } else { 0.0 };
    // Rounded down a little first: a bound must not ask for one more than it proves.
    whole((slabs.max(plane).max(many) * (1.0 - 1e-12)).ceil().max(0.0))
}

/// Returns a number of consecutive points of the Halton sequence that have a dispersion of at most `epsilon`, from any
/// index on. The dispersion of `n` points is at most `2^d p_1 ... p_d / n`, with the first `d` primes (Rote, Tichy,
/// Quasi-Monte Carlo methods and the dispersion of point sequences, Math. Comput. Modelling 23, 1996).
pub fn enough_of_halton(dims: usize, epsilon: f64) -> Option<u64> {
    check(dims, epsilon);
    whole((doubled_primes(dims) / epsilon).ceil())
}

/// Returns a number of points for which a Hammersley set has a dispersion of at most `epsilon`. The dispersion of `n`
/// points is at most `2^(d-1) p_1 ... p_(d-1) / n` (source: [`enough_of_halton`]). This holds for the set that is
/// made for `n` points, not for the beginning of a longer set.
pub fn enough_of_hammersley(dims: usize, epsilon: f64) -> Option<u64> {
    check(dims, epsilon);
    whole((doubled_primes(dims - 1) / epsilon).ceil())
}

/// Returns a number of first points of the Sobol sequence that have a dispersion of at most `epsilon`. The number is a
/// power of two. The dispersion of a `(t,m,d)`-net in base 2 is at most `2^d 2^(d-1+t) / n`. The quality parameter `t`
/// of the sequence in `d` dimensions is at most the sum of the degrees of its primitive polynomials, each less 1
/// (Sobol, On the distribution of points in a cube and the approximate evaluation of integrals, USSR Comput. Math.
/// Math. Phys. 7, 1967).
pub fn enough_of_sobol(dims: usize, epsilon: f64) -> Option<u64> {
    check(dims, epsilon);
    let t = sobol_quality(dims)?;
    let exponent = 2.0 * dims as f64 - 1.0 + t as f64 - libm::log2(epsilon);
    // A net has at least 2^t points.
    let m = (exponent * (1.0 - 1e-15)).ceil().max(t as f64);
    if m < 64.0 { Some(1 << m as u64) } else { None }
}

/// Returns a number of uniformly random points that have a dispersion of at most `epsilon` with probability at least
/// `1 - delta`. The number follows from this bound:
///
/// ```text
/// P(dispersion > epsilon) <= (M(M+1)/2)^d (1 - epsilon + 2d/M)^n     for any whole M > 2d/epsilon,
/// ```
///
/// The reason: a box of volume epsilon holds a box of a grid with `M` cells a side whose volume is smaller by at most
/// `2d/M`. The bound holds for every `M`; the function searches for the `M` that needs the fewest points.
///
/// # Panics
/// As for the other functions of this module; also if `delta` is not in `(0, 1)`.
pub fn enough_at_random(dims: usize, epsilon: f64, delta: f64) -> Option<u64> {
    check(dims, epsilon);
    assert!(delta > 0.0 && delta < 1.0, "delta is {delta}, expected a number between 0 and 1");
    let d = dims as f64;
    let least = 2.0 * d / epsilon;
    let points = |factor: f64| {
        let m = (least * factor).ceil().max(least.floor() + 1.0);
        let boxes = d * (libm::log(m) + libm::log(m + 1.0) - std::f64::consts::LN_2);
        (boxes - libm::log(delta)) / -libm::log1p(2.0 * d / m - epsilon)
    };
    // A grid with few cells wastes volume. Many cells make too many boxes. The best number is in between.
    let found = (1..400).map(|step| points(libm::exp2(f64::from(step) / 20.0))).fold(f64::INFINITY, f64::min);
    whole(found.ceil())
}

/// `2^dims` times the product of the first `dims` primes.
fn doubled_primes(dims: usize) -> f64 {
    let primes = (2u32..).filter(|n| (2..*n).take_while(|i| i * i <= *n).all(|i| n % i != 0));
    // Beyond a hundred dimensions the product is infinite anyhow.
    primes.take(dims.min(200)).map(|prime| 2.0 * f64::from(prime)).product()
}

/// The sum over the first `dims` dimensions of the degrees of their primitive polynomials over GF(2), each less 1.
/// The first dimension has no polynomial. `None` if a polynomial has a degree above 30.
fn sobol_quality(dims: usize) -> Option<u64> {
    let mut left = dims as u64 - 1;
    let mut sum = 0;
    for degree in 1u64..=30 {
        let polynomials = totient((1 << degree) - 1) / degree;
        let taken = left.min(polynomials);
        sum += taken * (degree - 1);
        left -= taken;
        if left == 0 {
            return Some(sum);
        }
    }
    None
}

/// The number of integers up to `n` that have no factor in common with `n`.
fn totient(mut n: u64) -> u64 {
    let mut coprime = n;
    let mut factor = 2;
    while factor * factor <= n {
        if n.is_multiple_of(factor) {
            coprime -= coprime / factor;
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        factor += 1;
    }
    if n > 1 { coprime - coprime / n } else { coprime }
}

fn check(dims: usize, epsilon: f64) {
    assert!(dims > 0, "points need a dimension");
    assert!(epsilon > 0.0 && epsilon < 1.0, "epsilon is {epsilon}, expected a number between 0 and 1");
}

/// Converts a number to `u64`, if it fits.
fn whole(number: f64) -> Option<u64> {
    (number < u64::MAX as f64).then_some(number as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_s_example_comes_out() {
        // 2^5 * 2310 / 0.1
        assert_eq!(enough_of_halton(5, 0.1), Some(739_200));
        // 2^4 * 210 / 0.1
        assert_eq!(enough_of_hammersley(5, 0.1), Some(33_600));
        assert_eq!(enough_of_hammersley(1, 0.1), Some(10));
    }

    #[test]
    fn the_quality_of_sobol_grows_with_the_degrees_of_its_polynomials() {
        // 1, 1, 2, 2, 6, 6, 18 polynomials of the degrees 1 to 7.
        let expected = [(1, 0), (2, 0), (3, 1), (4, 3), (5, 5), (6, 8), (7, 11), (13, 35), (14, 40)];
        for (dims, t) in expected {
            assert_eq!(sobol_quality(dims), Some(t), "{dims}");
        }
        // t = 0: at most 2^2 * 2 / n.
        assert_eq!(enough_of_sobol(2, 0.1), Some(128));
    }

    #[test]
    fn no_set_of_a_known_dispersion_has_fewer_points_than_any_set_needs() {
        // A point in the middle of a segment leaves halves; n points n + 1 parts.
        assert_eq!(needed_by_any_set(1, 0.5), Some(1));
        assert_eq!(needed_by_any_set(1, 0.1), Some(9));
        assert_eq!(needed_by_any_set(1, 0.3), Some(3));
        // 5/(4(n+5)) takes over in the plane, the logarithm in very many dimensions.
        assert_eq!(needed_by_any_set(2, 0.01), Some(120));
        assert_eq!(needed_by_any_set(1 << 16, 0.01), Some(384));
    }

    #[test]
    fn random_points_ask_for_more_the_smaller_what_may_remain_and_the_surer_it_must_be() {
        let points = |dims, epsilon, delta| enough_at_random(dims, epsilon, delta).unwrap();
        assert!(points(2, 0.1, 0.05) < points(2, 0.05, 0.05));
        assert!(points(2, 0.1, 0.05) < points(2, 0.1, 0.01));
        assert!(points(2, 0.1, 0.05) < points(3, 0.1, 0.05));
        // The bound holds for every M, hence for one that is easy to work out: d = 1, epsilon = 1/2, M = 8,
        // 36 (3/4)^n <= 1/2 from n = 15 on.
        assert!((1..=15).contains(&points(1, 0.5, 0.5)));
        // No bound asks for less than any set needs.
        assert!(points(3, 0.01, 0.5) > needed_by_any_set(3, 0.01).unwrap());
    }

    #[test]
    fn numbers_that_cannot_be_counted_are_none() {
        assert_eq!(enough_of_halton(40, 0.1), None);
        assert_eq!(enough_of_hammersley(1000, 0.1), None);
        assert_eq!(enough_of_sobol(20_000, 0.5), None);
    }
}
