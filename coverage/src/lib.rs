//! Measures how well a set of tests covers a parameter space.
//!
//! Tests are points of a [`Space`](paracosm_space::Space). This crate measures how much of the space they have
//! reached. [`kwise`] coverage measures the discrete parameters. [`dispersion`] (the largest box that no test has
//! entered: the paper's measure), [`fill`] (the largest ball) and the discrepancies ([`star`], [`extreme`], [`l2`])
//! measure the continuous parameters. [`kwise_dispersion`] measures both together. Each of these is described as a
//! [`Measure`]. [`empty_boxes`] keeps the holes up to date while tests arrive one by one, and [`proof`] proves that
//! no hole is larger. [`theory`] holds bounds that follow without any points. If tests failed, [`suspects`] says
//! which combinations of discrete values may be the cause. If constraints depend on continuous parameters, [`valid`] holds the
//! valid part of the space.
//!
//! ```
//! use paracosm_coverage::{Deadline, PointSet, dispersion::dispersion};
//!
//! let points = PointSet::new(2, [[0.25, 0.5], [0.75, 0.5]])?;
//! let largest = dispersion(&points, Deadline::never());
//! assert!(largest.volume.is_exact());
//! assert_eq!(largest.volume.lower, 0.5);
//! # Ok::<(), paracosm_coverage::PointSetError>(())
//! ```
//!
//! The crate opens no file and runs no simulation. Numbers called exact are exact. A measure that a time limit cuts
//! short comes back as a certified [`Bracket`].

mod bracket;
mod deadline;
pub mod dispersion;
pub mod empty_boxes;
pub mod extreme;
pub mod fill;
pub mod kwise;
pub mod kwise_dispersion;
pub mod l2;
pub mod least;
pub mod measure;
mod ordered;
mod points;
mod projection;
pub mod proof;
pub mod records;
#[cfg(test)]
mod samples;
pub mod star;
pub mod suspects;
pub mod theory;
pub mod valid;
mod witness;

pub use bracket::Bracket;
pub use deadline::Deadline;
pub use measure::{Measure, UnknownMeasure};
pub use points::{PointSet, PointSetError};
pub use projection::Projection;

/// All measures, in the order in which they are shown.
const MEASURES: &[Measure] = &[
    Measure::DISPERSION,
    Measure::STAR,
    Measure::EXTREME,
    Measure::FILL,
    Measure::L2_STAR,
    Measure::CENTERED,
    Measure::WRAPAROUND,
    Measure::MIXTURE,
    Measure::K_WISE,
    Measure::K_WISE_DISPERSION,
];
