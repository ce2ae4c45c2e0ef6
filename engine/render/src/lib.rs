//! What cameras see of a world.
//!
//! A [`Scene`] is what there is to see at one moment: [`Mesh`]es and where they stand, the light and the fog. It knows nothing of
//! how it is drawn. A [`View`] is a [`Camera`]'s look at a scene; a [`Renderer`] draws many of them at once, with or without a
//! graphics card, and each becomes a [`Frame`]: colours, depth, classes, and things.
//!
//! [`Optics`] makes a camera of its description, by the table [`camera_settings`]; an [`Exposure`] is a moment of a run before
//! it, and a [`Developer`] draws many of them.
//!
//! Coordinates are the engine's: x along the road, y to its left, z up, in metres. A mesh stands on z = 0, faces along
//! x, and has its middle over the origin.

mod atmosphere;
mod boxes;
mod camera;
mod developer;
mod error;
mod exposure;
mod frame;
pub mod gltf;
pub mod lens;
mod light;
pub mod mesh;
mod optics;
mod palette;
mod renderer;
mod scene;
mod settings;
mod view;

pub use boxes::{Box2, Box3, boxes, boxes_in_space};
pub use camera::Camera;
pub use developer::{Developer, Rendering, Undrawn, at_once};
pub use error::{CameraError, GraphicsCause, InstanceFlaw, LossReason, RenderError, ViewError};
pub use exposure::{Exposure, Sight};
pub use frame::{Extent, Frame};
pub use mesh::{Mesh, Semantic, SurfaceKind, Vertex};
pub use optics::Optics;
pub use renderer::{Adapter, Renderer, adapter};
pub use scene::{Atmosphere, Cast, Instance, Model, Scene, Stage, Stages};
pub use settings::{CameraFlaw, CameraSettings, NoCamera, RESOLUTION, camera_settings};
pub use view::{View, WantedImages};
