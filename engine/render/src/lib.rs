//! Draws images of a simulated world as its cameras see it.
//!
//! A [`Scene`] holds everything that is visible at one moment: [`Mesh`]es, their places, the light and the fog. A scene
//! does not depend on how it is drawn. A [`View`] is a [`Camera`] looking at a scene. A [`Renderer`] draws many views
//! at once, with or without a graphics card, and returns a [`Frame`] for each: colours, depth, semantic classes and
//! instances.
//!
//! Images have a [`Look`], which a [`Stage`] gives to all of its scenes. The look
//! [`Flat`](Look::Flat) is the default and never changes. The look [`Textured`](Look::Textured) has textures, cars and
//! people of many shapes, lamps that show what a vehicle does, and scenery that exists only in pictures.
//!
//! [`Optics`] makes a camera from its description, by the table [`camera_settings`]. An [`Exposure`] is a moment of a
//! run that a camera is to draw. A [`Developer`] draws many exposures.
//!
//! Coordinates are those of the engine, in metres: x along the road, y to the left, z up. A mesh stands on z = 0 and
//! faces along x; its middle is over the origin.
//!
//! ```no_run
//! use nalgebra::Isometry3;
//! use paracosm_engine::road::CrossIntersection;
//! use paracosm_render::{Atmosphere, Camera, Renderer, Stage, View, WantedImages};
//!
//! let stage = Stage::of(&*CrossIntersection::new().build()?);
//! let scene = stage.scene_of([], Atmosphere::default());
//! let camera = Camera::new(640, 480, 6.0, 7.2)?;
//! let view = View::new(&scene, &camera, Isometry3::translation(0.0, 0.0, 1.5));
//! let wanted = WantedImages { rgb: true, shadows: true, ..WantedImages::default() };
//! let frames = Renderer::new()?.render(&[view], wanted)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
mod texture;
mod view;

pub use boxes::{Box2, Box3, boxes, boxes_in_space};
pub use camera::Camera;
pub use developer::{Developer, Rendering, Undrawn, at_once};
pub use error::{CameraError, GraphicsCause, InstanceFlaw, LossReason, RenderError, ViewError};
pub use exposure::{Exposure, Sight};
pub use frame::{Extent, Frame};
pub use mesh::{Mesh, Semantic, SurfaceKind, Vertex};
pub use optics::Optics;
pub use paracosm_engine::sensor::Look;
pub use renderer::{Adapter, Renderer, adapter};
pub use scene::{Atmosphere, Cast, Instance, Model, Scene, Stage, Stages, is_only_pictured};
pub use settings::{CameraFlaw, CameraSettings, NoCamera, RESOLUTION, camera_settings};
pub use view::{View, WantedImages};
