//! The dispersion within the valid part of a space, against areas of clipped polygons and against all boxes.

use paracosm_coverage::Projection;
use paracosm_coverage::dispersion::{Dispersion, dispersion, dispersion_within, valid_is_at_most};
use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_coverage::kwise_dispersion::{kwise_dispersion, row_dispersion};
use paracosm_coverage::proof::{Budget, Target, prove};
use paracosm_coverage::valid::{Effort, Validity};
use paracosm_coverage::{Bracket, Deadline, PointSet};
use paracosm_space::{Domain, Parameter, Point, Space, Value};
use proptest::prelude::*;
use std::time::Duration;

fn square(constraints: &[String]) -> Space {
    let interval = |name| Parameter::new(name, Domain::Interval { lo: 0.0, hi: 1.0 });
    Space::new(vec![interval("a"), interval("b")]).unwrap().with_constraints(constraints).unwrap()
}

fn within(space: &Space, points: &[[f64; 2]], deadline: Deadline) -> (Bracket, Dispersion) {
    let rules = space.rules().unwrap();
    let valid = Validity::of(space, &rules).expect("a constraint depends on a").whole();
    let points = PointSet::new(2, points).unwrap();
    (valid.share(), dispersion_within(&points, Some(&valid), deadline, &mut |_| ()))
}

/// The area of the part of a box in which `a + slope * b <= most`, by clipping the box as a polygon.
fn area([low, high]: [[f64; 2]; 2], slope: f64, most: f64) -> f64 {
    let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
    let excess = |[a, b]: [f64; 2]| a + slope * b - most;
    let mut left: Vec<[f64; 2]> = Vec::new();
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % 4];
        if excess(from) <= 0.0 {
            left.push(from);
        }
        if (excess(from) <= 0.0) != (excess(to) <= 0.0) {
            let share = excess(from) / (excess(from) - excess(to));
            left.push([from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]);
        }
    }
    let turn = |i: usize| {
        let (p, q) = (left[i], left[(i + 1) % left.len()]);
        p[0] * q[1] - p[1] * q[0]
    };
    0.5 * (0..left.len()).map(turn).sum::<f64>()
}

