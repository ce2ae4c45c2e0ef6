//! What cameras see of a world.
//!
//! A [`Scene`] is what there is to see at one moment: [`Mesh`]es and where they stand, the light and the fog. It knows nothing of
//! how it is drawn.
//!
//! Coordinates are the engine's: x along the road, y to its left, z up, in metres. A mesh stands on z = 0, faces along
//! x, and has its middle over the origin.

pub mod gltf;
pub mod mesh;
mod scene;

pub use mesh::{Mesh, Semantic, Surface, Vertex};
pub use scene::{Air, Instance, Scene, Stage, Stages};
