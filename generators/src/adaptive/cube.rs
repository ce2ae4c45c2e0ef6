//! The cube in which adaptive strategies search: it represents every test of a mixed space as one vector.
//!
//! A discrete coordinate is an axis too, cut into slices of equal width, one for each level. So a search that knows
//! only numbers can move in it, and a better search asks for the kind of an axis. Levels that are ordered numbers are
//! near to each other as their slices are. Levels that are words are equally far from each other.
//!
//! A row that the constraints exclude is repaired. Parameter by parameter the level is kept, or replaced by the
//! nearest level that a valid test has together with the levels before it. So every test satisfies all constraints. A
//! search is told the result of the repaired test as the result of its proposal. A test that breaks a constraint on
//! continuous parameters moves to the nearest edge of the valid part in the same way ([`Moved`]).

use crate::keeping::Moved;
use paracosm_space::rules::Rules;
use paracosm_space::{Point, Space, Value};

/// The kind of an axis of the cube, which gives the numbers along the axis a meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    /// The axis is continuous, and a number along the axis is the coordinate itself.
    Continuous,
    /// The axis has the given number of levels, which have an order.
    Ordered(usize),
    /// The axis has the given number of levels, which have no order.
    Nominal(usize),
}

impl Axis {
    /// Returns the difference between two places along the axis. Different words all have the difference 1.
    pub(super) fn difference(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Nominal(_) => f64::from(a != b),
            Self::Continuous | Self::Ordered(_) => a - b,
        }
    }
}

/// The cube of a space, in which continuous and discrete parameters are axes.
pub(super) struct Cube {
    axes: Vec<Axis>,
    dims: usize,
    rules: Rules,
    /// The valid tests to which others move; `None` if no constraint depends on continuous parameters.
    moved: Option<Moved>,
}

impl Cube {
    pub(super) fn new(space: &Space, rules: Rules) -> Self {
        let moved = Moved::new(space, |row| valid_row(&rules, row));
        Self { axes: axes(space), dims: space.dims(), rules, moved }
    }

    /// Returns the kinds of all axes, with the continuous axes first.
    pub(super) fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of continuous axes.
    pub(super) fn dims(&self) -> usize {
        self.dims
    }

    /// Returns the test at a place. The place is moved to the nearest place of the cube, and repaired if the
    /// constraints exclude the test.
    pub(super) fn point(&self, at: &[f64]) -> Point {
        let (continuous, discrete) = at.split_at(self.dims);
        let row: Vec<usize> = discrete.iter().zip(self.rules.levels()).map(|(&u, &levels)| level(u, levels)).collect();
        self.valid(Point {
            continuous: continuous.iter().map(|u| u.clamp(0.0, 1.0_f64.next_down())).collect(),
            discrete: valid_row(&self.rules, row),
        })
    }

    /// Returns the test itself, or a valid test near it if it breaks a constraint on continuous parameters.
    pub(super) fn valid(&self, test: Point) -> Point {
        match &self.moved {
            Some(moved) => moved.moved(test),
            None => test,
        }
    }

    /// Returns the place of a test in the cube.
    pub(super) fn place(&self, point: &Point) -> Vec<f64> {
        place(&self.axes, point)
    }
}

/// Returns the row itself if it keeps the constraints, and otherwise a valid row near it.
fn valid_row(rules: &Rules, row: Vec<usize>) -> Vec<usize> {
    if rules.allows(&row) {
        return row;
    }
    let mut fixed = vec![None; row.len()];
    for (parameter, &wanted) in row.iter().enumerate() {
        let supported = rules.supported_at(parameter, |other| fixed[other]);
        let valid = (0..supported.len()).filter(|&level| supported[level]);
        fixed[parameter] = valid.min_by_key(|level| level.abs_diff(wanted));
    }
    fixed.into_iter().map(|level| level.expect("what is fixed so far is part of a valid test")).collect()
}

/// Returns the kinds of the axes of a space, with the continuous axes first.
pub(super) fn axes(space: &Space) -> Vec<Axis> {
    let discrete = space.discrete().filter_map(|coordinate| coordinate.parameter.levels()).map(axis_of);
    std::iter::repeat_n(Axis::Continuous, space.dims()).chain(discrete).collect()
}

/// Returns the place of a test in the cube, with each level in the middle of its slice.
pub(super) fn place(axes: &[Axis], point: &Point) -> Vec<f64> {
    let middle = |(&level, axis): (&usize, &Axis)| match *axis {
        Axis::Ordered(levels) | Axis::Nominal(levels) => middle(level, levels),
        Axis::Continuous => unreachable!("discrete axes come last"),
    };
    let discrete = point.discrete.iter().zip(&axes[point.continuous.len()..]).map(middle);
    point.continuous.iter().copied().chain(discrete).collect()
}

fn axis_of(levels: &[Value]) -> Axis {
    let numbers: Option<Vec<f64>> = levels.iter().map(Value::number).collect();
    // Two levels count as ordered, whatever they are.
    let is_ordered = levels.len() <= 2 || numbers.is_some_and(|numbers| numbers.is_sorted());
    if is_ordered { Axis::Ordered(levels.len()) } else { Axis::Nominal(levels.len()) }
}

/// Returns the level whose slice of the axis contains a number.
pub(super) fn level(u: f64, levels: usize) -> usize {
    ((u.max(0.0) * levels as f64) as usize).min(levels - 1)
}

/// Returns the middle of the slice of the axis that belongs to a level.
pub(super) fn middle(level: usize, levels: usize) -> f64 {
    (level as f64 + 0.5) / levels as f64
}

/// Returns a number mirrored at 0 and 1 until the number is between 0 and 1.
pub(super) fn mirrored(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x > 1.0 { 2.0 - x } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn space() -> Space {
        let text = "constraints = [\"lanes == 2 implies weather != 'fog'\", \"cars > lanes\"]
            parameter = [{ name = \"lanes\", choice = [2, 4, 6] }, { name = \"x\", interval = [0, 9] },
            { name = \"weather\", choice = [\"clear\", \"rain\", \"fog\"] }, { name = \"cars\", choice = [1, 3, 5, 7] }]";
        Space::from_toml(text).unwrap()
    }

    proptest! {
        #[test]
        fn every_place_has_a_test_that_keeps_the_constraints_and_valid_tests_stay_as_they_are(
            at in prop::collection::vec(-1.0..2.0_f64, 4)
        ) {
            let space = space();
            let cube = Cube::new(&space, space.rules().unwrap());
            let point = cube.point(&at);
            prop_assert!(space.allows(&point));
            prop_assert!((0.0..1.0).contains(&point.continuous[0]));
            prop_assert_eq!(cube.point(&cube.place(&point)), point);
        }

        #[test]
        fn mirrors_bring_every_number_between_them(x in -9.0..9.0_f64) {
            prop_assert!((0.0..=1.0).contains(&mirrored(x)));
            prop_assert!((mirrored(-x) - mirrored(x)).abs() < 1e-12);
            prop_assert!((mirrored(2.0 + x) - mirrored(x)).abs() < 1e-12);
        }
    }

    #[test]
    fn words_have_no_order_and_numbers_have_the_one_they_stand_in() {
        let space = space();
        let cube = Cube::new(&space, space.rules().unwrap());
        assert_eq!(cube.axes(), [Axis::Continuous, Axis::Ordered(3), Axis::Nominal(3), Axis::Ordered(4)]);
    }
}
