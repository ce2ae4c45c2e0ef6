//! The pilot: chooses levels and steps, and counts nothing.

use super::chains::{Population, grow, reaches};
use super::{Level, SHARE};
use crate::likelihood::Runs;
use crate::statistics::random::SplitMix64;
use paracosm_campaign::Error;

/// Of how many parts of the budget each level of the pilot gets one: a pilot of all levels takes less than a third.
const PART: usize = 60;

/// Failures that more levels are needed for have a probability below 1e-20.
const MOST_LEVELS: usize = 20;

/// The share of steps that is to be taken (Papaioannou et al. 2015).
const ACCEPTED: f64 = 0.44;

/// Steps beyond these ends help in no case: at 1 a place is forgotten.
const STEPS: [f64; 2] = [0.01, 1.0];

/// What the pilot found.
pub(super) struct Pilot {
    /// The levels before the failure; none where failures are common, or the way to them was lost.
    pub levels: Vec<Level>,
    /// Why no way was found.
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
                        "the pilot found no way down to a failure from a robustness of {threshold:.3}: the rest of the \
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

/// Where a population goes on.
enum Next {
    /// Enough of it failed.
    Failure,
    /// At this robustness.
    Level(f64),
    /// Nowhere: too many are at this robustness, and none below it.
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
    // A plateau of equal values is no level; what lies below it may be one.
    match below {
        _ if 2 * at <= sorted.len() => Next::Level(threshold),
        0 => Next::Stuck(threshold),
        below if below == failures => Next::Failure,
        below => Next::Level(sorted[below - 1]),
    }
}
