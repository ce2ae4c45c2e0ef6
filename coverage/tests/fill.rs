//! The largest empty ball: against brute force over all places that can be its centre, against values that are known,
//! and honest about what it did not finish.

use paracosm_coverage::fill::{Fill, fill};
use paracosm_coverage::{Bracket, Deadline, PointSet};
use proptest::prelude::*;
use std::time::{Duration, Instant};

type Points = Vec<Vec<f64>>;

/// What two radii may differ by that are each exact: what counts as exact, and rounding.
const CLOSE: f64 = 1e-11;

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

fn of(points: &Points, deadline: Deadline) -> Fill {
    fill(&PointSet::new(points[0].len(), points).unwrap(), deadline).unwrap()
}

/// The radius, which has to be exact.
fn radius(points: &Points) -> f64 {
    let found = of(points, Deadline::never()).radius;
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
    prop_oneof![of(1, 10), of(2, 10), of(3, 9), of(4, 8), of(5, 8)]
}

/// Multiples of powers of an irrational number: evenly spread.
fn spread(dims: usize, n: u32) -> Points {
    let multiple = |i: u32| {
        let step = |axis: usize| (0..=axis).fold(f64::from(i), |product, _| product * 0.8191725133961645);
        (0..dims).map(|axis| step(axis).fract()).collect()
    };
    (1..=n).map(multiple).collect()
}

/// The middles of the boxes that `per_axis` intervals along every axis make, or their corners.
fn grid(dims: u32, per_axis: usize, coordinate: fn(usize, usize) -> f64) -> Points {
    let digit = |i: usize, axis: u32| i / per_axis.pow(axis) % per_axis;
    (0..per_axis.pow(dims)).map(|i| (0..dims).map(|axis| coordinate(digit(i, axis), per_axis)).collect()).collect()
}

