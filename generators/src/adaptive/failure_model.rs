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
        let known =
            known.map(|(test, &robustness)| (place(&axes, test), robustness.clamp(-MOST_ROBUSTNESS, MOST_ROBUSTNESS)));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Strategy};

    fn tests(space: &Space, n: usize) -> Vec<Point> {
        Strategy::Halton.build(&Request::new(space, n)).unwrap().ask(n)
    }

    /// How much of 2,000 other tests the model tells right.
    fn right(space: &Space, n: usize, robustness: impl Fn(&Point) -> f64) -> f64 {
        let known = tests(space, n);
        let told: Vec<f64> = known.iter().map(&robustness).collect();
        let model = FailureModel::fit(space, &known, &told).unwrap();
        let others = Strategy::Random.build(&Request::new(space, 2000)).unwrap().ask(2000);
        let probabilities = model.probabilities(&others);
        let right = others.iter().zip(probabilities).filter(|(at, p)| (*p > 0.5) == (robustness(at) < 0.0)).count();
        right as f64 / 2000.0
    }

    fn ball(at: &Point) -> f64 {
        let square = |u: &f64| (u - 0.45) * (u - 0.45);
        at.continuous.iter().map(square).sum::<f64>().sqrt() - 0.3
    }

    #[test]
    fn a_ball_is_known_after_few_tests_by_a_robustness_that_is_its_distance() {
        assert!(right(&Space::unit_cube(3), 60, ball) > 0.98);
    }

    #[test]
    fn where_the_robustness_jumps_it_knows_more_than_the_nearest_test() {
        let jumping = |at: &Point| if ball(at) < 0.0 { -9.0 + 5.0 * at.continuous[0] } else { ball(at).min(0.1) };
        let space = Space::unit_cube(2);
        let known = tests(&space, 150);
        let square = |a: &Point, b: &Point| -> f64 {
            a.continuous.iter().zip(&b.continuous).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        let others = Strategy::Random.build(&Request::new(&space, 2000)).unwrap().ask(2000);
        let nearest = |at: &Point| known.iter().min_by(|a, b| square(a, at).total_cmp(&square(b, at))).unwrap();
        let told = others.iter().filter(|at| (jumping(nearest(at)) < 0.0) == (jumping(at) < 0.0)).count();
        let (nearest, model) = (told as f64 / 2000.0, right(&space, 150, jumping));
        assert!(model > nearest, "{model} {nearest}");
    }

    #[test]
    fn of_many_tests_it_sees_those_that_tell_most() {
        assert!(right(&Space::unit_cube(2), 3000, |at| if ball(at) < 0.0 { -5.0 } else { 1.0 }) > 0.985);
    }

    #[test]
    fn words_are_told_apart() {
        let text = "parameter = [{ name = \"x\", interval = [0, 1] }, { name = \"sky\", choice = [\"day\", \"dusk\", \"night\"] }]";
        let space = Space::from_toml(text).unwrap();
        assert!(right(&space, 90, |at| if at.discrete[0] == 2 { at.continuous[0] - 0.5 } else { 1.0 }) > 0.95);
    }

    #[test]
    fn the_share_of_tests_that_fail_is_known_as_well_as_they_are() {
        let space = Space::unit_cube(2);
        let known = tests(&space, 100);
        let fails = |at: &Point| 0.6 - at.continuous[0];
        let model = FailureModel::fit(&space, &known, &known.iter().map(fails).collect::<Vec<_>>()).unwrap();
        let at = |x: f64, y: f64| Point { continuous: vec![x, y], discrete: Vec::new() };
        let group = |x: [f64; 4]| x.map(|x| at(x, 0.5)).to_vec();
        let found = model.shares(&[group([0.1, 0.2, 0.3, 0.4]), group([0.2, 0.3, 0.4, 0.9]), group([0.9; 4])]);
        let expected = [(0.0, 0.0), (0.25, 0.0), (1.0, 1.0)];
        for (found, (mean, above)) in found.iter().zip(expected) {
            assert!(
                (found.mean - mean).abs() < 0.02 && found.deviation < 0.05 && found.above_half == above,
                "{found:?}"
            );
        }
        // Between tests of which no more than the verdict is known nothing is sure; the mean is that of the probabilities.
        let verdicts: Vec<f64> = known.iter().map(|at| 1.0_f64.copysign(fails(at))).collect();
        let model = FailureModel::fit(&space, &known[..30], &verdicts[..30]).unwrap();
        let (mut last, mut first) = (0.0_f64, 1.0_f64);
        for test in &known[..30] {
            let x = test.continuous[0];
            if fails(test) < 0.0 { first = first.min(x) } else { last = last.max(x) }
        }
        let edge = [at(0.5 * (last + first), 0.5), at(0.5 * (last + first) + 1e-4, 0.5)];
        let unsure = model.shares(&[edge.to_vec()])[0];
        assert!(unsure.deviation > 0.1 && (0.05..0.95).contains(&unsure.above_half), "{unsure:?}");
        let mean = model.probabilities(&edge).iter().sum::<f64>() / 2.0;
        assert!((unsure.mean - mean).abs() < 1e-12);
    }

    #[test]
    fn whatever_it_is_told_there_are_probabilities_or_no_model() {
        let space = Space::unit_cube(2);
        let known = tests(&space, 12);
        for told in [f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e-300, 1e300, f64::NAN] {
            let mixed: Vec<f64> = (0..12).map(|i| if i % 3 == 0 { -1.0 } else { told }).collect();
            for told in [vec![told; 12], mixed] {
                let Some(model) = FailureModel::fit(&space, &known, &told) else {
                    assert!(told.iter().all(|told| told.is_nan()));
                    continue;
                };
                assert!(model.probabilities(&known).iter().all(|p| (0.0..=1.0).contains(p)), "{told:?}");
            }
        }
        assert!(FailureModel::fit(&space, &known[..1], &[1.0]).is_none());
        let doubled: Vec<Point> = known.iter().chain(&known).cloned().collect();
        let told: Vec<f64> = (0..24).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(FailureModel::fit(&space, &doubled, &told).is_some());
    }
}
