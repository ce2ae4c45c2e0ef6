//! Parameter spaces: the parameters that tests vary, their values, and the constraints between them.
//!
//! A [`Space`] is the ordered list of the parameters that a study leaves open. A [`Parameter`] takes numbers of an
//! interval or values of a finite choice ([`Domain`]). It may vary over time as a signal ([`Shape`]). A test is
//! written in two ways: as [`Values`], which scenarios read and logs keep, and as a [`Point`] of coordinates, which
//! strategies propose and coverage measures use. Only [`Space::decode`] and [`Space::encode`] convert values and
//! coordinates into each other.
//!
//! Constraints exclude tests that make no sense. [`constraint`] is their language, and [`rules`] derives the
//! combinations of values that the constraints allow. A [`demand`] asks tests to cover more than all combinations of k
//! values. A [`Distribution`] gives the probabilities of a parameter's values. [`Space::from_toml`] reads SPACE.toml,
//! and [`pict`] reads the model files of PICT.
//!
//! ```
//! use paracosm_space::{Point, Space};
//!
//! let space = Space::from_toml(r#"
//!     [[parameter]]
//!     name = "speed"
//!     interval = [0.5, 10.0]
//!     unit = "m/s"
//!
//!     [[parameter]]
//!     name = "lanes"
//!     choice = [2, 4, 6]
//! "#)?;
//! let test = space.decode(&Point { continuous: vec![0.5], discrete: vec![1] });
//! assert_eq!(test.get("speed").and_then(|speed| speed.number()), Some(5.25));
//! assert_eq!(space.encode(&test)?.discrete, [1]);
//! # Ok::<(), paracosm_space::SpaceError>(())
//! ```
//!
//! The crate opens no file and runs no simulation.

pub mod constraint;
pub mod demand;
pub mod distribution;
mod domain;
mod error;
mod names;
mod parameter;
pub mod pict;
mod plural;
mod point;
mod position;
mod record;
pub mod rules;
mod shape;
mod space;
mod value;
mod word;

pub use distribution::Distribution;
pub use domain::Domain;
pub use error::SpaceError;
pub use names::{did_you_mean, nearest};
pub use parameter::{Coordinate, Parameter, ParameterError, ParameterFlaw};
pub use plural::{digits, plural, some_of, values_in_words};
pub use point::Point;
pub use position::Position;
pub use record::Record;
pub use shape::{Shape, ShapeError};
pub use space::Space;
pub use value::{Value, Values};
pub use word::{WordFlaw, word_flaw};
