//! A frame: the images of one view, as the renderer returns them.

use crate::{Camera, Semantic};
use nalgebra::Point2;

/// The images that the renderer draws of one view. All images are stored in rows from the top, with pixels from the
/// left.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The camera that took the images.
    pub camera: Camera,
    /// The red, green and blue of each pixel in sRGB; `None` if the colours are not wanted.
    pub rgb: Option<Vec<u8>>,
    /// The red, green and blue of each pixel in linear light; a white surface in full sun has about 1.
    pub linear: Option<Vec<f32>>,
    /// The distance in metres from the pinhole to the visible point at the middle of each pixel; infinite for the sky.
    pub depth: Option<Vec<f32>>,
    /// The number of the [`Semantic`] class of each pixel; `None` if the classes are not wanted.
    pub semantic: Option<Vec<u8>>,
    /// The id of the object at each pixel ([`Instance::id`](crate::Instance::id)); 0 for an object without an id.
    pub instance: Option<Vec<u16>>,
    /// The number and the bounds of the pixels that each object would have without the objects in front, sorted by id.
    pub alone: Option<Vec<Extent>>,
}

/// The number and the bounds of an object's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// The id of the object that the pixels show.
    pub id: u16,
    /// The number of pixels that show the object.
    pub pixels: u32,
    /// The least column and the least row of the object's pixels.
    pub min: [u32; 2],
    /// The greatest column and the greatest row of the object's pixels.
    pub max: [u32; 2],
}

impl Extent {
    pub(crate) fn of_pixel(id: u16, at: [u32; 2]) -> Self {
        Self { id, pixels: 1, min: at, max: at }
    }

    pub(crate) fn add(&mut self, at: [u32; 2]) {
        self.pixels += 1;
        self.min = [self.min[0].min(at[0]), self.min[1].min(at[1])];
        self.max = [self.max[0].max(at[0]), self.max[1].max(at[1])];
    }

    /// Adds other pixels of the same object.
    pub(crate) fn join(&mut self, other: &Self) {
        self.pixels += other.pixels;
        for axis in 0..2 {
            self.min[axis] = self.min[axis].min(other.min[axis]);
            self.max[axis] = self.max[axis].max(other.max[axis]);
        }
    }
}

impl Frame {
    /// Returns the width of the images in pixels.
    pub fn width(&self) -> u32 {
        self.camera.width()
    }

    /// Returns the height of the images in pixels.
    pub fn height(&self) -> u32 {
        self.camera.height()
    }

    /// Returns the depth of each pixel in metres along the camera's axis; `None` if the frame has no depth.
    pub fn planar_depth(&self) -> Option<Vec<f32>> {
        let depth = self.depth.as_ref()?;
        let forward = |(index, radial): (usize, &f32)| {
            let (column, row) = (index as u32 % self.width(), index as u32 / self.width());
            let middle = Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            (f64::from(*radial) / self.camera.ray(middle).norm()) as f32
        };
        Some(depth.iter().enumerate().map(forward).collect())
    }

    /// Returns the red, green and blue of each pixel's class in CARLA's colours; `None` if the frame has no classes.
    pub fn semantic_colours(&self) -> Option<Vec<u8>> {
        Some(self.semantic.as_ref()?.iter().flat_map(|class| Semantic::colour_of(*class)).collect())
    }
}
