//! The points themselves: against published ones, and against what the theory says of where they lie.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Request, Strategy};
use paracosm_space::Space;
use std::{collections::BTreeSet, fs};

fn points(strategy: Strategy, dims: usize, n: usize, seed: Option<u64>) -> Vec<Vec<f64>> {
    points_from(strategy, dims, n, seed, None)
}

fn points_from(strategy: Strategy, dims: usize, n: usize, seed: Option<u64>, skip: Option<u64>) -> Vec<Vec<f64>> {
    let space = Space::unit_cube(dims);
    let request = Request { seed, skip, ..Request::new(&space, n) };
    let mut generator = strategy.build(&request).unwrap_or_else(|error| panic!("{strategy}: {error}"));
    generator.ask(n).into_iter().map(|test| test.continuous).collect()
}

/// Every elementary interval of volume 1/n has one of n = 2^m points of the plane.
fn assert_net(points: &[Vec<f64>], name: &str) {
    let n = points.len();
    assert!(n.is_power_of_two());
    for columns in (0..=n.ilog2()).map(|bits| 1 << bits) {
        let rows = n / columns;
        let cell = |point: &Vec<f64>| ((point[0] * columns as f64) as usize, (point[1] * rows as f64) as usize);
        let cells: BTreeSet<_> = points.iter().map(cell).collect();
        assert_eq!(cells.len(), n, "{name}: {columns} by {rows} intervals");
    }
}

#[test]
fn plain_points_equal_the_reference_points() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/point_sets.json");
    let text = fs::read_to_string(path).expect("the reference data");
    let reference: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
    for (strategy, sets) in
        [(Strategy::HALTON, 6), (Strategy::SOBOL, 3), (Strategy::FIBONACCI, 1), (Strategy::HAMMERSLEY, 1)]
    {
        let prefix = format!("{strategy}_");
        let named = |set: &&serde_json::Value| set["name"].as_str().is_some_and(|name| name.starts_with(&prefix));
        let mut compared = 0;
        for set in reference["sets"].as_array().expect("a list of sets").iter().filter(named) {
            let theirs: Vec<Vec<f64>> = serde_json::from_value(set["points"].clone()).expect("a list of points");
            let ours = points(strategy, theirs[0].len(), theirs.len(), None);
            for (ours, theirs) in ours.iter().flatten().zip(theirs.iter().flatten()) {
                assert!((ours - theirs).abs() <= 1e-15, "{}: {ours} is not {theirs}", set["name"]);
            }
            compared += 1;
        }
        assert_eq!(compared, sets, "{strategy}");
    }
}

#[test]
fn plain_points_equal_those_of_scipy_in_many_dimensions_and_far_into_the_sequence() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/qmc_points.json");
    let text = fs::read_to_string(path).expect("the reference data");
    let reference: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
    let sets = reference["sets"].as_array().expect("a list of sets");
    assert_eq!(sets.len(), 3);
    for set in sets {
        let strategy: Strategy = set["strategy"].as_str().expect("a name").parse().expect("a strategy");
        let dims = set["dims"].as_u64().expect("a number") as usize;
        for (index, theirs) in set["points"].as_object().expect("points by index") {
            let theirs: Vec<f64> = serde_json::from_value(theirs.clone()).expect("a point");
            let ours = points_from(strategy, dims, 1, None, Some(index.parse().expect("an index")));
            assert_eq!(theirs.len(), dims);
            for (ours, theirs) in ours[0].iter().zip(&theirs) {
                assert!((ours - theirs).abs() <= 1e-15, "{strategy} {index}: {ours} is not {theirs}");
            }
        }
    }
}

#[test]
fn kronecker_equals_the_points_of_its_author() {
    // z = (0.5 + g^-(j+1) i) % 1 from i = 1, as published.
    let expected =
        [[0.254_877_666_246_692_7, 0.069_840_290_998_053_2], [0.009_755_332_493_385_5, 0.639_680_581_996_106_4]];
    let ours = points_from(Strategy::KRONECKER, 2, 2, None, Some(1));
    for (ours, expected) in ours.iter().flatten().zip(expected.as_flattened()) {
        assert!((ours - expected).abs() < 1e-14, "{ours} is not {expected}");
    }
    assert_eq!(points(Strategy::KRONECKER, 7, 1, None), [[0.5; 7]]);
}

#[test]
fn a_power_of_two_of_sobol_points_of_the_plane_is_a_net_however_randomised() {
    for m in 0..=12 {
        assert_net(&points(Strategy::SOBOL, 2, 1 << m, None), "plain");
        for seed in 0..4 {
            assert_net(&points(Strategy::SOBOL, 2, 1 << m, Some(seed)), "shifted");
            assert_net(&points(Strategy::SOBOL_OWEN, 2, 1 << m, Some(seed)), "scrambled");
        }
    }
}