/// The greatest share of the valid part in an empty box, by trying all boxes that end at points.
fn naive(points: &[[f64; 2]], slope: f64, most: f64) -> f64 {
    let ends = |axis: usize| points.iter().map(move |point| point[axis]).chain([0.0, 1.0]).collect::<Vec<_>>();
    let (across, along) = (ends(0), ends(1));
    let mut best = 0.0f64;
    for &left in &across {
        for &right in across.iter().filter(|right| **right > left) {
            for &low in &along {
                for &high in along.iter().filter(|high| **high > low) {
                    let inside = |p: &[f64; 2]| left < p[0] && p[0] < right && low < p[1] && p[1] < high;
                    if !points.iter().any(inside) {
                        best = best.max(area([[left, low], [right, high]], slope, most));
                    }
                }
            }
        }
    }
    best / area([[0.0; 2], [1.0; 2]], slope, most)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_bracket_holds_the_largest_share_of_a_clipped_square_and_is_narrow(
        points in prop::collection::vec([0.0f64..1.0, 0.0f64..1.0], 0..8),
        slope in 0.2f64..3.0,
        most in 0.3f64..1.5,
    ) {
        let valid: Vec<[f64; 2]> = points.into_iter().filter(|[a, b]| a + slope * b <= most).collect();
        let space = square(&[format!("a + {slope} * b <= {most}")]);
        let (share, found) = within(&space, &valid, Deadline::never());
        let whole = area([[0.0; 2], [1.0; 2]], slope, most);
        prop_assert!(share.lower <= whole && whole <= share.upper, "{share:?} without {whole}");
        prop_assert!(share.upper - share.lower < 0.005, "{share:?}");
        let expected = naive(&valid, slope, most);
        let Bracket { lower, upper } = found.volume;
        prop_assert!(lower <= expected + 1e-12 && expected <= upper + 1e-12, "{:?} without {expected}", found.volume);
        prop_assert!(upper - lower < 0.03, "{:?}", found.volume);
        let witness = &found.witness;
        let inside = |point: &[f64; 2]| (0..2).all(|axis| witness.lower[axis] < point[axis] && point[axis] < witness.upper[axis]);
        prop_assert!(!valid.iter().any(inside));
        let of_witness = area(
            [[witness.lower[0], witness.lower[1]], [witness.upper[0], witness.upper[1]]], slope, most,
        ) / whole;
        prop_assert!(lower <= of_witness + 1e-12, "the witness has {of_witness}, not {lower}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_share_below_the_largest_is_never_proved_and_the_measured_bound_is(
        points in prop::collection::vec([0.0f64..1.0, 0.0f64..1.0], 0..12),
        slope in 0.2f64..3.0,
        most in 0.3f64..1.5,
        wanted in 0.5f64..1.0,
    ) {
        let valid: Vec<[f64; 2]> = points.into_iter().filter(|[a, b]| a + slope * b <= most).collect();
        let space = square(&[format!("a + {slope} * b <= {most}")]);
        let expected = naive(&valid, slope, most);
        let measured = within(&space, &valid, Deadline::never()).1.volume;
        let rules = space.rules().unwrap();
        let parts = [Validity::of(&space, &rules).unwrap().whole()];
        let targets = [Target { projection: Projection { fixed: vec![], axes: vec![0, 1] }, part: Some(0) }];
        let tests: Vec<_> = valid.iter().map(|at| Point { continuous: at.to_vec(), discrete: vec![] }).collect();
        let budget = Budget { pivots: 100_000, deadline: Deadline::never() };
        let upper = |volume| prove(&targets, &parts, &tests, volume, budget).upper;
        let proved = upper(measured);
        prop_assert!(proved >= expected - 1e-12, "{proved} is proved, but a box has {expected}");
        prop_assert!(proved <= measured.upper * (1.0 + 1e-9), "{proved} is proved, but {} was measured", measured.upper);
        let hoped = upper(Bracket::exact(expected * wanted));
        prop_assert!(hoped >= expected - 1e-12, "{hoped} is proved, but a box has {expected}");
    }
}

#[test]
fn a_valid_part_that_is_a_box_gives_the_dispersion_of_this_box() {
    let space = square(&["a <= 0.5".to_owned()]);
    let points = [[0.1, 0.3], [0.3, 0.8], [0.45, 0.5], [0.25, 0.25]];
    let (share, found) = within(&space, &points, Deadline::never());
    let scaled = PointSet::new(2, points.map(|[a, b]| [2.0 * a, b])).unwrap();
    let expected = dispersion(&scaled, Deadline::never()).volume;
    // The edge itself is never decided, because tests on the edge are valid.
    for (found, expected) in [(share, 0.5), (found.volume, expected.lower)] {
        let Bracket { lower, upper } = found;
        assert!(lower <= expected && expected <= upper && upper - lower < 1e-12, "{found:?} for {expected}");
    }
}

#[test]
fn the_result_does_not_depend_on_threads_and_a_short_time_gives_a_wider_bracket() {
    let space = square(&["a * a + b * b <= 1".to_owned()]);
    let golden = |i: usize| [0.5 + i as f64 * 0.754_877_666, 0.5 + i as f64 * 0.569_840_290].map(|x: f64| x.fract());
    let points: Vec<[f64; 2]> = (0..200).map(golden).filter(|[a, b]| a * a + b * b <= 1.0).collect();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| within(&space, &points, Deadline::never()))
    };
    let (share, found) = on(1);
    assert_eq!((share, found.clone()), on(3));
    let quarter = std::f64::consts::FRAC_PI_4;
    assert!(share.lower <= quarter && quarter <= share.upper && share.upper - share.lower < 0.002, "{share:?}");
    let Bracket { lower, upper } = within(&space, &points, Deadline::after(Duration::ZERO)).1.volume;
    assert!(lower <= found.volume.lower && found.volume.upper <= upper, "{lower} {upper} {found:?}");
}

