//! Drivers in their own process, over gRPC: the protocol of `proto/paracosm/driver/v1/driver.proto`, from both ends.
//!
//! A [`Session`] is a [`Driver`](paracosm_engine::driver::Driver) like any other, whose answers come from a server;
//! `serve`, a feature, is such a server for drivers written in Rust. The protocol is for everyone, the Python package in `python/`
//! speaks it too. A session has a connection of its own and a runtime that only runs while it waits, so that nothing but
//! this crate knows of tasks, and a question costs no change of threads on this side.
//!
//! What is told goes over as it is, bit by bit: the same driver gives the same trace in process and over gRPC.

mod address;
#[cfg(feature = "serve")]
mod serve;
mod session;
mod terms;
mod wire;

pub use address::{Address, AddressError};
#[cfg(feature = "serve")]
pub use serve::{SessionOptions, serve};
pub use session::{OpenError, Session};
pub use terms::Terms;

/// The version of the protocol.
const PROTOCOL: u32 = 1;

#[cfg(test)]
mod tests;
