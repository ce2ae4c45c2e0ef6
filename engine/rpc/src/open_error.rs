//! The reasons why a session does not begin.

use crate::PROTOCOL;
use paracosm_engine::driver::Fault;
use thiserror::Error;

/// An error at the beginning of a session.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OpenError {
    /// No process listens at the given address.
    #[error("no process listens at this address; start the driver first")]
    Unreachable,
    /// The name of the host cannot be resolved to an address.
    #[error("the name of the host is not known; check the address")]
    UnknownHost,
    /// The process at the given address is not a driver.
    #[error(
        "the process at this address is no driver for PARACOSM: it does not offer paracosm.driver.v1.Driver over gRPC"
    )]
    Foreign,
    /// The driver speaks another version of the protocol.
    #[error(
        "the driver speaks version {found} of the protocol, expected version {PROTOCOL}; update the driver or PARACOSM, whichever is older"
    )]
    Protocol {
        /// The version of the protocol that the driver speaks.
        found: u32,
    },
    /// The program was built without the feature that connects to drivers.
    #[error(
        "this program was built without drivers in processes of their own; build it with the feature `rpc` of the crate `paracosm`"
    )]
    NotBuilt,
    /// The driver refuses the session, does not answer, or asks for an impossible period or impossible sensors.
    #[error(transparent)]
    Unusable(#[from] Fault),
}
