//! What the tests so far say of all others: how probable it is that they fail.
//!
//! The model of `boundary` for everybody: [`FailureModel::fit`] takes the tests of any campaign.

use super::bend::is_failure;
use super::cube::{Axis, axes, place};
use super::fit::prior;
use super::plausible::plausible;
use super::process::{Draw, Posterior, Process};
use super::telling::telling;
use super::verdicts::{Fitter, Link, Verdicts};
use super::{MOST_ROBUSTNESS, normal};
use crate::seeded::{Purpose, seeded};
use paracosm_space::{Point, Space};
use rand::Rng;
use std::ops::Range;

/// So many tests the model sees.
const MOST_TESTS: usize = 400;

/// By at most so many other tests, evenly chosen, the model is calibrated.
const MOST_OTHERS: usize = 2048;

/// So many times uncertain shares are drawn.
const DRAWS: usize = 128;

/// By so many kernels they are drawn.
const KERNELS: usize = 8;

/// So many places are looked at together.
const TOGETHER: usize = 1024;

/// A Gaussian-process model of which tests fail.
///
/// It is a probabilistic least-squares classification (Rasmussen and Williams, "Gaussian Processes for Machine Learning",
/// 2006, section 6.5) of the robustness, which is bent in one of three ways, whichever tells left-out tests best. Of more
/// than 400 tests it sees 400, half of them where passing turns into failing and half spread over the space; how often tests
/// fail of which it knows little, the others tell.
pub struct FailureModel {
    axes: Vec<Axis>,
    /// What the model has seen: places, and what became of them as the model takes it.
    seen: Vec<Vec<f64>>,
    values: Vec<f64>,
    verdicts: Verdicts,
    /// How many tests there are, seen or not.
    tests: usize,
}

/// One of the processes that are as plausible as the fitted one, with what is drawn by it.
struct Belief {
    process: Process,
    link: Link,
    /// Which tests of a group it is asked of: one sample.
    tests: Range<usize>,
    /// The draws, with a standard normal number for the error of sampling.
    draws: Vec<Draw>,
    errors: Vec<f64>,
}

/// What is known of the share of some tests that fail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailingShare {
    /// The expected share: the probability that one of them, chosen at random, fails.
    pub mean: f64,
    /// How far the share may be from it: one standard deviation.
    pub deviation: f64,
    /// The probability that it is more than one half. As the model itself may be wrong, it is no nearer to 0 or 1 than so many
    /// tests can tell: each of them counts as one observation, and there is one more for either side (Laplace's rule of
    /// succession). With less than 18 tests it is between 0.05 and 0.95.
    pub above_half: f64,
}

impl FailureModel {
    /// The model of tests of a space, given a robustness for each, whose sign is the verdict: a test with -0 has failed. What
    /// is no number is left out.
    ///
    /// `None` where there are less than two tests.
    pub fn fit(space: &Space, tests: &[Point], robustness: &[f64]) -> Option<Self> {
        let axes = axes(space);
        let known = tests.iter().zip(robustness).filter(|(_, robustness)| !robustness.is_nan());
        let known =
            known.map(|(test, &robustness)| (place(&axes, test), robustness.clamp(-MOST_ROBUSTNESS, MOST_ROBUSTNESS)));
        let (places, robustness): (Vec<Vec<f64>>, Vec<f64>) = known.unzip();
        if places.len() < 2 {
            return None;
        }
        let tests = places.len();
        let views: Vec<&[f64]> = places.iter().map(Vec::as_slice).collect();
        let failed: Vec<bool> = robustness.iter().map(|&robustness| is_failure(robustness)).collect();
        let chosen = telling(&prior(&axes), &views, &failed, MOST_TESTS);
        let seen: Vec<Vec<f64>> = chosen.iter().map(|&i| places[i].clone()).collect();
        let told: Vec<f64> = chosen.iter().map(|&i| robustness[i]).collect();
        let verdicts = Fitter::new(&axes).fit(&seen, &told)?;
        let others = thinned((0..places.len()).filter(|i| !chosen.contains(i)).collect());
        let all = || chosen.iter().chain(&others);
        let (places, robustness): (Vec<Vec<f64>>, Vec<f64>) =
            all().map(|&i| (places[i].clone(), robustness[i])).unzip();
        let verdicts = verdicts.calibrated(&places, &robustness, chosen.len());
        let values = told.iter().map(|&value| verdicts.bend.apply(value)).collect();
        Some(Self { axes, seen, values, verdicts, tests })
    }

    /// The probability that each of these tests fails.
    pub fn probabilities(&self, tests: &[Point]) -> Vec<f64> {
        let mut probabilities = Vec::with_capacity(tests.len());
        for tests in tests.chunks(TOGETHER) {
            let places = tests.iter().map(|test| place(&self.axes, test)).collect();
            let posterior = self.verdicts.process.posterior(places);
            let one = |index| self.verdicts.failure(posterior.mean(index), posterior.deviation(index));
            probabilities.extend((0..tests.len()).map(one));
        }
        probabilities
    }

