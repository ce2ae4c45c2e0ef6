//! Sets of points with a small dispersion that were searched for as a whole.
//!
//! Such sets are better than sets that a formula makes. The crate on coverage ships some. For other sizes, a short search begins with the best of the plain sets. It makes a number of moves that depends on the size alone, so that the same request always has the same points.
//!
//! A set is not random, so a seed chooses the first point, and one of the 2^d d! images of the set under the symmetries of the cube, which all have the same dispersion. Each discrete row
//! has an image of its own. A set of the whole cube is not the best for a part of it, so under constraints on continuous parameters, `greedy` takes its place.

use crate::deal::Deal;
use crate::optimised::settled;
use crate::seeded::{Purpose, seeded};
use crate::sequence::{PerRow, RowSet};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind};
use crate::{GeneratorError, Strategy};
use paracosm_coverage::PointSet;
use rand::Rng;
use rand::seq::SliceRandom;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

impl Strategy {
    /// The strategy "best", which takes the set with the smallest dispersion that is known; a seed turns and mirrors the set.
    pub const BEST: Self = Self::of(&Descriptor {
        name: "best",
        about: "a low dispersion: a shipped set, or the result of a short search, made for exactly the budget",
        dims: ANY,
        look: Look::filled(0x00_0000, MarkShape::Tip),
        method: Method(MethodKind::Sets {
            plain: true,
            in_a_part: Some(Strategy::GREEDY),
            build: |dims, seed, deal| Ok(Box::new(PerRow::new(deal, Best::new(dims, seed, deal)?))),
        }),
    });
}

/// The best sets of all rows, each turned and mirrored in its own way.
struct Best {
    seed: Option<u64>,
    /// A set for each number of points.
    sets: BTreeMap<usize, Arc<PointSet>>,
}

/// The most sets that are remembered.
const MOST_REMEMBERED: usize = 64;

/// The sets by their number of points and of dimensions. A comparison asks for the same set with each seed, and the search takes up to some seconds.
static REMEMBERED: Mutex<BTreeMap<(usize, usize), Arc<PointSet>>> = Mutex::new(BTreeMap::new());

/// Returns the set of `settled`, which depends on the size alone.
fn remembered(n: usize, dims: usize) -> Result<Arc<PointSet>, GeneratorError> {
    let sets = || REMEMBERED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = sets().get(&(n, dims)) {
        return Ok(known.clone());
    }
    // Others need not wait for the search.
    let set = Arc::new(settled(n, dims)?);
    let mut sets = sets();
    if sets.len() >= MOST_REMEMBERED {
        sets.clear();
    }
    sets.insert((n, dims), set.clone());
    Ok(set)
}

impl Best {
    fn new(dims: usize, seed: Option<u64>, deal: Deal) -> Result<Self, GeneratorError> {
        let sizes = [0, deal.rows - 1].map(|row| deal.tests_of(row) as usize);
        let sets = sizes.into_iter().filter(|&size| size > 0).map(|size| Ok((size, remembered(size, dims)?)));
        Ok(Self { seed, sets: sets.collect::<Result<_, GeneratorError>>()? })
    }
}

impl RowSet for Best {
    fn point(&self, row: u64, size: u64, index: u64) -> Vec<f64> {
        let set = &self.sets[&(size as usize)];
        if row == 0 && self.seed.is_none() {
            return set.point(index as usize).to_vec();
        }
        let mut rng = seeded(self.seed.unwrap_or(0), Purpose::Shift, row);
        let point = set.point(((index + rng.random_range(0..size)) % size) as usize);
        let mut axes: Vec<usize> = (0..point.len()).collect();
        axes.shuffle(&mut rng);
        let mirrored =
            |axis: usize| if rng.random() { (1.0 - point[axis]).min(1.0_f64.next_down()) } else { point[axis] };
        axes.into_iter().map(mirrored).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GeneratorError, Request};
    use paracosm_coverage::dispersion::dispersion;
    use paracosm_coverage::{Deadline, Measure, records};
    use paracosm_space::Space;

    fn points(strategy: Strategy, n: usize, dims: usize, seed: Option<u64>) -> Vec<Vec<f64>> {
        let space = Space::unit_cube(dims);
        let mut made = strategy.build(&Request { seed, ..Request::new(&space, n) }).unwrap();
        made.ask(n).into_iter().map(|point| point.continuous).collect()
    }

    fn measured(points: &[Vec<f64>]) -> f64 {
        dispersion(&PointSet::new(points[0].len(), points).unwrap(), Deadline::never()).volume.upper
    }

    #[test]
    fn no_plain_set_and_no_smaller_shipped_set_has_a_lower_dispersion() {
        for (n, dims) in [(1, 2), (7, 2), (21, 2), (51, 2), (101, 2), (250, 2), (6, 3), (40, 3), (5, 4)] {
            let best = measured(&points(Strategy::BEST, n, dims, None));
            for strategy in
                Strategy::all().filter(|strategy| strategy.has_plain_set() && strategy.dims().contains(&dims))
            {
                let other = measured(&points(strategy, n, dims, None));
                assert!(best <= other, "{n} points of {strategy} in {dims} dimensions: {other} below {best}");
            }
            let smaller = records::RECORDS
                .iter()
                .filter(|record| record.measure == Measure::DISPERSION && record.dims == dims && record.points <= n);
            for record in smaller {
                let points: Vec<Vec<f64>> = record.set().iter().map(<[f64]>::to_vec).collect();
                assert!(best <= measured(&points), "{n} points, and {} are shipped", record.points);
            }
        }
    }

    #[test]
    fn a_seed_turns_and_mirrors_the_set_and_keeps_its_dispersion() {
        let plain = points(Strategy::BEST, 50, 3, None);
        assert_eq!(plain, points(Strategy::BEST, 50, 3, None));
        let mut images = vec![plain.clone()];
        for seed in 0..6 {
            let image = points(Strategy::BEST, 50, 3, Some(seed));
            assert_eq!(image, points(Strategy::BEST, 50, 3, Some(seed)));
            assert!((measured(&image) - measured(&plain)).abs() < 1e-12);
            images.push(image);
        }
        images.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
        images.dedup();
        assert!(images.len() >= 4, "48 images are possible");
    }

    #[test]
    fn more_points_than_the_search_can_take_are_refused() {
        for dims in [1, 2] {
            let space = Space::unit_cube(dims);
            let refused = Strategy::BEST.build(&Request::new(&space, 1001)).map(|_| ());
            assert_eq!(refused, Err(GeneratorError::BestLimit { points: 1001, most: 1000 }));
        }
    }
}
