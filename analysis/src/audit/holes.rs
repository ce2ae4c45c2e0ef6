//! The holes of a suite: for each row of discrete values, the largest box of continuous values that no test has entered.

use super::Suite;
use crate::combinations::combinations;
use paracosm_campaign::{Error, Study};
use paracosm_coverage::dispersion::{Dispersion, LargestEmptyBox, dispersion_within};
use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_coverage::valid::{Effort, ValidPart, Validity};
use paracosm_coverage::{Bracket, Deadline, PointSet};
use paracosm_generators::{Request, Strategy};
use paracosm_space::{Coordinate, Point, Record, Space, Value};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The greatest number of rows of discrete values that are all looked at. In a space with more rows, only those with a test are.
const MOST_ROWS: u64 = 4096;
/// The greatest number of empty boxes of a row that are kept.
const MOST_BOXES: usize = 1 << 16;

/// The largest hole of a row of discrete values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowHole {
    /// The values of the discrete parameters.
    pub row: Record<Value>,
    /// The number of tests of the suite in the row.
    pub tests: usize,
    /// The volume of the largest empty box, as a share of the valid part of the row.
    #[serde(flatten)]
    pub volume: Bracket,
    /// The two ends of the box along each continuous parameter, as values. The box has the lower volume.
    #[serde(rename = "box")]
    pub sides: Record<[f64; 2]>,
    /// The levels of the row.
    #[serde(skip)]
    pub(super) levels: Vec<usize>,
    /// The box in coordinates.
    #[serde(skip)]
    pub(super) found: LargestEmptyBox,
    /// The valid part of the row; `None` if no constraint depends on continuous parameters.
    #[serde(skip)]
    pub(super) part: Option<Arc<ValidPart>>,
}

impl RowHole {
    /// Returns the tests of a suite in the row of the hole. A test is on the hole's slice along two axes if it lies between the sides of
    /// the hole along all other axes; such a test is beside the hole along one of the two axes.
    pub fn slice<'a>(&'a self, suite: &'a Suite, axes: [usize; 2]) -> impl Iterator<Item = (&'a Point, bool)> {
        let is_between = move |point: &Point| {
            let sides = self.found.lower.iter().zip(&self.found.upper);
            let mut sides = point.continuous.iter().zip(sides).enumerate();
            sides.all(|(axis, (x, (lower, upper)))| axes.contains(&axis) || (lower < x && x < upper))
        };
        let points = suite.points.iter().filter(|point| point.discrete == self.levels);
        points.map(move |point| (point, is_between(point)))
    }
}

/// The holes of a suite, the largest first. Holes of the same volume stand in the order of their rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Holes {
    /// The largest hole of all, with the bracket of its volume over all rows; `None` if there is no row.
    pub hole: Option<RowHole>,
    /// The largest hole of each row.
    pub rows: Vec<RowHole>,
    /// `true` if the space has so many rows that rows without a test were not looked at.
    pub only_tested_rows: bool,
}

