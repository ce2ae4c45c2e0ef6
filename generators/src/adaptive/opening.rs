//! The first tests of every adaptive strategy: some corners of the box, then points of the Halton sequence.
//!
//! Several famous benchmarks fail at a corner: full throttle and no brake. A corner here has every continuous
//! *parameter* at one of its ends, with all coordinates of a signal at the same end. With up to three such parameters
//! all corners are tested. With more, eight corners are tested, those of an orthogonal array, so that any two of the
//! first seven parameters show all four combinations of their ends. If there are fewer than eight such corners,
//! others make up eight, with pieces of a signal at different ends, from an orthogonal array of all coordinates. This
//! is only done for up to seven coordinates, because eight corners of more coordinates show too little. The seed
//! decides the order. Then points of the shifted Halton sequence follow: three more than there are continuous
//! parameters, but from 4 to 16, and more if they are needed to see up to 32 rows of the discrete family. The tests
//! take the rows in turn, in an order that the seed decides as well: a family begins with the first levels of all
//! parameters, and failures may lie at the last levels. The opening takes at most a third of the budget.
//!
//! Signals count as one parameter here too: many points in many coordinates tell a search less than the tests that
//! they take are worth (docs/decisions/040). Halton points that break a constraint on continuous parameters
//! are passed over.

use crate::{
    Request,
    family::Family,
    seeded::{Purpose, seeded},
    sequence::{Halton, Sequence},
};
use paracosm_space::{Point, Space};
use rand::Rng;

/// The greatest number of corners.
const MOST_CORNERS: usize = 8;

/// The greatest number of axes for which these corners show all pairs of ends.
const MOST_PAIRED: usize = 7;

/// The greatest number of rows of the discrete family that are part of the opening.
const MOST_ROWS: usize = 32;

/// The greatest number of Halton points in a row that are passed over.
const MOST_PASSED: u64 = 1000;

/// The opening of an adaptive strategy, which gives the first points and then low-dispersion points.
pub(super) struct Opening {
    family: Family,
    /// The first rows of the family, shuffled.
    rows: Vec<u64>,
    halton: Halton,
    corners: Vec<Vec<f64>>,
    len: usize,
    next: usize,
    /// The space, if its constraints depend on continuous parameters.
    constrained: Option<Space>,
    /// The number of Halton points that were passed over.
    passed: u64,
}

impl Opening {
    pub(super) fn new(request: &Request, family: Family) -> Self {
        let dims = request.space.dims();
        let seed = request.seed.unwrap_or(0);
        let corners = if dims == 0 { Vec::new() } else { corners(request, seed) };
        let points = if dims == 0 { 0 } else { (parameters(&owners(request)).len() + 3).clamp(4, 16) };
        let mut rows: Vec<u64> = (0..family.len().min(MOST_ROWS as u64)).collect();
        shuffle(&mut rows, &mut seeded(seed, Purpose::Corners, 1));
        let len = (corners.len() + points).max(rows.len()).min(request.budget.div_ceil(3));
        let constrained = request.space.checks_each_test().then(|| request.space.clone());
        Self { family, rows, halton: Halton::new(dims, Some(seed)), corners, len, next: 0, constrained, passed: 0 }
    }

    /// Returns `true` if all points of the opening have been proposed.
    pub(super) fn is_over(&self) -> bool {
        self.next >= self.len
    }

    /// Returns the next point. After the opening the low-dispersion sequence goes on.
    pub(super) fn next(&mut self) -> Point {
        let index = self.next;
        self.next += 1;
        let row = index as u64 % self.family.len();
        let row = self.rows.get(row as usize).copied().unwrap_or(row);
        let test = |continuous| Point { continuous, discrete: self.family.row(row) };
        if let Some(corner) = self.corners.get(index) {
            return test(corner.clone());
        }
        let first = (index - self.corners.len()) as u64 + 1 + self.passed;
        let point = |passed: u64| test(self.halton.point(first + passed));
        let Some(space) = &self.constrained else { return point(0) };
        let passed = (0..MOST_PASSED).find(|&passed| space.allows(&point(passed)));
        let point = point(passed.unwrap_or(0));
        self.passed += passed.unwrap_or(0);
        point
    }
}

/// The name of the parameter of each continuous coordinate.
fn owners<'a>(request: &Request<'a>) -> Vec<&'a str> {
    request.space.continuous().map(|coordinate| coordinate.parameter.name.as_str()).collect()
}

/// The continuous parameters of these coordinates. The coordinates of a parameter stand next to each other.
fn parameters<'a>(owners: &[&'a str]) -> Vec<&'a str> {
    let mut parameters = owners.to_vec();
    parameters.dedup();
    parameters
}

