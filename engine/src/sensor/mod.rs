//! Sensors: they measure the world around a car, with the noise and the gaps that sensors have.
//!
//! A [`Sensor`] turns a [`SensorView`], the true state of the world at one moment, into a reading. [`Lidar`],
//! [`Radar`], [`Gnss`], [`Imu`] and [`GroundTruth`] come with the engine; users implement the trait for their own. A
//! [`Rig`] holds the sensors of a car. It lets each sensor measure when its period has passed, and hands readings out
//! after their latency, except for readings that are lost. [`Run::equip`](crate::Run::equip) gives a run a rig.
//!
//! All randomness comes from a [`Chance`] that the rig makes anew for every reading, from its seed, the name of the
//! sensor and the number of the reading. So random numbers change nothing in another sensor, nor in the next reading.
//!
//! ```
//! use paracosm_engine::sensor::{Delivery, Imu, ImuSettings, Radar, RadarSettings, Rig};
//! use paracosm_engine::{AutonomousVehicle, Program, RoadSegment, Run, Scenario, Setup, driver};
//!
//! fn empty_road(s: &mut Scenario) {
//!     let road = s.place(RoadSegment::new(300.0));
//!     s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
//!     s.duration(1.0);
//! }
//!
//! let mut rig = Rig::new(7);
//! let radar = rig.attach("front radar", Radar::new(RadarSettings::default())?, Delivery::after(0.05))?;
//! let imu = rig.attach("imu", Imu::new(ImuSettings::default())?, Delivery::default())?;
//!
//! let program = Program::new("empty-road", "a car alone", empty_road);
//! let test = program.declare()?.nominal();
//! let mut run = Run::new(&program, &test, Setup::asking_every(0.1))?;
//! run.equip(rig);
//! let mut turning = Vec::new();
//! run.watch(driver::find("cruise")?.build(&[])?.as_mut(), |run| {
//!     turning.extend(run.rig().arrived(&imu).iter().map(|sample| sample.reading.yaw_rate));
//! });
//! assert_eq!(turning.len(), 101);
//! assert!(run.rig().latest(&radar).is_some_and(|sweep| sweep.time < 1.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod air;
mod camera;
mod camera_setting;
mod descriptor;
mod drift;
mod error;
mod gnss;
mod imu;
mod lidar;
mod look;
mod mount;
mod radar;
mod rig;
mod sight;
mod truth;

pub use crate::chance::Chance;
pub use air::Air;
pub use camera::{CameraSpec, Cameras, Image, Moment, Shutter, Shutters};
pub use camera_setting::{CORE_CAMERA_SETTINGS, CameraSetting};
pub use descriptor::Descriptor;
pub use drift::Inaccuracy;
pub use error::SensorError;
pub use gnss::{Fix, Gnss, GnssSettings};
pub use imu::{Imu, ImuSettings, Inertia};
pub use lidar::{Beam, Lidar, LidarPoint, LidarSettings, Pinhole, Scan, scan_of_depth};
pub use look::{Look, UnknownLook};
pub use mount::Mount;
pub use radar::{Detection, Radar, RadarSettings};
pub use rig::{Delivery, Handle, Rig, Sample};
pub use truth::{GroundTruth, GroundTruthSettings, TrueBody};

pub(crate) use sight::hides;

use crate::object::BodyState;
use crate::road::RoadNetwork;
use crate::vehicle::VehicleState;
use crate::weather::Weather;

/// The descriptions of all kinds of sensors that come with the engine. Lists show the kinds in this order.
pub const ALL: &[Descriptor] =
    &[camera::DESCRIPTOR, lidar::DESCRIPTOR, radar::DESCRIPTOR, gnss::DESCRIPTOR, imu::DESCRIPTOR, truth::DESCRIPTOR];

/// A sensor, which measures the world around a car or the car itself.
///
/// For example, your own ultrasound sensor in the front bumper measures the nearest body to some centimetres:
///
/// ```
/// use paracosm_engine::sensor::{Chance, Delivery, Rig, Sensor, SensorView};
/// use paracosm_engine::{AutonomousVehicle, Pedestrian, Program, RoadSegment, Run, Scenario, Setup, Side, driver};
///
/// struct Bumper {
///     range: f64,
///     noise: f64,
/// }
///
/// impl Sensor for Bumper {
///     type Reading = Option<f64>;
///
///     fn period(&self) -> f64 {
///         0.05
///     }
///
///     fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Option<f64>) {
///         let car = view.car.pose();
///         let front = car.position + 2.2 * car.forward();
///         let distances = view.others().map(|(_, body)| (body.pose.position - front).norm());
///         let nearest = distances.fold(self.range, f64::min);
///         // It draws one number whether or not it hears a body, and only from the given source.
///         let error = self.noise * chance.normal();
///         *reading = (nearest < self.range).then_some(nearest + error);
///     }
/// }
///
/// fn somebody_waits(s: &mut Scenario) {
///     let road = s.place(RoadSegment::new(300.0));
///     s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
///     s.place(Pedestrian::at(road.on_sidewalk(Side::Right, 40.0)));
///     s.duration(3.0);
/// }
///
/// let mut rig = Rig::new(7);
/// let bumper = rig.attach("bumper", Bumper { range: 8.0, noise: 0.02 }, Delivery::after(0.01))?;
/// let program = Program::new("somebody-waits", "a car passes somebody", somebody_waits);
/// let test = program.declare()?.nominal();
/// let mut run = Run::new(&program, &test, Setup::asking_every(0.1))?;
/// run.equip(rig);
/// let mut heard = Vec::new();
/// run.watch(driver::find("cruise")?.build(&[])?.as_mut(), |run| {
///     heard.extend(run.rig().arrived(&bumper).iter().map(|sample| sample.reading));
/// });
/// let near = heard.iter().flatten().copied().fold(f64::INFINITY, f64::min);
/// assert!(heard[0].is_none() && (1.0..8.0).contains(&near), "{near} m");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Sensor: Send + 'static {
    /// The type of the sensor's measurement at one moment. A rig reuses values of this type.
    type Reading: Default + Send + 'static;

    /// Returns the seconds between two readings.
    fn period(&self) -> f64;

    /// Resets the sensor's memory, because a new run begins.
    fn reset(&mut self) {}

    /// Measures the world and writes the result to `reading`, over the values of an earlier reading. All noise is drawn
    /// from `chance`.
    fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Self::Reading);
}

/// The true state of the world at one moment, as far as sensors can measure it.
#[derive(Debug, Clone, Copy)]
pub struct SensorView<'a> {
    /// The seconds since the run began.
    pub time: f64,
    /// The state of the car that carries the sensor.
    pub car: &'a VehicleState,
    /// The states of all bodies in the world, with the car's body first.
    pub bodies: &'a [BodyState],
    /// The states of the same bodies at the previous tick.
    pub before: &'a [BodyState],
    /// The seconds since the previous tick.
    pub dt: f64,
    /// The road network of the world.
    pub network: &'a RoadNetwork,
    /// The weather, which is light, fog, rain and the position of the sun.
    pub weather: Weather,
    /// The effect of the weather on light, which [`Air::of`] computes.
    pub air: Air,
}

impl<'a> SensorView<'a> {
    /// Returns the bodies that are present in the world, without the car, each with its index among all bodies.
    pub fn others(&self) -> impl Iterator<Item = (usize, &'a BodyState)> + use<'a> {
        self.bodies.iter().enumerate().skip(1).filter(|(_, body)| body.present)
    }
}

#[cfg(test)]
mod tests;
