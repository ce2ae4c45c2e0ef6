//! A scene: everything that is visible at one moment.

mod figure;
mod ground;
mod pavement;
mod stage;

pub use stage::{Cast, Model, Stage, Stages};

use crate::Mesh;
use nalgebra::Isometry3;
use paracosm_engine::{Weather, sensor};
use std::sync::Arc;

/// Everything that is visible at one moment.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The things in the scene.
    pub instances: Vec<Instance>,
    /// The light and the fog.
    pub air: Atmosphere,
}

/// A mesh with its place in a scene.
#[derive(Debug, Clone)]
pub struct Instance {
    /// The shape of the thing, shared by all things that look alike.
    pub mesh: Arc<Mesh>,
    /// The transformation from the mesh's coordinates to the world's.
    pub pose: Isometry3<f32>,
    /// The factors by which the thing is larger than the mesh, along the mesh's axes.
    pub scale: [f32; 3],
    /// The colour of the painted surfaces, red, green and blue in linear light, from 0 to 1.
    pub paint: [f32; 3],
    /// The id of the thing that this instance is part of. It is 0 for no particular thing, otherwise one more than the
    /// index of the body among the bodies of the run.
    pub id: u16,
}

/// The light and the fog of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atmosphere {
    /// The brightness of the light, from 0 (night) to 1 (broad daylight).
    pub light: f32,
    /// The height of the sun, in radians above the horizon. The lower the sun, the dimmer and warmer is the light;
    /// below the horizon there is dusk. Shadows on level ground fade as the sun comes near the horizon: at 3 degrees
    /// the sun sends a twentieth of its light onto level ground, which adds less than a tenth to the light of the sky.
    pub sun_elevation: f32,
    /// The direction of the sun, in radians counter-clockwise from x.
    pub sun_azimuth: f32,
    /// The extinction of the fog in 1/m, 0 if there is no fog. It is 3.912 / visibility (Koschmieder, 2 % contrast).
    pub extinction: f32,
}

impl Atmosphere {
    /// Returns the air of a weather. The fog is the fog that the other sensors see through ([`sensor::Air::of`]).
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
    /// Returns broad daylight from the left and behind, without fog.
    fn default() -> Self {
        Self { light: 1.0, sun_elevation: 0.9, sun_azimuth: 2.3, extinction: 0.0 }
    }
}