#[test]
fn boxes_that_are_kept_point_by_point_give_the_same_bracket() {
    let space = square(&["a * a + b * b <= 1 or a > 0.9".to_owned()]);
    let rules = space.rules().unwrap();
    let valid = Validity::of(&space, &rules).unwrap().whole();
    let mut boxes = EmptyBoxes::within(valid.clone(), usize::MAX).unwrap();
    let points: Vec<[f64; 2]> =
        (1..40).map(|i| [f64::from(i) * 0.754_877_666, f64::from(i) * 0.569_840_290].map(f64::fract)).collect();
    for (n, point) in points.iter().enumerate() {
        boxes.add(point).unwrap();
        let set = PointSet::new(2, &points[..=n]).unwrap();
        let searched = dispersion_within(&set, Some(&valid), Deadline::never(), &mut |_| ()).volume;
        let kept = boxes.dispersion();
        assert_eq!(kept.upper, searched.upper, "{n}");
        assert!(kept.lower <= searched.lower && searched.lower - kept.lower < 0.01, "{n}: {kept:?} {searched:?}");
    }
}

#[test]
fn a_share_is_proved_refuted_or_left_open() {
    let space = square(&["a + b <= 1".to_owned()]);
    let rules = space.rules().unwrap();
    let valid = Validity::of(&space, &rules).unwrap().whole();
    // The test halves the triangle: the larger empty box has three quarters of it.
    let points = PointSet::new(2, [[0.5, 0.25]]).unwrap();
    let found = dispersion_within(&points, Some(&valid), Deadline::never(), &mut |_| ()).volume;
    assert!(found.lower < 0.75 && 0.75 <= found.upper, "{found:?}");
    let at_most = |share| valid_is_at_most(&points, &valid, share, Deadline::never());
    assert_eq!((at_most(0.74), at_most(0.75), at_most(0.77)), (Some(false), None, Some(true)));
}

#[test]
fn a_projection_is_valid_where_the_other_parameters_can_make_it_so() {
    let space = square(&["a + b <= 1".to_owned()]);
    let rules = space.rules().unwrap();
    let validity = Validity::of(&space, &rules).unwrap();
    let part = validity.part(&Projection { fixed: vec![], axes: vec![0] }, Effort::Quick);
    assert_eq!((part.share(), part.dims()), (Bracket::exact(1.0), 1));
    // Along each parameter alone, the tests leave the same gaps as without the constraint.
    let test = |a, b| Point { continuous: vec![a, b], discrete: vec![] };
    let tests = [test(0.25, 0.5), test(0.75, 0.125)];
    let found = kwise_dispersion(2, &rules, Some(&validity), &tests, 1, Deadline::never()).unwrap();
    assert_eq!((found.volume, found.axes), (Bracket::exact(0.5), vec![0]));
}

#[test]
fn rows_have_valid_parts_of_their_own() {
    let speed = Parameter::new("speed", Domain::Interval { lo: 0.0, hi: 100.0 });
    let limit = Parameter::new("limit", Domain::Choice([25.0, 50.0, 100.0].map(Value::Number).into()));
    let space = Space::new(vec![speed, limit]).unwrap().with_constraints(["speed <= limit"]).unwrap();
    let rules = space.rules().unwrap();
    let validity = Validity::of(&space, &rules).unwrap();
    for (level, share) in [(0, 0.25), (1, 0.5), (2, 1.0)] {
        let part = validity.part(&Projection { fixed: vec![(0, level)], axes: vec![0] }, Effort::Full).share();
        assert!(part.lower <= share && share <= part.upper && part.upper - part.lower < 1e-3, "{part:?} for {share}");
    }
    // Some row allows every speed.
    assert_eq!(validity.whole().share(), Bracket::exact(1.0));
    let test = |speed: f64, level| Point { continuous: vec![speed / 100.0], discrete: vec![level] };
    // The rows leave 12.5 of 25, 40 of 50 and 60 of 100.
    let tests = [test(12.5, 0), test(10.0, 1), test(40.0, 2)];
    let rows = row_dispersion(1, Some(&validity), &tests, Deadline::never());
    assert!(rows.lower <= 0.8 && 0.8 <= rows.upper && rows.upper - rows.lower < 0.01, "{rows:?}");
}
