//! A model that predicts which tests fail: it estimates on which side of 0 the robustness is, and how sure that is.
//!
//! The model is a probabilistic least-squares classification (Rasmussen and Williams 2006, section 6.5). A Gaussian
//! process goes through the transformed robustness. The probability of a failure is `Phi(-(slope m + offset) / sqrt(1
//! + slope^2 v))` for its mean m and variance v (their equation 6.41). Slope and offset make the verdicts of left-out
//! tests most likely. The choice among models ignores the offset, which matters only for the number of tests that
//! fail ([`Verdicts::calibrated`]).
//!
//! The best transformation (`Bend`) depends on the system under test. If the robustness passes steadily through 0, it
//! tells more than the verdict does. If it jumps there, say from some centimetres of clearance to metres of missing
//! braking distance, a process takes the jump for short lengths, and the bare verdicts -1 and 1 are the better
//! values. So there are three transformations, and the one that predicts left-out tests best is used.
//!
//! A left-out test counts as much as the part of the space that is nearer to it than to any other test. Otherwise the
//! tests that a search has put where nothing is sure would make the model doubt what it knows everywhere else (the
//! weights of Shimodaira 2000 for a sample whose distribution differs from that of its population).

use super::anywhere;
use super::bend::{Bend, is_failure};
use super::cube::Axis;
use super::fit::{fit, prior};
use super::log_ei::normal_below;
use super::places::snapped;
use super::process::{Kernel, Process};
use crate::seeded::{Purpose, seeded};
use rand::Rng;

/// The slopes to try, as logarithms: from -2 to 8 in steps of a half.
const LEAST_SLOPE: f64 = -2.0;
const SLOPES: usize = 21;

/// The number of places that are looked at together.
const TOGETHER: usize = 1024;

/// The number of random places that determine how much of the space each test represents.
const PLACES: usize = 1024;

/// The number of steps of the first fit, and the limits for later fits: fewer along many axes, where a step takes
/// longer.
const FIRST_FIT: usize = 40;
const LATER_FIT: (usize, usize) = (4, 8);

/// The greatest offset, on both sides of 0, and the number of times that its interval is cut to two thirds.
const MOST_OFFSET: f64 = 4.0;
const CUTS: usize = 18;

/// The number of offsets from which plausible ones are drawn.
const OFFSETS: usize = 33;

/// The least probability of a verdict, so that a single surprise does not decide everything.
const LEAST_PROBABLE: f64 = 1e-6;

/// A fitter of failure models, which keeps the kernel of each transformation as the start of the next fit.
pub(super) struct Fitter {
    kernels: [Kernel; 3],
    is_fitted: bool,
}

/// A fitted model of verdicts, with a transformation, a Gaussian process and a link.
pub(super) struct Verdicts {
    pub bend: Bend,
    pub process: Process,
    link: Link,
    left_out: LeftOut,
}

/// The results of tests, and the prediction for each by a process that has not seen it.
struct LeftOut {
    values: Vec<f64>,
    /// The mean and deviation of each prediction.
    told: Vec<(f64, f64)>,
    weights: Vec<f64>,
}

/// The link function, which turns a value of the process into a probability of failure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    slope: f64,
    offset: f64,
}

/// Links with their probabilities.
pub(super) struct PlausibleLinks {
    links: Vec<Link>,
    /// The probability of each link, up to a common factor.
    chances: Vec<f64>,
    fitted: Link,
}

impl Fitter {
    pub(super) fn new(axes: &[Axis]) -> Self {
        Self { kernels: [(); 3].map(|()| prior(axes)), is_fitted: false }
    }