#[test]
fn later_stretches_of_sobol_points_are_nets_too() {
    for start in [3 << 8, 1 << 30, (1 << 53) - (1 << 8)] {
        for strategy in [Strategy::SOBOL, Strategy::SOBOL_OWEN] {
            assert_net(&points_from(strategy, 2, 1 << 8, Some(1), Some(start)), strategy.name());
        }
    }
}

#[test]
fn each_of_a_thousand_sobol_coordinates_is_stratified() {
    let n = 1 << 10;
    let sets = [
        points(Strategy::SOBOL, 1000, n, None),
        points(Strategy::SOBOL, 1000, n, Some(9)),
        points(Strategy::SOBOL_OWEN, 1000, n, None),
    ];
    for set in &sets {
        for axis in 0..1000 {
            let cells: BTreeSet<usize> = set.iter().map(|point| (point[axis] * n as f64) as usize).collect();
            assert_eq!(cells.len(), n, "axis {axis}");
        }
    }
    // The plain points are the very corners of their cells.
    assert!(sets[0].iter().flatten().all(|u| (u * n as f64).fract() == 0.0));
    let different: BTreeSet<Vec<u64>> =
        (0..1000).map(|axis| sets[0].iter().map(|point| point[axis].to_bits()).collect()).collect();
    assert_eq!(different.len(), 1000);
}

#[test]
fn sobol_reaches_its_last_dimension() {
    let set = points(Strategy::SOBOL, 21_201, 3, None);
    assert_eq!(set, [vec![0.0; 21_201], vec![0.5; 21_201], [vec![0.75], set[2][1..].to_vec()].concat()]);
    assert!(set[2].iter().all(|u| [0.25, 0.75].contains(u)));
}

#[test]
fn any_stretch_of_scrambled_halton_fills_the_intervals_of_every_base() {
    for (axis, base) in [2_usize, 3, 5, 7, 11, 13].into_iter().enumerate() {
        for power in 1..=3 {
            let n = base.pow(power);
            for (seed, start) in [(0, 0), (1, 17), (2, 1 << 40), (3, (1 << 53) - n as u64)] {
                let set = points_from(Strategy::HALTON_SCRAMBLED, 6, n, Some(seed), Some(start));
                let cells: BTreeSet<usize> = set.iter().map(|point| (point[axis] * n as f64) as usize).collect();
                assert_eq!(cells.len(), n, "base {base}, seed {seed}, from {start}");
            }
        }
    }
}

#[test]
fn scrambling_takes_the_stripes_out_of_halton_s_large_bases() {
    // The axes of 31 and 37: the correlation of the first points, almost 1 where they climb side by side.
    let correlation = |set: &[Vec<f64>]| {
        let moment = |f: fn(f64, f64) -> f64| {
            set.iter().map(|point| f(point[10] - 0.5, point[11] - 0.5)).sum::<f64>() / set.len() as f64
        };
        moment(|x, y| x * y) / (moment(|x, _| x * x) * moment(|_, y| y * y)).sqrt()
    };
    assert!(correlation(&points(Strategy::HALTON, 12, 30, None)) > 0.9);
    let scrambled = (0..40).map(|seed| correlation(&points(Strategy::HALTON_SCRAMBLED, 12, 30, Some(seed))));
    // As of 40 independent correlations, each of standard deviation 1/sqrt(29).
    assert!((scrambled.sum::<f64>() / 40.0).abs() < 5.0 / (29.0 * 40.0_f64).sqrt());
}

#[test]
fn every_randomised_coordinate_is_uniform_over_the_seeds() {
    let randomised = [Strategy::HALTON, Strategy::HALTON_SCRAMBLED, Strategy::SOBOL, Strategy::SOBOL_OWEN];
    for strategy in randomised {
        let seeds = 2000;
        let mut cells = [[0_u32; 10]; 3];
        for seed in 0..seeds {
            // The sixth point, of an index that is no round number in any base.
            let point = &points(strategy, 3, 6, Some(seed))[5];
            (0..3).for_each(|axis| cells[axis][(point[axis] * 10.0) as usize] += 1);
        }
        // 200 expected, with a standard deviation of 13.4.
        assert!(cells.iter().flatten().all(|count| count.abs_diff(200) < 67), "{strategy}: {cells:?}");
    }
}

#[test]
fn fibonacci_is_about_as_even_between_fibonacci_numbers() {
    let n_dispersion = |n: usize| {
        let set = PointSet::new(2, points(Strategy::FIBONACCI, 2, n, None)).expect("points of the cube");
        n as f64 * dispersion(&set, Deadline::never()).volume.upper
    };
    let classical = [34, 55, 89, 144].map(n_dispersion).into_iter().fold(0.0, f64::max);
    let between = (34..144).map(n_dispersion).fold(0.0, f64::max);
    assert!(between < 1.2 * classical, "{between} against {classical}");
    let halton = |n| {
        let set = PointSet::new(2, points(Strategy::HALTON, 2, n, None)).expect("points of the cube");
        n as f64 * dispersion(&set, Deadline::never()).volume.upper
    };
    assert!(between < halton(144), "{between} against {}", halton(144));
}