    /// What is known of the share of failures in each of some groups of tests of one size; nothing of groups without tests.
    /// Every test has a weight, how much it counts.
    ///
    /// A group may consist of several samples of one size, one after the other, of the tests that it stands for. How much
    /// their shares differ is the error of having taken samples (Owen, "Monte Carlo theory, methods and examples", section
    /// 17.2), which is in the deviation too. With one sample the tests are all that there are.
    ///
    /// The mean is that of the fitted process. The deviation and what is above one half are of 128 draws, always by the same
    /// chance, of eight processes whose lengths and links are as plausible as the fitted ones, with means and variances that
    /// are no more certain than the tests make them: a few tests leave all of this open, and little is sure.
    pub fn shares(&self, groups: &[Vec<(Point, f64)>], samples: usize) -> Vec<FailingShare> {
        let all = groups.first().map_or(0, Vec::len);
        if samples == 0 || all < samples {
            return Vec::new();
        }
        let beliefs = self.beliefs(samples, all / samples);
        let mut shares = Vec::with_capacity(groups.len());
        for groups in groups.chunks((TOGETHER / all).max(1)) {
            let places = |tests: Range<usize>| -> Vec<Vec<f64>> {
                let tests = groups.iter().flat_map(|group| &group[tests.clone()]);
                tests.map(|(test, _)| place(&self.axes, test)).collect()
            };
            let posterior = self.verdicts.process.posterior(places(0..all));
            let believed: Vec<Posterior> =
                beliefs.iter().map(|belief| belief.process.posterior(places(belief.tests.clone()))).collect();
            for (index, tests) in groups.iter().enumerate() {
                let failure = |i| self.verdicts.failure(posterior.mean(i), posterior.deviation(i));
                let failures: Vec<f64> = (index * all..(index + 1) * all).map(failure).collect();
                let weights: Vec<f64> = tests.iter().map(|(_, weight)| *weight).collect();
                let group = Group::new(&failures, &weights, samples);
                shares.push(self.share(&group, index, &beliefs, &believed));
            }
        }
        shares
    }

    /// Processes with plausible lengths, each for one sample of so many tests.
    fn beliefs(&self, samples: usize, size: usize) -> Vec<Belief> {
        let mut rng = seeded(0, Purpose::Draws, 0);
        let fitted = self.verdicts.process.kernel();
        let kernels = plausible(fitted, &self.seen, &self.values, KERNELS, &mut rng);
        let count = samples * KERNELS.div_ceil(samples);
        let freedom = self.seen.len() - 1;
        let mut belief = |index: usize| {
            let process = Process::with_noise(&kernels[index % KERNELS], &self.seen, &self.values)?;
            let link = self.verdicts.plausible_link(&mut rng);
            let mut draw = || Draw {
                values: (0..size).map(|_| normal(&mut rng)).collect(),
                mean: normal(&mut rng),
                spread: spread(freedom, &mut rng),
            };
            let draws: Vec<Draw> = (0..DRAWS.div_ceil(count)).map(|_| draw()).collect();
            let errors = draws.iter().map(|_| normal(&mut rng)).collect();
            let sample = index % samples;
            Some(Belief { process, link, tests: sample * size..(sample + 1) * size, draws, errors })
        };
        (0..count).filter_map(&mut belief).collect()
    }

    /// What is known of the share in the group with this index among those that the processes are asked of.
    fn share(&self, group: &Group, index: usize, beliefs: &[Belief], believed: &[Posterior]) -> FailingShare {
        let sampling = group.sampling();
        let (mut square, mut above, mut count) = (0.0, 0, 0);
        for (belief, posterior) in beliefs.iter().zip(believed) {
            let size = belief.tests.len();
            let members: Vec<usize> = (index * size..(index + 1) * size).collect();
            for (values, error) in posterior.draws(&members, &belief.draws).into_iter().zip(&belief.errors) {
                let first = belief.tests.start;
                let off = |i: usize| belief.link.of_value(values[i - first]) - group.failures[i];
                let step = group.of(belief.tests.clone(), &off);
                square += step * step;
                above += usize::from(group.mean + step + sampling.sqrt() * error > 0.5);
                count += 1;
            }
        }
        let (count, tests) = (f64::from(count.max(1)), self.tests as f64);
        FailingShare {
            mean: group.mean,
            deviation: (square / count + sampling).sqrt(),
            above_half: (tests * above as f64 / count + 1.0) / (tests + 2.0),
        }
    }
}

/// How many times its most likely value a standard deviation may be that values with so many degrees of freedom tell: the
/// root of n over a chi-squared number.
fn spread(freedom: usize, rng: &mut impl Rng) -> f64 {
    let squares: f64 = (0..freedom).map(|_| normal(rng)).map(|x| x * x).sum();
    ((freedom + 1) as f64 / squares.max(f64::MIN_POSITIVE)).sqrt()
}

/// A group of tests as the fitted process sees it.
struct Group<'a> {
    failures: &'a [f64],
    weights: &'a [f64],
    weight: f64,
    samples: usize,
    mean: f64,
}

impl<'a> Group<'a> {
    fn new(failures: &'a [f64], weights: &'a [f64], samples: usize) -> Self {
        let weight = weights.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mean = weights.iter().zip(failures).map(|(weight, failure)| weight * failure).sum::<f64>() / weight;
        Self { failures, weights, weight, samples, mean }
    }

    /// What a sample says of the weighted mean of something.
    fn of(&self, sample: Range<usize>, value: &dyn Fn(usize) -> f64) -> f64 {
        sample.map(|i| self.weights[i] * value(i)).sum::<f64>() / self.weight * self.samples as f64
    }

    /// The variance of the mean over all that the samples stand for.
    fn sampling(&self) -> f64 {
        if self.samples < 2 {
            return 0.0;
        }
        let size = self.weights.len() / self.samples;
        let error = |sample| self.of(sample * size..(sample + 1) * size, &|i| self.failures[i] - self.mean);
        let square = (0..self.samples).map(error).map(|error| error * error).sum::<f64>();
        square / (self.samples * (self.samples - 1)) as f64
    }
}

/// Evenly chosen ones of many.
fn thinned(all: Vec<usize>) -> Vec<usize> {
    let kept = all.len().min(MOST_OTHERS);
    (0..kept).map(|i| all[i * all.len() / kept]).collect()
}

#[cfg(test)]
mod tests;
