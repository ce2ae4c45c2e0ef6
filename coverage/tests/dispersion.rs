//! The search for the largest empty box: the same on any number of threads, and honest about what it did not finish.

use paracosm_coverage::dispersion::{Dispersion, dispersion, dispersion_within, is_at_most};
use paracosm_coverage::{Deadline, PointSet};
use std::time::{Duration, Instant};

/// Halton points from index 1; every second set is rounded, so that many coordinates and volumes are equal.
fn points(dims: usize, n: u64, rounded: bool) -> PointSet {
    let radical_inverse = |mut index: u64, base: u64| {
        let (mut share, mut sum) = (1.0, 0.0);
        while index > 0 {
            share /= base as f64;
            sum += share * (index % base) as f64;
            index /= base;
        }
        if rounded { (sum * 8.0).round() / 8.0 } else { sum }
    };
    let primes = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    let point = |index| primes[..dims].iter().map(|&base| radical_inverse(index, base)).collect::<Vec<_>>();
    PointSet::new(dims, (1..=n).map(point)).unwrap()
}

fn on_threads(threads: usize, points: &PointSet) -> Dispersion {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| dispersion(points, Deadline::never()))
}

#[test]
fn volume_and_witness_do_not_depend_on_the_number_of_threads() {
    for (dims, n) in [(2, 3000), (3, 1000), (4, 400), (5, 200), (6, 120)] {
        for rounded in [false, true] {
            let points = points(dims, n, rounded);
            let one = on_threads(1, &points);
            assert!(one.volume.is_exact());
            for threads in [2, 3, 8] {
                assert_eq!(one, on_threads(threads, &points), "d = {dims}, {threads} threads, rounded: {rounded}");
            }
        }
    }
}

#[test]
fn a_bracket_holds_the_exact_value_and_its_witness_is_empty() {
    let points = points(6, 300, false);
    let exact = dispersion(&points, Deadline::never());
    assert!(exact.volume.is_exact());
    for milliseconds in [0, 1, 5, 20, 50] {
        let limited = dispersion(&points, Deadline::after(Duration::from_millis(milliseconds)));
        let volume = limited.volume;
        assert!(volume.lower <= exact.volume.lower && exact.volume.lower <= volume.upper, "{volume:?}");
        assert_eq!(volume.lower, limited.witness.volume());
        let inside = |point: &[f64]| {
            let sides = limited.witness.lower.iter().zip(&limited.witness.upper).zip(point);
            sides.into_iter().all(|((lower, upper), x)| lower < x && x < upper)
        };
        assert!(!points.iter().any(inside));
    }
}

#[test]
fn a_limited_search_in_many_dimensions_ends_in_time() {
    let points = points(12, 400, false);
    let begun = Instant::now();
    let found = dispersion(&points, Deadline::after(Duration::from_secs(1))).volume;
    // Generous: the machine may be busy with other tests.
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    assert!(0.0 < found.lower && found.lower <= found.upper && found.upper <= 1.0, "{found:?}");
}

#[test]
fn whether_it_is_at_most_something_is_known_on_either_side_of_it() {
    for (dims, n) in [(1, 20), (2, 300), (3, 200), (5, 100), (6, 60)] {
        for rounded in [false, true] {
            let points = points(dims, n, rounded);
            let exact = dispersion(&points, Deadline::never()).volume.lower;
            let at_most = |volume| is_at_most(&points, volume, Deadline::never());
            assert_eq!(at_most(exact), Some(true), "d = {dims}");
            assert_eq!(at_most(exact.next_down()), Some(false), "d = {dims}");
            assert_eq!((at_most(0.0), at_most(1.0)), (Some(false), Some(true)));
        }
    }
    // In no time nothing is claimed that is not so.
    let points = points(6, 300, false);
    let exact = dispersion(&points, Deadline::never()).volume.lower;
    let at_once = |volume| is_at_most(&points, volume, Deadline::after(Duration::ZERO));
    assert_ne!(at_once(exact), Some(false));
    assert_ne!(at_once(exact.next_down()), Some(true));
}

#[test]
fn whoever_watches_sees_the_bracket_close_and_never_open_again() {
    let points = points(9, 300, false);
    let mut seen = Vec::new();
    let limit = Deadline::after(Duration::from_secs(1));
    let found = dispersion_within(&points, None, limit, &mut |bracket| seen.push(bracket)).volume;
    seen.push(found);
    assert!(seen.len() > 1);
    for pair in seen.windows(2) {
        assert!(pair[0].lower <= pair[1].lower && pair[1].upper <= pair[0].upper, "{pair:?}");
    }
}

#[test]
fn points_on_a_sphere_take_no_more_time_than_there_is_and_little_memory() {
    // Boxes can be cut as deep as there are points, which the search must not list at every depth.
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    let on_sphere = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / 30_000.0;
        let (radius, turn) = ((1.0 - z * z).sqrt(), golden * i as f64);
        [0.5 + 0.49 * radius * libm::cos(turn), 0.5 + 0.49 * radius * libm::sin(turn), 0.5 + 0.49 * z]
    };
    let points = PointSet::new(3, (0..30_000).map(on_sphere)).unwrap();
    let begun = Instant::now();
    let found = dispersion(&points, Deadline::after(Duration::from_secs(1)));
    assert!(begun.elapsed() < Duration::from_secs(10), "{:?}", begun.elapsed());
    // A box of sides 0.49 * 2 / sqrt(3) fits into the sphere.
    assert!(found.volume.upper > 0.18 && found.volume.lower <= found.volume.upper, "{:?}", found.volume);
}
