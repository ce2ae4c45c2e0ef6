//! Subset simulation (Au and Beck, Estimation of small failure probabilities in high dimensions by subset simulation,
//! Probabilistic Engineering Mechanics 16, 2001), which is adaptive multilevel splitting (Cérou and Guyader, Stochastic
//! Analysis and Applications 25, 2007): a rare failure is reached over levels of robustness, each of which a tenth of the
//! tests of the one before it falls below.
//!
//! A run that chooses its levels by the tests that it then counts is a little off, and its own tests depend on each
//! other, so that formulas for its spread say too little. Therefore a pilot chooses the levels and the steps of the
//! chains once, and independent repetitions with these only count; the interval is that of their mean. Each
//! repetition is nearly log-normally distributed, and unbiased but for terms of the order of one over its tests.
//! What all repetitions miss alike, such as failures in a place to which no level leads, no interval shows.

mod chains;
mod pilot;

use super::{Question, Runs, Tail, Tally, monte_carlo};
use crate::statistics::random::SplitMix64;
use crate::statistics::{clopper_pearson, log_normal_mean_interval, mean_interval};
use chains::{Population, grow};
use paracosm_campaign::Error;
use pilot::Pilot;

/// The share of tests that reaches the next level: 0.1 is what Au and Beck recommend.
const SHARE: f64 = 0.1;

/// How many independent repetitions there are.
const REPLICATES: usize = 10;

/// With less a repetition has too few tests at a level to go on from.
pub(super) const LEAST_BUDGET: usize = 2000;

/// A level of robustness on the way down.
struct Level {
    /// The robustness that tests of this level do not exceed.
    threshold: f64,
    /// How far the chains step at this level, from 0 to 1.
    step: f64,
}

pub(super) fn estimate(question: &Question, dims: usize, runs: &mut Runs) -> Result<Tail, Error> {
    let mut random = SplitMix64(question.seed);
    let Pilot { levels, lost } = Pilot::run(question.budget, dims, runs, &mut random)?;
    let mut notes: Vec<String> = lost.into_iter().collect();
    let left = question.budget.saturating_sub(runs.evaluations);
    // No level asks for more than its size, so that the budget is kept.
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

/// One estimate of the probability of a failure; the independent tests with which it begins are added to `first`.
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

/// The interval of the mean of independent repetitions.
fn interval(estimates: &[f64], first: Tally, confidence: f64, notes: &mut Vec<String>) -> [f64; 2] {
    let blind = estimates.iter().filter(|estimate| **estimate == 0.0).count();
    if blind == 0 {
        return log_normal_mean_interval(estimates, confidence);
    }
    notes.push(format!(
        "{blind} of {REPLICATES} repetitions found no failure, so that the interval is wide: take a larger budget"
    ));
    // So few failures that no distribution can be read off them. By Markov's inequality a mean that is seldom so many
    // times too large bounds the truth from below, and from above the independent tests do.
    let tail = (1.0 - confidence) / 2.0;
    let mean = estimates.iter().sum::<f64>() / estimates.len() as f64;
    let [_, upper] = mean_interval(estimates, confidence);
    [tail * mean, upper.max(first.interval(confidence)[1])]
}

/// The interval where some tests could not be judged: how many tests these are is known from the independent ones.
fn widened(lower: f64, upper: f64, first: Tally, question: &Question) -> (f64, f64) {
    let [_, unjudged] = clopper_pearson(first.unjudged, first.tests, question.confidence);
    (lower * (1.0 - unjudged), upper + unjudged)
}
