//! The errors of cameras, of scenes and of the graphics adapter.

use nalgebra::{Isometry3, Point3};
use std::sync::Arc;
use thiserror::Error;

/// The error of the graphics interface that caused an error of this crate.
pub type GraphicsCause = Arc<dyn std::error::Error + Send + Sync>;

/// The reason why the renderer cannot draw any image.
#[derive(Debug, Clone, Error)]
pub enum RenderError {
    /// The machine has no graphics adapter.
    #[error(
        "no graphics adapter was found ({0}). No display or graphics card is needed: on Debian and Ubuntu the package \
         mesa-vulkan-drivers draws on the processor (apt install mesa-vulkan-drivers)"
    )]
    NoAdapter(GraphicsCause),
    /// The machine has a graphics adapter, but the renderer cannot open it.
    #[error("the graphics adapter {adapter} could not be opened: {source}")]
    NotOpened {
        /// The name of the graphics adapter.
        adapter: String,
        /// The error that the graphics adapter returned.
        source: GraphicsCause,
    },
    /// The graphics adapter was removed, or its driver failed. A new renderer may work.
    #[error("the graphics device was lost: {reason:?}, {message}; make a new renderer")]
    Lost {
        /// The reason for the loss, as the graphics interface states it.
        reason: LossReason,
        /// The message of the graphics driver.
        message: String,
    },
    /// The graphics adapter refused a request, most often a request for memory.
    #[error("the graphics device failed: {0}")]
    Failed(GraphicsCause),
}

/// The reason why a graphics device was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LossReason {
    /// The graphics driver does not give a reason.
    Unknown,
    /// The program itself ended the graphics device.
    Destroyed,
}

/// The reason why one view of a scene cannot be drawn. Other views of the same call can be drawn.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ViewError {
    /// The image is wider or higher than the graphics adapter allows.
    #[error("the image is {width} x {height} pixels, expected at most {limit} each way on this graphics adapter")]
    TooLarge {
        /// The width of the image in pixels.
        width: u32,
        /// The height of the image in pixels.
        height: u32,
        /// The greatest width and the greatest height that the adapter allows, in pixels.
        limit: u32,
    },
    /// The scene or the image needs a larger buffer than the graphics adapter allows.
    #[error("{what} takes {bytes} bytes, expected at most {limit} on this graphics adapter")]
    TooMuch {
        /// The name of the buffer that is too large.
        what: &'static str,
        /// The needed size of the buffer, in bytes.
        bytes: u64,
        /// The greatest size of a buffer that the adapter allows, in bytes.
        limit: u64,
    },
    /// The pose of the camera or the place of the head lamps has a number that is not finite.
    #[error("the pose of the camera has a number that is not finite: {pose}, head lamps {head_lamps:?}")]
    Pose {
        /// The pose of the vehicle that carries the camera.
        pose: Isometry3<f64>,
        /// The point midway between the head lamps, in the coordinates of the vehicle that carries the camera; `None`
        /// without head lamps.
        head_lamps: Option<Point3<f64>>,
    },
    /// An object of the scene has a number that is not valid.
    #[error("instance {index} of the scene (id {id}) has a {flaw}")]
    Instance {
        /// The index of the object's instance in the scene.
        index: usize,
        /// The id of the object in the scene; 0 for an object without an id.
        id: u16,
        /// The flaw of the object, with the value that is not valid.
        flaw: InstanceFlaw,
    },
    /// A number that describes the light or the fog is out of its range.
    #[error("the air has {what} of {found}, expected {expected}")]
    Air {
        /// The name of the quantity that is out of range.
        what: &'static str,
        /// The value of the quantity that is out of range.
        found: f32,
        /// The expected range of the quantity.
        expected: &'static str,
    },
    /// The camera is inside an object of the scene, so that nothing else is visible.
    #[error(
        "the camera is inside instance {index} of the scene (id {id}); mount it outside, or leave that id out of the view"
    )]
    Inside {
        /// The index of the object's instance in the scene.
        index: usize,
        /// The id of the object in the scene; 0 for an object without an id.
        id: u16,
    },
}

/// The reason why an object of a scene is not valid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InstanceFlaw {
    /// The pose of the object has a number that is not finite.
    #[error("pose of {0}, expected finite numbers")]
    Pose(Isometry3<f32>),
    /// The scale of the object has a number that is not finite or not above 0.
    #[error("scale of {0:?}, expected finite numbers above 0")]
    Scale([f32; 3]),
    /// The colour of the object has a number below 0 or above 1.
    #[error("paint of {0:?}, expected numbers from 0 to 1")]
    Paint([f32; 3]),
    /// A corner of the object's mesh has a number that is not finite.
    #[error("mesh whose corner {index} is at {position:?} with texture coordinates {uv:?}, expected finite numbers")]
    Corner {
        /// The index of the corner in the mesh.
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
    /// The width or the height of the image is 0.
    #[error("a resolution of {0} x {1} pixels, expected at least 1 x 1")]
    Resolution(u32, u32),
    /// The focal length or the sensor width is not finite and above 0.
    #[error("{what} of {found} mm, expected a finite number above 0")]
    Length {
        /// The name of the length, which is the focal length or the sensor width.
        what: &'static str,
        /// The given focal length or sensor width, in millimetres.
        found: f64,
    },
    /// The place or an angle of the mount has a number that is not finite.
    #[error("a mount with a number that is not finite: ({}, {}, {}), yaw {yaw}, pitch {pitch}, roll {roll}", place[0], place[1], place[2])]
    Mount {
        /// The place of the camera on its vehicle, in metres ahead, to the left and up.
        place: [f64; 3],
        /// The yaw angle of the camera, in radians to the left.
        yaw: f64,
        /// The pitch angle of the camera, in radians downwards.
        pitch: f64,
        /// The roll angle of the camera, in radians to the right.
        roll: f64,
    },
}
