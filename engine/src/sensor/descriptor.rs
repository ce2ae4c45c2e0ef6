//! The description of a kind of sensor for lists.

/// The description of a kind of sensor that comes with the engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Descriptor {
    /// The name of the kind, as it stands in messages.
    pub name: &'static str,
    /// A description of what the sensor measures, in one line.
    pub about: &'static str,
}
