//! Proofs, followed by a checker that is written from their definition and shares nothing with the search.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::kwise_dispersion::kwise_dispersion;
use paracosm_coverage::proof::{Budget, MARGIN, Proof, Proved, Scope, Target, prove};
use paracosm_coverage::{Bracket, Deadline, PointSet};
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use proptest::prelude::*;

const PLENTY: Budget = Budget { pivots: 1_000_000, deadline: Deadline::never() };

/// A box whose empty boxes are looked at: its corners, and where the boxes are known to begin below and to end above.
#[derive(Clone)]
struct Region {
    lower: Vec<f64>,
    upper: Vec<f64>,
    begin_below: Vec<f64>,
    end_above: Vec<f64>,
}

impl Region {
    fn volume(&self) -> f64 {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| upper - lower).product()
    }
}

/// Whether pivots prove that no box that these points leave empty is larger than a volume, and are used up by that.
fn proves(dims: usize, points: &[Option<Vec<f64>>], pivots: &[usize], upper: f64) -> bool {
    let cube = Region {
        lower: vec![0.0; dims],
        upper: vec![1.0; dims],
        begin_below: vec![f64::INFINITY; dims],
        end_above: vec![f64::NEG_INFINITY; dims],
    };
    let mut pivots = pivots.iter();
    follow(cube, points, &mut pivots, upper) && pivots.next().is_none()
}

fn follow(mut region: Region, points: &[Option<Vec<f64>>], pivots: &mut std::slice::Iter<usize>, upper: f64) -> bool {
    if region.volume() <= upper * (1.0 - MARGIN) {
        return true;
    }
    let Some(Some(pivot)) = pivots.next().and_then(|&pivot| points.get(pivot)) else { return false };
    let mut parts = Vec::new();
    for (axis, &x) in pivot.iter().enumerate() {
        if !(region.lower[axis] < x && x < region.upper[axis]) {
            return false;
        }
        if x < region.begin_below[axis] {
            let mut part = region.clone();
            part.lower[axis] = x;
            parts.push(part);
            region.begin_below[axis] = x;
        }
        if x > region.end_above[axis] {
            let mut part = region.clone();
            part.upper[axis] = x;
            parts.push(part);
            region.end_above[axis] = x;
        }
    }
    parts.into_iter().rev().all(|part| follow(part, points, pivots, upper))
}

/// Tests with coordinates from a grid half of the time, so that they tie and lie on faces.
fn tests(dims: usize, levels: &[usize], most: usize) -> impl Strategy<Value = Vec<Point>> {
    let coordinate = || prop_oneof![0.0..=1.0f64, (0..=8u8).prop_map(|i| f64::from(i) / 8.0)];
    let continuous = prop::collection::vec(coordinate(), dims);
    let discrete: Vec<_> = levels.iter().map(|&levels| 0..levels).collect();
    let test = (continuous, discrete).prop_map(|(continuous, discrete)| Point { continuous, discrete });
    prop::collection::vec(test, 0..most)
}

fn continuous() -> impl Strategy<Value = (usize, Vec<Point>)> {
    (1..=4usize).prop_flat_map(|dims| tests(dims, &[], 40).prop_map(move |tests| (dims, tests)))
}

fn dispersion_of(dims: usize, tests: &[Point]) -> Bracket {
    let points = PointSet::new(dims, tests.iter().map(|test| &test.continuous)).unwrap();
    dispersion(&points, Deadline::never()).volume
}

/// Proves a bound without constraints on continuous parameters.
fn of_scope(dims: usize, levels: &[usize], tests: &[Point], scope: Scope, volume: Bracket, budget: Budget) -> Proved {
    let projections = scope.projections(dims, &Rules::free(levels), usize::MAX).unwrap();
    let targets: Vec<_> = projections.into_iter().map(|projection| Target { projection, part: None }).collect();
    prove(&targets, &[], tests, volume, budget)
}

fn whole(dims: usize, tests: &[Point], volume: Bracket, budget: Budget) -> Proved {
    of_scope(dims, &[], tests, Scope::Continuous, volume, budget)
}

/// Whether a proof of a projection holds.
fn holds(proof: &Proof, tests: &[Point], upper: f64) -> bool {
    let project = |test: &Point| {
        let selected = proof.fixed.iter().all(|&(parameter, level)| test.discrete[parameter] == level);
        selected.then(|| proof.axes.iter().map(|&axis| test.continuous[axis]).collect())
    };
    let points: Vec<_> = tests.iter().map(project).collect();
    proves(proof.axes.len(), &points, &proof.pivots, upper)
}

