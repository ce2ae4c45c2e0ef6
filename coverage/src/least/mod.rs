//! Proves that no set of points has a dispersion below a level.
//!
//! The order of the points along each axis decides which boxes between them are empty. So a dispersion below a level bounds products of differences of
//! coordinates. If the differences along all axes but one have lower bounds, such a product is an upper bound on the difference along this axis, and upper bounds
//! on differences follow from each other as in a problem of shortest paths. A search adds one point after another to the order, in each of its places, and then cuts the
//! intervals of differences in two, until no coordinates keep the bounds.
//!
//! A box with m points inside, which has the volume v, has an empty box of the volume v times the least dispersion of m points. So the levels that are proved for fewer
//! points bound the volumes of boxes with points inside.
//!
//! Bounds are whole numbers of units of 2^-40, which are rounded so that a proof stays a proof.

mod differences;
mod order;
mod search;

use crate::Deadline;
use differences::{Differences, UNIT};
use order::Order;
use search::{Search, Stop};
use serde::{Deserialize, Serialize};

/// A cut of the interval of a difference in two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Split {
    /// The axis.
    pub axis: usize,
    /// The node from which the difference goes: 0 for the lower end of the cube, and the number of a point along the first axis from 1.
    pub from: usize,
    /// The node to which the difference goes.
    pub to: usize,
    /// The place of the cut, in units of 2^-40.
    pub at: i64,
}

/// A step of a proof, in the order in which a search goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Step {
    /// No coordinates keep the bounds.
    Impossible,
    /// The next point takes each of its places, from the lowest to the highest, along the last axis first.
    NextPoint,
    /// The interval of a difference is cut; the lower part comes first.
    Split(Split),
}

/// The answer to the question whether points have a dispersion below a level.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// No points have a dispersion below the level: the steps of the proof.
    Proved(Vec<Step>),
    /// The time was too short.
    Open,
    /// These points may have a dispersion of about the level or below.
    Found(Vec<Vec<f64>>),
}

/// Proves that no `points` points in `[0,1]^dims` have a dispersion below `level`. `levels` has a proved level for each smaller number of points, from 0 on.
pub fn prove(dims: usize, points: usize, level: f64, levels: &[f64], deadline: Deadline) -> Answer {
    let units = |volume: f64| (volume * UNIT as f64).ceil() as i64 + 1;
    let volumes: Vec<i64> = levels[..points].iter().map(|known| units(level / known)).chain([UNIT]).collect();
    let bounds = vec![Differences::of_the_cube(points); dims];
    let mut search = Search { volumes: &volumes, deadline, steps: Vec::new() };
    match search.order(&Order::new(points, dims), bounds) {
        Ok(()) => Answer::Proved(search.steps),
        Err(Stop::Time) => Answer::Open,
        Err(Stop::Found(points)) => Answer::Found(points),
    }
}
