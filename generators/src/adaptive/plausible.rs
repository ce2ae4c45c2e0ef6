//! Draws kernels that, after the tests, are as plausible as the most probable kernel.
//!
//! A few tests say little about the lengths. If the most probable lengths are taken for the truth, the model is too
//! sure of places without tests, above all along many axes. So a statement counts as sure only if it is sure for
//! lengths drawn from their posterior. They are drawn by slice sampling, one logarithm after the other (Neal, "Slice
//! sampling", Annals of Statistics 2003; for the lengths of Gaussian processes Murray and Adams, NIPS 2010).

use super::fit::{bounds, log_posterior, logarithms, of_logarithms};
use super::process::Kernel;
use rand::Rng;

/// The width of the first slice, in logarithms: a few deviations of the prior.
const WIDTH: f64 = 3.0;

/// The number of times that every logarithm is drawn again from one kernel to the next.
const SWEEPS: usize = 3;

/// The greatest number of times that a slice shrinks: after that it is a point.
const MOST_SHRINKS: usize = 30;

/// Draws `count` kernels from the distribution of kernels that the given values leave possible. `from` is the most
/// probable kernel.
pub(super) fn plausible(
    from: &Kernel,
    places: &[Vec<f64>],
    values: &[f64],
    count: usize,
    rng: &mut impl Rng,
) -> Vec<Kernel> {
    let axes = &from.axes;
    let probable = |at: &[f64]| log_posterior(axes, at, places, values);
    let mut at = logarithms(from);
    let all = at.len();
    let mut height = probable(&at);
    let mut kernels = Vec::with_capacity(count);
    for _ in 0..count {
        for index in (0..SWEEPS).flat_map(|_| 0..all) {
            let slice = height + libm::log(1.0 - rng.random::<f64>());
            let (least, most) = bounds(axes, index);
            let before = at[index];
            let mut low = before - WIDTH * rng.random::<f64>();
            let mut high = (low + WIDTH).min(most);
            low = low.max(least);
            for _ in 0..MOST_SHRINKS {
                let drawn = low + (high - low) * rng.random::<f64>();
                at[index] = drawn;
                let found = probable(&at);
                if found > slice {
                    height = found;
                    break;
                }
                at[index] = before;
                if drawn < before { low = drawn } else { high = drawn }
            }
        }
        kernels.push(of_logarithms(axes, &at));
    }
    kernels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adaptive::cube::Axis;
    use crate::adaptive::fit::{fit, prior};
    use crate::seeded::{Purpose, seeded};

    /// The deviation of the logarithms of the plausible lengths, after `n` tests of a wave along one of two axes.
    fn spread(n: usize) -> [f64; 2] {
        let places: Vec<Vec<f64>> =
            (0..n).map(|i| vec![(0.5 + i as f64 * 0.754_878).fract(), (0.5 + i as f64 * 0.569_840).fract()]).collect();
        let values: Vec<f64> = places.iter().map(|at| libm::sin(7.0 * at[0])).collect();
        let from = fit(&prior(&[Axis::Continuous; 2]), &places, &values, 40);
        let kernels = plausible(&from, &places, &values, 200, &mut seeded(0, Purpose::Draws, 0));
        [0, 1].map(|axis| {
            let lengths: Vec<f64> = kernels.iter().map(|kernel| libm::log(kernel.lengths[axis])).collect();
            let mean = lengths.iter().sum::<f64>() / 200.0;
            (lengths.iter().map(|length| (length - mean) * (length - mean)).sum::<f64>() / 200.0).sqrt()
        })
    }

    #[test]
    fn few_tests_leave_lengths_as_open_as_they_were_and_many_do_not() {
        let (few, many) = (spread(2), spread(60));
        // The assumed deviation is 1.
        assert!(few.iter().all(|spread| (0.75..1.25).contains(spread)), "{few:?}");
        assert!(many[0] < 0.3, "{many:?}");
    }

    #[test]
    fn where_no_process_goes_through_the_values_the_kernel_stays() {
        let from = prior(&[Axis::Continuous]);
        let none = plausible(&from, &[], &[], 2, &mut seeded(0, Purpose::Draws, 0));
        let stays = |kernel: &Kernel| (kernel.lengths[0] - from.lengths[0]).abs() < 1e-12;
        assert!(none.len() == 2 && none.iter().all(stays), "{none:?}");
    }
}
