//! What is to be drawn.

use crate::{Camera, Scene};
use nalgebra::{Isometry3, Point3};

/// One camera's look at one scene.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// What there is to see.
    pub scene: &'a Scene,
    /// With what.
    pub camera: &'a Camera,
    /// From where: the pose in the world of what carries the camera.
    pub pose: Isometry3<f64>,
    /// The id of things that are left out, if any: usually what carries the camera, of which it would see the inside.
    pub without: Option<u16>,
    /// Where what carries the camera has its head lamps, in its own coordinates, if it has any: midway between the two.
    /// They shine forward as the day's light fades.
    pub head_lamps: Option<Point3<f64>>,
}

impl<'a> View<'a> {
    /// All there is, seen by a camera on what is here, without head lamps.
    pub fn new(scene: &'a Scene, camera: &'a Camera, pose: Isometry3<f64>) -> Self {
        Self { scene, camera, pose, without: None, head_lamps: None }
    }
}

/// Which images of a view are wanted. What is not asked for is not drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WantedImages {
    /// Colours as a screen shows them.
    pub rgb: bool,
    /// Colours in linear light, before anything rounds or cuts them: for those who make lenses and sensors of it.
    pub linear: bool,
    /// How far away it is.
    pub depth: bool,
    /// What it is.
    pub semantic: bool,
    /// Which it is.
    pub instance: bool,
    /// Which pixels each thing would have if it were alone; occlusion is measured against them. It draws everything
    /// once more.
    pub alone: bool,
    /// Whether things throw shadows in `rgb` and `linear`.
    pub shadows: bool,
}

impl WantedImages {
    /// Whether light is to be computed.
    pub(crate) fn light(self) -> bool {
        self.rgb || self.linear
    }
}
