//! A model of which tests fail: which side of 0 the robustness is on, and how sure that is.
//!
//! Probabilistic least-squares classification (Rasmussen and Williams 2006, section 6.5): a Gaussian process goes through
//! the robustness as it is bent, and the probability of a failure is `Phi(-slope m / sqrt(1 + slope^2 v))` for its mean m
//! and variance v, where the slope makes the verdicts of left-out tests most likely.
//!
//! How to bend depends on the system under test. Where the robustness goes steadily through 0 it tells more than the
//! verdict does; where it jumps there, from some centimetres of clearance to metres of missing braking distance, say,
//! a process takes the jump for short lengths, and the bare verdicts -1 and 1 are the better values. So there are three
//! bends, and the one by which the left-out tests are told best is believed.

use super::bend::Bend;
use super::cube::Axis;
use super::fit::{fit, prior};
use super::log_ei::normal_below;
use super::process::{Kernel, Process};

/// The slopes that are tried, as logarithms: from -2 to 8 in steps of a half.
const LEAST_SLOPE: f64 = -2.0;
const SLOPES: usize = 21;

/// How many steps the first fit takes, and those after it.
const FIRST_FIT: usize = 40;
const LATER_FIT: usize = 8;

/// No verdict is less probable than this: one surprise is no end of the world.
const LEAST_PROBABLE: f64 = 1e-6;

/// The kernels of the three bends, which every fit goes on from.
pub(super) struct Fitter {
    kernels: [Kernel; 3],
    is_fitted: bool,
}

/// What a fit found.
pub(super) struct Verdicts {
    pub bend: Bend,
    pub process: Process,
    slope: f64,
}

impl Fitter {
    pub(super) fn new(axes: &[Axis]) -> Self {
        Self { kernels: [(); 3].map(|()| prior(axes)), is_fitted: false }
    }

    /// The best of the three models; the first places have to tell the lengths. `None` where there is no place.
    pub(super) fn fit(&mut self, places: &[Vec<f64>], robustness: &[f64]) -> Option<Verdicts> {
        let steps = if self.is_fitted { LATER_FIT } else { FIRST_FIT };
        self.is_fitted = true;
        let bends = Bend::of_sides(robustness);
        let mut best: Option<(f64, Verdicts)> = None;
        for (bend, kernel) in bends.into_iter().zip(&mut self.kernels) {
            let values: Vec<f64> = robustness.iter().map(|&value| bend.apply(value)).collect();
            *kernel = fit(kernel, places, &values, steps);
            let Some(process) = Process::with_noise(kernel, places, &values) else { continue };
            let (likelihood, slope) = best_slope(&process, &values);
            if best.as_ref().is_none_or(|(other, _)| likelihood > *other) {
                best = Some((likelihood, Verdicts { bend, process, slope }));
            }
        }
        best.map(|(_, verdicts)| verdicts)
    }
}

impl Verdicts {
    /// The probability that a test fails whose robustness, bent, is this.
    pub(super) fn of_value(&self, value: f64) -> f64 {
        normal_below(-self.slope * value)
    }

    /// The probability that a test fails whose robustness, bent, has this mean and deviation.
    pub(super) fn failure(&self, mean: f64, deviation: f64) -> f64 {
        normal_below(-link(self.slope, mean, deviation))
    }
}

fn link(slope: f64, mean: f64, deviation: f64) -> f64 {
    let spread = slope * deviation;
    slope * mean / (1.0 + spread * spread).sqrt()
}

/// By which slope the verdicts of left-out tests are most likely, and how likely: the logarithm.
fn best_slope(process: &Process, values: &[f64]) -> (f64, f64) {
    let left_out = process.leave_one_out(values);
    let likelihood = |slope: f64| -> f64 {
        let one = |(&value, &(mean, deviation)): (&f64, &(f64, f64))| {
            let right = normal_below(1.0_f64.copysign(value) * link(slope, mean, deviation));
            libm::log(right.max(LEAST_PROBABLE))
        };
        values.iter().zip(&left_out).map(one).sum()
    };
    let slopes = (0..SLOPES).map(|i| libm::exp(LEAST_SLOPE + 0.5 * i as f64));
    slopes.map(|slope| (likelihood(slope), slope)).max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are slopes")
}
