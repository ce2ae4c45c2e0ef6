//! What can go wrong with seeing.

use thiserror::Error;

/// Why nothing can be drawn.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RenderError {
    /// There is nothing to draw with.
    #[error(
        "no graphics adapter was found ({0}). None needs a display or a graphics card: on Debian and Ubuntu the package \
         mesa-vulkan-drivers draws on the processor (apt install mesa-vulkan-drivers)"
    )]
    NoAdapter(String),
    /// There is an adapter, but it does not let itself be used.
    #[error("the graphics adapter {adapter} could not be opened: {reason}")]
    NotOpened {
        /// Its name.
        adapter: String,
        /// What it said.
        reason: String,
    },
    /// The adapter was taken away or its driver gave up. A new renderer may work.
    #[error("the graphics device was lost: {0}; a new renderer has to be made")]
    Lost(String),
    /// The adapter refused what it was asked for, most often memory.
    #[error("the graphics device failed: {0}")]
    Failed(String),
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
    #[error("the pose of the camera has a number that is not finite: {0}")]
    Pose(String),
    /// A thing's place is no place.
    #[error("instance {index} of the scene (id {id}) has a {what} of {found}, expected {expected}")]
    Instance {
        /// Which of the scene's instances.
        index: usize,
        /// Its id.
        id: u16,
        /// What of it is wrong.
        what: &'static str,
        /// What it is.
        found: String,
        /// What it should be.
        expected: &'static str,
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
    /// An effect of a lens or a sensor that there is not.
    #[error("`{what}` is {found}, expected {expected}")]
    Effect {
        /// Which effect.
        what: &'static str,
        /// What it is.
        found: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A mount that is nowhere.
    #[error("a mount with a number that is not finite: {0}")]
    Mount(String),
}
