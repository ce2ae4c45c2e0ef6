//! Draws the largest hole of a suite, so that one sees what was never tested.
//!
//! A hole with many sides is drawn as slices: each panel has two parameters as axes, and the tests that lie between the sides of the hole
//! along all others. No such test is inside the hole.

use crate::plot::{Axis, Picture, Slice, Slices};
use paracosm_analysis::audit::{Audited, RowHole, Suite};
use paracosm_space::{Coordinate, Space, plural};
use std::collections::BTreeSet;

/// The greatest number of parameters that the slices of a picture have as axes: the narrowest sides of the hole.
const AXES: usize = 4;

/// Draws the largest hole of an audited suite as [`slices`]; `None` if there are none.
pub fn picture(space: &Space, suite: &Suite, audited: &Audited) -> Option<Picture> {
    slices(space, suite, audited).map(Picture::of_slices)
}

/// Returns the slices of the largest hole of an audited suite; `None` if the space has fewer than two continuous parameters, or if no hole
/// is left. If the witness does not brake in this hole, a cross marks the test in which it fails.
pub fn slices(space: &Space, suite: &Suite, audited: &Audited) -> Option<Slices> {
    let hole = audited.holes.hole.as_ref().filter(|hole| hole.volume.lower > 0.0)?;
    let axes: Vec<Coordinate> = space.continuous().collect();
    let shown = narrowest(&axes, hole);
    let fails = audited.witness.as_ref().filter(|witness| witness.is_largest_hole && witness.row == hole.row);
    let fails = fails.and_then(|witness| space.encode(&witness.fails_at).ok());
    let mut pairs: Vec<[usize; 2]> = (0..shown.len())
        .flat_map(|x| (x + 1..shown.len()).map(move |y| [x, y]))
        .map(|pair| pair.map(|at| shown[at]))
        .collect();
    // A panel in which the hole is everything shows nothing.
    let is_narrow = |at: &usize| width(&axes[*at], hole) < 1.0;
    if pairs.iter().flatten().any(is_narrow) {
        pairs.retain(|pair| pair.iter().any(is_narrow));
    }
    let panels: Option<Vec<Slice>> = pairs
        .iter()
        .map(|&[x, y]| {
            let [across, up] = [&axes[x], &axes[y]];
            let at = |coordinates: &[f64]| {
                [across.parameter.value_at(coordinates[x]), up.parameter.value_at(coordinates[y])]
            };
            let [mut between, mut others] = [BTreeSet::new(), BTreeSet::new()];
            for (point, is_between) in hole.slice(suite, [x, y]) {
                let place = at(&point.continuous).map(f64::to_bits);
                if is_between {
                    between.insert(place)
                } else {
                    others.insert(place)
                };
            }
            let values =
                |places: BTreeSet<[u64; 2]>| places.into_iter().map(|place| place.map(f64::from_bits)).collect();
            let side = |axis: &Coordinate| hole.sides.get(&axis.name()).copied();
            Some(Slice {
                x: Axis::of(across)?,
                y: Axis::of(up)?,
                sides: [side(across)?, side(up)?],
                others: values(&others - &between),
                between: values(between),
                fails: fails.as_ref().map(|point| at(&point.continuous)),
            })
        })
        .collect();
    let panels = panels.filter(|panels| !panels.is_empty())?;
    let (title, note) = (title(audited, hole), note(&panels, axes.len(), hole));
    Some(Slices { title, note, panels })
}

/// Returns the width of a hole along an axis, as a share of the axis.
fn width(axis: &Coordinate, hole: &RowHole) -> f64 {
    let [lo, hi] = hole.sides.get(&axis.name()).copied().unwrap_or_default();
    let [least, most] = [0.0, 1.0].map(|end| axis.parameter.value_at(end));
    (hi - lo) / (most - least)
}

/// Returns the positions of the axes along which the hole is narrowest, in the order of the axes.
fn narrowest(axes: &[Coordinate], hole: &RowHole) -> Vec<usize> {
    let mut order: Vec<usize> = (0..axes.len()).collect();
    order.sort_by(|a, b| width(&axes[*a], hole).total_cmp(&width(&axes[*b], hole)));
    order.truncate(AXES);
    order.sort_unstable();
    order
}