impl Holes {
    /// Finds the holes of a suite until a deadline. A hole is exact unless the deadline cuts its search short, or constraints
    /// between continuous parameters leave a part of the space undecided.
    ///
    /// # Errors
    /// The constraints of the space contradict each other.
    pub fn of(suite: &Suite, study: &Study, deadline: Deadline) -> Result<Self, Error> {
        let space = study.space();
        let rules = space.rules()?;
        let mut rows: BTreeMap<Vec<usize>, Vec<&Point>> = BTreeMap::new();
        let levels = space.levels();
        let all = levels.iter().fold(1u64, |product, levels| product.saturating_mul(*levels as u64));
        let only_tested_rows = all > MOST_ROWS;
        if !only_tested_rows {
            let valid = |row: &Vec<usize>| rules.allows(row);
            rows.extend(combinations(&levels).filter(valid).map(|row| (row, Vec::new())));
        }
        for point in &suite.points {
            rows.entry(point.discrete.clone()).or_default().push(point);
        }
        let validity = Validity::of(space, &rules);
        let effort = Effort::for_parts(rows.len() as u64);
        let parts: Vec<_> = rows
            .into_iter()
            .map(|(row, points)| {
                let part = validity.as_ref().map(|validity| validity.of_row(&row, effort));
                (row, points, part)
            })
            // No test of such a row keeps the constraints.
            .filter(|(_, _, part)| part.as_ref().is_none_or(|part| part.share().upper > 0.0))
            .collect();
        let names: Vec<Coordinate> = space.discrete().collect();
        let axes: Vec<Coordinate> = space.continuous().collect();
        let mut known: Vec<(PointSet, Option<Arc<ValidPart>>, Dispersion)> = Vec::new();
        let mut left = parts.len();
        let mut found = Vec::new();
        for (levels, points, part) in parts {
            let Dispersion { volume, witness } = if axes.is_empty() {
                // A row without continuous parameters is a single test.
                let volume = if points.is_empty() { 1.0 } else { 0.0 };
                let witness = LargestEmptyBox { lower: Vec::new(), upper: Vec::new() };
                Dispersion { volume: Bracket::exact(volume), witness }
            } else {
                let places = PointSet::new(axes.len(), points.iter().map(|point| &point.continuous))?;
                // Rows of a grid have the same points.
                let same = known.iter().find(|(other, valid, _)| *other == places && *valid == part);
                if let Some((_, _, hole)) = same {
                    hole.clone()
                } else {
                    let share = deadline.part(1.0 / left as f64);
                    let hole = dispersion_within(&places, part.as_deref(), share, &mut |_| ());
                    known.push((places, part.clone(), hole.clone()));
                    hole
                }
            };
            left -= 1;
            let named = names.iter().zip(&levels).map(|(name, level)| {
                let values = name.parameter.levels().expect("it is a discrete parameter");
                (name.name(), values[*level].clone())
            });
            found.push(RowHole {
                row: named.collect(),
                tests: points.len(),
                volume,
                sides: sides(&axes, &witness),
                levels,
                found: witness,
                part,
            });
        }
        let mut rows = found;
        rows.sort_by(|a, b| b.volume.lower.total_cmp(&a.volume.lower));
        let volume = largest(&rows);
        let hole = rows.first().map(|hole| RowHole { volume, ..hole.clone() });
        Ok(Self { hole, rows, only_tested_rows })
    }

    /// Returns the bracket of the volume of the largest hole; 0 if there is no row.
    pub fn largest(&self) -> Bracket {
        largest(&self.rows)
    }
}

fn largest(rows: &[RowHole]) -> Bracket {
    let most = |end: fn(&Bracket) -> f64| rows.iter().map(|hole| end(&hole.volume)).fold(0.0, f64::max);
    Bracket { lower: most(|volume| volume.lower), upper: most(|volume| volume.upper) }
}

/// Returns the sides of a box over the continuous parameters, as values.
pub(super) fn sides(axes: &[Coordinate], found: &LargestEmptyBox) -> Record<[f64; 2]> {
    let ends = found.lower.iter().zip(&found.upper);
    axes.iter()
        .zip(ends)
        .map(|(axis, (&lo, &hi))| (axis.name(), [lo, hi].map(|u| axis.parameter.value_at(u))))
        .collect()
}

/// Returns the empty boxes among the points of a row.
pub(super) fn empty_boxes(space: &Space, levels: &[usize], points: &[Point]) -> Result<EmptyBoxes, Error> {
    let rules = space.rules()?;
    let mut boxes = match Validity::of(space, &rules) {
        None => EmptyBoxes::at_most(space.dims(), MOST_BOXES)?,
        Some(validity) => EmptyBoxes::within(validity.of_row(levels, Effort::Full), MOST_BOXES)?,
    };
    for point in points.iter().filter(|point| point.discrete == levels) {
        boxes.add(&point.continuous)?;
    }
    Ok(boxes)
}

/// Returns valid tests inside a box of a row, evenly distributed.
pub(super) fn tests_in(
    space: &Space,
    levels: &[usize],
    found: &LargestEmptyBox,
    most: usize,
) -> Result<Vec<Point>, Error> {
    let place = |u: &[f64]| {
        let ends = found.lower.iter().zip(&found.upper);
        let continuous = u.iter().zip(ends).map(|(u, (lower, upper))| lower + u * (upper - lower)).collect();
        Point { continuous, discrete: levels.to_vec() }
    };
    if space.dims() == 0 {
        return Ok(vec![place(&[])]);
    }
    // Half of them or more may break a constraint.
    let cube = Space::unit_cube(space.dims());
    let points = Strategy::HALTON.build(&Request::new(&cube, 8 * most))?.ask(8 * most);
    let inside = points.iter().map(|point| place(&point.continuous)).filter(|point| space.allows(point));
    Ok(inside.take(most).collect())
}
