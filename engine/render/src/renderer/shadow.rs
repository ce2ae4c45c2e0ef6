//! The place of the shadow map: a square in front of the camera, perpendicular to the sun's rays.

use super::raw::rows;
use crate::{Atmosphere, Look};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Vector3};

/// The numbers of texels of the maps each way, from the finer map to the coarser map.
pub(super) const TEXELS: [u32; 2] = [1024, 512];
/// The distance in metres from which on the pixels of a camera with the coarser map are larger than the texels of the map.
const SMOOTH: f64 = 20.0;
/// The heights in metres up to which objects throw no shadow into the maps.
const LOW: [f64; 2] = [0.05, 0.25];
/// Half of the side that the map covers, in metres.
const REACH: f64 = 36.0;
/// The distance from the camera to the middle of the map, in metres.
const AHEAD: f64 = 30.0;
/// The greatest distance, towards the sun and away from it, at which objects throw shadows into the map, in metres.
const DEEP: f64 = 150.0;

/// The shadow map of one view.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShadowMap {
    /// The index of the map's number of texels in [`TEXELS`].
    pub grade: usize,
    /// The transformation from the camera's coordinates to the light's coordinates. In the light's coordinates, x and y
    /// are perpendicular to the rays, z points towards the sun, and the middle is the origin.
    to_light: Isometry3<f64>,
}

/// Returns the direction to the sun, in the world.
pub(super) fn to_sun(air: &Atmosphere) -> Vector3<f64> {
    let (sin_up, cos_up) = libm::sincos(f64::from(air.sun_elevation));
    let (sin_around, cos_around) = libm::sincos(f64::from(air.sun_azimuth));
    Vector3::new(cos_up * cos_around, cos_up * sin_around, sin_up)
}

impl ShadowMap {
    /// The greatest distance in metres from an object to a point that its shadow falls on.
    pub const DEPTH: f64 = 2.0 * DEEP;

    /// Makes the shadow map for a pose of the camera and a direction to the sun. `focal` is the focal length of the camera
    /// in pixels. In the look [`Textured`](Look::Textured), a camera with large pixels has the coarser map.
    pub fn new(camera: &Isometry3<f64>, focal: f64, sun: &Vector3<f64>, look: Look) -> Self {
        let texel = |grade: usize| 2.0 * REACH / f64::from(TEXELS[grade]);
        let grade = usize::from(look == Look::Textured && SMOOTH / focal > texel(1));
        let ahead = camera * Vector3::x();
        let level = Vector3::new(ahead.x, ahead.y, 0.0).try_normalize(1e-9).unwrap_or_default();
        let turn = Rotation3::rotation_between(sun, &Vector3::z()).unwrap_or_else(Rotation3::identity);
        // The middle moves by whole texels, so that the edges of shadows stand still while the camera moves.
        let texel = texel(grade);
        let middle = turn * (camera.translation.vector + level * AHEAD);
        let middle = Vector3::new((middle.x / texel).round() * texel, (middle.y / texel).round() * texel, middle.z);
        let to_light = Isometry3::from_parts((-middle).into(), turn.into());
        Self { grade, to_light: to_light * camera }
    }

    /// Returns the rows of the matrix that maps the camera's coordinates to the shadow map. On the map, coordinates are
    /// 0 to 1 across and down, and 0 to 1 in depth.
    pub fn rows(&self) -> [[f32; 4]; 3] {
        let linear = Matrix3::from_diagonal(&Vector3::new(0.5 / REACH, -0.5 / REACH, -0.5 / DEEP));
        rows(&linear, &self.to_light, &Vector3::repeat(0.5))
    }

    /// Returns the height in metres up to which objects throw no shadow into the map.
    pub fn low(&self) -> f64 {
        LOW[self.grade]
    }

    /// Returns `true` if an object within a ball can throw a shadow into the shadow map.
    pub fn catches(&self, middle: &Point3<f64>, radius: f64) -> bool {
        let middle = self.to_light * middle;
        middle.x.abs() < REACH + radius && middle.y.abs() < REACH + radius && middle.z.abs() < DEEP + radius
    }
}
