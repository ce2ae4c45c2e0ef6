//! What there is to see at one moment.

mod figure;
mod ground;
mod pavement;
mod stage;

pub use stage::{Cast, Model, Stage, Stages};

use crate::Mesh;
use nalgebra::Isometry3;
use paracosm_engine::{Weather, sensor};
use std::sync::Arc;

/// What there is to see at one moment.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The things in it.
    pub instances: Vec<Instance>,
    /// Light and fog.
    pub air: Atmosphere,
}

/// A thing: a mesh, and where it stands.
#[derive(Debug, Clone)]
pub struct Instance {
    /// Its shape, shared by all that look alike.
    pub mesh: Arc<Mesh>,
    /// From the mesh's coordinates to the world's.
    pub pose: Isometry3<f32>,
    /// How much larger than the mesh it is along the mesh's axes.
    pub scale: [f32; 3],
    /// The colour of what is painted on it: red, green and blue in linear light, from 0 to 1.
    pub paint: [f32; 3],
    /// Which thing it is part of: 0 for what belongs to nothing in particular, else one more than the index of the body
    /// among those of the run.
    pub id: u16,
}

/// Light and fog.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atmosphere {
    /// From 0, night, to 1, broad daylight.
    pub light: f32,
    /// How high the sun stands, in radians above the horizon. Light is dimmer and warmer the lower that is, and below the
    /// horizon there is dusk. Shadows on level ground fade towards the horizon: the sun of 3 degrees, with a twentieth of its
    /// light on the level, adds less than a tenth to that of the sky.
    pub sun_elevation: f32,
    /// Where the sun stands, in radians counter-clockwise from x.
    pub sun_azimuth: f32,
    /// The extinction of the fog in 1/m, 0 without any: 3.912 / visibility (Koschmieder, 2 % contrast).
    pub extinction: f32,
}

impl Atmosphere {
    /// The air of a weather, with the fog that its other sensors see through ([`sensor::Air::of`]).
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
    /// Broad daylight from the left and behind, no fog.
    fn default() -> Self {
        Self { light: 1.0, sun_elevation: 0.9, sun_azimuth: 2.3, extinction: 0.0 }
    }
}