fn title(audited: &Audited, hole: &RowHole) -> String {
    let row: Vec<String> = hole.row.iter().map(|(name, value)| format!("{name} {value}")).collect();
    let has_part = audited.coverage.continuous.as_ref().is_some_and(|measured| measured.valid_share.is_some());
    let part = if has_part { "the valid part of " } else { "" };
    let of = if row.is_empty() { "the space".to_owned() } else { format!("the row {}", row.join(", ")) };
    let least = if hole.volume.is_exact() { "" } else { "at least " };
    format!("{}: the largest hole, {least}{:.3} of {part}{of}", audited.suite, hole.volume.lower)
}

fn note(panels: &[Slice], dims: usize, hole: &RowHole) -> String {
    let row = if hole.row.iter().next().is_some() { " of the row" } else { "" };
    let fails = panels.iter().any(|panel| panel.fails.is_some());
    let fails = if fails { "; red cross: the witness fails" } else { "" };
    if dims == 2 {
        return format!("blue: the tests{fails}");
    }
    format!(
        "blue: tests within the hole along {}, grey: other tests{row}{fails}",
        match dims - 2 {
            1 => "the third parameter".to_owned(),
            others => format!("the {} that the panel does not show", plural(others, "parameter")),
        }
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_analysis::audit::Audit;
    use paracosm_campaign::{Catalogue, Study};
    use paracosm_space::Point;

    fn study(scenario: &str) -> (Study, Catalogue) {
        let catalogue = Catalogue::of(paracosm_scenarios::ALL);
        (Study::of(catalogue.find(scenario).unwrap()).driver("planner").build().unwrap(), catalogue)
    }

    fn of_source(scenario: &str, source: &str) -> Option<Slices> {
        let (study, catalogue) = study(scenario);
        drawn(&study, Suite::of(&source.parse().unwrap(), &study, &catalogue).unwrap())
    }

    fn drawn(study: &Study, suite: Suite) -> Option<Slices> {
        let audit = Audit::of(study, vec![suite]).unwrap();
        let report = audit.run(&mut Vec::new(), |_| Ok(())).unwrap();
        slices(study.space(), &audit.suites()[0], &report.suites[0])
    }

    #[test]
    fn no_test_that_could_lie_in_the_hole_does_and_a_test_touches_each_side_that_is_no_end() {
        for (scenario, source, panels) in
            [("pedestrian-crossing", "halton:40", 1), ("cut-in", "lhs:40", 6), ("ncap-cpna", "lhs:9", 0)]
        {
            let Some(slices) = of_source(scenario, source) else {
                assert_eq!(panels, 0, "{scenario}");
                continue;
            };
            assert_eq!(slices.panels.len(), panels, "{scenario}");
            for Slice { x, y, sides, between, others, .. } in &slices.panels {
                let is_inside =
                    |test: &&[f64; 2]| (0..2).all(|axis| sides[axis][0] < test[axis] && test[axis] < sides[axis][1]);
                assert_eq!(between.iter().find(is_inside), None, "{scenario}: {slices:?}");
                assert!(between.iter().all(|test| !others.contains(test)));
                for (axis, ends) in [x, y].into_iter().enumerate() {
                    for side in sides[axis] {
                        let is_end = side == ends.range.0 || side == ends.range.1;
                        assert!(
                            is_end || between.iter().any(|test| test[axis] == side),
                            "{scenario}, {}: {side}",
                            ends.label
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_hole_as_wide_as_the_space_is_drawn_over_its_narrow_sides_only() {
        let (study, _) = study("cut-in");
        let middle = Point { continuous: vec![0.5; 4], discrete: Vec::new() };
        let slices = drawn(&study, Suite::new("the middle".into(), vec![middle], &study).unwrap()).unwrap();
        assert_eq!(slices.title, "the middle: the largest hole, 0.500 of the space");
        assert_eq!(slices.panels.len(), 3, "{slices:?}");
        let is_whole = |panel: &Slice| panel.sides == [panel.x.range, panel.y.range].map(|(lo, hi)| [lo, hi]);
        assert!(!slices.panels.iter().any(is_whole), "{slices:?}");
        assert!(slices.note.contains("along the 2 parameters that the panel does not show"), "{}", slices.note);
    }
}
