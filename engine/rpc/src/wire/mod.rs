//! The messages of the protocol, and what they stand for.

mod equipment;
mod observation;

#[allow(clippy::all, missing_docs)]
mod generated {
    tonic::include_proto!("paracosm.driver.v1");
}

pub use equipment::Described;
pub use generated::*;
pub use observation::{read, write};

use crate::{PROTOCOL, Terms};

/// The words that begin a session.
pub fn hello(terms: &Terms) -> Hello {
    Hello {
        protocol: PROTOCOL,
        client: concat!("paracosm ", env!("CARGO_PKG_VERSION")).to_owned(),
        seed: terms.seed,
        settings: terms.settings.iter().cloned().collect(),
    }
}
