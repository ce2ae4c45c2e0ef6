//! A city with a grid of streets, as in the paper's Figure 3.

use super::composite::Composite;
use super::element::{CrossIntersection, RoadSegment, TIntersection};
use super::layout::POINTS;
use crate::geometry::Pose;
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI};

/// The directions, counted clockwise from the east, as the points of intersections are.
const EAST: usize = 0;
const SOUTH: usize = 1;
const WEST: usize = 2;
const NORTH: usize = 3;

/// Makes a city with a grid of `rows` times `columns` junctions and streets of `block` metres between the junctions. It
/// has cross-intersections, T-intersections along the edges and bends in the corners, so that no street has a dead end.
///
/// The junction in row 3 and column 4, counted from 0 in the north-west, is called `junction 3,4`; the streets that
/// begin there are `street 3,4 east` and `street 3,4 south`. The middle of `junction 0,0` is the origin.
///
/// # Panics
/// There are fewer than two rows or columns.
pub fn grid_city(rows: usize, columns: usize, block: f64, lanes: i32) -> Composite {
    assert!(rows > 1 && columns > 1, "a grid has at least two rows and two columns, not {rows} and {columns}");
    let grid = Grid { rows, columns, lanes };
    let street = |name: &str| RoadSegment::new(block).lanes(lanes).named(name);
    let mut city = grid.junction(0, 0).at(Pose { position: Vector2::new(grid.reach(), 0.0), heading: PI });
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))).skip(1) {
        let along = (column > 0).then(|| (row, column - 1, EAST, WEST));
        let down = (row > 0).then(|| (row - 1, column, SOUTH, NORTH));
        let mut placed = false;
        for (from_row, from_column, out, back) in along.into_iter().chain(down) {
            let name = format!("street {from_row},{from_column} {}", if out == EAST { "east" } else { "south" });
            let end = format!("{name}.two");
            city = city.connect(&grid.point(from_row, from_column, out), street(&name), "one");
            city = if placed {
                city.close(&end, &grid.point(row, column, back))
            } else {
                city.connect(&end, grid.junction(row, column), grid.port(row, column, back))
            };
            placed = true;
        }
    }
    city
}

struct Grid {
    rows: usize,
    columns: usize,
    lanes: i32,
}

impl Grid {
    /// Returns `true` if a street leads from a junction in a direction.
    fn leads(&self, row: usize, column: usize, direction: usize) -> bool {
        match direction {
            EAST => column + 1 < self.columns,
            SOUTH => row + 1 < self.rows,
            WEST => column > 0,
            _ => row > 0,
        }
    }

    /// Returns the point of a junction in a direction. No street lies counter-clockwise of the first point.
    fn port(&self, row: usize, column: usize, direction: usize) -> &'static str {
        let begins = |d: &usize| self.leads(row, column, *d) && !self.leads(row, column, (d + 3) % 4);
        let first = (0..4).find(begins).unwrap_or(EAST);
        POINTS[(direction + 4 - first) % 4]
    }

    fn point(&self, row: usize, column: usize, direction: usize) -> String {
        format!("{}.{}", self.name(row, column), self.port(row, column, direction))
    }

    fn name(&self, row: usize, column: usize) -> String {
        format!("junction {row},{column}")
    }

    fn junction(&self, row: usize, column: usize) -> Composite {
        let name = self.name(row, column);
        match (0..4).filter(|direction| self.leads(row, column, *direction)).count() {
            4 => CrossIntersection::new().lanes(self.lanes).named(name).into(),
            3 => TIntersection::new().lanes(self.lanes).named(name).into(),
            // A bend is as far from its middle to its ends as an intersection, so that the streets stay parallel.
            _ => RoadSegment::arc(self.reach(), FRAC_PI_2).lanes(self.lanes).named(name).into(),
        }
    }

    /// Returns the distance from the middle of an intersection to its points, in metres.
    fn reach(&self) -> f64 {
        CrossIntersection::new().lanes(self.lanes).reach()
    }
}
