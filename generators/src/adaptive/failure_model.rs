//! What the tests so far say of all others: how probable it is that they fail.
//!
//! The model of `boundary` for everybody: [`FailureModel::fit`] takes the tests of any campaign.

use super::bend::is_failure;
use super::cube::{Axis, axes, place};
use super::fit::prior;
use super::telling::telling;
use super::verdicts::{Fitter, Verdicts};
use super::{MOST_ROBUSTNESS, normal};
use crate::seeded::{Purpose, seeded};
use paracosm_coverage::{Point, Space};

/// So many tests the model sees.
const MOST_TESTS: usize = 400;

/// So many times uncertain shares are drawn.
const DRAWS: usize = 128;

/// So many places are looked at together.
const TOGETHER: usize = 1024;

/// A Gaussian-process model of which tests fail.
///
/// It is a probabilistic least-squares classification (Rasmussen and Williams, "Gaussian Processes for Machine Learning",
/// 2006, section 6.5) of the robustness, which is bent in one of three ways, whichever tells left-out tests best. Of more
/// than 400 tests it sees 400, half of them where passing turns into failing and half spread over the space.
pub struct FailureModel {
    axes: Vec<Axis>,
    verdicts: Verdicts,
}

/// What is known of the share of some tests that fail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailingShare {
    /// The expected share: the probability that one of them, chosen at random, fails.
    pub mean: f64,
    /// How far the share may be from it: one standard deviation.
    pub deviation: f64,
    /// The probability that it is more than one half.
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
        let known = known.map(|(test, &robustness)| {
            (place(&axes, test), robustness.clamp(-MOST_ROBUSTNESS, MOST_ROBUSTNESS))
        });
        let (places, robustness): (Vec<Vec<f64>>, Vec<f64>) = known.unzip();
        if places.len() < 2 {
            return None;
        }
        let views: Vec<&[f64]> = places.iter().map(Vec::as_slice).collect();
        let failed: Vec<bool> = robustness.iter().map(|&robustness| is_failure(robustness)).collect();
        let chosen = telling(&prior(&axes), &views, &failed, MOST_TESTS);
        let places: Vec<Vec<f64>> = chosen.iter().map(|&i| places[i].clone()).collect();
        let robustness: Vec<f64> = chosen.iter().map(|&i| robustness[i]).collect();
        let verdicts = Fitter::new(&axes).fit(&places, &robustness)?;
        Some(Self { axes, verdicts })
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
    ///
    /// The mean is exact; the deviation and what is above one half are of 128 draws of the process, always by the same
    /// chance.
    pub fn shares(&self, groups: &[Vec<Point>]) -> Vec<FailingShare> {
        let size = groups.first().map_or(0, Vec::len);
        if size == 0 {
            return Vec::new();
        }
        let mut rng = seeded(0, Purpose::Draws, 0);
        let draws: Vec<Vec<f64>> = (0..DRAWS).map(|_| (0..size).map(|_| normal(&mut rng)).collect()).collect();
        let mut shares = Vec::with_capacity(groups.len());
        for groups in groups.chunks((TOGETHER / size).max(1)) {
            let places = groups.iter().flatten().map(|test| place(&self.axes, test)).collect();
            let posterior = self.verdicts.process.posterior(places);
            for group in 0..groups.len() {
                let members: Vec<usize> = (group * size..(group + 1) * size).collect();
                let failure = |&index: &usize| self.verdicts.failure(posterior.mean(index), posterior.deviation(index));
                let mean = members.iter().map(failure).sum::<f64>() / size as f64;
                let share = |values: Vec<f64>| {
                    values.into_iter().map(|value| self.verdicts.of_value(value)).sum::<f64>() / size as f64
                };
                let drawn: Vec<f64> = posterior.draws(&members, &draws).into_iter().map(share).collect();
                let square = drawn.iter().map(|share| (share - mean) * (share - mean)).sum::<f64>() / DRAWS as f64;
                let above_half = drawn.iter().filter(|share| **share > 0.5).count() as f64 / DRAWS as f64;
                shares.push(FailingShare { mean, deviation: square.sqrt(), above_half });
            }
        }
        shares
    }
}
