//! A scene: everything that is visible at one moment.

mod cells;
mod figure;
mod ground;
mod markings;
mod pavement;
mod scenery;
mod signals;
mod stage;

pub use scenery::is_only_pictured;
pub use stage::{Cast, Model, Stage, Stages};

use crate::{Look, Mesh};
use nalgebra::Isometry3;
use paracosm_engine::{Weather, sensor};
use std::sync::Arc;

/// The visible objects at one moment, with the light and the fog.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The meshes of the objects, with their places in the scene.
    pub instances: Vec<Instance>,
    /// The light and the fog of the scene.
    pub air: Atmosphere,
    /// The look in which surfaces are drawn. A [`Stage`] also chooses the shapes of bodies by it.
    pub look: Look,
}

/// A mesh with its place, its size and its colour in a scene.
#[derive(Debug, Clone)]
pub struct Instance {
    /// The mesh of the object, which several instances may share.
    pub mesh: Arc<Mesh>,
    /// The transformation from the mesh's coordinates to the coordinates of the world.
    pub pose: Isometry3<f32>,
    /// The factors by which the object is larger than its mesh, along the mesh's x, y and z axes.
    pub scale: [f32; 3],
    /// The red, green and blue of the painted surfaces, in linear light from 0 to 1.
    pub paint: [f32; 3],
    /// The id of the object to which the instance belongs. The id is 0 for no particular object, otherwise one more
    /// than the index of the body among the bodies of the run.
    pub id: u16,
}

/// The light and the fog of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atmosphere {
    /// The brightness of the daylight, from 0 (night) to 1 (broad daylight).
    pub light: f32,
    /// The elevation of the sun, in radians above the horizon. The lower the sun, the dimmer and warmer is the light;
    /// below the horizon there is dusk. Shadows on level ground fade as the sun comes near the horizon: at 3 degrees
    /// the sun sends a twentieth of its light onto level ground, which adds less than a tenth to the light of the sky.
    pub sun_elevation: f32,
    /// The direction of the sun on the ground plane, in radians counter-clockwise from the x axis.
    pub sun_azimuth: f32,
    /// The extinction coefficient of the fog in 1/m; 0 without fog. It is 3.912 / visibility (Koschmieder, 2 %
    /// contrast).
    pub extinction: f32,
}

impl Atmosphere {
    /// Returns the light and the fog in the given weather. The fog is the fog that the other sensors see through
    /// ([`sensor::Air::of`]).
    pub fn of(weather: &Weather) -> Self {
        Self {
            light: weather.light as f32,
            sun_elevation: weather.sun_elevation as f32,
            sun_azimuth: weather.sun_azimuth as f32,
            extinction: sensor::Air::of(weather).extinction as f32,
        }
    }
}

impl Default for Atmosphere {
    /// Returns broad daylight without fog, with the sun behind and to the left.
    fn default() -> Self {
        Self { light: 1.0, sun_elevation: 0.9, sun_azimuth: 2.3, extinction: 0.0 }
    }
}
