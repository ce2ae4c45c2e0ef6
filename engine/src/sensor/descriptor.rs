//! What lists say of a kind of sensor.

/// All that the software says of a kind of sensor that comes with the engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Descriptor {
    /// The name of the kind, as it stands in messages.
    pub name: &'static str,
    /// What the sensor measures, in one line.
    pub about: &'static str,
}
