//! Finds the most probable lengths and noise of a Gaussian process. It maximises the likelihood with a weak prior,
//! which keeps sensible values where few tests say nothing (as in Hvarfner et al., ICML 2024, lengths grow with the
//! root of the number of axes).
//!
//! The method is Rprop (Riedmiller and Braun 1993): each parameter has its own step, which grows while the slope
//! keeps its sign. It needs no line search, starts from the last fit, and uses at most the first 96 tests.

use super::cube::Axis;
use super::process::{Kernel, Mean, Process};

/// The number of tests that determine the lengths.
const MOST_TESTS: usize = 96;

/// The prior: normal distributions of the logarithms.
const LENGTH: f64 = 0.5;
const LENGTH_DEVIATION: f64 = 1.0;
const NOISE: f64 = 1e-5;
const NOISE_DEVIATION: f64 = 2.0;

/// The steps of the search, in logarithms.
const FIRST_STEP: f64 = 0.2;
const LONGEST_STEP: f64 = 1.0;
const SHORTEST_STEP: f64 = 1e-3;

/// The bounds of the lengths and of the noise.
const LENGTHS: (f64, f64) = (0.01, 30.0);
const NOISES: (f64, f64) = (1e-8, 0.3);

/// Returns the kernel that is assumed before any test.
pub(super) fn prior(axes: &[Axis]) -> Kernel {
    let length = LENGTH * (axes.len() as f64).sqrt();
    Kernel { axes: axes.to_vec(), lengths: vec![length; axes.len()], noise: NOISE }
}

/// Returns the logarithms of a kernel's lengths, and last of its noise. These are the fitted numbers.
pub(super) fn logarithms(kernel: &Kernel) -> Vec<f64> {
    kernel.lengths.iter().chain([&kernel.noise]).map(|&x| libm::log(x)).collect()
}

/// Makes the kernel with the given logarithms of lengths and noise.
pub(super) fn of_logarithms(axes: &[Axis], at: &[f64]) -> Kernel {
    let lengths = at[..axes.len()].iter().map(|&x| libm::exp(x)).collect();
    Kernel { axes: axes.to_vec(), lengths, noise: libm::exp(at[axes.len()]) }
}

/// Returns the bounds of the logarithm with the given index.
pub(super) fn bounds(axes: &[Axis], index: usize) -> (f64, f64) {
    let (least, most) = if index < axes.len() { LENGTHS } else { NOISES };
    (libm::log(least), libm::log(most))
}

/// For each logarithm, its distance from the prior's mean, in deviations of the prior, and that deviation.
fn off(axes: &[Axis], at: &[f64]) -> Vec<(f64, f64)> {
    let middle = logarithms(&prior(axes));
    let deviation = |index: usize| if index < axes.len() { LENGTH_DEVIATION } else { NOISE_DEVIATION };
    let one = |index: usize| ((at[index] - middle[index]) / deviation(index), deviation(index));
    (0..at.len()).map(one).collect()
}

/// Returns the logarithm of the posterior probability of a kernel, given by its logarithms, up to a constant. Only the
/// first places count.
pub(super) fn log_posterior(axes: &[Axis], at: &[f64], places: &[Vec<f64>], values: &[f64]) -> f64 {
    let n = places.len().min(MOST_TESTS);
    let process = Process::new(of_logarithms(axes, at), places[..n].to_vec(), &values[..n], Mean::Unknown);
    let prior: f64 = off(axes, at).iter().map(|(off, _)| -0.5 * off * off).sum();
    process.map_or(f64::NEG_INFINITY, |process| process.log_likelihood() + prior)
}

/// Fits a kernel to the values by `steps` steps from the kernel `from`.
pub(super) fn fit(from: &Kernel, places: &[Vec<f64>], values: &[f64], steps: usize) -> Kernel {
    let n = places.len().min(MOST_TESTS);
    let (places, values) = (&places[..n], &values[..n]);
    let axes = &from.axes;
    let mut at = logarithms(from);
    let mut lengths = vec![FIRST_STEP; at.len()];
    let mut before = vec![0.0; at.len()];
    let mut best = (f64::NEG_INFINITY, from.clone());
    for _ in 0..steps {
        let kernel = of_logarithms(axes, &at);
        let Some(process) = Process::new(kernel.clone(), places.to_vec(), values, Mean::Unknown) else { break };
        let mut value = process.log_likelihood();
        let mut gradient = process.log_likelihood_gradient();
        for (slope, (off, deviation)) in gradient.iter_mut().zip(off(axes, &at)) {
            value -= 0.5 * off * off;
            *slope -= off / deviation;
        }
        if value > best.0 {
            best = (value, kernel);
        }
        for (index, &slope) in gradient.iter().enumerate() {
            let agrees = slope * before[index];
            if agrees > 0.0 {
                lengths[index] = (lengths[index] * 1.5).min(LONGEST_STEP);
            } else if agrees < 0.0 {
                lengths[index] = (lengths[index] * 0.5).max(SHORTEST_STEP);
            }
            before[index] = slope;
            let (least, most) = bounds(axes, index);
            let step = if slope == 0.0 { 0.0 } else { lengths[index].copysign(slope) };
            at[index] = (at[index] + step).clamp(least, most);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Strategy};
    use paracosm_space::Space;

    fn places(n: usize) -> Vec<Vec<f64>> {
        let space = Space::unit_cube(2);
        let tests = Strategy::HALTON.build(&Request::new(&space, n)).unwrap().ask(n);
        tests.into_iter().map(|test| test.continuous).collect()
    }

    #[test]
    fn an_axis_that_does_not_matter_gets_the_greater_length() {
        let places = places(40);
        let values: Vec<f64> = places.iter().map(|at| libm::sin(9.0 * at[0])).collect();
        let fitted = fit(&prior(&[Axis::Continuous; 2]), &places, &values, 40);
        assert!(fitted.lengths[1] > 3.0 * fitted.lengths[0], "{:?}", fitted.lengths);
        assert!(fitted.noise < 1e-3);
    }

    #[test]
    fn noise_is_seen_as_such() {
        let places = places(80);
        // The last digits of a product look random for any length.
        let noise = |at: &[f64]| (at[0] * 9871.0 + at[1] * 7919.0).fract() - 0.5;
        let values: Vec<f64> = places.iter().map(|at| at[0] + noise(at)).collect();
        let fitted = fit(&prior(&[Axis::Continuous; 2]), &places, &values, 60);
        assert!(fitted.noise > 1e-2, "{fitted:?}");
    }

    #[test]
    fn a_climb_leads_far_from_a_bad_start() {
        let places = places(30);
        let values: Vec<f64> = places.iter().map(|at| libm::cos(5.0 * at[0] * at[1])).collect();
        // Far from the true length of such a smooth function.
        let start = Kernel { lengths: vec![0.05; 2], noise: 1e-2, ..prior(&[Axis::Continuous; 2]) };
        let likelihood = |steps| {
            let kernel = fit(&start, &places, &values, steps);
            Process::new(kernel, places.clone(), &values, Mean::Unknown).unwrap().log_likelihood()
        };
        assert!(likelihood(40) > likelihood(1) + 5.0);
    }
}
