//! Shows how the coverage of a campaign grew with its tests.

use crate::Limit;
use crate::estimate::{Coverage, Measured};
use paracosm_campaign::{Error, Log, TestSet};
use paracosm_coverage::Measure;
use serde::Serialize;

/// The number of sizes at which the coverage is measured.
const SIZES: u32 = 14;
/// The limit of work at each size.
const LIMIT: Limit = Limit::Work(100_000_000);

/// The coverage of the space by the first tests of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Growth {
    /// The number of tests that count for coverage.
    pub tests: usize,
    /// A lower and an upper bound of the dispersion, which is the volume of the largest empty box; `None` without continuous parameters.
    pub dispersion: Option<[f64; 2]>,
    /// The share of the combinations of discrete values that the tests cover; `None` without discrete parameters.
    pub k_wise: Option<f64>,
}

impl Growth {
    /// Measures the coverage by the first tests of a campaign, for numbers of tests that grow by the same factor.
    ///
    /// # Errors
    /// A test does not belong to the space, or the system cannot start a thread.
    pub fn of(log: &Log) -> Result<Vec<Self>, Error> {
        let tests = log.test_set()?;
        let all = tests.points.len();
        let mut growth: Vec<Self> = Vec::new();
        for step in 1..=SIZES {
            let size = libm::pow(all as f64, f64::from(step) / f64::from(SIZES)).round() as usize;
            if size == 0 || growth.last().is_some_and(|last| last.tests == size) {
                continue;
            }
            let first = TestSet { points: tests.points[..size].to_vec(), ..tests.clone() };
            let coverage = Coverage::of(&first, &[Measure::DISPERSION, Measure::K_WISE], None, LIMIT)?;
            growth.push(Self { tests: size, dispersion: dispersion(&coverage), k_wise: k_wise(&coverage) });
        }
        Ok(growth)
    }
}

fn dispersion(coverage: &Coverage) -> Option<[f64; 2]> {
    let continuous = coverage.continuous.as_ref()?;
    continuous.measured.iter().find_map(|(_, measured)| match measured {
        Measured::Hole(hole) => Some([hole.volume.lower, hole.volume.upper]),
        _ => None,
    })
}

fn k_wise(coverage: &Coverage) -> Option<f64> {
    coverage.discrete.as_ref()?.as_ref().map(|discrete| discrete.ratio)
}
