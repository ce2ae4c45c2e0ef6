//! A view: a scene, and the camera that is to draw it.

use crate::{Camera, Scene};
use nalgebra::{Isometry3, Point3};

/// A scene with the camera that takes images of the scene.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// The scene that is drawn.
    pub scene: &'a Scene,
    /// The pinhole camera that draws the scene.
    pub camera: &'a Camera,
    /// The pose of the vehicle that carries the camera, in the world.
    pub pose: Isometry3<f64>,
    /// The id of an object that is not drawn; `None` if all objects are drawn. Usually it is that of the vehicle that
    /// carries the camera, since the camera would see its inner sides.
    pub without: Option<u16>,
    /// The point midway between the head lamps, in the coordinates of the vehicle that carries the camera; `None`
    /// without head lamps. The lamps shine forward as daylight fades.
    pub head_lamps: Option<Point3<f64>>,
}

impl<'a> View<'a> {
    /// Makes a view of a whole scene from a camera on a vehicle at `pose`, without head lamps.
    pub fn new(scene: &'a Scene, camera: &'a Camera, pose: Isometry3<f64>) -> Self {
        Self { scene, camera, pose, without: None, head_lamps: None }
    }
}

/// The kinds of images that the renderer is to draw of a view. The renderer draws no other images.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WantedImages {
    /// True if the colours in sRGB are wanted.
    pub rgb: bool,
    /// True if the colours in linear light are wanted, which are neither rounded nor limited.
    pub linear: bool,
    /// True if the distance of each pixel is wanted.
    pub depth: bool,
    /// True if the semantic class of each pixel is wanted.
    pub semantic: bool,
    /// True if the id of the object at each pixel is wanted.
    pub instance: bool,
    /// True if the pixels of each object without the objects in front are wanted, for the computation of occlusion.
    /// Objects with ids are drawn a second time for it.
    pub alone: bool,
    /// True if objects are to throw shadows in the images `rgb` and `linear`.
    pub shadows: bool,
}

impl WantedImages {
    /// Returns `true` if light has to be computed.
    pub(crate) fn light(self) -> bool {
        self.rgb || self.linear
    }
}
