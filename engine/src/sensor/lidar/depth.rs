//! A LiDAR from a depth image: its points are read from the distances that a camera at its place sees.

use super::{Beam, LidarPoint, Scan};
use crate::sensor::SensorError;
use crate::sensor::error::Checks;
use nalgebra::Vector3;

/// A depth camera without distortion, which looks ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pinhole {
    /// The numbers of columns and rows of the camera's images.
    pub size: [usize; 2],
    /// The horizontal and the vertical focal length in pixels.
    pub focal: [f64; 2],
    /// The point of the image that lies straight ahead, in pixels from the image's upper left corner.
    pub centre: [f64; 2],
}

impl Pinhole {
    /// Makes a camera with square pixels, from the size of its images and its horizontal opening angle in radians.
    pub fn new(size: [usize; 2], opening: f64) -> Self {
        let [width, height] = size.map(|pixels| pixels as f64);
        let focal = 0.5 * width / libm::tan(0.5 * opening);
        Self { size, focal: [focal, focal], centre: [0.5 * width, 0.5 * height] }
    }

    fn check(&self) -> Result<(), SensorError> {
        let checks = Checks("depth camera");
        for (axis, setting) in ["0", "1"].into_iter().enumerate().map(|(axis, name)| (axis, format!("[{name}]"))) {
            checks.counts(&format!("size{setting}"), self.size[axis], (1, 100_000))?;
            checks.within(&format!("focal{setting}"), self.focal[axis], (1e-3, 1e6), "px")?;
            checks.within(&format!("centre{setting}"), self.centre[axis], (-1e6, 1e6), "px")?;
        }
        Ok(())
    }

    /// Returns column and row of the pixel that sees in a direction (x ahead, y left, z up); `None` outside the image.
    fn pixel(&self, direction: Vector3<f64>) -> Option<[usize; 2]> {
        if direction.x <= 0.0 {
            return None;
        }
        let across = self.centre[0] - self.focal[0] * direction.y / direction.x;
        let down = self.centre[1] - self.focal[1] * direction.z / direction.x;
        let inside = |at: f64, size: usize| (0.0..size as f64).contains(&at).then_some(at as usize);
        Some([inside(across, self.size[0])?, inside(down, self.size[1])?])
    }

    /// Returns the unit vector through the middle of a pixel.
    fn direction(&self, [column, row]: [usize; 2]) -> Vector3<f64> {
        let left = (self.centre[0] - (column as f64 + 0.5)) / self.focal[0];
        let up = (self.centre[1] - (row as f64 + 0.5)) / self.focal[1];
        Vector3::new(1.0, left, up).normalize()
    }
}

/// Writes the scan of a LiDAR without noise, from the depth image of a camera at the LiDAR's place. `depth` has for
/// each pixel the distance in metres from the camera to the surface along the pixel's ray, row by row from the upper
/// left corner; a pixel without a surface has a number above `range` or NaN. The intensity falls by `fading`, in 1/m.
///
/// A beam gets the point in the middle of the pixel that it falls in. So points are on the surfaces as exactly as the
/// distances are, and their directions are off by at most half a pixel. Beams outside the image see nothing.
///
/// # Errors
/// The camera or the range is impossible, the image has another size, or the fading is not a number from 0 to 100.
pub fn scan_of_depth(
    camera: &Pinhole,
    depth: &[f32],
    beams: impl IntoIterator<Item = Beam>,
    range: f64,
    fading: f64,
    scan: &mut Scan,
) -> Result<(), SensorError> {
    camera.check()?;
    let checks = Checks("lidar");
    checks.range(range)?;
    checks.within("fading", fading, (0.0, 100.0), "1/m")?;
    let [width, height] = camera.size;
    if depth.len() != width * height {
        return Err(SensorError::WrongSize { found: depth.len(), size: (width, height) });
    }
    scan.points.clear();
    scan.points.extend(beams.into_iter().filter_map(|beam| {
        let [column, row] = camera.pixel(beam.direction())?;
        let distance = f64::from(depth[row * width + column]);
        (0.0..=range).contains(&distance).then(|| LidarPoint {
            position: (camera.direction([column, row]) * distance).cast(),
            intensity: libm::exp(-fading * distance) as f32,
            id: 0,
        })
    }));
    Ok(())
}
