//! A scanning LiDAR: rings of beams around the car, and the points that the beams hit.
//!
//! Bodies are upright boxes and cylinders from their altitude to their height; the ground is flat. A scan is taken at
//! one moment: the car does not move while the beams go round. The beams do not hit the car that carries the sensor.
//!
//! An echo from the distance d has the intensity exp(-(a + 2 β) d). a is the attenuation of clear air, and β the
//! extinction of fog and rain, which the light passes there and back. No echo with an intensity of `sure` or more is
//! lost for its weakness. Below, the probability of a loss grows to 1 at an intensity of 0. All surfaces are alike.
//!
//! The beams are cast in 64 bits ([`scanner`]), not by parry, which computes in 32. Measured over a million beams each
//! at 10, 50, 100 and 200 m that end in a body: parry's boxes are off by 0.18 mm at most, but without a bound if a beam
//! grazes a face. Its cylinders, which it finds by iteration, are off by up to 0.44 m, in one of 1,500 hits by more
//! than 1 mm, and take 4 µs a beam.

mod depth;
mod scanner;

pub use depth::{Pinhole, scan_of_depth};

use super::Descriptor;
use super::error::{Checks, SensorError};
use super::{Chance, Mount, Sensor, SensorView};
use nalgebra::{Vector2, Vector3};
use scanner::Scanner;

/// The description of LiDARs in lists of sensors.
pub(super) const DESCRIPTOR: Descriptor =
    Descriptor { name: "lidar", about: "points from which beams of light come back, with their intensity" };

/// The steepest beam in radians, up or down: 85 degrees.
const STEEPEST: f64 = 1.483_529_864_195_180_3;

/// The settings of a LiDAR, not checked yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarSettings {
    /// The mounting of the sensor's middle, with the direction of its first column of beams.
    pub mount: Mount,
    /// The duration of one turn in seconds, which is the time between two scans.
    pub period: f64,
    /// The number of channels, which is the number of beams in a vertical column.
    pub channels: usize,
    /// The elevation of the lowest channel, in radians above the horizon. A single channel is half way to `highest`.
    pub lowest: f64,
    /// The elevation of the highest channel, in radians above the horizon. The other channels are evenly spaced.
    pub highest: f64,
    /// The number of measurements of each channel in a turn.
    pub columns: usize,
    /// The greatest distance in metres that the sensor measures.
    pub range: f64,
    /// The standard deviation of the noise of a measured distance, in metres.
    pub noise: f64,
    /// The attenuation of the intensity in clear air, in 1/m.
    pub attenuation: f64,
    /// The least intensity at which no echo is lost because it is too weak. Below, the loss is 1 - intensity / `sure`.
    pub sure: f64,
    /// The probability that an echo is lost independently of its intensity.
    pub loss: f64,
}

impl Default for LidarSettings {
    /// Returns the settings of CARLA's LiDAR (32 channels from -30 to 10 degrees, ten turns a second, attenuation 0.004
    /// /m) on a roof, with 1,800 columns, a range of 100 m and a noise of 2 cm.
    fn default() -> Self {
        Self {
            mount: Mount::above(2.0),
            period: 0.1,
            channels: 32,
            lowest: -30_f64.to_radians(),
            highest: 10_f64.to_radians(),
            columns: 1800,
            range: 100.0,
            noise: 0.02,
            attenuation: 0.004,
            sure: 0.8,
            loss: 0.0,
        }
    }
}

/// The direction of a beam as seen from the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// The azimuth of the beam in radians, counter-clockwise from straight ahead.
    pub azimuth: f64,
    /// The elevation of the beam in radians above the horizon.
    pub elevation: f64,
}

impl Beam {
    /// Returns the unit vector along the beam (x ahead, y to the left, z up).
    pub fn direction(&self) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(self.azimuth);
        let (up, along) = libm::sincos(self.elevation);
        Vector3::new(along * cos, along * sin, up)
    }
}

/// A point that a LiDAR has measured by an echo.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LidarPoint {
    /// The position of the point in metres, as seen from the sensor (x ahead, y to the left, z up).
    pub position: Vector3<f32>,
    /// The strength of the echo, from 0 to 1.
    pub intensity: f32,
    /// The index of the body that gave the echo, plus one; 0 for the ground or an unknown source.
    pub id: u32,
}

/// The points that a LiDAR measures in one turn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scan {
    /// The points of the scan, column by column counter-clockwise from ahead, and from the lowest channel up.
    pub points: Vec<LidarPoint>,
}

