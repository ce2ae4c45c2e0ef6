//! Client and server for drivers in their own process, by the gRPC protocol of `proto/paracosm/driver/v1/driver.proto`.
//!
//! A [`Session`] is a [`Driver`](paracosm_engine::driver::Driver) like any other, but a server gives its answers. The
//! feature `serve` adds such a server, for drivers written in Rust. Drivers in other languages can use the protocol as
//! well; the Python package in `python/` does. Each session has its own connection and a runtime that runs only while
//! the session waits. Only this crate deals with asynchronous tasks, and a question costs no change of threads on this
//! side.
//!
//! The feature `connect` builds the client. A program without it has addresses, and its sessions do not begin.
//!
//! All values are sent bit by bit, so the same driver gives the same trace in process and over gRPC.
//!
//! ```no_run
//! use paracosm_engine::driver::Driver;
//! use paracosm_rpc::{Address, Session, Terms};
//! use std::sync::{Arc, atomic::AtomicBool};
//! use std::time::Duration;
//!
//! let address: Address = "grpc://127.0.0.1:50051".parse()?;
//! let terms = Terms { seed: 0, settings: Vec::new(), timeout: Duration::from_secs(10) };
//! let session = Session::open(&address, &terms, Arc::new(AtomicBool::new(false)))?;
//! println!("`{}` wants a question every {} s", session.name(), session.period());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(not(feature = "connect"))]
mod absent;
mod address;
mod open_error;
#[cfg(feature = "connect")]
mod partner;
#[cfg(feature = "serve")]
mod serve;
#[cfg(feature = "connect")]
mod session;
mod terms;
#[cfg(feature = "connect")]
mod wire;

#[cfg(not(feature = "connect"))]
pub use absent::Session;

pub use address::{Address, AddressError};
pub use open_error::OpenError;
#[cfg(feature = "connect")]
pub use partner::{Answers, Partner};
#[cfg(feature = "serve")]
pub use serve::{SessionOptions, serve};
#[cfg(feature = "connect")]
pub use session::Session;
pub use terms::Terms;

/// The messages of the protocol that a [`Partner`] in this process deals with.
#[cfg(feature = "connect")]
pub mod message {
    pub use crate::wire::{
        Camera, Delivery, Fix, Gnss, Image, Imu, Inaccuracy, Inertia, Lidar, Mount, Other, Reset, Scan, Step, Vehicle,
        Way, Welcome, other::Outline,
    };
}

/// True if sessions can begin, because the feature `connect` was built.
pub const CONNECTS: bool = cfg!(feature = "connect");

/// The version of the protocol that this crate speaks.
const PROTOCOL: u32 = 1;

#[cfg(test)]
mod tests;
