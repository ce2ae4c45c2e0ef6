//! Compares strategies by how much their sets tell about the failures of both maps of Figure 9: with the emergency brake, and with a
//! network as the driver.
//!
//! One set says little, because the recalls of sets of one size are spread widely. The maps make many sets cheap: a test has the verdict of
//! its cell, and nothing is simulated.

use crate::recovery::{Mark, recovery};
use crate::sampling::{grid, marks, write_csv};
use crate::{Done, fig9, print, scenario};
use indicatif::ProgressBar;
use paracosm::analysis::statistics::median_and_quartiles;
use paracosm::generators::{Request, Strategy};
use paracosm::space::Space;
use rayon::prelude::*;
use std::error::Error;
use std::path::Path;

const STRATEGIES: [Strategy; 5] =
    [Strategy::RANDOM, Strategy::HALTON, Strategy::SOBOL_OWEN, Strategy::LHS, Strategy::GREEDY];

/// The number of sets of each strategy, each with another seed. A seed shifts the points of Halton.
const SETS: u64 = 200;

/// The map with a network as the driver, which comes with the software.
const WITH_NETWORK: &str = include_str!("../data/fig9-cnn-reference.csv");
/// The number of tests on each side of that map.
const SIDE_WITH_NETWORK: usize = 50;
/// The sizes of the samples of `fig9-cnn`.
const SIZES_WITH_NETWORK: [usize; 3] = [25, 50, 100];

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length((fig9::SIDE * fig9::SIDE) as u64);
    for (name, map, sizes) in
        [("fig9", without_network(bar)?, fig9::SIZES), ("fig9-cnn", with_network(), SIZES_WITH_NETWORK)]
    {
        let mut rows = vec![["strategy", "tests", "seed", "recall"].map(str::to_owned).to_vec()];
        for strategy in STRATEGIES {
            for size in sizes {
                let recalls: Vec<f64> =
                    (0..SETS).into_par_iter().map(|seed| recall(&map, strategy, size, seed)).collect();
                let (median, [lower, upper]) = median_and_quartiles(&recalls);
                print(&format!("{name:<9}{strategy:<12}{size:>4}  {median:.3} ({lower:.3} to {upper:.3})\n"))?;
                let row = |(seed, recall): (u64, f64)| {
                    vec![strategy.to_string(), size.to_string(), seed.to_string(), recall.to_string()]
                };
                rows.extend((0..SETS).zip(recalls).map(row));
            }
        }
        write_csv(&out.join(format!("{name}-recalls.csv")), &rows)?;
    }
    bar.finish_and_clear();
    Ok(())
}

/// Returns the share of the map's failures that the nearest test of a set predicts. The rows of the square map follow each other.
fn recall(map: &[Mark], strategy: Strategy, size: usize, seed: u64) -> f64 {
    let side = map.len().isqrt();
    let space = Space::unit_cube(2);
    let points =
        strategy.build(&Request { seed: Some(seed), ..Request::new(&space, size) }).expect("a plain request").ask(size);
    let test = |at: [f64; 2]| {
        let [column, row] = at.map(|share| (share * side as f64) as usize);
        (at, map[side * row + column].1)
    };
    let set: Vec<Mark> = points.iter().map(|point| test([point.continuous[0], point.continuous[1]])).collect();
    recovery(&set, map).recall
}

fn with_network() -> Vec<Mark> {
    let middle = |place: usize| (place as f64 + 0.5) / SIDE_WITH_NETWORK as f64;
    let verdicts = WITH_NETWORK.lines().skip(1).map(|row| row.contains(",fail,")).enumerate();
    verdicts.map(|(i, fails)| ([middle(i % SIDE_WITH_NETWORK), middle(i / SIDE_WITH_NETWORK)], fails)).collect()
}

fn without_network(bar: &ProgressBar) -> Result<Vec<Mark>, Box<dyn Error + Send + Sync>> {
    let study = scenario("pedestrian-crossing")?.build()?;
    Ok(marks(&study, &grid(&study, fig9::SIDE, bar)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All small sets and the first large ones, because greedy takes seconds for a large set.
    #[test]
    fn the_recalls_in_the_repository_are_the_recalls_of_today() {
        let maps = [
            (include_str!("../data/fig9-recalls.csv"), without_network(&ProgressBar::hidden()).unwrap()),
            (include_str!("../data/fig9-cnn-recalls.csv"), with_network()),
        ];
        for (csv, map) in maps {
            let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|line| line.split(',').collect()).collect();
            assert_eq!(rows.len(), STRATEGIES.len() * 3 * SETS as usize);
            for row in rows {
                let (strategy, size, seed) =
                    (row[0].parse().unwrap(), row[1].parse().unwrap(), row[2].parse().unwrap());
                if size == 25 || seed < 3 {
                    assert_eq!(recall(&map, strategy, size, seed).to_string(), row[3], "{row:?}");
                }
            }
        }
    }
}
