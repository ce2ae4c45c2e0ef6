//! Implements plain Monte Carlo: runs independent tests and counts the failures.

use super::{Question, Runs, Tail, Tally};
use crate::statistics::random::SplitMix64;
use paracosm_campaign::Error;

/// The number of tests that run at a time, enough for many cores and few enough for the memory.
pub(super) const BATCH: usize = 4096;

/// The statistical basis of the interval, in words.
pub(super) const SOURCE: &str = "Clopper and Pearson, independent tests";

pub(super) fn estimate(question: &Question, dims: usize, runs: &mut Runs) -> Result<Tail, Error> {
    let mut random = SplitMix64(question.seed);
    let mut tally = Tally::default();
    while tally.tests < question.budget {
        let batch = BATCH.min(question.budget - tally.tests);
        let points: Vec<Vec<f64>> = (0..batch).map(|_| (0..dims).map(|_| random.unit()).collect()).collect();
        tally.add(Tally::of(&runs.run(&points)?));
    }
    let notes = if tally.failures == 0 {
        let note = "no test failed: to find rarer failures, choose a larger budget or the method subset";
        vec![note.to_owned()]
    } else {
        Vec::new()
    };
    Ok(Tail {
        probability: tally.share()?,
        interval: tally.interval(question.confidence),
        source: SOURCE.to_owned(),
        notes,
    })
}
