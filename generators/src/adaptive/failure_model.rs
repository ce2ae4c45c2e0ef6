//! Estimates from the tests so far how probable it is that other tests fail.
//!
//! It is the model of `boundary`, open to every user: [`FailureModel::fit`] takes the tests of any campaign.

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
use rayon::prelude::*;
use std::ops::Range;

/// The greatest number of tests that the model sees.
const MOST_TESTS: usize = 400;

/// The greatest number of other tests, evenly chosen, that calibrate the model.
const MOST_OTHERS: usize = 2048;

/// The number of draws of uncertain shares.
const DRAWS: usize = 128;

/// The number of kernels for the draws.
const KERNELS: usize = 8;

/// The number of places that are looked at together.
const TOGETHER: usize = 1024;

/// A Gaussian-process model that estimates the probability that a test fails.
///
/// It is a probabilistic least-squares classification (Rasmussen and Williams, "Gaussian Processes for Machine
/// Learning", 2006, section 6.5) of the robustness. The robustness is transformed in one of three ways: the one that
/// predicts left-out tests best. If there are more than 400 tests, the model sees 400: half of them spread over the
/// space, half where passing turns into failing. The other tests then calibrate how often tests fail if the model
/// knows little about them.
pub struct FailureModel {
    axes: Vec<Axis>,
    /// The places of the tests that the model has seen; `values` has their transformed robustness.
    seen: Vec<Vec<f64>>,
    values: Vec<f64>,
    verdicts: Verdicts,
    /// The number of all tests, seen or not.
    tests: usize,
}

/// One of the processes that are as plausible as the fitted process, with its draws.
struct Belief {
    process: Process,
    link: Link,
    /// The tests of a group for which the process is used: one sample.
    tests: Range<usize>,
    /// The draws; `errors` has a standard normal number for each, for the error of sampling.
    draws: Vec<Draw>,
    errors: Vec<f64>,
}

/// The estimated share of failing tests in a group of tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailingShare {
    /// The expected share of failing tests in the group. It is the probability that a random test of the group fails.
    pub mean: f64,
    /// The standard deviation of the share, which measures its uncertainty.
    pub deviation: f64,
    /// The probability that more than one half of the tests in the group fail. As the model itself may be wrong, it is
    /// no nearer to 0 or 1 than the number of tests allows: each test counts as one observation, and there is one more
    /// for either side (Laplace's rule of succession). With fewer than 18 tests it is between 0.05 and 0.95.
    pub above_half: f64,
}

impl FailureModel {
    /// Fits a failure model to tests of a space with their robustness. `robustness` has a number for each test, and its
    /// sign is the verdict: a test with -0 has failed. Tests whose robustness is NaN are left out.
    ///
    /// Returns `None` if fewer than two tests are left.
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
        let mut is_chosen = vec![false; places.len()];
        chosen.iter().for_each(|&i| is_chosen[i] = true);
        let others = thinned((0..places.len()).filter(|&i| !is_chosen[i]).collect());
        let all = || chosen.iter().chain(&others);
        let (places, robustness): (Vec<Vec<f64>>, Vec<f64>) =
            all().map(|&i| (places[i].clone(), robustness[i])).unzip();
        let verdicts = verdicts.calibrated(&places, &robustness, chosen.len());
        let values = told.iter().map(|&value| verdicts.bend.apply(value)).collect();
        Some(Self { axes, seen, values, verdicts, tests })
    }

    /// Returns the probability of failure for each of the given tests.
    pub fn probabilities(&self, tests: &[Point]) -> Vec<f64> {
        let probabilities = tests.par_chunks(TOGETHER).flat_map_iter(|tests| {
            let places = tests.iter().map(|test| place(&self.axes, test)).collect();
            let posterior = self.verdicts.process.posterior(places);
            let one = |index| self.verdicts.failure(posterior.mean(index), posterior.deviation(index));
            (0..tests.len()).map(one).collect::<Vec<_>>()
        });
        probabilities.collect()
    }

    /// Estimates the share of failing tests in each of several groups of tests. All groups have the same size; the
    /// result is empty if the groups have no tests. Every test has a weight.
    ///
    /// A group may consist of several samples of one size, one after the other, of the tests that it represents. The
    /// difference between their shares is the error of sampling (Owen, "Monte Carlo theory, methods and examples",
    /// section 17.2), which is part of the deviation. With one sample the group is taken to be complete.
    ///
    /// The mean is that of the fitted process. The deviation and the probability above one half come from about 128
    /// draws, always with the same random numbers, of about eight processes. The lengths and links of these processes
    /// are as plausible as the fitted ones, and their means and variances are as uncertain as the tests leave them:
    /// with few tests little is sure.
    pub fn shares(&self, groups: &[Vec<(Point, f64)>], samples: usize) -> Vec<FailingShare> {
        let all = groups.first().map_or(0, Vec::len);
        if samples == 0 || all < samples {
            return Vec::new();
        }
        let beliefs = self.beliefs(samples, all / samples);
        let shares = groups.par_chunks((TOGETHER / all).max(1)).flat_map_iter(|groups| {
            let places = |tests: Range<usize>| -> Vec<Vec<f64>> {
                let tests = groups.iter().flat_map(|group| &group[tests.clone()]);
                tests.map(|(test, _)| place(&self.axes, test)).collect()
            };
            let posterior = self.verdicts.process.posterior(places(0..all));
            let believed: Vec<Posterior> =
                beliefs.iter().map(|belief| belief.process.posterior(places(belief.tests.clone()))).collect();
            let share = |(index, tests): (usize, &Vec<(Point, f64)>)| {
                let failure = |i| self.verdicts.failure(posterior.mean(i), posterior.deviation(i));
                let failures: Vec<f64> = (index * all..(index + 1) * all).map(failure).collect();
                let weights: Vec<f64> = tests.iter().map(|(_, weight)| *weight).collect();
                self.share(&Group::new(&failures, &weights, samples), index, &beliefs, &believed)
            };
            groups.iter().enumerate().map(share).collect::<Vec<_>>()
        });
        shares.collect()
    }

    /// Processes with plausible lengths, each for one sample of `size` tests.
    fn beliefs(&self, samples: usize, size: usize) -> Vec<Belief> {
        let mut rng = seeded(0, Purpose::Draws, 0);
        let fitted = self.verdicts.process.kernel();
        let kernels = plausible(fitted, &self.seen, &self.values, KERNELS, &mut rng);
        let count = samples * KERNELS.div_ceil(samples);
        let freedom = self.seen.len() - 1;
        let links = self.verdicts.plausible_links();
        let mut belief = |index: usize| {
            let process = Process::with_noise(&kernels[index % KERNELS], &self.seen, &self.values)?;
            let link = links.draw(&mut rng);
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

    /// The estimate of the share in a group. `index` is the group's position among the groups of the posteriors.
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

/// A random factor between a standard deviation and its most likely value, after values with so many degrees of
/// freedom: the root of n over a chi-squared number.
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

    /// The estimate that a sample gives of the weighted mean of a value.
    fn of(&self, sample: Range<usize>, value: &dyn Fn(usize) -> f64) -> f64 {
        sample.map(|i| self.weights[i] * value(i)).sum::<f64>() / self.weight * self.samples as f64
    }

    /// The variance of the mean over all tests that the samples represent.
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

/// An even selection of at most `MOST_OTHERS` of the tests.
fn thinned(all: Vec<usize>) -> Vec<usize> {
    let kept = all.len().min(MOST_OTHERS);
    (0..kept).map(|i| all[i * all.len() / kept]).collect()
}

#[cfg(test)]
mod tests;
