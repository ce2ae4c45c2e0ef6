//! Bounds on the number of tests, which are known before any test is drawn.
//!
//! [`rows`] has the bounds for the discrete parameters of a set of tests, [`points`] has the bounds for the
//! continuous parameters, and [`covering`] has lower bounds for every covering array.

pub mod covering;
pub mod points;
pub mod rows;
