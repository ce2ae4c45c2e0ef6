//! Parameter spaces, and how well a set of tests covers them.
//!
//! A [`Space`] is the ordered list of the parameters a study leaves open. Tests are points of it, and this
//! crate says how much of the space such points have looked at: the discrete half by [`kwise`] coverage, the
//! continuous half by [`dispersion`] (the largest box no test has entered: the paper's measure), by [`fill`] (the
//! largest ball) and by discrepancy ([`star`], [`extreme`], [`l2`]), and both halves together by
//! [`kwise_dispersion`]. [`empty_boxes`] knows the holes as tests arrive one by one, and [`proof`] proves that there are
//! no larger ones. [`theory`] holds the bounds that are known without looking at any point.
//!
//! How likely parameters have which values is a [`Distribution`]. Where tests failed, [`suspects`] says which combinations of discrete values are behind it.
//!
//! Which tests make sense is said by constraints: [`constraint`] is their language, [`rules`] what follows from
//! them, and [`pict`] reads spaces and constraints from the model files of PICT. What tests are to cover beyond all
//! combinations of k values is a [`demand`].
//!
//! The crate computes: it opens no file and runs no simulation. Numbers called exact are exact; what a time
//! limit cut short comes back as a certified [`Bracket`].

mod bracket;
pub mod constraint;
pub mod demand;
pub mod dispersion;
pub mod distribution;
pub mod empty_boxes;
pub mod extreme;
pub mod fill;
pub mod kwise;
pub mod kwise_dispersion;
pub mod l2;
mod names;
pub mod pict;
mod points;
pub mod proof;
pub mod rules;
mod space;
pub mod star;
pub mod suspects;
pub mod theory;

pub use bracket::{Bracket, Deadline};
pub use distribution::Distribution;
pub use names::{did_you_mean, nearest};
pub use points::{PointSet, PointSetError};
pub use space::{Coordinate, Domain, Parameter, Point, Record, Shape, Space, SpaceError, Value, Values};