proptest! {
    #[test]
    fn the_dispersion_is_proved((dims, tests) in continuous()) {
        let volume = dispersion_of(dims, &tests);
        let proved = whole(dims, &tests, volume, PLENTY);
        prop_assert!(proved.upper >= volume.upper && proved.upper <= volume.upper * (1.0 + 10.0 * MARGIN));
        if proved.upper < 1.0 {
            prop_assert_eq!(proved.proofs.len(), 1);
            prop_assert!(holds(&proved.proofs[0], &tests, proved.upper));
        }
    }

    #[test]
    fn what_is_not_true_is_not_proved((dims, tests) in continuous(), share in 0.1..0.999f64) {
        let volume = dispersion_of(dims, &tests).lower;
        let proved = whole(dims, &tests, Bracket::exact(volume * share), PLENTY);
        prop_assert!(proved.upper >= volume);
        prop_assert!(proved.proofs.iter().all(|proof| holds(proof, &tests, proved.upper)));
        let true_proof = whole(dims, &tests, Bracket::exact(volume), PLENTY).proofs;
        prop_assert!(!true_proof.iter().any(|proof| holds(proof, &tests, volume * share)));
    }

    #[test]
    fn a_wide_bracket_is_narrowed((dims, tests) in continuous()) {
        let volume = dispersion_of(dims, &tests).lower;
        let proved = whole(dims, &tests, Bracket { lower: volume * 0.5, upper: 1.0 }, PLENTY);
        prop_assert!(proved.upper >= volume && (proved.upper <= volume * 1.1 || proved.upper >= 1.0));
        prop_assert!(proved.proofs.iter().all(|proof| holds(proof, &tests, proved.upper)));
    }

    #[test]
    fn with_few_pivots_less_is_proved((dims, tests) in continuous(), pivots in 0..20usize) {
        let volume = dispersion_of(dims, &tests);
        let proved = whole(dims, &tests, volume, Budget { pivots, ..PLENTY });
        prop_assert!(proved.upper >= volume.upper);
        prop_assert!(proved.proofs.iter().map(|proof| proof.pivots.len()).sum::<usize>() <= pivots);
        prop_assert!(proved.proofs.iter().all(|proof| holds(proof, &tests, proved.upper)));
    }

    #[test]
    fn every_projection_on_k_parameters_is_proved(tests in tests(3, &[2, 3], 120), k in 1..=5usize) {
        let volume = kwise_dispersion(3, &Rules::free(&[2, 3]), None, &tests, k, Deadline::never()).unwrap().volume;
        let proved = of_scope(3, &[2, 3], &tests, Scope::Every(k), volume, PLENTY);
        prop_assert!(proved.upper >= volume.upper && proved.upper <= volume.upper * (1.0 + 10.0 * MARGIN));
        if proved.upper < 1.0 {
            // The coefficient of x^k in (1 + x)^3 (1 + 2 x) (1 + 3 x).
            prop_assert_eq!(proved.proofs.len(), [1, 8, 24, 34, 23, 6][k]);
            let mut distinct: Vec<_> = proved.proofs.iter().map(|proof| (&proof.fixed, &proof.axes)).collect();
            distinct.sort();
            distinct.dedup();
            prop_assert_eq!(distinct.len(), proved.proofs.len());
            prop_assert!(proved.proofs.iter().all(|proof| proof.fixed.len() + proof.axes.len() == k));
            prop_assert!(proved.proofs.iter().all(|proof| holds(proof, &tests, proved.upper)));
        }
    }
}

#[test]
fn combinations_of_levels_are_proved_by_a_test_that_has_them() {
    let test = |discrete: [usize; 2]| Point { continuous: vec![], discrete: discrete.to_vec() };
    let tests = [[0, 1], [1, 1], [0, 0], [1, 0], [0, 1]].map(test);
    let proved = of_scope(0, &[2, 2], &tests, Scope::Every(2), Bracket::exact(0.0), PLENTY);
    let pivots: Vec<_> = proved.proofs.iter().map(|proof| proof.pivots.clone()).collect();
    assert_eq!((proved.upper, pivots), (0.0, vec![vec![2], vec![0], vec![3], vec![1]]));
    let hole = of_scope(0, &[2, 2], &tests[..3], Scope::Every(2), Bracket::exact(1.0), PLENTY);
    assert_eq!(hole, Proved { upper: 1.0, proofs: vec![] });
}

#[test]
fn without_time_nothing_is_proved() {
    let tests = vec![Point { continuous: vec![0.5; 6], discrete: vec![] }; 3];
    let none = Budget { deadline: Deadline::after(std::time::Duration::ZERO), ..PLENTY };
    assert_eq!(whole(6, &tests, Bracket::exact(0.5), none), Proved { upper: 1.0, proofs: vec![] });
}

#[test]
fn proofs_do_not_depend_on_the_number_of_threads() {
    let coordinate = |i: u32, axis: u32| f64::from(i * (2 * axis + 3) * 7919 % 10007) / 10007.0;
    let tests: Vec<Point> = (1..400)
        .map(|i| Point { continuous: (0..5).map(|axis| coordinate(i, axis)).collect(), discrete: vec![] })
        .collect();
    let volume = kwise_dispersion(5, &Rules::free(&[]), None, &tests, 3, Deadline::never()).unwrap().volume;
    let on = |threads, pivots| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let budget = Budget { pivots, ..PLENTY };
        pool.install(|| of_scope(5, &[], &tests, Scope::Every(3), volume, budget))
    };
    for pivots in [1000, 1_000_000] {
        let one = on(1, pivots);
        assert!(one.upper < 1.0);
        assert_eq!(one, on(4, pivots));
    }
}

#[test]
fn a_scope_that_the_space_does_not_have_is_an_error() {
    assert!(Scope::Continuous.projections(0, &Rules::free(&[2]), 1).is_err());
    assert!(Scope::Every(3).projections(1, &Rules::free(&[2]), 1).is_err());
}