    /// Fits a model with each of three transformations of the robustness, and returns the best model. The first places
    /// determine the lengths. `None` if there is no place.
    pub(super) fn fit(&mut self, places: &[Vec<f64>], robustness: &[f64]) -> Option<Verdicts> {
        let later = (FIRST_FIT / self.kernels[0].axes.len().max(1)).clamp(LATER_FIT.0, LATER_FIT.1);
        let steps = if self.is_fitted { later } else { FIRST_FIT };
        self.is_fitted = true;
        let bends = Bend::of_sides(robustness);
        // With one verdict only, there is nothing to classify, and only the robustness shows where the other may be.
        let failures = robustness.iter().filter(|robustness| is_failure(**robustness)).count();
        let bends = &bends[..if (1..robustness.len()).contains(&failures) { 3 } else { 1 }];
        let weights = weights(&self.kernels[0].axes, places);
        let mut best: Option<(f64, Verdicts)> = None;
        for (&bend, kernel) in bends.iter().zip(&mut self.kernels) {
            let values: Vec<f64> = robustness.iter().map(|&value| bend.apply(value)).collect();
            *kernel = fit(kernel, places, &values, steps);
            let Some(process) = Process::with_noise(kernel, places, &values) else { continue };
            let told = process.leave_one_out(&values);
            let left_out = LeftOut { values, told, weights: weights.clone() };
            let (likelihood, link) = left_out.best_link(|_| 0.0);
            if best.as_ref().is_none_or(|(other, _)| likelihood > *other) {
                best = Some((likelihood, Verdicts { bend, process, link, left_out }));
            }
        }
        best.map(|(_, verdicts)| verdicts)
    }
}

impl Verdicts {
    /// Returns the links with the probability that each has after the left-out tests. The prior of the offset is
    /// standard normal.
    pub(super) fn plausible_links(&self) -> PlausibleLinks {
        let offset = |i: usize| MOST_OFFSET * (2.0 * i as f64 / (OFFSETS - 1) as f64 - 1.0);
        let links = slopes().flat_map(|slope| (0..OFFSETS).map(move |i| Link { slope, offset: offset(i) }));
        let links: Vec<Link> = links.collect();
        // A weight measures a part of the whole space; together the weights count as many as there are tests.
        let share = self.left_out.values.len() as f64 / self.left_out.weights.iter().sum::<f64>();
        let log = |link: &Link| share * self.left_out.likelihood(*link) - 0.5 * link.offset * link.offset;
        let logs: Vec<f64> = links.iter().map(log).collect();
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let chances = logs.iter().map(|log| libm::exp(log - most)).collect();
        PlausibleLinks { links, chances, fitted: self.link }
    }

    /// Returns the probability that a test fails whose transformed robustness has the given mean and deviation.
    pub(super) fn failure(&self, mean: f64, deviation: f64) -> f64 {
        normal_below(-self.link.of(mean, deviation))
    }

    /// Returns the model with the link that makes the verdicts of all given tests most likely. The process has seen the
    /// first `seen` tests; each of them is left out when it is predicted.
    ///
    /// The process sees the most informative tests, which are at the boundary more often, and fail more often, than
    /// other tests. So the other tests must show how many fail.
    pub(super) fn calibrated(mut self, places: &[Vec<f64>], robustness: &[f64], seen: usize) -> Self {
        let values: Vec<f64> = robustness.iter().map(|&value| self.bend.apply(value)).collect();
        let mut told = self.process.leave_one_out(&values[..seen]);
        for others in places[seen..].chunks(TOGETHER) {
            let posterior = self.process.posterior(others.to_vec());
            told.extend((0..others.len()).map(|at| (posterior.mean(at), posterior.deviation(at))));
        }
        let weights = weights(&self.process.kernel().axes, places);
        self.left_out = LeftOut { values, told, weights };
        self.link = self.left_out.best_link(best_offset).1;
        self
    }
}

impl PlausibleLinks {
    /// Draws a link with its probability.
    pub(super) fn draw(&self, rng: &mut impl Rng) -> Link {
        let mut left = rng.random::<f64>() * self.chances.iter().sum::<f64>();
        let drawn = self.chances.iter().position(|chance| {
            left -= chance;
            left < 0.0
        });
        drawn.map_or(self.fitted, |drawn| self.links[drawn])
    }
}

impl Link {
    /// Returns the probability that a test with the given transformed robustness fails.
    pub(super) fn of_value(self, value: f64) -> f64 {
        normal_below(-self.of(value, 0.0))
    }

    /// The mean of a value in standard deviations of the unknown verdict: below 0 means that a failure is more
    /// likely.
    fn of(self, mean: f64, deviation: f64) -> f64 {
        let spread = self.slope * deviation;
        (self.slope * mean + self.offset) / (1.0 + spread * spread).sqrt()
    }
}

