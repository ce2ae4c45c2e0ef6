//! Defects of drivers and of their sensors, to test a test suite.
//!
//! A [`Defect`] is a [`Kind`] of defect with a size. [`Defect::in_driver`] puts the defect into any driver: it changes the
//! observations before the driver sees them, or the controls of the driver, or the time at which they take effect. Images of
//! cameras and readings of other sensors stay as they are.
//!
//! A [`Mutant`] is a defect that [conditions](Condition) on the values of a test turn on. [`mutants`] makes a fixed set
//! of mutants for a space. The set depends on nothing but the space, the number of mutants and the seed.
//!
//! ```
//! use paracosm_engine::driver;
//! use paracosm_mutants::{Defect, mutants};
//! use paracosm_space::Space;
//!
//! let late = Defect::new("late-reaction", 0.5)?;
//! assert_eq!(late.to_string(), "late-reaction 0.5 s");
//! let driver = late.in_driver(driver::find("aeb")?.build(&[])?);
//! assert_eq!(driver.latency(), 0.5);
//!
//! let set = mutants(&Space::unit_cube(3), 200, 1);
//! assert_eq!(set[..100], mutants(&Space::unit_cube(3), 100, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The page `docs/mutants.md` lists all kinds with their sources.

mod acting;
mod chance;
mod condition;
mod defect;
mod error;
mod flaw;
mod kind;
mod kinds;
mod mutant;
mod sensing;
mod set;
mod timing;

pub use condition::{Condition, ConditionError};
pub use defect::{Defect, NO_BRAKES};
pub use error::DefectError;
pub use kind::Kind;
pub use kinds::{ALL, find};
pub use mutant::Mutant;
pub use set::{mutants, mutants_where};

#[cfg(test)]
mod tests;