/// Corners of the box, in an order that the seed decides.
fn corners(request: &Request, seed: u64) -> Vec<Vec<f64>> {
    let names = owners(request);
    let parameters = parameters(&names);
    let number = |name: &str| parameters.iter().position(|other| *other == name).expect("a parameter of the list");
    let all = if parameters.len() < 3 { 1 << parameters.len() } else { MOST_CORNERS };
    let end = |is_high: bool| if is_high { 1.0_f64.next_down() } else { 0.0 };
    let mut corners: Vec<Vec<f64>> =
        (0..all).map(|corner| names.iter().map(|name| end(is_high(corner, number(name)))).collect()).collect();
    if names.len() <= MOST_PAIRED && parameters.len() < names.len() {
        for corner in 0..MOST_CORNERS {
            let jagged: Vec<f64> = (0..names.len()).map(|axis| end(is_high(corner, axis))).collect();
            if corners.len() < MOST_CORNERS && !corners.contains(&jagged) {
                corners.push(jagged);
            }
        }
    }
    shuffle(&mut corners, &mut seeded(seed, Purpose::Corners, 0));
    corners
}

/// Shuffles the elements (Fisher and Yates).
fn shuffle<T>(all: &mut [T], rng: &mut impl Rng) {
    for last in (1..all.len()).rev() {
        all.swap(last, rng.random_range(0..=last));
    }
}

/// Returns `true` if a parameter is at its upper end. The columns are all sums modulo 2 of three independent columns.
/// Beyond seven parameters they repeat, and every other repetition is inverted.
fn is_high(corner: usize, parameter: usize) -> bool {
    // The three independent columns first, then their sums.
    const COLUMNS: [usize; 7] = [1, 2, 4, 3, 5, 6, 7];
    let odd = (corner & COLUMNS[parameter % 7]).count_ones() % 2 == 1;
    odd ^ (parameter / 7 % 2 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn corners_of(space: &Space, seed: u64) -> Vec<Vec<bool>> {
        let corners = corners(&Request::new(space, 100), seed);
        corners.iter().map(|corner| corner.iter().map(|&u| u > 0.5).collect()).collect()
    }

    #[test]
    fn up_to_three_parameters_all_corners_are_tested() {
        for dims in 1..=3 {
            let corners: BTreeSet<_> = corners_of(&Space::unit_cube(dims), 5).into_iter().collect();
            assert_eq!(corners.len(), 1 << dims);
        }
    }

    #[test]
    fn with_seven_parameters_any_two_meet_all_combinations_of_their_ends() {
        let corners = corners_of(&Space::unit_cube(7), 1);
        assert_eq!(corners.len(), 8);
        for i in 0..7 {
            for j in 0..i {
                let pairs: BTreeSet<_> = corners.iter().map(|corner| (corner[i], corner[j])).collect();
                assert_eq!(pairs.len(), 4, "{i}, {j}");
            }
        }
    }

    #[test]
    fn the_pieces_of_a_short_signal_are_at_different_ends_too() {
        let text =
            "parameter = [{ name = \"leader_speed\", interval = [0, 20], signal = { shape = \"piecewise-linear\",
            pieces = 3 } }]";
        let corners = corners_of(&Space::from_toml(text).unwrap(), 3);
        assert_eq!((corners.len(), corners[0].len()), (8, 4));
        assert!(corners.contains(&vec![false; 4]) && corners.contains(&vec![true; 4]));
        // As if the car ahead brakes at once.
        assert!(corners.iter().any(|corner| corner[0] && !corner[1]));
        assert_eq!(corners.iter().collect::<BTreeSet<_>>().len(), 8);
    }

    #[test]
    fn all_coordinates_of_a_long_signal_are_at_the_same_end() {
        let text = "parameter = [{ name = \"throttle\", interval = [0, 100], signal = { shape = \"piecewise-constant\",
            pieces = 5 } }, { name = \"brake\", interval = [0, 325], signal = { shape = \"polynomial\", degree = 2 } }]";
        let corners = corners_of(&Space::from_toml(text).unwrap(), 3);
        let ends: BTreeSet<_> = corners.iter().map(|corner| (corner[0], corner[5])).collect();
        assert_eq!(ends.len(), 4);
        for corner in corners {
            assert!(corner[..5].iter().all(|&end| end == corner[0]));
            assert!(corner[5..].iter().all(|&end| end == corner[5]));
        }
    }
    #[test]
    fn the_first_rows_of_a_family_are_all_tested_and_the_seed_says_which_first() {
        let text =
            "parameter = [{ name = \"speed\", interval = [0, 20] }, { name = \"overlap\", choice = [1, 2, 3, 4, 5] },
            { name = \"leader\", choice = [\"stands\", \"drives\", \"brakes\"] }]";
        let space = Space::from_toml(text).unwrap();
        let rows = |seed| -> Vec<Vec<usize>> {
            let request = Request { seed: Some(seed), ..Request::new(&space, 100) };
            let family = Family::new(&space.rules().unwrap(), &request).unwrap();
            let mut opening = Opening::new(&request, family);
            (0..opening.len).map(|_| opening.next().discrete).collect()
        };
        assert_eq!(rows(1).into_iter().collect::<BTreeSet<_>>().len(), 15);
        let first: BTreeSet<_> = (0..40).map(|seed| rows(seed)[0].clone()).collect();
        assert!(first.len() > 10, "{first:?}");
    }
}
