//! The logarithm of the expected improvement (Ament et al., NeurIPS 2023, arXiv 2310.20708).
//!
//! If the improvement is small, it underflows, and all places look alike; its logarithm does not underflow. With `z =
//! (best - mean) / deviation` it is `log(deviation) + log h(z)`, `h(z) = phi(z) + z Phi(z)`. Three forms compute it;
//! each is used where it cancels least.

use std::f64::consts::{FRAC_1_SQRT_2, LN_2, PI};

/// Returns the logarithm of the expected improvement on `best`. The improvement is the amount by which a normally
/// distributed number is below `best`, or 0 if it is above.
pub(super) fn log_expected_improvement(best: f64, mean: f64, deviation: f64) -> f64 {
    libm::log(deviation) + log_h((best - mean) / deviation)
}

/// Returns the probability that a standard normal number is below `z`.
pub(super) fn normal_below(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

fn log_h(z: f64) -> f64 {
    let half_log_tau = 0.5 * libm::log(2.0 * PI);
    if z > -1.0 {
        return libm::log(libm::exp(-0.5 * z * z - half_log_tau) + z * normal_below(z));
    }
    let log_density = -0.5 * z * z - half_log_tau;
    if z < -1e4 {
        // The first term of the asymptotic series; the next is smaller by 3 / z^2.
        return log_density - 2.0 * libm::log(-z);
    }
    // log(1 - |z| sqrt(pi/2) erfcx(|z| / sqrt 2))
    let part = libm::log(scaled_erfc(-z * FRAC_1_SQRT_2) * -z) + 0.5 * libm::log(0.5 * PI);
    log_density + log_1_minus_exp(part)
}

/// `log(1 - exp(x))` of a negative number.
fn log_1_minus_exp(x: f64) -> f64 {
    if x > -LN_2 { libm::log(-libm::expm1(x)) } else { libm::log1p(-libm::exp(x)) }
}

/// `exp(x^2) erfc(x)` of a positive number.
fn scaled_erfc(x: f64) -> f64 {
    if x < 20.0 {
        return libm::exp(x * x) * libm::erfc(x);
    }
    let s = 1.0 / (2.0 * x * x);
    let series = 1.0 - s * (1.0 - 3.0 * s * (1.0 - 5.0 * s * (1.0 - 7.0 * s * (1.0 - 9.0 * s))));
    series / (x * PI.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes the same value by Simpson's rule. The improvement `s` has the density `phi(z - s)`; `phi(z)` is taken
    /// out.
    fn integrated(z: f64) -> f64 {
        let weight = |s: f64| s * libm::exp(z * s - 0.5 * s * s);
        // Far to the right of the peak, where the weight has fallen by more than exp(-40).
        let (end, n) = (z.max(0.0) + 40.0 / (1.0 + 4.0 * (-z).max(0.0)) + 9.0 / (1.0 - z.min(0.0)), 40_000);
        let h = end / f64::from(n);
        let inner: f64 = (1..n).map(|i| if i % 2 == 1 { 4.0 } else { 2.0 } * weight(h * f64::from(i))).sum();
        libm::log(h / 3.0 * (weight(0.0) + inner + weight(end))) - 0.5 * z * z - 0.5 * libm::log(2.0 * PI)
    }

    #[test]
    fn it_is_the_integral_wherever_that_can_be_computed() {
        for i in -400..=80 {
            let z = 0.1 * f64::from(i);
            let (found, expected) = (log_h(z), integrated(z));
            assert!((found - expected).abs() < 1e-6 * (1.0 + 1e-3 * expected.abs()), "{z}: {found}, {expected}");
        }
    }

    #[test]
    fn it_falls_without_a_step_where_the_forms_meet() {
        for z in [-1.0, -20.0 * 2.0_f64.sqrt(), -1e4] {
            let step = 1e-7 * z.abs();
            let slope = (log_h(z + step) - log_h(z - step)) / (2.0 * step);
            // The derivative is Phi(z) / h(z), which tends to -z - 2/z.
            assert!(slope > 0.0 && slope < 2.0 * (1.0 - z), "{z}: {slope}");
        }
        assert!(log_h(-1e8).is_finite() && log_h(-1e8) < log_h(-1e7));
    }

    #[test]
    fn scale_and_place_enter_as_they_should() {
        let a = log_expected_improvement(3.0, 5.0, 2.0);
        assert!((a - (LN_2 + log_h(-1.0))).abs() < 1e-15);
        // Certain improvement: the difference itself.
        assert!((log_expected_improvement(5.0, 1.0, 1e-3) - libm::log(4.0)).abs() < 1e-12);
    }
}
