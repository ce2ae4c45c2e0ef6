//! Ranks numbers by simplicity: numbers with few decimals are simpler, and among those the numbers near the nominal
//! value.
//!
//! How many decimals count as few depends on the range of the parameter: in [0.5, 10] whole numbers are the simplest,
//! in [0.2, 0.8] tenths are. The next levels are tenths of that step, hundredths, and so on.

use std::cmp::Ordering;

/// The number of levels below the coarsest on which a number counts as round.
const FINEST: i32 = 9;

/// The decimal grids of an interval, which rank numbers by simplicity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decimals {
    lo: f64,
    hi: f64,
    /// The power of ten of the coarsest grid: the greatest power that is no more than half of the interval's width.
    coarsest: i32,
}

impl Decimals {
    /// Returns the decimal grids of the interval from `lo` to `hi`.
    pub fn of(lo: f64, hi: f64) -> Self {
        let coarsest = libm::floor(libm::log10(0.5 * hi - 0.5 * lo)) as i32;
        Self { lo, hi, coarsest }
    }

    /// Returns the level of the coarsest grid that contains this number. A lower level is simpler, and 0 is the
    /// simplest.
    pub fn level(&self, number: f64) -> i32 {
        let fits = |level: &i32| self.at(libm::round(number / self.step(*level)), *level) == number;
        (0..=FINEST).find(fits).unwrap_or(FINEST + 1)
    }

    /// Returns the distance below which bisection does not distinguish numbers.
    pub fn resolution(&self) -> f64 {
        self.step(2)
    }

    /// Returns the nearest number on each grid, from the coarsest grid, that is at least as far from `goal` as
    /// `number`.
    pub fn beyond(&self, number: f64, goal: f64) -> impl Iterator<Item = f64> {
        let grids = *self;
        (0..=FINEST).filter_map(move |level| {
            let nearest = libm::round(number / grids.step(level));
            let further = if number > goal { 1.0 } else { -1.0 };
            let is_beyond = |candidate: f64| (candidate - number) * further >= 0.0;
            let found = [nearest, nearest + further].map(|multiple| grids.at(multiple, level));
            found.into_iter().find(|found| is_beyond(*found) && (grids.lo..=grids.hi).contains(found))
        })
    }

    fn step(&self, level: i32) -> f64 {
        self.at(1.0, level)
    }

    /// Returns a multiple of the step of a grid, exactly as the decimal text of the multiple is read.
    fn at(&self, multiple: f64, level: i32) -> f64 {
        format!("{multiple:.0}e{}", self.coarsest - level).parse().unwrap_or(f64::NAN)
    }
}

/// Compares numbers by simplicity: first by level, then by the distance to the nominal value.
pub(super) fn simpler((level, distance): (i32, f64), than: (i32, f64)) -> Ordering {
    level.cmp(&than.0).then(distance.total_cmp(&than.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_round_depends_on_the_range() {
        let (speeds, frictions, distances) = (Decimals::of(0.5, 10.0), Decimals::of(0.2, 0.8), Decimals::of(5.0, 60.0));
        assert_eq!([7.0, 3.2, 3.25, 1.0 / 3.0].map(|speed| speeds.level(speed)), [0, 1, 2, FINEST + 1]);
        assert_eq!([0.3, 0.7, 0.25].map(|friction| frictions.level(friction)), [0, 0, 1]);
        assert_eq!([20.0, 21.0, 21.5, -0.0].map(|distance| distances.level(distance)), [0, 1, 2, 0]);
    }

    #[test]
    fn round_numbers_are_found_on_the_far_side_of_the_nominal() {
        let speeds = Decimals::of(0.5, 10.0);
        assert_eq!(speeds.beyond(3.017, 1.4).take(4).collect::<Vec<_>>(), [4.0, 3.1, 3.02, 3.017]);
        assert_eq!(speeds.beyond(0.73, 1.4).take(3).collect::<Vec<_>>(), [0.7, 0.73, 0.73]);
        let frictions = Decimals::of(0.2, 0.8);
        assert_eq!(frictions.beyond(0.31, 0.8).take(2).collect::<Vec<_>>(), [0.3, 0.31]);
        assert_eq!(frictions.beyond(0.3, 0.8).next(), Some(0.3));
    }
}
