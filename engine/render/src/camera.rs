//! The pinhole camera: the direction in which each pixel looks.

use crate::CameraError;
use nalgebra::{Isometry3, Point2, Point3, Translation3, UnitQuaternion, Vector3};
use paracosm_engine::sensor::CameraSpec;

/// A pinhole camera with its mounting place and direction on a vehicle. The camera's own axes are x forward, y to the
/// left, z up. Pixels are counted from the upper left corner of the image to the right and down; the middle of the
/// first pixel is at (0.5, 0.5).
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    width: u32,
    height: u32,
    focal_length: f64,
    sensor_width: f64,
    mount: Isometry3<f64>,
}

impl Camera {
    /// The least distance at which the camera sees objects, in metres along the camera's axis.
    pub const NEAR: f64 = 0.1;

    /// Makes a camera at the origin of its vehicle that looks forward, with the image size in pixels, and the focal
    /// length and the sensor width in millimetres.
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

    /// Makes a camera from its description, mounted at the described place on its vehicle.
    ///
    /// # Errors
    /// There are no pixels, a length is not finite and positive, or a number of the mount is not finite.
    pub fn of(spec: &CameraSpec) -> Result<Self, CameraError> {
        let [width, height] = spec.resolution;
        let [yaw, pitch, roll] = spec.yaw_pitch_roll.map(f64::to_radians);
        let camera = Self::new(width, height, spec.focal_mm, spec.sensor_mm)?;
        camera.mounted(Point3::from(spec.position), yaw, pitch, roll)
    }

    /// Returns the camera with another mounting place and direction on its vehicle. The mount is at a place in metres,
    /// turned by yaw (to the left), then pitch (downwards), then roll (to the right) in radians, as in ISO 8855.
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

    /// Returns the width of the image in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height of the image in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the transformation from the camera's coordinates to the coordinates of the vehicle that carries the
    /// camera.
    pub fn mount(&self) -> &Isometry3<f64> {
        &self.mount
    }

    /// Returns the focal length in pixels, which is the same along rows and columns.
    pub fn focal_pixels(&self) -> f64 {
        self.focal_length * f64::from(self.width) / self.sensor_width
    }

    /// Returns the horizontal field of view, in radians.
    pub fn field_of_view(&self) -> f64 {
        2.0 * libm::atan(self.sensor_width / (2.0 * self.focal_length))
    }

    /// Returns the direction of the ray through an image point, as a vector with x = 1 in the camera's coordinates.
    pub fn ray(&self, pixel: Point2<f64>) -> Vector3<f64> {
        let middle = self.middle();
        let focal = self.focal_pixels();
        Vector3::new(1.0, (middle.x - pixel.x) / focal, (middle.y - pixel.y) / focal)
    }

    /// Returns the pixel coordinates of a point in the camera's coordinates; `None` if the point is nearer than
    /// [`Self::NEAR`] or behind the camera. The place may be outside the image.
    pub fn project(&self, point: &Point3<f64>) -> Option<Point2<f64>> {
        let middle = self.middle();
        let scale = self.focal_pixels() / point.x;
        (point.x >= Self::NEAR).then(|| Point2::new(middle.x - point.y * scale, middle.y - point.z * scale))
    }

    /// Returns the pose of the camera in the world, given the pose of the vehicle that carries the camera.
    pub fn pose(&self, carrier: &Isometry3<f64>) -> Isometry3<f64> {
        carrier * self.mount
    }

    fn middle(&self) -> Point2<f64> {
        Point2::new(f64::from(self.width) / 2.0, f64::from(self.height) / 2.0)
    }
}
