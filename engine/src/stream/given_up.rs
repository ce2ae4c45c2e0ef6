//! The end of a run by a function of a stream.

/// The payload of a panic by which a function of a stream ends the run, because it cannot give a value: a stream has no way to return an error. The
/// test ends with the reason as its error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GivenUp(
    /// The reason.
    pub String,
);
