//! The description of a kind of sensor for lists.

/// The description of a kind of sensor that comes with the engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Descriptor {
    /// The name of the kind of sensor in messages.
    pub name: &'static str,
    /// The description of the sensor's measurements in one line.
    pub about: &'static str,
}
