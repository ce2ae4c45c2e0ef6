//! A view: a scene, and the camera that is to draw it.

use crate::{Camera, Scene};
use nalgebra::{Isometry3, Point3};

/// A camera that looks at a scene.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// The scene that is drawn.
    pub scene: &'a Scene,
    /// The camera that draws the scene.
    pub camera: &'a Camera,
    /// The pose in the world of the vehicle that carries the camera.
    pub pose: Isometry3<f64>,
    /// The id of the things that are not drawn, if any. Usually it is that of the vehicle that carries the camera,
    /// since the camera would see its inner sides.
    pub without: Option<u16>,
    /// The point midway between the two head lamps, in the coordinates of the vehicle that carries the camera, if it
    /// has head lamps. They shine forward as daylight fades.
    pub head_lamps: Option<Point3<f64>>,
}

impl<'a> View<'a> {
    /// Makes a view of the whole scene, by a camera on a vehicle at `pose`, without head lamps.
    pub fn new(scene: &'a Scene, camera: &'a Camera, pose: Isometry3<f64>) -> Self {
        Self { scene, camera, pose, without: None, head_lamps: None }
    }
}

/// The images of a view that are wanted. The renderer draws no others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WantedImages {
    /// True for colours as a screen shows them.
    pub rgb: bool,
    /// True for colours in linear light, neither rounded nor cut off, for models of lenses and sensors.
    pub linear: bool,
    /// True for the distance of each pixel.
    pub depth: bool,
    /// True for the semantic class of each pixel.
    pub semantic: bool,
    /// True for the id of the thing at each pixel.
    pub instance: bool,
    /// True for the pixels that each thing would have if it were alone; occlusion is measured against them. Everything
    /// is drawn a second time for it.
    pub alone: bool,
    /// True if things throw shadows in `rgb` and `linear`.
    pub shadows: bool,
}

impl WantedImages {
    /// Returns `true` if light has to be computed.
    pub(crate) fn light(self) -> bool {
        self.rgb || self.linear
    }
}
