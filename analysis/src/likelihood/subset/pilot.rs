//! Runs the pilot of a subset simulation, which chooses levels and steps and does not count.

use super::chains::{Population, grow, reaches};
use super::{Level, SHARE};
use crate::likelihood::Runs;
use crate::statistics::random::SplitMix64;
use paracosm_campaign::Error;

/// The number of parts of the budget, of which each level of the pilot gets one: a pilot with all levels takes less
/// than a third of the budget.
const PART: usize = 60;

/// The greatest number of levels: failures that need more levels have a probability below 1e-20.
const MOST_LEVELS: usize = 20;

/// The share of steps that the chains should accept (Papaioannou et al. 2015).
const ACCEPTED: f64 = 0.44;

/// The least and the greatest step. Other steps never help: a step of 1 forgets the current place.
const STEPS: [f64; 2] = [0.01, 1.0];

/// The result of the pilot, which are the chosen levels.
pub(super) struct Pilot {
    /// The levels of robustness on the way to a failure; empty if failures are common or the pilot found no way to a
    /// failure.
    pub levels: Vec<Level>,
    /// The reason why the pilot found no way to a failure; `None` if the pilot found a way.
    pub lost: Option<String>,
}

impl Pilot {
    pub fn run(budget: usize, dims: usize, runs: &mut Runs, random: &mut SplitMix64) -> Result<Self, Error> {
        let size = budget / PART;
        let (mut population, _) = Population::independent(size, dims, runs, random)?;
        let mut levels: Vec<Level> = Vec::new();
        loop {
            let threshold = match next_threshold(&population) {
                Next::Failure => return Ok(Self { levels, lost: None }),
                Next::Level(threshold) if levels.len() < MOST_LEVELS => threshold,
                Next::Level(threshold) | Next::Stuck(threshold) => {
                    let lost = format!(
                        "the pilot found no way to a failure below a robustness of {threshold:.3}: the rest of the \
                         budget went into independent tests"
                    );
                    return Ok(Self { levels: Vec::new(), lost: Some(lost) });
                }
            };
            let mut step = levels.last().map_or(0.6, |level| level.step);
            let mut asked = 0;
            let adapt = |moved: Option<f64>| {
                if let Some(moved) = moved {
                    asked += 1;
                    let change = (moved - ACCEPTED) / f64::from(asked).sqrt();
                    step = (step * libm::exp(change)).clamp(STEPS[0], STEPS[1]);
                }
                step
            };
            population = grow(population.below(threshold), size, threshold, adapt, runs, random)?;
            levels.push(Level { threshold, step });
        }
    }
}

/// The way in which a population continues.
enum Next {
    /// The population has enough failing tests.
    Failure,
    /// The population has a next level at this robustness.
    Level(f64),
    /// There is no next level: too many tests have this robustness, and no test is below it.
    Stuck(f64),
}

fn next_threshold(population: &Population) -> Next {
    let mut sorted: Vec<f64> = population.0.iter().map(|member| member.robustness).collect();
    sorted.sort_by(f64::total_cmp);
    let wanted = ((SHARE * sorted.len() as f64).ceil() as usize).max(1);
    let failures = population.failures();
    if failures >= wanted {
        return Next::Failure;
    }
    let threshold = sorted[wanted - 1];
    let below = sorted.partition_point(|robustness| robustness.total_cmp(&threshold).is_lt());
    let at = sorted.iter().filter(|robustness| reaches(**robustness, threshold)).count();
    // A plateau of equal values cannot be a level, but the value below it can.
    match below {
        _ if 2 * at <= sorted.len() => Next::Level(threshold),
        0 => Next::Stuck(threshold),
        below if below == failures => Next::Failure,
        below => Next::Level(sorted[below - 1]),
    }
}
