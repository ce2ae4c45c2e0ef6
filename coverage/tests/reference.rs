//! The measures against independently computed values: `tests/data/point_sets.json`, where several brute-force
//! methods agree on the exact ones and scipy gave the others.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Deadline, PointSet, l2};
use serde_json::Value;

fn each(check: impl Fn(&Value, &PointSet)) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/point_sets.json");
    let file: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let sets = file["sets"].as_array().unwrap();
    assert_eq!(sets.len(), 20);
    for set in sets {
        let points: Vec<Vec<f64>> = serde_json::from_value(set["points"].clone()).unwrap();
        check(set, &PointSet::new(set["d"].as_u64().unwrap() as usize, points).unwrap());
    }
}

/// Compares, unless the file has no value.
fn compare(set: &Value, key: &str, found: Option<f64>) {
    if let Some(expected) = set[key].as_f64() {
        let found = found.expect("a value, as the file has one");
        assert!((found - expected).abs() <= 1e-12, "{} {key}: found {found}, expected {expected}", set["name"]);
    }
}

fn exact(bracket: Bracket) -> Option<f64> {
    bracket.is_exact().then_some(bracket.lower)
}

#[test]
fn dispersion_is_that_of_the_reference() {
    each(|set, points| compare(set, "dispersion", exact(dispersion(points, Deadline::never()).volume)));
}

#[test]
fn star_discrepancy_is_that_of_the_reference() {
    each(|set, points| compare(set, "star", exact(star_discrepancy(points, Deadline::never()))));
}

#[test]
fn discrepancies_in_closed_form_are_those_of_scipy() {
    each(|set, points| {
        compare(set, "cd2", l2::centered(points, Deadline::never()));
        compare(set, "wd2", l2::wraparound(points, Deadline::never()));
        compare(set, "md2", l2::mixture(points, Deadline::never()));
        compare(set, "l2star", l2::l2_star(points, Deadline::never()));
    });
}

#[test]
fn a_set_without_points_leaves_everything_uncovered() {
    let nothing = PointSet::new::<[f64; 3]>(3, []).unwrap();
    let all = dispersion(&nothing, Deadline::never());
    assert_eq!((all.volume, all.witness.volume()), (Bracket::exact(1.0), 1.0));
    assert_eq!(star_discrepancy(&nothing, Deadline::never()), Bracket::exact(1.0));
    for measure in [l2::centered, l2::wraparound, l2::mixture, l2::l2_star] {
        assert_eq!(measure(&nothing, Deadline::never()), None);
    }
}
