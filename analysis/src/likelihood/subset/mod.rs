//! Implements subset simulation (Au and Beck, Estimation of small failure probabilities in high dimensions by subset
//! simulation, Probabilistic Engineering Mechanics 16, 2001), a form of adaptive multilevel splitting (Cérou and
//! Guyader, Stochastic Analysis and Applications 25, 2007). It reaches a rare failure through levels of robustness: a
//! tenth of the tests of each level falls below the next level.
//!
//! A run that chooses its levels by the same tests that it counts is slightly biased. Its tests also depend on each
//! other, so that formulas for its spread give too small a value. Therefore a pilot chooses the levels and the steps
//! of the chains once, and independent repetitions with these levels and steps only count. The interval is that of
//! the mean of the repetitions. Each repetition is nearly log-normally distributed, and unbiased except for terms of
//! the order of one over its number of tests. The interval does not show what all repetitions miss, such as failures
//! in a place to which no level leads.

mod chains;
mod pilot;

use super::{Question, Runs, Tail, Tally, monte_carlo};
use crate::statistics::random::SplitMix64;
use crate::statistics::{clopper_pearson, log_normal_mean_interval, mean_interval};
use chains::{Population, grow};
use paracosm_campaign::Error;
use pilot::Pilot;

/// The share of tests that reaches the next level. Au and Beck recommend 0.1.
const SHARE: f64 = 0.1;

/// The number of independent repetitions.
const REPLICATES: usize = 10;

/// The least budget, because with a smaller budget a repetition has too few tests at a level to continue.
pub(super) const LEAST_BUDGET: usize = 2000;

/// A level of robustness on the way to a failure.
struct Level {
    /// The robustness that tests of this level do not exceed.
    threshold: f64,
    /// The size of the steps of the chains at this level, from 0 to 1.
    step: f64,
}

pub(super) fn estimate(question: &Question, dims: usize, runs: &mut Runs) -> Result<Tail, Error> {
    let mut random = SplitMix64(question.seed);
    let Pilot { levels, lost } = Pilot::run(question.budget, dims, runs, &mut random)?;
    let mut notes: Vec<String> = lost.into_iter().collect();
    let left = question.budget.saturating_sub(runs.evaluations);
    // No level runs more tests than `size`, so that the budget is kept.
    let size = (left / (REPLICATES * (levels.len() + 1))).max(1);
    let mut first = Tally::default();
    let mut estimates = Vec::with_capacity(REPLICATES);
    for _ in 0..REPLICATES {
        let mut random = SplitMix64(random.bits());
        estimates.push(repetition(&levels, size, dims, runs, &mut random, &mut first)?);
    }
    if levels.is_empty() {
        let interval = first.interval(question.confidence);
        return Ok(Tail { probability: first.share()?, interval, source: monte_carlo::SOURCE.to_owned(), notes });
    }
    let probability = estimates.iter().sum::<f64>() / REPLICATES as f64;
    let [lower, upper] = interval(&estimates, first, question.confidence, &mut notes);
    let (lower, upper) = if runs.unjudged == 0 { (lower, upper) } else { widened(lower, upper, first, question) };
    let source = format!("{REPLICATES} repetitions of {size} tests at each of {} levels", levels.len() + 1);
    Ok(Tail { probability, interval: [lower, upper], source, notes })
}

/// Returns one estimate of the probability of a failure. The independent tests with which it begins are added to
/// `first`.
fn repetition(
    levels: &[Level],
    size: usize,
    dims: usize,
    runs: &mut Runs,
    random: &mut SplitMix64,
    first: &mut Tally,
) -> Result<f64, Error> {
    let (mut population, tally) = Population::independent(size, dims, runs, random)?;
    first.add(tally);
    let mut probability = 1.0;
    for level in levels {
        let members = population.len();
        let seeds = population.below(level.threshold);
        if seeds.is_empty() {
            return Ok(0.0);
        }
        probability *= seeds.len() as f64 / members as f64;
        population = grow(seeds, size, level.threshold, |_| level.step, runs, random)?;
    }
    Ok(probability * population.failures() as f64 / population.len().max(1) as f64)
}

/// Returns the interval of the mean of independent repetitions.
fn interval(estimates: &[f64], first: Tally, confidence: f64, notes: &mut Vec<String>) -> [f64; 2] {
    let blind = estimates.iter().filter(|estimate| **estimate == 0.0).count();
    if blind == 0 {
        return log_normal_mean_interval(estimates, confidence);
    }
    notes.push(format!(
        "{blind} of {REPLICATES} repetitions found no failure, so that the interval is wide: take a larger budget"
    ));
    // With so few failures no distribution can be assumed. By Markov's inequality, a mean is rarely 1/`tail` times
    // too large, which gives a lower bound. The independent tests give an upper bound.
    let tail = (1.0 - confidence) / 2.0;
    let mean = estimates.iter().sum::<f64>() / estimates.len() as f64;
    let [_, upper] = mean_interval(estimates, confidence);
    [tail * mean, upper.max(first.interval(confidence)[1])]
}

/// Widens the interval if some tests could not be judged. The independent tests show how many tests these are.
fn widened(lower: f64, upper: f64, first: Tally, question: &Question) -> (f64, f64) {
    let [_, unjudged] = clopper_pearson(first.unjudged, first.tests, question.confidence);
    (lower * (1.0 - unjudged), upper + unjudged)
}
