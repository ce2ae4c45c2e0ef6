//! The network address of a driver: `grpc://HOST:PORT`.

use std::fmt;
use std::net::SocketAddr;
#[cfg(feature = "connect")]
use std::net::ToSocketAddrs;
use std::str::FromStr;
use thiserror::Error;

/// The beginning of every address of a driver.
const SCHEME: &str = "grpc://";

/// The network address at which a driver listens, in the form `grpc://HOST:PORT`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address {
    host: String,
    port: u16,
}

/// The error for a text that is no address of a driver.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{text}` is no address of a driver: {why}, expected grpc://HOST:PORT, for example grpc://127.0.0.1:50051")]
pub struct AddressError {
    text: String,
    why: &'static str,
}

impl Address {
    /// Returns `true` if a text is meant to be an address rather than the name of a driver.
    pub fn is_meant(text: &str) -> bool {
        text.contains("://")
    }

    /// Returns the host and the port of the address as `HOST:PORT`.
    pub fn authority(&self) -> String {
        format!("{}:{}", self.host, self.port)
    }

    /// Returns `true` if the host's name can be resolved to an address.
    #[cfg(feature = "connect")]
    pub(crate) fn is_known(&self) -> bool {
        self.authority().to_socket_addrs().is_ok_and(|mut all| all.next().is_some())
    }
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let wrong = |why| AddressError { text: text.to_owned(), why };
        let rest = text.strip_prefix(SCHEME).ok_or_else(|| wrong("it does not begin with grpc://"))?;
        let (host, port) = rest.rsplit_once(':').ok_or_else(|| wrong("it has no port"))?;
        let port = port.parse().map_err(|_| wrong("the port is no number from 1 to 65535"))?;
        let inner = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
        let sound = match inner {
            Some(inner) => inner.parse::<std::net::Ipv6Addr>().is_ok(),
            None => !host.is_empty() && host.chars().all(|c| c.is_ascii_alphanumeric() || "-._".contains(c)),
        };
        match (sound, port) {
            (false, _) => Err(wrong("the host is neither a name nor an IP address")),
            (true, 0) => Err(wrong("the port is no number from 1 to 65535")),
            (true, port) => Ok(Self { host: host.to_owned(), port }),
        }
    }
}

impl From<SocketAddr> for Address {
    fn from(address: SocketAddr) -> Self {
        let host = match address {
            SocketAddr::V4(v4) => v4.ip().to_string(),
            SocketAddr::V6(v6) => format!("[{}]", v6.ip()),
        };
        Self { host, port: address.port() }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{SCHEME}{}:{}", self.host, self.port)
    }
}
