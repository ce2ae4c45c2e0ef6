//! The pinhole: which pixel sees which way.

use crate::CameraError;
use nalgebra::{Isometry3, Point2, Point3, Translation3, UnitQuaternion, Vector3};
use paracosm_engine::sensor::CameraSpec;

/// A pinhole camera and where it is mounted. Its own axes are x forward, y to the left, z up; pixels are counted from
/// the upper left corner of the image to the right and down, and the middle of the first is at (0.5, 0.5).
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    width: u32,
    height: u32,
    focal_length: f64,
    sensor_width: f64,
    mount: Isometry3<f64>,
}

impl Camera {
    /// Nothing nearer than this along the camera's axis is drawn, in metres.
    pub const NEAR: f64 = 0.1;

    /// A camera with so many pixels across and down, a focal length and the width of its sensor in millimetres, at the
    /// origin of what carries it, looking forward.
    ///
    /// # Errors
    /// There are no pixels, or a length is not finite and positive.
    pub fn new(width: u32, height: u32, focal_length: f64, sensor_width: f64) -> Result<Self, CameraError> {
        if width == 0 || height == 0 {
            return Err(CameraError::Resolution(width, height));
        }
        for (what, found) in [("a focal length", focal_length), ("a sensor width", sensor_width)] {
            if !(found > 0.0 && found.is_finite()) {
                return Err(CameraError::Length { what, found });
            }
        }
        Ok(Self { width, height, focal_length, sensor_width, mount: Isometry3::identity() })
    }

    /// The camera of a description, at its place on what carries it.
    ///
    /// # Errors
    /// There are no pixels, a length is not finite and positive, or a number of its place is not finite.
    pub fn of(spec: &CameraSpec) -> Result<Self, CameraError> {
        let [width, height] = spec.resolution;
        let [yaw, pitch, roll] = spec.yaw_pitch_roll.map(f64::to_radians);
        let camera = Self::new(width, height, spec.focal_mm, spec.sensor_mm)?;
        camera.mounted(Point3::from(spec.position), yaw, pitch, roll)
    }

    /// The same camera, mounted elsewhere on what carries it: its place in metres, and how it is turned by yaw (to the
    /// left), then pitch (downwards), then roll (to the right) in radians, as ISO 8855 has them.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn mounted(self, place: Point3<f64>, yaw: f64, pitch: f64, roll: f64) -> Result<Self, CameraError> {
        if ![place.x, place.y, place.z, yaw, pitch, roll].iter().all(|number| number.is_finite()) {
            return Err(CameraError::Mount { place: place.into(), yaw, pitch, roll });
        }
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Ok(Self { mount: Isometry3::from_parts(Translation3::from(place.coords), turn), ..self })
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// From the camera's coordinates to those of what carries it.
    pub fn mount(&self) -> &Isometry3<f64> {
        &self.mount
    }

    /// The focal length in pixels, which are square.
    pub fn focal_pixels(&self) -> f64 {
        self.focal_length * f64::from(self.width) / self.sensor_width
    }

    /// The angle between the left and the right edge of the image, in radians.
    pub fn field_of_view(&self) -> f64 {
        2.0 * libm::atan(self.sensor_width / (2.0 * self.focal_length))
    }

    /// Which way a place on the image looks, in the camera's coordinates; 1 long along x.
    pub fn ray(&self, pixel: Point2<f64>) -> Vector3<f64> {
        let middle = self.middle();
        let focal = self.focal_pixels();
        Vector3::new(1.0, (middle.x - pixel.x) / focal, (middle.y - pixel.y) / focal)
    }

    /// Where on the image a point in the camera's coordinates is seen; nowhere if it is nearer than [`Self::NEAR`] or
    /// behind. It may be beside the image.
    pub fn project(&self, point: &Point3<f64>) -> Option<Point2<f64>> {
        let middle = self.middle();
        let scale = self.focal_pixels() / point.x;
        (point.x >= Self::NEAR).then(|| Point2::new(middle.x - point.y * scale, middle.y - point.z * scale))
    }

    /// The camera's own pose in the world when what carries it is here.
    pub fn pose(&self, carrier: &Isometry3<f64>) -> Isometry3<f64> {
        carrier * self.mount
    }

    fn middle(&self) -> Point2<f64> {
        Point2::new(f64::from(self.width) / 2.0, f64::from(self.height) / 2.0)
    }
}
