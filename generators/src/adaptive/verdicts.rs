//! A model of which tests fail: which side of 0 the robustness is on, and how sure that is.
//!
//! Probabilistic least-squares classification (Rasmussen and Williams 2006, section 6.5): a Gaussian process goes through
//! the robustness as it is bent, and the probability of a failure is `Phi(-(slope m + offset) / sqrt(1 + slope^2 v))` for its
//! mean m and variance v (their equation 6.41), where slope and offset make the verdicts of left-out tests most likely. Which
//! model is believed is told without the offset; it matters to who asks how many tests fail ([`Verdicts::calibrated`]).
//!
//! How to bend depends on the system under test. Where the robustness goes steadily through 0 it tells more than the
//! verdict does; where it jumps there, from some centimetres of clearance to metres of missing braking distance, say,
//! a process takes the jump for short lengths, and the bare verdicts -1 and 1 are the better values. So there are three
//! bends, and the one by which the left-out tests are told best is believed.
//!
//! A left-out test counts as much as the part of the space that is nearer to it than to any other. Otherwise the tests that a
//! search has put where nothing is sure would make the model doubt what it knows everywhere else (the weights of Shimodaira
//! 2000 for a sample that is not drawn like what it stands for).

use super::anywhere;
use super::bend::{Bend, is_failure};
use super::cube::Axis;
use super::fit::{fit, prior};
use super::log_ei::normal_below;
use super::places::snapped;
use super::process::{Kernel, Process};
use crate::seeded::{Purpose, seeded};
use rand::Rng;

/// The slopes that are tried, as logarithms: from -2 to 8 in steps of a half.
const LEAST_SLOPE: f64 = -2.0;
const SLOPES: usize = 21;

/// So many places are looked at together.
const TOGETHER: usize = 1024;

/// By so many random places it is told how much of the space a test stands for.
const PLACES: usize = 1024;

/// How many steps the first fit takes, and those after it: fewer along many axes, where a step takes longer, within these
/// limits.
const FIRST_FIT: usize = 40;
const LATER_FIT: (usize, usize) = (4, 8);

/// Where the offset is looked for, on both sides of 0, and how often what remains is cut to two thirds.
const MOST_OFFSET: f64 = 4.0;
const CUTS: usize = 18;

/// Among so many offsets plausible ones are drawn.
const OFFSETS: usize = 33;

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
    link: Link,
    left_out: LeftOut,
}

/// What became of tests, and what a process says of each that has not seen it.
struct LeftOut {
    values: Vec<f64>,
    /// Mean and deviation.
    told: Vec<(f64, f64)>,
    weights: Vec<f64>,
}

/// How a value of the process becomes a probability.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    slope: f64,
    offset: f64,
}

impl Fitter {
    pub(super) fn new(axes: &[Axis]) -> Self {
        Self { kernels: [(); 3].map(|()| prior(axes)), is_fitted: false }
    }

    /// The best of the three models; the first places have to tell the lengths. `None` where there is no place.
    pub(super) fn fit(&mut self, places: &[Vec<f64>], robustness: &[f64]) -> Option<Verdicts> {
        let later = (FIRST_FIT / self.kernels[0].axes.len().max(1)).clamp(LATER_FIT.0, LATER_FIT.1);
        let steps = if self.is_fitted { later } else { FIRST_FIT };
        self.is_fitted = true;
        let bends = Bend::of_sides(robustness);
        // Of one verdict alone nothing is to be told apart, and where the other may be only the robustness knows.
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
    /// A link that left-out tests leave as plausible as the best one, offsets being a priori standard normal.
    pub(super) fn plausible_link(&self, rng: &mut impl Rng) -> Link {
        let offset = |i: usize| MOST_OFFSET * (2.0 * i as f64 / (OFFSETS - 1) as f64 - 1.0);
        let links = slopes().flat_map(|slope| (0..OFFSETS).map(move |i| Link { slope, offset: offset(i) }));
        let links: Vec<Link> = links.collect();
        // A weight tells of the whole space; together they count as many as there are tests.
        let share = self.left_out.values.len() as f64 / self.left_out.weights.iter().sum::<f64>();
        let log = |link: &Link| share * self.left_out.likelihood(*link) - 0.5 * link.offset * link.offset;
        let logs: Vec<f64> = links.iter().map(log).collect();
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let chances: Vec<f64> = logs.iter().map(|log| libm::exp(log - most)).collect();
        let mut left = rng.random::<f64>() * chances.iter().sum::<f64>();
        let drawn = chances.iter().position(|chance| {
            left -= chance;
            left < 0.0
        });
        drawn.map_or(self.link, |drawn| links[drawn])
    }

    /// The probability that a test fails whose robustness, bent, has this mean and deviation.
    pub(super) fn failure(&self, mean: f64, deviation: f64) -> f64 {
        normal_below(-self.link.of(mean, deviation))
    }

    /// The same with the link that makes the verdicts of all these tests most likely, each left out of what the process has
    /// seen: the first `seen` of them.
    ///
    /// The process sees the tests that tell most, which are more often at the boundary, and fail more often, than tests do;
    /// so the others have to say how many fail.
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

impl Link {
    /// The probability that a test fails whose robustness, bent, is this.
    pub(super) fn of_value(self, value: f64) -> f64 {
        normal_below(-self.of(value, 0.0))
    }

    /// What is below 0 is rather a failure: the mean and deviation of a value, in standard deviations of what is to be known.
    fn of(self, mean: f64, deviation: f64) -> f64 {
        let spread = self.slope * deviation;
        (self.slope * mean + self.offset) / (1.0 + spread * spread).sqrt()
    }
}

/// How much of the space each of the places stands for: how many random ones are nearest to it, and half a one more.
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

/// The squared distance of two places if it is below a bound; most are far apart along few axes already.
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

/// The slopes that are tried.
fn slopes() -> impl Iterator<Item = f64> {
    (0..SLOPES).map(|i| libm::exp(LEAST_SLOPE + 0.5 * i as f64))
}

impl LeftOut {
    /// How likely the verdicts are by a link: the logarithm.
    fn likelihood(&self, link: Link) -> f64 {
        let one = |(&value, &(mean, deviation)): (&f64, &(f64, f64))| {
            let right = normal_below(1.0_f64.copysign(value) * link.of(mean, deviation));
            libm::log(right.max(LEAST_PROBABLE))
        };
        self.values.iter().zip(&self.told).map(one).zip(&self.weights).map(|(log, weight)| weight * log).sum()
    }

    /// By which link they are most likely, and how likely. For each slope `offset` finds the offset, given the likelihood of
    /// one.
    fn best_link(&self, offset: impl Fn(&dyn Fn(f64) -> f64) -> f64) -> (f64, Link) {
        let best = |slope: f64| offset(&|offset| self.likelihood(Link { slope, offset }));
        let links = slopes().map(|slope| Link { slope, offset: best(slope) });
        let links = links.map(|link| (self.likelihood(link), link));
        links.max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are slopes")
    }
}

/// The most probable offset for this logarithm of a likelihood, which has one peak, with a standard normal prior: where the
/// verdicts are told apart anyhow it stays near 0.
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
