//! What is known about a set of tests before any test is drawn.
//!
//! [`rows`] has the bounds for the discrete half of a test set, [`points`] those for the continuous half; [`covering`] says
//! what every covering array needs.

pub mod covering;
pub mod points;
pub mod rows;
