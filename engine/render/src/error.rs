//! The errors of cameras, of scenes and of the graphics adapter.

use nalgebra::{Isometry3, Point3};
use std::sync::Arc;
use thiserror::Error;

/// The error of the graphics interface that caused one of our errors.
pub type GraphicsCause = Arc<dyn std::error::Error + Send + Sync>;

/// The reason why nothing can be drawn.
#[derive(Debug, Clone, Error)]
pub enum RenderError {
    /// The machine has no graphics adapter.
    #[error(
        "no graphics adapter was found ({0}). No display or graphics card is needed: on Debian and Ubuntu the package \
         mesa-vulkan-drivers draws on the processor (apt install mesa-vulkan-drivers)"
    )]
    NoAdapter(GraphicsCause),
    /// There is an adapter, but it cannot be opened.
    #[error("the graphics adapter {adapter} could not be opened: {source}")]
    NotOpened {
        /// The name of the adapter.
        adapter: String,
        /// The error that the adapter returned.
        source: GraphicsCause,
    },
    /// The adapter was taken away, or its driver gave up. A new renderer may work.
    #[error("the graphics device was lost: {reason:?}, {message}; make a new renderer")]
    Lost {
        /// The reason that the graphics interface gives for the loss.
        reason: LossReason,
        /// The message of the driver.
        message: String,
    },
    /// The adapter refused a request, most often a request for memory.
    #[error("the graphics device failed: {0}")]
    Failed(GraphicsCause),
}

/// The reason why a graphics device was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LossReason {
    /// The driver does not give a reason.
    Unknown,
    /// The device was told to end.
    Destroyed,
}

/// The reason why one view cannot be drawn. Other views of the same call can be drawn.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ViewError {
    /// The image is larger than the largest image of the adapter.
    #[error("the image is {width} x {height} pixels, expected at most {limit} each way on this graphics adapter")]
    TooLarge {
        /// The width of the image in pixels.
        width: u32,
        /// The height of the image in pixels.
        height: u32,
        /// The most pixels each way that the adapter takes.
        limit: u32,
    },
    /// The scene has more triangles in one mesh, or more things at once, than the adapter takes.
    #[error("{what} takes {bytes} bytes, expected at most {limit} on this graphics adapter")]
    TooMuch {
        /// The object that takes the bytes.
        what: &'static str,
        /// The number of bytes that the object takes.
        bytes: u64,
        /// The greatest number of bytes that the adapter takes.
        limit: u64,
    },
    /// The pose of the camera has a number that is not finite.
    #[error("the pose of the camera has a number that is not finite: {pose}, head lamps {head_lamps:?}")]
    Pose {
        /// The pose of the vehicle that carries the camera.
        pose: Isometry3<f64>,
        /// The head lamps of that vehicle.
        head_lamps: Option<Point3<f64>>,
    },
    /// A thing of the scene has a flaw.
    #[error("instance {index} of the scene (id {id}) has a {flaw}")]
    Instance {
        /// The index of the instance in the scene.
        index: usize,
        /// The id of the thing.
        id: u16,
        /// The flaw of the instance.
        flaw: InstanceFlaw,
    },
    /// The light or the fog is out of range.
    #[error("the air has {what} of {found}, expected {expected}")]
    Air {
        /// The quantity that is out of range.
        what: &'static str,
        /// The value of the quantity.
        found: f32,
        /// The expected range.
        expected: &'static str,
    },
    /// The camera is inside a thing, from where nothing is visible.
    #[error(
        "the camera is inside instance {index} of the scene (id {id}); mount it outside, or leave that id out of the view"
    )]
    Inside {
        /// The index of the instance in the scene.
        index: usize,
        /// The id of the thing.
        id: u16,
    },
}

/// The flaw of a thing in a scene.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InstanceFlaw {
    /// The pose has a number that is not finite.
    #[error("pose of {0}, expected finite numbers")]
    Pose(Isometry3<f32>),
    /// The scale has a number that is not finite or not above 0.
    #[error("scale of {0:?}, expected finite numbers above 0")]
    Scale([f32; 3]),
    /// The paint has a number outside of 0 to 1.
    #[error("paint of {0:?}, expected numbers from 0 to 1")]
    Paint([f32; 3]),
    /// The mesh has a corner with a number that is not finite.
    #[error("mesh whose corner {index} is at {position:?} with texture coordinates {uv:?}, expected finite numbers")]
    Corner {
        /// The index of the corner.
        index: usize,
        /// The position of the corner in metres.
        position: [f32; 3],
        /// The texture coordinates of the corner.
        uv: [f32; 2],
    },
}

/// The reason why a camera cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CameraError {
    /// The image has no pixels.
    #[error("a resolution of {0} x {1} pixels, expected at least 1 x 1")]
    Resolution(u32, u32),
    /// A length of the camera is not finite and positive.
    #[error("{what} of {found} mm, expected a finite number above 0")]
    Length {
        /// The name of the length.
        what: &'static str,
        /// The length that was found, in millimetres.
        found: f64,
    },
    /// The mount has a number that is not finite.
    #[error("a mount with a number that is not finite: ({}, {}, {}), yaw {yaw}, pitch {pitch}, roll {roll}", place[0], place[1], place[2])]
    Mount {
        /// The place of the mount, in metres ahead, to the left and up.
        place: [f64; 3],
        /// The yaw, in radians to the left.
        yaw: f64,
        /// The pitch, in radians downwards.
        pitch: f64,
        /// The roll, in radians to the right.
        roll: f64,
    },
}
