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
use paracosm_coverage::{Point, Space};
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
        let group = |x: [f64; 4]| x.map(|x| (at(x, 0.5), 1.0)).to_vec();
        let found = model.shares(&[group([0.1, 0.2, 0.3, 0.4]), group([0.2, 0.3, 0.4, 0.9]), group([0.9; 4])], 1);
        // As sure as a hundred tests can be.
        let (never, always) = (1.0 / 102.0, 101.0 / 102.0);
        let expected = [(0.0, never), (0.25, never), (1.0, always)];
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
        let unsure = model.shares(&[edge.clone().map(|test| (test, 1.0)).to_vec()], 1)[0];
        assert!(unsure.deviation > 0.1 && (0.05..0.95).contains(&unsure.above_half), "{unsure:?}");
        let mean = model.probabilities(&edge).iter().sum::<f64>() / 2.0;
        assert!((unsure.mean - mean).abs() < 1e-12);
    }

    #[test]
    fn the_error_of_taking_samples_is_in_the_deviation_and_weights_count() {
        let space = Space::unit_cube(2);
        let known = tests(&space, 100);
        let fails = |at: &Point| 0.6 - at.continuous[0];
        let model = FailureModel::fit(&space, &known, &known.iter().map(fails).collect::<Vec<_>>()).unwrap();
        let group = |tests: [(f64, f64); 4]| {
            vec![tests.map(|(x, weight)| (Point { continuous: vec![x, 0.5], discrete: Vec::new() }, weight)).to_vec()]
        };
        // Two samples, one of which fails whole: the share is one half, give or take one half.
        let apart = model.shares(&group([(0.1, 1.0), (0.2, 1.0), (0.8, 1.0), (0.9, 1.0)]), 2)[0];
        assert!((apart.mean - 0.5).abs() < 0.02 && (apart.deviation - 0.5).abs() < 0.02, "{apart:?}");
        let alike = model.shares(&group([(0.1, 1.0), (0.9, 1.0), (0.2, 1.0), (0.8, 1.0)]), 2)[0];
        assert!((alike.mean - 0.5).abs() < 0.02 && alike.deviation < 0.05, "{alike:?}");
        let weighed = model.shares(&group([(0.1, 1.0), (0.9, 3.0), (0.2, 1.0), (0.8, 0.0)]), 1)[0];
        assert!((weighed.mean - 0.6).abs() < 0.02, "{weighed:?}");
    }

    /// Of places along two of some parameters, where tests pass on one side of a random plane: the share that is decided after
    /// so many tests, and the share of it that is right.
    fn decided(dimensions: usize, n: usize, planes: u64) -> (f64, f64) {
        let (mut decided, mut right, mut places) = (0, 0, 0);
        for plane in 0..planes {
            let mut rng = seeded(plane, Purpose::Points, 77);
            let slopes: Vec<f64> = (0..dimensions).map(|_| normal(&mut rng)).collect();
            let space = Space::unit_cube(dimensions);
            let worth = |at: &Point| {
                let side: f64 = at.continuous.iter().zip(&slopes).map(|(u, slope)| slope * (u - 0.5)).sum();
                side + 0.1
            };
            let known =
                Strategy::Random.build(&Request { seed: Some(plane), ..Request::new(&space, n) }).unwrap().ask(n);
            let told: Vec<f64> = known.iter().map(worth).collect();
            let failing = told.iter().filter(|told| **told < 0.0).count();
            if failing == 0 || failing == n {
                continue;
            }
            let model = FailureModel::fit(&space, &known, &told).unwrap();
            let others = Request { seed: Some(plane + 1000), ..Request::new(&space, 128) };
            let others = Strategy::Random.build(&others).unwrap().ask(128);
            let at = |x: f64, y: f64| -> Vec<(Point, f64)> {
                let place = |mut other: Point| {
                    (other.continuous[0], other.continuous[1]) = (x, y);
                    (other, 1.0)
                };
                others.iter().cloned().map(place).collect()
            };
            let groups: Vec<_> = (0..25).map(|i| at(f64::from(i % 5) / 4.01, f64::from(i / 5) / 4.01)).collect();
            for (group, share) in groups.iter().zip(model.shares(&groups, 8)) {
                let fails = group.iter().filter(|(test, _)| worth(test) < 0.0).count() > 64;
                places += 1;
                if share.above_half >= 0.95 || share.above_half <= 0.05 {
                    decided += 1;
                    right += usize::from(fails == (share.above_half > 0.5));
                }
            }
        }
        (f64::from(decided) / f64::from(places), right as f64 / f64::from(decided.max(1)))
    }

    #[test]
    fn a_few_tests_decide_nothing_and_what_more_tests_decide_is_right() {
        for (dimensions, n) in [(10, 5), (10, 10), (2, 4)] {
            assert_eq!(decided(dimensions, n, 10).0, 0.0, "{dimensions} axes, {n} tests");
        }
        for (dimensions, n, least) in [(3, 20, 0.7), (10, 50, 0.4)] {
            let (share, right) = decided(dimensions, n, 20);
            assert!(share > least && right > 0.97, "{dimensions} axes, {n} tests: {share}, {right} of it right");
        }
    }

    #[test]
    fn where_little_can_be_told_as_many_are_said_to_fail_as_do() {
        // Of tests in six parameters one in eight fails, and hardly any parameter says which. The model sees 400 of them, but
        // all that fail.
        let space = Space::unit_cube(6);
        let known = tests(&space, 600);
        let told: Vec<f64> =
            (0..600_u64).map(|i| if crate::seeded::mix(i).is_multiple_of(8) { -3.0 } else { 1.0 }).collect();
        let counted = told.iter().filter(|told| **told < 0.0).count() as f64 / 600.0;
        let model = FailureModel::fit(&space, &known, &told).unwrap();
        let others = Strategy::Random.build(&Request::new(&space, 2000)).unwrap().ask(2000);
        let mean = model.probabilities(&others).iter().sum::<f64>() / 2000.0;
        assert!((mean - counted).abs() < 0.02, "{mean}, counted {counted}");
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
