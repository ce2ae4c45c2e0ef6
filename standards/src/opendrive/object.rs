//! Objects and signals of a file: things beside the roads and on them.

use paracosm_engine::Pose;
use paracosm_engine::object::Body;

/// An object or a signal of a road.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// The identifier in the file.
    pub id: String,
    /// The type of the object, such as `pole`, or of the signal, such as `274`; empty if the file does not say it.
    pub kind: String,
    /// True for a signal.
    pub is_signal: bool,
    /// The solid parts, each with the pose of its middle. Without parts, the object is flat or high above the ground.
    pub parts: Vec<(Body, Pose)>,
}
