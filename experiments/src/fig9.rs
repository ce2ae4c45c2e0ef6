//! The paper's Figure 9 without a network: the pedestrian study, sampled at random and by the Halton sequence.
//!
//! The paper shows one random sample beside the Halton points, and says that the Halton points are more spread out,
//! above all if they are few. Here the driver is `aeb`, which is fast enough for a map of 10,000 tests and for 30
//! random samples.

use crate::sampling::{Comparison, marks, reference_map};
use crate::{Done, scenario};
use indicatif::ProgressBar;
use std::path::Path;

/// The numbers of tests in the samples.
pub const SIZES: [usize; 3] = [25, 100, 500];
const SEEDS: u64 = 30;
/// The number of tests on each side of the map.
pub const SIDE: usize = 100;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let study = scenario("pedestrian-crossing")?.build()?;
    bar.set_length((SIDE * SIDE) as u64);
    let map = marks(&study, &reference_map(&study, SIDE, out, "fig9", bar)?)?;
    let comparison = Comparison { study: &study, sizes: &SIZES, seeds: SEEDS, map: &map };
    bar.inc_length(comparison.tests() as u64);
    comparison.run(out, "fig9", bar)
}
