//! Measures on tests what the paper's propositions say: random tests cover all k-wise combinations (3.2), and the dispersion of Halton tests falls
//! as one over their number (3.3).

use crate::{Done, print, write};
use indicatif::ProgressBar;
use paracosm::coverage::dispersion::dispersion;
use paracosm::coverage::kwise::kwise_coverage;
use paracosm::coverage::theory::rows::proposition_3_2;
use paracosm::coverage::{Deadline, PointSet};
use paracosm::generators::{GeneratorError, Request, Strategy};
use paracosm::space::rules::Rules;
use paracosm::space::{Point, Space};
use rayon::prelude::*;
use std::error::Error;
use std::path::Path;

/// The numbers of two-valued coordinates, with the strength k.
const FAMILIES: [(usize, usize); 4] = [(10, 2), (20, 2), (100, 2), (20, 3)];
/// The probability with which a random family may miss a combination.
const DELTA: f64 = 0.05;
const FAMILY_SEEDS: u64 = 1000;

/// The numbers of tests in two dimensions.
const SIZES: [usize; 7] = [25, 100, 500, 1_000, 5_000, 20_000, 100_000];
const SEEDS: u64 = 20;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length(FAMILIES.len() as u64 * FAMILY_SEEDS + SIZES.len() as u64 * (SEEDS + 1));
    let mut families = String::from("coordinates,k,tests,seed,covers\n");
    for (coordinates, k) in FAMILIES {
        let tests = proposition_3_2(coordinates, k, DELTA).ceil() as usize;
        let covers: Result<Vec<bool>, _> =
            (0..FAMILY_SEEDS).into_par_iter().map(|seed| is_family(coordinates, k, tests, seed, bar)).collect();
        let covers = covers?;
        for (seed, covers) in covers.iter().enumerate() {
            families += &format!("{coordinates},{k},{tests},{seed},{}\n", u8::from(*covers));
        }
        let share = covers.iter().filter(|covers| **covers).count();
        print(&format!("{coordinates} coordinates, k = {k}: {share} of {FAMILY_SEEDS} sets of {tests} tests cover\n"))?;
    }
    write(&out.join("propositions-families.csv"), &families)?;

    let mut dispersions = String::from("strategy,tests,seed,dispersion\n");
    for tests in SIZES {
        let seeds: Vec<Option<u64>> = std::iter::once(None).chain((0..SEEDS).map(Some)).collect();
        let measured: Result<Vec<f64>, _> = seeds.par_iter().map(|seed| of_points(*seed, tests, bar)).collect();
        let measured = measured?;
        dispersions += &format!("halton,{tests},,{}\n", measured[0]);
        for (seed, dispersion) in measured[1..].iter().enumerate() {
            dispersions += &format!("random,{tests},{seed},{dispersion}\n");
        }
        print(&format!(
            "{tests} tests of Halton: dispersion {:.5}, {:.2} over their number\n",
            measured[0],
            tests as f64 * measured[0]
        ))?;
    }
    bar.finish_and_clear();
    write(&out.join("propositions-dispersion.csv"), &dispersions)
}

/// Returns `true` if random tests of two-valued coordinates contain every combination of k values.
fn is_family(
    coordinates: usize,
    k: usize,
    tests: usize,
    seed: u64,
    bar: &ProgressBar,
) -> Result<bool, Box<dyn Error + Send + Sync>> {
    let points = points(Strategy::RANDOM, coordinates, tests, Some(seed))?;
    let rows: Vec<Vec<usize>> =
        points.iter().map(|point| point.continuous.iter().map(|x| usize::from(*x >= 0.5)).collect()).collect();
    let rules = Rules::new(&vec![2; coordinates], &[])?;
    bar.inc(1);
    let counted = kwise_coverage(&rules, k, rows.iter().map(Vec::as_slice))?;
    Ok(counted.covered == counted.valid)
}

/// Returns the dispersion of points in the unit square: of Halton's plain sequence, or of random points with a seed.
fn of_points(seed: Option<u64>, tests: usize, bar: &ProgressBar) -> Result<f64, Box<dyn Error + Send + Sync>> {
    let strategy = if seed.is_some() { Strategy::RANDOM } else { Strategy::HALTON };
    let points = points(strategy, 2, tests, seed)?;
    let set = PointSet::new(2, points.iter().map(|point| &point.continuous))?;
    bar.inc(1);
    Ok(dispersion(&set, Deadline::never()).volume.lower)
}

fn points(strategy: Strategy, dims: usize, tests: usize, seed: Option<u64>) -> Result<Vec<Point>, GeneratorError> {
    let space = Space::unit_cube(dims);
    Ok(strategy.build(&Request { seed, ..Request::new(&space, tests) })?.ask(tests))
}
