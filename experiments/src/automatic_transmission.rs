//! Counts after how many simulations each strategy falsifies the automatic transmission. The study takes five
//! requirements of the benchmark and 30 seeds, with tests in batches as in campaigns, and one at a time. A run without
//! a failure counts as its whole budget.

use crate::system::{InputFlaw, inputs};
use crate::transmission::{SAMPLES_PER_SECOND, run as simulate};
use crate::{Done, print, write};
use indicatif::ProgressBar;
use paracosm::generators::{Request, Strategy};
use paracosm::oracles::{Formula, Trace, Truth};
use paracosm::space::{Point, Space};
use rayon::prelude::*;
use std::path::Path;

/// The space of the tests, from the same file that is given to the command line.
const SPACE: &str = include_str!("../systems/automatic-transmission.toml");

/// The greatest number of simulations in a run.
const BUDGET: usize = 300;
const SEEDS: u64 = 30;
/// The numbers of tests that an adaptive strategy is asked for at a time: as many as in a campaign, and one.
const BATCHES: [usize; 2] = [16, 1];

/// The requirements, with their names in the benchmark.
const REQUIREMENTS: [(&str, &str); 5] = [
    ("AT1", "always[0,20] (speed < 120)"),
    ("AT2", "always[0,10] (rpm < 4750)"),
    ("AT6a", "always[0,30] (rpm < 3000) implies always[0,4] (speed < 35)"),
    ("AT6b", "always[0,30] (rpm < 3000) implies always[0,8] (speed < 50)"),
    ("AT6c", "always[0,30] (rpm < 3000) implies always[0,20] (speed < 65)"),
];

/// The strategies that are compared; `random-corners` is the control.
const STRATEGIES: [Strategy; 11] = [
    Strategy::RANDOM,
    Strategy::HALTON,
    Strategy::RANDOM_CORNERS,
    Strategy::ANNEAL,
    Strategy::PSO,
    Strategy::NELDER_MEAD,
    Strategy::CMAES,
    Strategy::GP_CMAES,
    Strategy::BAYES,
    Strategy::BOUNDARY,
    Strategy::AUTO,
];

/// The number of simulations until the first failure in each run of a strategy on a requirement; `None` without a
/// failure.
type Runs = Vec<Option<usize>>;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let space = Space::from_toml(SPACE)?;
    let ways: Vec<(usize, Strategy)> = ways().collect();
    bar.set_length((REQUIREMENTS.len() * ways.len()) as u64 * SEEDS);
    let mut table = String::from("requirement,strategy,batch,seed,simulations\n");
    for (name, formula) in REQUIREMENTS {
        let formula: Formula = formula.parse()?;
        bar.suspend(|| {
            let [strategy, batch, mean, median, found] = ["strategy", "batch", "mean", "median", "found"];
            print(&format!("{name}: {formula}\n  {strategy:<16}{batch:>8}{mean:>8}{median:>8}{found:>8}\n"))
        })?;
        for &(batch, strategy) in &ways {
            let seeds: Vec<u64> = (0..SEEDS).collect();
            let runs: Result<Runs, _> = seeds
                .into_par_iter()
                .map(|seed| {
                    let first = first_failure(&space, &formula, strategy, batch, seed);
                    bar.inc(1);
                    first
                })
                .collect();
            let runs = runs?;
            for (seed, run) in runs.iter().enumerate() {
                let simulations = run.map_or_else(String::new, |run| run.to_string());
                table += &format!("{name},{},{batch},{seed},{simulations}\n", strategy.name());
            }
            bar.suspend(|| print(&line(strategy.name(), batch, &runs)))?;
        }
    }
    bar.finish_and_clear();
    write(&out.join("simulations.csv"), &table)
}

/// Returns the pairs of batch size and strategy. Every strategy runs in batches as in a campaign; adaptive strategies,
/// for which the batch size matters, run with the other batch size as well.
fn ways() -> impl Iterator<Item = (usize, Strategy)> {
    let matters = |batch: usize, strategy: Strategy| batch == BATCHES[0] || strategy.is_adaptive();
    BATCHES.into_iter().flat_map(move |batch| {
        STRATEGIES.into_iter().filter(move |&strategy| matters(batch, strategy)).map(move |strategy| (batch, strategy))
    })
}

/// Returns a line with the mean, the median, and the number of runs with a failure.
fn line(name: &str, batch: usize, runs: &[Option<usize>]) -> String {
    let found = runs.iter().flatten().count();
    let mut counts: Vec<usize> = runs.iter().map(|run| run.unwrap_or(BUDGET)).collect();
    counts.sort_unstable();
    let mean = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
    let median = (counts[(counts.len() - 1) / 2] + counts[counts.len() / 2]) as f64 / 2.0;
    format!("  {name:<16}{batch:>8}{mean:>8.1}{median:>8.1}{:>8}\n", format!("{found}/{}", counts.len()))
}

/// Returns after how many simulations the first test fails; `None` if no test fails within the budget.
fn first_failure(
    space: &Space,
    formula: &Formula,
    strategy: Strategy,
    batch: usize,
    seed: u64,
) -> Result<Option<usize>, Box<dyn std::error::Error + Send + Sync>> {
    let mut generator = strategy.build(&Request { seed: Some(seed), ..Request::new(space, BUDGET) })?;
    let mut done = 0;
    while done < BUDGET {
        let tests = generator.ask(batch.min(BUDGET - done));
        if tests.is_empty() {
            break;
        }
        let mut robustness = Vec::new();
        for (index, test) in tests.iter().enumerate() {
            let trace = trace(space, test)?;
            let evaluation = formula.evaluate(&trace)?;
            if evaluation.truth == Truth::Violated {
                return Ok(Some(done + index + 1));
            }
            robustness.push(Some(evaluation.robustness));
        }
        generator.tell(&tests, &robustness);
        done += tests.len();
    }
    Ok(None)
}

fn trace(space: &Space, test: &Point) -> Result<Trace, InputFlaw> {
    let [throttle, brake] = inputs(&space.decode(test))?;
    let mut trace = Trace::new(1.0 / SAMPLES_PER_SECOND, ["speed", "rpm", "gear"].map(str::to_owned).to_vec());
    for sample in simulate(&throttle, &brake) {
        trace.record(&[sample.speed, sample.rpm, sample.gear as f64]);
    }
    trace.finish();
    Ok(trace)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truths(throttle: [f64; 7]) -> Vec<Truth> {
        let space = Space::from_toml(SPACE).unwrap();
        let continuous = throttle.into_iter().map(|percent| percent / 100.0).chain([0.0; 3]).collect();
        let trace = trace(&space, &Point { continuous, discrete: Vec::new() }).unwrap();
        let truth = |(_, text): &(&str, &str)| text.parse::<Formula>().unwrap().evaluate(&trace).unwrap().truth;
        REQUIREMENTS.iter().map(truth).collect()
    }

    #[test]
    fn every_requirement_can_be_violated_and_holds_without_throttle() {
        use Truth::{Holds, Violated};
        assert_eq!(truths([0.0; 7]), [Holds; 5]);
        assert_eq!(truths([99.999; 7])[..2], [Violated; 2]);
        assert_eq!(truths([48.0, 40.0, 34.0, 30.0, 30.0, 20.0, 20.0])[2..], [Violated; 3]);
    }

    #[test]
    fn a_run_without_a_failure_counts_as_the_whole_budget() {
        let expected = format!("  {:<16}{:>8}{:>8}{:>8}{:>8}\n", "x", 16, "155.0", "155.0", "1/2");
        assert_eq!(line("x", 16, &[Some(10), None]), expected);
    }
}
