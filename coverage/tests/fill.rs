//! The largest empty ball: against brute force over all places that can be its centre, against values that are known,
//! and honest about what it did not finish.

use paracosm_coverage::fill::{Fill, fill};
use paracosm_coverage::{Deadline, PointSet};
use proptest::prelude::*;
use std::time::{Duration, Instant};

type Points = Vec<Vec<f64>>;

/// What is lost to rounding, and to what counts as exact.
const CLOSE: f64 = 4e-12;

/// Coordinates, half of the time from a small grid, so that points tie, coincide and lie on faces.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![0.0..=1.0f64, (0..=4u8).prop_map(|i| f64::from(i) / 4.0)]
}

fn points(dims: usize, most: usize) -> impl Strategy<Value = Points> {
    let anywhere = prop::collection::vec(prop::collection::vec(coordinate(), dims), 1..=most);
    let grid = (0..=4u8).prop_map(|i| f64::from(i) / 4.0);
    let tied = prop::collection::vec(prop::collection::vec(grid, dims), 1..=most);
    prop_oneof![anywhere, tied]
}

fn of(dims: impl Into<Option<usize>>, points: &Points, deadline: Deadline) -> Fill {
    let dims = dims.into().unwrap_or(points[0].len());
    fill(&PointSet::new(dims, points).unwrap(), deadline).unwrap()
}

/// The radius, which has to be exact.
fn radius(points: &Points) -> f64 {
    let found = of(None, points, Deadline::never()).radius;
    assert!(found.is_exact(), "{found:?}");
    found.lower
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn to_nearest(place: &[f64], points: &Points) -> f64 {
    points.iter().map(|point| distance(place, point)).fold(f64::INFINITY, f64::min)
}

/// The solution of a small system of equations, by elimination; none where it is not unique, or hardly.
fn solve(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs()))?;
        rows.swap(i, pivot);
        if rows[i][i].abs() < 1e-9 {
            return None;
        }
        for j in (0..n).filter(|&j| j != i) {
            let factor = rows[j][i] / rows[i][i];
            let pivot = rows[i].clone();
            rows[j].iter_mut().zip(pivot).for_each(|(x, y)| *x -= factor * y);
        }
    }
    Some((0..n).map(|i| rows[i][n] / rows[i][i]).collect())
}

/// The subsets of `0..n` with `size` members.
fn subsets(n: usize, size: usize) -> Vec<Vec<usize>> {
    let with_size = |mask: &u32| mask.count_ones() as usize == size;
    let members = |mask: u32| (0..n).filter(|i| mask >> i & 1 == 1).collect();
    (0..1u32 << n).filter(with_size).map(members).collect()
}

/// The largest distance over all places with `d + 1 - f` points at the same distance and on `f` faces of the cube.
fn radius_by_definition(dims: usize, points: &Points) -> f64 {
    let mut largest = 0.0f64;
    for faces in 0..3usize.pow(dims as u32) {
        let ends = (0..dims).map(|axis| [None, Some(0.0), Some(1.0)][faces / 3usize.pow(axis as u32) % 3]);
        let ends: Vec<Option<f64>> = ends.collect();
        let free = ends.iter().filter(|end| end.is_none()).count();
        for subset in subsets(points.len(), free + 1) {
            let first = &points[subset[0]];
            let square = |point: &Vec<f64>| point.iter().map(|x| x * x).sum::<f64>();
            let on_face = ends.iter().enumerate().filter_map(|(axis, end)| {
                let mut row = vec![0.0; dims + 1];
                (row[axis], row[dims]) = (1.0, (*end)?);
                Some(row)
            });
            let equidistant = subset[1..].iter().map(|&other| {
                let differences = points[other].iter().zip(first).map(|(x, y)| 2.0 * (x - y));
                differences.chain([square(&points[other]) - square(first)]).collect()
            });
            let Some(place) = solve(on_face.chain(equidistant).collect()) else { continue };
            if place.iter().all(|x| (-1e-12..=1.0 + 1e-12).contains(x)) {
                largest = largest.max(to_nearest(&place, points));
            }
        }
    }
    largest
}

fn few_points() -> impl Strategy<Value = (usize, Points)> {
    let of = |dims, most| points(dims, most).prop_map(move |points| (dims, points));
    prop_oneof![of(1, 10), of(2, 12), of(3, 12), of(4, 11), of(5, 11)]
}

proptest! {
    #[test]
    fn the_radius_is_the_largest_over_all_places_that_can_be_the_centre((dims, points) in few_points()) {
        prop_assert!((radius(&points) - radius_by_definition(dims, &points)).abs() <= 1e-9);
    }
}