impl Scan {
    /// Returns the points in the format of KITTI data sets, with x, y, z and intensity as little-endian 32-bit floats.
    pub fn to_kitti(&self) -> Vec<u8> {
        let numbers = self.points.iter().flat_map(|point| {
            let [x, y, z] = point.position.into();
            [x, y, z, point.intensity]
        });
        numbers.flat_map(f32::to_le_bytes).collect()
    }
}

/// A LiDAR, which measures points around the car.
#[derive(Debug, Clone)]
pub struct Lidar {
    settings: LidarSettings,
    scanner: Scanner,
}

impl Lidar {
    /// Makes a LiDAR with the given settings.
    ///
    /// # Errors
    /// A setting is out of its range or is not a number, or the lowest of several channels is not below the highest.
    pub fn new(settings: LidarSettings) -> Result<Self, SensorError> {
        let checks = Checks("lidar");
        settings.mount.check(&checks)?;
        checks.period(settings.period)?;
        checks.counts("channels", settings.channels, (1, 512))?;
        checks.counts("columns", settings.columns, (1, 36_000))?;
        checks.within("lowest", settings.lowest, (-STEEPEST, STEEPEST), "rad")?;
        checks.within("highest", settings.highest, (-STEEPEST, STEEPEST), "rad")?;
        checks.range(settings.range)?;
        checks.within("noise", settings.noise, (0.0, 100.0), "m")?;
        checks.within("attenuation", settings.attenuation, (0.0, 100.0), "1/m")?;
        checks.within("sure", settings.sure, (0.0, 1.0), "")?;
        checks.within("loss", settings.loss, (0.0, 1.0), "")?;
        let LidarSettings { lowest, highest, channels, .. } = settings;
        if channels > 1 && lowest >= highest {
            return Err(SensorError::EmptyField { sensor: "lidar".to_owned(), lowest, highest });
        }
        let elevations: Vec<f64> = (0..channels).map(|channel| elevation(&settings, channel)).collect();
        Ok(Self { scanner: Scanner::new(settings.columns, &elevations), settings })
    }

    /// Returns the directions of the beams, in the order of the points of a scan.
    pub fn beams(&self) -> impl Iterator<Item = Beam> + use<'_> {
        let azimuth = |column| scanner::azimuth(column, self.settings.columns);
        let column = move |column| {
            let beam = move |channel| Beam { azimuth: azimuth(column), elevation: elevation(&self.settings, channel) };
            (0..self.settings.channels).map(beam)
        };
        (0..self.settings.columns).flat_map(column)
    }

    /// Returns the probability that an echo of this intensity is lost.
    fn loss(&self, intensity: f64) -> f64 {
        let LidarSettings { sure, loss, .. } = self.settings;
        let weak = if intensity < sure { 1.0 - intensity / sure } else { 0.0 };
        1.0 - (1.0 - loss) * (1.0 - weak)
    }
}

/// Returns the elevation of a channel, in radians above the horizon.
fn elevation(settings: &LidarSettings, channel: usize) -> f64 {
    let share = if settings.channels == 1 { 0.5 } else { channel as f64 / (settings.channels - 1) as f64 };
    settings.lowest + share * (settings.highest - settings.lowest)
}

impl Sensor for Lidar {
    type Reading = Scan;

    fn period(&self) -> f64 {
        self.settings.period
    }

    fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Scan) {
        let LidarSettings { mount, range, noise, attenuation, .. } = self.settings;
        let sensor = mount.pose(view.car);
        self.scanner.begin(mount.position.z, range);
        for (index, state) in view.others() {
            self.scanner.add(index as u32 + 1, state, &sensor);
        }
        let fading = attenuation + 2.0 * view.air.extinction;
        reading.points.clear();
        for echo in self.scanner.echoes() {
            // The random numbers are drawn for every beam, so a hit does not change the noise of the other beams.
            let (luck, noise) = (chance.unit(), noise * chance.normal());
            let intensity = libm::exp(-fading * echo.distance);
            if echo.distance <= range && luck >= self.loss(intensity) {
                let position = echo.direction * (echo.distance + noise).max(0.0);
                reading.points.push(LidarPoint { position: position.cast(), intensity: intensity as f32, id: echo.id });
            }
        }
    }
}

/// Returns the unit vector in the plane at an angle.
fn unit(angle: f64) -> Vector2<f64> {
    let (sin, cos) = libm::sincos(angle);
    Vector2::new(cos, sin)
}
