//! What can go wrong with seeing.

use nalgebra::{Isometry3, Point3};
use std::sync::Arc;
use thiserror::Error;

/// The error of the graphics interface that is behind one of ours.
pub type GraphicsCause = Arc<dyn std::error::Error + Send + Sync>;

/// Why nothing can be drawn.
#[derive(Debug, Clone, Error)]
pub enum RenderError {
    /// There is nothing to draw with.
    #[error(
        "no graphics adapter was found ({0}). None needs a display or a graphics card: on Debian and Ubuntu the package \
         mesa-vulkan-drivers draws on the processor (apt install mesa-vulkan-drivers)"
    )]
    NoAdapter(GraphicsCause),
    /// There is an adapter, but it does not let itself be used.
    #[error("the graphics adapter {adapter} could not be opened: {source}")]
    NotOpened {
        /// Its name.
        adapter: String,
        /// What it said.
        source: GraphicsCause,
    },
    /// The adapter was taken away or its driver gave up. A new renderer may work.
    #[error("the graphics device was lost: {reason:?}, {message}; a new renderer has to be made")]
    Lost {
        /// How it came to be lost.
        reason: LossReason,
        /// What its driver says.
        message: String,
    },
    /// The adapter refused what it was asked for, most often memory.
    #[error("the graphics device failed: {0}")]
    Failed(GraphicsCause),
}

/// How a graphics device was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LossReason {
    /// The driver does not say.
    Unknown,
    /// It was told to end.
    Destroyed,
}

/// Why one view cannot be drawn; the views beside it can.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ViewError {
    /// The image is larger than the adapter's largest.
    #[error("the image is {width} x {height} pixels, expected at most {limit} each way on this graphics adapter")]
    TooLarge {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Pixels.
        limit: u32,
    },
    /// The scene has more triangles in one mesh, or more things at once, than the adapter takes.
    #[error("{what} takes {bytes} bytes, expected at most {limit} on this graphics adapter")]
    TooMuch {
        /// What it is that takes them.
        what: &'static str,
        /// How many they are.
        bytes: u64,
        /// How many they may be.
        limit: u64,
    },
    /// The camera's place is no place.
    #[error("the pose of the camera has a number that is not finite: {pose}, head lamps {head_lamps:?}")]
    Pose {
        /// The pose of what carries the camera.
        pose: Isometry3<f64>,
        /// The head lamps beside it.
        head_lamps: Option<Point3<f64>>,
    },
    /// A thing's place is no place.
    #[error("instance {index} of the scene (id {id}) has a {flaw}")]
    Instance {
        /// Which of the scene's instances.
        index: usize,
        /// Its id.
        id: u16,
        /// What is wrong with it.
        flaw: InstanceFlaw,
    },
    /// The light or the fog is not one that there is.
    #[error("the air has {what} of {found}, expected {expected}")]
    Air {
        /// What of it is wrong.
        what: &'static str,
        /// What it is.
        found: f32,
        /// What it should be.
        expected: &'static str,
    },
    /// There is nothing to see from within a thing.
    #[error(
        "the camera is inside instance {index} of the scene (id {id}); mount it outside, or leave that id out of the view"
    )]
    Inside {
        /// Which of the scene's instances.
        index: usize,
        /// Its id.
        id: u16,
    },
}

/// What is wrong with a thing in a scene.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InstanceFlaw {
    /// A pose with a number that is not finite.
    #[error("pose of {0}, expected finite numbers")]
    Pose(Isometry3<f32>),
    /// A scale that is no scale.
    #[error("scale of {0:?}, expected finite numbers above 0")]
    Scale([f32; 3]),
    /// A paint that is no colour.
    #[error("paint of {0:?}, expected numbers from 0 to 1")]
    Paint([f32; 3]),
    /// A mesh with a corner that is no place.
    #[error("mesh of corner {index} at {position:?} with texture coordinates {uv:?}, expected finite numbers")]
    Corner {
        /// Which of its corners.
        index: usize,
        /// Metres.
        position: [f32; 3],
        /// Its texture coordinates.
        uv: [f32; 2],
    },
}

/// Why there is no such camera.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CameraError {
    /// An image without pixels.
    #[error("a resolution of {0} x {1} pixels, expected at least 1 x 1")]
    Resolution(u32, u32),
    /// A length of the camera's that is none.
    #[error("{what} of {found} mm, expected a finite number above 0")]
    Length {
        /// Which length.
        what: &'static str,
        /// What it is.
        found: f64,
    },
    /// A mount that is nowhere.
    #[error("a mount with a number that is not finite: ({}, {}, {}), yaw {yaw}, pitch {pitch}, roll {roll}", place[0], place[1], place[2])]
    Mount {
        /// Metres ahead, to the left and up.
        place: [f64; 3],
        /// Radians to the left.
        yaw: f64,
        /// Radians downwards.
        pitch: f64,
        /// Radians to the right.
        roll: f64,
    },
}
