//! Chooses the size of a set so that just the wanted number of its tests is valid.
//!
//! A set that depends on its size is even only as a whole: the first points of a larger Hammersley set all lie low on the
//! first axis. So a set may not be cut off at the budget. Several sizes are tried, until a set has as many valid tests as
//! wanted. If none has, the set with the smallest surplus loses tests that are evenly spread over it.

use paracosm_space::Point;
use std::collections::BTreeSet;

/// The greatest number of sizes to try.
const MOST_SIZES: usize = 32;
/// The number of sizes to try even for a large set.
const LEAST_SIZES: usize = 3;
/// The number of points of all tried sets together from which on no other size is tried.
const MOST_POINTS: usize = 200_000;

/// Returns as many valid tests as wanted, or fewer if no set that was tried has so many. `expected` is the size that the
/// set probably needs. `valid_of` returns the valid tests of a set of a size in their order; `None` if there is no such set.
pub(super) fn sized(
    wanted: usize,
    expected: usize,
    mut valid_of: impl FnMut(usize) -> Option<Vec<Point>>,
) -> Vec<Point> {
    let mut best: Vec<Point> = Vec::new();
    let mut tried = BTreeSet::new();
    let mut points = 0_usize;
    let (mut near, mut upwards) = (expected.max(wanted), true);
    while tried.len() < MOST_SIZES {
        let size = nearest(&tried, near, upwards, wanted);
        points = points.saturating_add(size);
        if tried.len() >= LEAST_SIZES && points > MOST_POINTS {
            break;
        }
        tried.insert(size);
        let Some(valid) = valid_of(size) else { break };
        let found = valid.len();
        let rank = |found: usize| (found < wanted, found.abs_diff(wanted));
        if rank(found) < rank(best.len()) {
            best = valid;
        }
        if found == wanted {
            break;
        }
        upwards = found < wanted;
        let step = match size.saturating_mul(found.abs_diff(wanted)).checked_div(found) {
            Some(step) => step.max(1),
            None => size.saturating_mul(3),
        };
        near = if upwards { size.saturating_add(step) } else { size.saturating_sub(step) };
    }
    thinned(best, wanted)
}

/// Returns the size nearest to `near` that was not tried, and is at least `least`.
fn nearest(tried: &BTreeSet<usize>, near: usize, upwards: bool, least: usize) -> usize {
    let near = near.max(least);
    let sides = |away: usize| {
        let (above, below) = (near.saturating_add(away), near.checked_sub(away));
        if upwards { [Some(above), below] } else { [below, Some(above)] }
    };
    let mut sizes = (0..=tried.len()).flat_map(sides).flatten();
    sizes.find(|size| *size >= least && !tried.contains(size)).expect("one size more than those that were tried")
}

/// Leaves out tests that are evenly spread over the list, until at most `wanted` are left.
fn thinned(tests: Vec<Point>, wanted: usize) -> Vec<Point> {
    let len = tests.len();
    if len <= wanted {
        return tests;
    }
    // The middles of as many equal stretches as tests are wanted: neither end of the list loses more than the other.
    let mut next =
        (0..wanted as u128).map(|at| ((2 * at + 1) * len as u128 / (2 * wanted as u128)) as usize).peekable();
    let is_kept = |(at, test)| (next.next_if_eq(&at).is_some()).then_some(test);
    tests.into_iter().enumerate().filter_map(is_kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(size: usize, is_valid: impl Fn(usize) -> bool) -> Option<Vec<Point>> {
        let point = |index: usize| Point { continuous: vec![index as f64 / size as f64], discrete: Vec::new() };
        Some((0..size).filter(|&index| is_valid(index)).map(point).collect())
    }

    #[test]
    fn a_set_gets_the_size_at_which_all_its_valid_tests_are_wanted() {
        let mut sizes = Vec::new();
        let tests = sized(30, 40, |size| {
            sizes.push(size);
            set(size, |index| index % 3 == 0)
        });
        assert!(tests.len() == 30 && sizes.len() < 5, "{sizes:?}");
        assert_eq!(tests, set(*sizes.last().unwrap(), |index| index % 3 == 0).unwrap());
    }

    #[test]
    fn a_surplus_is_dropped_evenly_and_not_at_the_end() {
        // Two points are valid together, so no set has an odd number of them.
        let tests = sized(31, 60, |size| set(size / 4 * 4, |index| index % 4 < 2));
        assert_eq!(tests.len(), 31);
        let dropped = set(64, |index| index % 4 < 2).unwrap();
        let missing = dropped.iter().position(|test| !tests.contains(test)).unwrap();
        assert!((8..24).contains(&missing), "{missing}");
        let surplus: Vec<_> = set(12, |_| true).unwrap();
        let kept: Vec<f64> = thinned(surplus, 4).iter().map(|test| test.continuous[0] * 12.0).collect();
        assert_eq!(kept, [1.0, 4.0, 7.0, 10.0]);
    }

    #[test]
    fn a_set_without_enough_valid_tests_gives_those_that_it_has() {
        assert_eq!(sized(5, 5, |size| set(size, |index| index < 2)).len(), 2);
        assert!(sized(5, 5, |size| set(size, |_| false)).is_empty());
        assert!(sized(5, 5, |_| None).is_empty());
    }
}