/// The share of the space that each place represents: the number of random places nearest to it, plus a half.
fn weights(axes: &[Axis], places: &[Vec<f64>]) -> Vec<f64> {
    let mut rng = seeded(0, Purpose::Draws, 1);
    let mut weights = vec![0.5; places.len()];
    for _ in 0..PLACES {
        let at = snapped(axes, anywhere(axes, &mut rng));
        let mut nearest = (f64::INFINITY, None);
        for (index, place) in places.iter().enumerate() {
            if let Some(distance) = squared_distance_below(nearest.0, axes, place, &at) {
                nearest = (distance, Some(index));
            }
        }
        nearest.1.into_iter().for_each(|nearest| weights[nearest] += 1.0);
    }
    weights
}

/// The squared distance of two places if it is below a bound; most places are far apart after a few axes.
fn squared_distance_below(bound: f64, axes: &[Axis], a: &[f64], b: &[f64]) -> Option<f64> {
    let mut sum = 0.0;
    for (axis, (a, b)) in axes.iter().zip(a.iter().zip(b)) {
        let difference = axis.difference(*a, *b);
        sum += difference * difference;
        if sum >= bound {
            return None;
        }
    }
    Some(sum)
}

/// The slopes to try.
fn slopes() -> impl Iterator<Item = f64> {
    (0..SLOPES).map(|i| libm::exp(LEAST_SLOPE + 0.5 * i as f64))
}

impl LeftOut {
    /// The logarithm of the likelihood of the verdicts with a link.
    fn likelihood(&self, link: Link) -> f64 {
        let one = |(&value, &(mean, deviation)): (&f64, &(f64, f64))| {
            let right = normal_below(1.0_f64.copysign(value) * link.of(mean, deviation));
            libm::log(right.max(LEAST_PROBABLE))
        };
        self.values.iter().zip(&self.told).map(one).zip(&self.weights).map(|(log, weight)| weight * log).sum()
    }

    /// The link with the greatest likelihood, after that likelihood. For each slope, `offset` chooses the offset,
    /// given the likelihood of an offset.
    fn best_link(&self, offset: impl Fn(&dyn Fn(f64) -> f64) -> f64) -> (f64, Link) {
        let best = |slope: f64| offset(&|offset| self.likelihood(Link { slope, offset }));
        let links = slopes().map(|slope| Link { slope, offset: best(slope) });
        let links = links.map(|link| (self.likelihood(link), link));
        links.max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are slopes")
    }
}

/// The most probable offset for this logarithm of a likelihood, which has one peak, with a standard normal prior: if
/// the verdicts are told apart anyway, the offset stays near 0.
fn best_offset(likelihood: &dyn Fn(f64) -> f64) -> f64 {
    let posterior = |offset: f64| likelihood(offset) - 0.5 * offset * offset;
    let (mut low, mut high) = (-MOST_OFFSET, MOST_OFFSET);
    for _ in 0..CUTS {
        let third = (high - low) / 3.0;
        if posterior(low + third) < posterior(high - third) { low += third } else { high -= third }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_counts_as_much_as_the_space_around_it() {
        let places = [vec![0.25], vec![0.745], vec![0.755]];
        let weights = weights(&[Axis::Continuous], &places);
        assert_eq!(weights.iter().sum::<f64>(), 1025.5);
        for (weight, share) in weights.iter().zip([0.4975, 0.2525, 0.25]) {
            assert!((weight / 1025.5 - share).abs() < 0.05, "{weights:?}");
        }
    }

    #[test]
    fn a_robustness_that_jumps_is_taken_for_its_verdict_and_a_steady_one_for_itself() {
        let places: Vec<Vec<f64>> = (0..60).map(|i| vec![(f64::from(i) * 0.618_034).fract()]).collect();
        let bend = |robustness: &dyn Fn(f64) -> f64| {
            let robustness: Vec<f64> = places.iter().map(|at| robustness(at[0])).collect();
            Fitter::new(&[Axis::Continuous]).fit(&places, &robustness).unwrap().bend
        };
        assert!(matches!(bend(&|x| x - 0.37), Bend::Signed { .. }));
        assert!(!matches!(bend(&|x| if x < 0.37 { -50.0 * x - 1.0 } else { 0.01 }), Bend::Signed { .. }));
    }
}
