//! The beta distribution: the regularised incomplete beta function and its inverse.
//!
//! Users can choose this distribution. Exact confidence intervals of proportions and the quantiles of Student's t
//! distribution are also computed from it.

/// The greatest number of terms of the continued fraction. More are never needed: their number grows as the square
/// root of the larger shape.
const MOST_TERMS: usize = 1_000_000;

/// Returns the probability that a beta-distributed number with the shapes `a` and `b` is at most `x`. This is the
/// regularised incomplete beta function I_x(a, b). The shapes `a` and `b` are above 0.
///
/// It is computed by the continued fraction of DLMF 8.17.22, evaluated as by Lentz (Applied Optics 15, 1976), and by
/// the symmetry I_x(a, b) = 1 - I_(1-x)(b, a).
pub fn beta_cdf(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    if x < (a + 1.0) / (a + b + 2.0) {
        power(a, b, x) * fraction(a, b, x) / a
    } else {
        1.0 - power(a, b, x) * fraction(b, a, 1.0 - x) / b
    }
}

/// Returns the number below which a share `p` of the beta distribution with the shapes `a` and `b` lies. This is the
/// inverse of [`beta_cdf`].
pub fn beta_quantile(a: f64, b: f64, p: f64) -> f64 {
    if p <= 0.0 {
        0.0
    } else if p >= 1.0 {
        1.0
    } else if p <= beta_cdf(a, b, 0.5) {
        small_quantile(a, b, p)
    } else {
        1.0 - small_quantile(b, a, 1.0 - p)
    }
}

/// Returns a quantile of at most one half, with all its digits. Newton's method is applied to ln I as a function of ln
/// x, which is nearly straight in the lower tail. A bracket keeps the result; bisection narrows it if Newton's method
/// does not.
fn small_quantile(a: f64, b: f64, p: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    let mut x = a / (a + b);
    for step in 1.. {
        let found = beta_cdf(a, b, x);
        if found < p {
            low = x;
        } else {
            high = x;
        }
        // The bit patterns of floats from 0 to 1 have the same order as the numbers.
        let (below, above) = (low.to_bits(), high.to_bits());
        if above - below <= 1 {
            break;
        }
        let slope = power(a, b, x) / ((1.0 - x) * found);
        let next = x * libm::exp((libm::log(p) - libm::log(found)) / slope);
        if (next - x).abs() <= f64::EPSILON * x {
            break;
        }
        let helps = low < next && next < high && step % 4 != 0;
        x = if helps { next } else { f64::from_bits(below + (above - below) / 2) };
    }
    x
}

/// Returns x^a (1-x)^b / B(a, b). The saddle-point expansion of Loader (Fast and accurate computation of binomial
/// probabilities, 2000) avoids cancellation for large shapes.
fn power(a: f64, b: f64, x: f64) -> f64 {
    let n = a + b;
    let exponent =
        stirling_error(n) - stirling_error(a) - stirling_error(b) - deviance(a, n * x) - deviance(b, n * (1.0 - x));
    libm::exp(exponent) * (a * b / (std::f64::consts::TAU * n)).sqrt()
}

/// Returns the error of Stirling's approximation of ln Γ(n + 1), which is the exact value less the approximation.
fn stirling_error(n: f64) -> f64 {
    if n <= 15.0 {
        let half_log_tau = 0.5 * libm::log(std::f64::consts::TAU);
        return libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - half_log_tau;
    }
    let square = 1.0 / (n * n);
    let inner = 1.0 / 1680.0 - square * (1.0 / 1188.0 - square * (691.0 / 360_360.0));
    (1.0 / 12.0 - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square * inner))) / n
}

/// Returns x ln(x / mean) + mean - x, without cancellation if both numbers are close to each other.
fn deviance(x: f64, mean: f64) -> f64 {
    let ratio = (x - mean) / (x + mean);
    if ratio.abs() >= 0.1 {
        return x * libm::log(x / mean) + mean - x;
    }
    // x ln(x / mean) is 2 x artanh(ratio), which is a series of odd powers.
    let mut sum = (x - mean) * ratio;
    let mut power = 2.0 * x * ratio;
    for odd in (3..).step_by(2) {
        power *= ratio * ratio;
        let next = sum + power / f64::from(odd);
        if next == sum {
            break;
        }
        sum = next;
    }
    sum
}

/// Evaluates the continued fraction of [`beta_cdf`].
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let apart_from_0 = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut d = 1.0 / apart_from_0(1.0 - (a + b) * x / (a + 1.0));
    let (mut c, mut value) = (1.0, d);
    for m in (1..MOST_TERMS).map(|m| m as f64) {
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for term in [even, odd] {
            d = 1.0 / apart_from_0(1.0 + term * d);
            c = apart_from_0(1.0 + term / c);
            factor = c * d;
            value *= factor;
        }
        if (factor - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    value
}
