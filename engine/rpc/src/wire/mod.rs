//! The messages of the protocol and their conversions. `generated` is made from `driver.proto`; a test checks that both
//! agree.

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

/// Returns the message that begins a session.
pub fn hello(terms: &Terms) -> Hello {
    Hello {
        protocol: PROTOCOL,
        client: concat!("paracosm ", env!("CARGO_PKG_VERSION")).to_owned(),
        seed: terms.seed,
        settings: terms.settings.iter().cloned().collect(),
    }
}
