//! The messages of the protocol, and what they stand for. `generated` is made of `driver.proto`; a test keeps it so.

mod equipment;
mod observation;
#[cfg(feature = "serve")]
mod read;

#[allow(clippy::all, missing_docs)]
#[rustfmt::skip]
mod generated;

pub use equipment::Described;
pub use generated::*;
pub use observation::write;
#[cfg(feature = "serve")]
pub use read::read;

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