proptest! {
    #[test]
    fn the_radius_is_the_largest_over_all_places_that_can_be_the_centre((dims, points) in few_points()) {
        // Elimination is not as accurate as the search.
        prop_assert!((radius(&points) - radius_by_definition(dims, &points)).abs() <= 1e-9);
    }

    #[test]
    fn on_a_line_it_is_half_the_widest_gap_or_a_gap_at_an_end(points in points(1, 200)) {
        let mut line: Vec<f64> = points.iter().map(|point| point[0]).collect();
        line.sort_by(f64::total_cmp);
        let between = line.windows(2).map(|gap| (gap[1] - gap[0]) / 2.0);
        let expected = between.chain([line[0], 1.0 - line[line.len() - 1]]).fold(0.0, f64::max);
        prop_assert!((radius(&points) - expected).abs() <= CLOSE);
    }

    #[test]
    fn the_centre_lies_in_the_cube_and_is_that_far_from_its_nearest_point(points in points(4, 60)) {
        let found = of(&points, Deadline::never());
        prop_assert!(found.centre.iter().all(|x| (0.0..=1.0).contains(x)));
        prop_assert_eq!(found.radius.lower, to_nearest(&found.centre, &points));
    }

    #[test]
    fn no_place_is_further_from_all_points(
        points in points(5, 100),
        places in prop::collection::vec(prop::collection::vec(coordinate(), 5), 100)
    ) {
        let radius = radius(&points);
        for place in places {
            prop_assert!(to_nearest(&place, &points) <= radius + CLOSE);
        }
    }

    #[test]
    fn the_order_of_points_and_axes_and_the_ends_of_axes_change_nothing(points in points(3, 60)) {
        let reversed: Points = points.iter().rev().cloned().collect();
        let turned: Points = points.iter().map(|point| vec![point[1], point[2], point[0]]).collect();
        let mirrored: Points = points.iter().map(|point| vec![1.0 - point[0], point[1], point[2]]).collect();
        let twice = [points.as_slice(), &points].concat();
        for other in [&reversed, &turned, &mirrored, &twice] {
            prop_assert!((radius(other) - radius(&points)).abs() <= CLOSE);
        }
    }

    #[test]
    fn another_point_never_raises_it(points in points(4, 60), more in prop::collection::vec(coordinate(), 4)) {
        let with = [points.as_slice(), &[more]].concat();
        prop_assert!(radius(&with) <= radius(&points) + CLOSE);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn many_points_in_the_plane_leave_what_a_fine_grid_of_places_says(points in points(2, 300)) {
        let steps = 300u32;
        let line: Vec<f64> = (0..=steps).map(|i| f64::from(i) / f64::from(steps)).collect();
        let places = line.iter().flat_map(|x| line.iter().map(move |y| [*x, *y]));
        let furthest = places.map(|place| to_nearest(&place, &points)).fold(0.0, f64::max);
        let radius = radius(&points);
        // From any place to the next one of the grid it is half a diagonal at most, and so much do distances change.
        let between = 0.5f64.sqrt() / f64::from(steps);
        prop_assert!(furthest <= radius + CLOSE && radius <= furthest + between + CLOSE, "{} {}", radius, furthest);
    }
}

#[test]
fn without_points_there_is_no_largest_ball() {
    let none: [[f64; 2]; 0] = [];
    assert_eq!(fill(&PointSet::new(2, none).unwrap(), Deadline::never()), None);
}

#[test]
fn one_point_in_the_middle_leaves_half_a_diagonal_and_in_a_corner_a_whole_one() {
    for dims in [1, 2, 3, 7, 20] {
        let diagonal = (dims as f64).sqrt();
        assert!((radius(&vec![vec![0.5; dims]]) - diagonal / 2.0).abs() <= CLOSE);
        assert!((radius(&vec![vec![1.0; dims]]) - diagonal).abs() <= CLOSE);
    }
}

#[test]
fn of_grids_it_is_half_the_diagonal_of_a_cell_at_thousands_of_places() {
    for (dims, per_axis) in [(1, 1000), (2, 20), (2, 64), (3, 12), (5, 4), (8, 2)] {
        let middles = grid(dims, per_axis, |i, n| (i as f64 + 0.5) / n as f64);
        let expected = f64::from(dims).sqrt() / (2 * per_axis) as f64;
        assert!((radius(&middles) - expected).abs() <= CLOSE, "{per_axis}^{dims}");
    }
    for (dims, per_axis) in [(1, 1000), (2, 21), (3, 11), (5, 4), (8, 2)] {
        let corners = grid(dims, per_axis, |i, n| i as f64 / (n - 1) as f64);
        let expected = f64::from(dims).sqrt() / (2 * (per_axis - 1)) as f64;
        assert!((radius(&corners) - expected).abs() <= CLOSE, "{per_axis}^{dims}");
    }
}

#[test]
fn triangles_that_fill_the_square_leave_their_circumradius() {
    // Rows of equilateral triangles, and points on the faces so close that all that counts is inside.
    let side = 1.0 / 30.0;
    let row = |j: u32| (0..=30).map(move |i| (f64::from(i) + 0.5 * f64::from(j % 2), f64::from(j)));
    let inside = (0..=34).flat_map(row).map(|(x, y)| vec![x * side, y * 0.75f64.sqrt() * side]);
    let on_faces = (0..=200).map(|i| f64::from(i) / 200.0);
    let on_faces = on_faces.flat_map(|t| [vec![t, 0.0], vec![t, 1.0], vec![0.0, t], vec![1.0, t]]);
    let points: Points = inside.filter(|point| point.iter().all(|x| *x <= 1.0)).chain(on_faces).collect();
    assert!((radius(&points) - side / 3f64.sqrt()).abs() <= CLOSE);
}

#[test]
fn points_on_a_circle_are_all_as_far_from_its_middle() {
    let on_circle = |i: u32| {
        let angle = f64::from(i) / 500.0 * std::f64::consts::TAU;
        vec![0.5 + 0.5 * libm::cos(angle), 0.5 + 0.5 * libm::sin(angle)]
    };
    assert!((radius(&(0..500).map(on_circle).collect()) - 0.5).abs() <= CLOSE);
}

#[test]
fn a_hundred_thousand_points_a_hair_apart_on_a_line_are_no_trouble() {
    let n = 100_000;
    let even: Points = (0..n).map(|i| vec![(f64::from(i) + 0.5) / f64::from(n)]).collect();
    assert!((radius(&even) - 0.5 / f64::from(n)).abs() <= 1e-15);
}

#[test]
fn a_gap_that_is_hardly_the_widest_is_found() {
    let mut line: Points = (0..3000).map(|i| vec![(f64::from(i) + 0.5) / 3000.0]).collect();
    line[1234][0] += 1e-9;
    assert!((radius(&line) - (0.5 / 3000.0 + 0.5e-9)).abs() <= 1e-15);
}

#[test]
fn an_exact_result_does_not_depend_on_the_number_of_threads() {
    for (dims, n) in [(2, 3000), (3, 1000), (5, 300), (8, 200)] {
        let points = spread(dims, n);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| of(&points, Deadline::never()))
        };
        let one = on(1);
        assert!(one.radius.is_exact());
        for threads in [2, 3, 8] {
            assert_eq!(one, on(threads), "d = {dims}, {threads} threads");
        }
    }
}

#[test]
fn a_bracket_holds_the_exact_value() {
    // The search of so many points in so many dimensions takes longer than the limits.
    let points = spread(8, 3000);
    let exact = of(&points, Deadline::never()).radius;
    assert!(exact.is_exact());
    for milliseconds in [0, 1, 5, 20, 100] {
        let limited = of(&points, Deadline::after(Duration::from_millis(milliseconds)));
        let Bracket { lower, upper } = limited.radius;
        assert!(lower <= exact.lower * (1.0 + 1e-12) && exact.lower <= upper, "{:?} {exact:?}", limited.radius);
        assert_eq!(lower, to_nearest(&limited.centre, &points));
    }
    let at_once = of(&points, Deadline::after(Duration::ZERO)).radius;
    assert!(0.0 < at_once.lower && at_once.lower < at_once.upper && at_once.upper <= 8f64.sqrt(), "{at_once:?}");
}

#[test]
fn a_limited_search_in_many_dimensions_ends_in_time() {
    let points = spread(20, 5000);
    let begun = Instant::now();
    let found = of(&points, Deadline::after(Duration::from_secs(1))).radius;
    // Generous: the machine may be busy with other tests.
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    assert!(0.0 < found.lower && found.lower < found.upper && found.upper <= 20f64.sqrt(), "{found:?}");
}
