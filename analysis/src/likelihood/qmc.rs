//! Implements quasi-Monte Carlo: the points are more even than random points. Each set of points is randomised as a
//! whole, and repetitions show by their spread how large the error is (Owen, Scrambled net variance for integrals of
//! smooth functions, Annals of Statistics 25, 1997; L'Ecuyer and Lemieux, Recent advances in randomized quasi-Monte
//! Carlo methods, 2002).

use super::monte_carlo::BATCH;
use super::{Question, Runs, Tail, Tally};
use crate::statistics::mean_interval;
use crate::statistics::random::SplitMix64;
use paracosm_campaign::Error;
use paracosm_generators::{Request, Strategy};
use paracosm_space::Space;

/// The least number of repetitions, because Student's interval is wide with fewer repetitions.
pub(super) const REPLICATES: usize = 10;

pub(super) fn estimate(question: &Question, dims: usize, runs: &mut Runs) -> Result<Tail, Error> {
    // Sobol's points are most even if their number is a power of two. The rest of the budget makes more repetitions.
    let size = 1_usize << (question.budget / REPLICATES).ilog2();
    let count = question.budget / size;
    let space = Space::unit_cube(dims);
    let mut seeds = SplitMix64(question.seed);
    let mut tallies = Vec::with_capacity(count);
    for _ in 0..count {
        let request = Request { seed: Some(seeds.bits()), ..Request::new(&space, size) };
        let mut generator = Strategy::SOBOL_OWEN.build(&request)?;
        let mut tally = Tally::default();
        while tally.tests < size {
            let points = generator.ask(BATCH.min(size - tally.tests));
            let points: Vec<Vec<f64>> = points.into_iter().map(|point| point.continuous).collect();
            tally.add(Tally::of(&runs.run(&points)?));
        }
        tallies.push(tally);
    }
    let mut all = Tally::default();
    tallies.iter().for_each(|tally| all.add(*tally));
    let (interval, source, notes) = interval(&tallies, all, question.confidence);
    Ok(Tail { probability: all.share()?, interval, source, notes })
}

/// Returns the interval, its statistical basis in words, and remarks about it.
fn interval(tallies: &[Tally], all: Tally, confidence: f64) -> ([f64; 2], String, Vec<String>) {
    let count = tallies.len();
    let judged = all.tests - all.unjudged;
    let fewer = all.failures.min(judged - all.failures);
    if fewer < count {
        let outcome = if fewer == all.failures { "failures" } else { "passing tests" };
        let note = format!(
            "with so few {outcome} ({fewer} in {count} repetitions) the spread of the repetitions says nothing: the interval is that of as many \
             independent tests"
        );
        return (all.interval(confidence), "Clopper and Pearson, as of independent tests".to_owned(), vec![note]);
    }
    let share = |failures: usize, tests: usize| failures as f64 / tests as f64;
    let passed: Vec<f64> = tallies.iter().map(|tally| share(tally.failures, tally.tests)).collect();
    let failed: Vec<f64> = tallies.iter().map(|tally| share(tally.failures + tally.unjudged, tally.tests)).collect();
    let source = format!("Student, {count} repetitions of {} scrambled Sobol points", tallies[0].tests);
    let ([lower, _], [_, upper]) = (mean_interval(&passed, confidence), mean_interval(&failed, confidence));
    if passed.iter().any(|share| *share != passed[0]) {
        return ([lower, upper], source, Vec::new());
    }
    // That no repetition differs by a test does not mean that the next repetition would not differ.
    let tail = (1.0 - confidence) / 2.0;
    let off = (1.0 - libm::pow(tail, 1.0 / count as f64)) / tallies[0].tests as f64;
    let note =
        "all repetitions agree: the interval allows for a further repetition that differs by one test".to_owned();
    ([lower - off, upper + off], source, vec![note])
}
