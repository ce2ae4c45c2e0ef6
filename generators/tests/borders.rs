//! The share of tests that the borders of the space get: the figures of docs/samplers.md.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Aim, Request, Strategy};
use paracosm_space::{Point, Space};

fn tests(strategy: Strategy, space: &Space, seed: u64, n: usize) -> Vec<Point> {
    strategy.build(&Request { seed: Some(seed), ..Request::new(space, n) }).unwrap().ask(n)
}

/// The percentage of 500 points that lie outside of the cube in the middle that has 90 % of the volume.
fn outermost(strategy: Strategy, dims: usize, seed: u64) -> f64 {
    let half = 0.5 * libm::pow(0.9, 1.0 / dims as f64);
    let tests = tests(strategy, &Space::unit_cube(dims), seed, 500);
    tests.iter().filter(|test| test.continuous.iter().any(|x| (x - 0.5).abs() > half)).count() as f64 / 5.0
}

#[test]
fn greedy_avoids_the_borders_and_greedy_periodic_gives_them_their_share() {
    // The document has the medians of ten seeds; the quartiles differ by 0.5 at most.
    let document = include_str!("../../docs/samplers.md");
    for strategy in [Strategy::GREEDY, Strategy::GREEDY_PERIODIC, Strategy::HALTON] {
        let rows = document.lines().filter(|line| line.starts_with(&format!("| `{strategy}` |")));
        let mut rows = rows.map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
        let cells = rows.find(|cells| cells[2].ends_with(" %")).expect("a row of the table of borders");
        for (dims, cell) in [(2, cells[2]), (4, cells[3])] {
            let said: f64 = cell.trim_end_matches(" %").parse().unwrap();
            let mut shares: Vec<f64> = (0..3).map(|seed| outermost(strategy, dims, seed)).collect();
            shares.sort_by(f64::total_cmp);
            assert!((shares[1] - said).abs() <= 0.8, "{strategy}, {dims} dimensions: {shares:?} against {said}");
        }
    }
}

#[test]
fn each_test_of_greedy_periodic_is_equally_probable_everywhere() {
    // Also the first, the second and the last of few tests, in a corner and in the middle. 2,000 seeds: a share of a
    // quarter has a deviation of 1 %.
    let space = Space::unit_cube(2);
    let sets: Vec<Vec<Point>> = (0..2_000).map(|seed| tests(Strategy::GREEDY_PERIODIC, &space, seed, 6)).collect();
    for number in [0, 1, 2, 5] {
        let share = |holds: &dyn Fn(f64) -> bool| {
            let inside = |set: &&Vec<Point>| set[number].continuous.iter().all(|x| holds(*x));
            sets.iter().filter(inside).count() as f64 / sets.len() as f64
        };
        let (corner, middle) = (share(&|x| x < 0.5), share(&|x| (0.25..0.75).contains(&x)));
        assert!((0.21..0.29).contains(&corner) && (0.21..0.29).contains(&middle), "{number}: {corner} {middle}");
    }
}

#[test]
fn greedy_periodic_leaves_smaller_holes_than_halton() {
    for (dims, n) in [(2, 100), (3, 100)] {
        let space = Space::unit_cube(dims);
        let volume = |strategy, seed| {
            let tests = tests(strategy, &space, seed, n);
            let points = PointSet::new(dims, tests.iter().map(|test| &test.continuous)).unwrap();
            dispersion(&points, Deadline::never()).volume.lower
        };
        let wins =
            (0..9).filter(|seed| volume(Strategy::GREEDY_PERIODIC, *seed) < volume(Strategy::HALTON, *seed)).count();
        assert!(wins >= 8, "{dims} dimensions: {wins} of 9");
    }
}

#[test]
fn the_borders_of_mixed_spaces_get_their_share_whatever_the_aim() {
    let text = "parameter = [{ name = \"u\", interval = [0, 1] }, { name = \"v\", interval = [0, 1] },
        { name = \"a\", choice = [1, 2, 3] }]";
    let space = Space::from_toml(text).unwrap();
    for aim in Aim::ALL {
        let share = |strategy: Strategy| {
            let request = Request { seed: Some(1), aim: Some(aim), ..Request::new(&space, 300) };
            let tests = strategy.build(&request).unwrap().ask(300);
            let is_outermost = |test: &&Point| test.continuous.iter().any(|x| (x - 0.5).abs() > 0.475);
            tests.iter().filter(is_outermost).count() as f64 / 300.0
        };
        // The outermost 9.75 % of the volume.
        let (greedy, periodic) = (share(Strategy::GREEDY), share(Strategy::GREEDY_PERIODIC));
        assert!(greedy < 0.085 && (0.08..0.12).contains(&periodic), "{}: {greedy} {periodic}", aim.name());
    }
}
