//! The sensors of a driver, as the driver describes them and as a run carries them.

use super::{Fix, Image as WireImage, Inertia, Scan, Step, Welcome};
use nalgebra::Vector3;
use paracosm_engine::driver::{Equipment, Fault, FaultKind};
use paracosm_engine::sensor::{
    CameraSpec, Cameras, Delivery, Gnss, GnssSettings, Handle, Image, Imu, ImuSettings, Inaccuracy, Lidar,
    LidarSettings, Look, Mount, Rig, Sample, Sensor, SensorError, UnknownLook,
};

/// The description that a driver gives of itself in its welcome.
pub struct Described {
    pub name: String,
    pub period: f64,
    pub others: bool,
    seed: u64,
    cameras: Cameras,
    lidars: Vec<Fitting<Lidar>>,
    gnss: Vec<Fitting<Gnss>>,
    imus: Vec<Fitting<Imu>>,
}

/// A sensor that is ready to be attached, and its handle once it is attached.
struct Fitting<S> {
    name: String,
    sensor: S,
    delivery: Delivery,
    handle: Option<Handle<S>>,
}

impl Described {
    /// Reads the driver's welcome and checks its period and its sensors.
    pub fn new(welcome: Welcome, seed: u64) -> Result<Self, Fault> {
        let Welcome { name, period, others, .. } = welcome;
        if !(period > 0.0 && period.is_finite()) {
            return Err(Fault::of(
                FaultKind::Equipment,
                format!("the driver's period is {period} s, expected a finite number above 0"),
            ));
        }
        let look = match welcome.look.as_str() {
            "" => Look::default(),
            name => name.parse().map_err(|flaw: UnknownLook| Fault::of(FaultKind::Equipment, flaw.to_string()))?,
        };
        let mut cameras = Cameras { seed, look, ..Cameras::default() };
        for camera in &welcome.cameras {
            if cameras.all.insert(camera.name.clone(), camera.into()).is_some() {
                return Err(Fault::of(
                    FaultKind::Equipment,
                    format!("two of the driver's cameras are called `{}`; give each camera its own name", camera.name),
                ));
            }
        }
        let sensor = |error: SensorError| {
            Fault::of(FaultKind::Equipment, format!("the driver asks for an impossible sensor: {error}"))
        };
        let lidars = welcome.lidars.iter().map(|lidar| {
            let made = Lidar::new(lidar.into())?;
            Ok(Fitting::new(&lidar.name, made, lidar.delivery.as_ref()))
        });
        let gnss = welcome.gnss.iter().map(|gnss| {
            let made = Gnss::new(gnss.into())?;
            Ok(Fitting::new(&gnss.name, made, gnss.delivery.as_ref()))
        });
        let imus = welcome.imus.iter().map(|imu| {
            let made = Imu::new(imu.into())?;
            Ok(Fitting::new(&imu.name, made, imu.delivery.as_ref()))
        });
        let mut described = Self {
            name,
            period,
            others,
            seed,
            cameras,
            lidars: lidars.collect::<Result<_, _>>().map_err(sensor)?,
            gnss: gnss.collect::<Result<_, _>>().map_err(sensor)?,
            imus: imus.collect::<Result<_, _>>().map_err(sensor)?,
        };
        described.rig().map_err(sensor)?;
        Ok(described)
    }

    /// Makes the driver's equipment anew for a run.
    pub fn equipment(&mut self) -> Equipment {
        Equipment { rig: self.rig().expect("it was made before"), cameras: self.cameras.clone() }
    }

    fn rig(&mut self) -> Result<Rig, SensorError> {
        let mut rig = Rig::new(self.seed);
        self.lidars.iter_mut().try_for_each(|fitting| fitting.attach(&mut rig))?;
        self.gnss.iter_mut().try_for_each(|fitting| fitting.attach(&mut rig))?;
        self.imus.iter_mut().try_for_each(|fitting| fitting.attach(&mut rig))?;
        Ok(rig)
    }

    /// Adds the images and readings that have arrived to the next step.
    pub fn write(&self, rig: &Rig, images: &[Image], step: &mut Step) {
        let names: Vec<&String> = self.cameras.all.keys().collect();
        step.images.extend(images.iter().map(|image| WireImage {
            camera: names[image.camera].clone(),
            number: image.number,
            time: image.time,
            width: image.width,
            height: image.height,
            rgb: image.rgb.clone().into(),
        }));
        for (sensor, Sample { number, time, reading }) in arrived(&self.lidars, rig) {
            step.scans.push(Scan { sensor, number: *number, time: *time, points: reading.to_kitti().into() });
        }
        for (sensor, Sample { number, time, reading }) in arrived(&self.gnss, rig) {
            let fix = Fix { sensor, number: *number, time: *time, valid: reading.is_some(), ..Fix::default() };
            step.fixes.push(reading.map_or(fix.clone(), |reading| Fix {
                x: reading.position.x,
                y: reading.position.y,
                velocity_x: reading.velocity.x,
                velocity_y: reading.velocity.y,
                ..fix
            }));
        }
        for (sensor, Sample { number, time, reading }) in arrived(&self.imus, rig) {
            step.inertia.push(Inertia {
                sensor,
                number: *number,
                time: *time,
                acceleration_x: reading.acceleration.x,
                acceleration_y: reading.acceleration.y,
                yaw_rate: reading.yaw_rate,
            });
        }
    }
}

/// Returns the readings that have arrived from sensors of one kind, each with the name of its sensor.
fn arrived<'a, S: Sensor>(
    fittings: &'a [Fitting<S>],
    rig: &'a Rig,
) -> impl Iterator<Item = (String, &'a Sample<S::Reading>)> {
    fittings.iter().flat_map(move |fitting| {
        let samples = fitting.handle.as_ref().map_or(&[][..], |handle| rig.arrived(handle));
        samples.iter().map(|sample| (fitting.name.clone(), sample))
    })
}

impl<S: Sensor + Clone> Fitting<S> {
    fn new(name: &str, sensor: S, delivery: Option<&super::Delivery>) -> Self {
        let delivery = delivery
            .map_or_else(Delivery::default, |delivery| Delivery { latency: delivery.latency, loss: delivery.loss });
        Self { name: name.to_owned(), sensor, delivery, handle: None }
    }

    fn attach(&mut self, rig: &mut Rig) -> Result<(), SensorError> {
        self.handle = Some(rig.attach(&self.name, self.sensor.clone(), self.delivery)?);
        Ok(())
    }
}

impl From<&super::Camera> for CameraSpec {
    fn from(camera: &super::Camera) -> Self {
        let mut spec = Self {
            resolution: [camera.width, camera.height],
            focal_mm: camera.focal_mm,
            sensor_mm: camera.sensor_mm,
            position: [camera.x, camera.y, camera.z],
            yaw_pitch_roll: [camera.yaw_degrees, camera.pitch_degrees, camera.roll_degrees],
            rate: camera.rate,
            latency: camera.latency,
            dropped: camera.dropped,
            ..Self::default()
        };
        // A field that is 0 was not set.
        let said = OF_LENS.iter().map(|(name, of, _)| (*name, of(camera))).filter(|(_, value)| *value != 0.0);
        said.for_each(|(name, value)| spec.lens.set(name, value));
        camera.lens.iter().for_each(|(name, value)| spec.lens.set(name.as_str(), *value));
        spec
    }
}

impl From<(&String, &CameraSpec)> for super::Camera {
    fn from((name, spec): (&String, &CameraSpec)) -> Self {
        let [x, y, z] = spec.position;
        let [yaw_degrees, pitch_degrees, roll_degrees] = spec.yaw_pitch_roll;
        let mut camera = Self {
            name: name.clone(),
            width: spec.resolution[0],
            height: spec.resolution[1],
            focal_mm: spec.focal_mm,
            sensor_mm: spec.sensor_mm,
            x,
            y,
            z,
            yaw_degrees,
            pitch_degrees,
            roll_degrees,
            rate: spec.rate,
            latency: spec.latency,
            dropped: spec.dropped,
            ..Self::default()
        };
        for (name, value) in spec.lens.iter() {
            match OF_LENS.iter().find(|(own, ..)| *own == name) {
                Some((_, _, at)) => *at(&mut camera) = *value,
                None => {
                    camera.lens.insert(name.to_owned(), *value);
                }
            }
        }
        camera
    }
}

/// The name of a lens setting, the function that reads its field, and the function that gives access to write it.
type Field = (&'static str, fn(&super::Camera) -> f64, fn(&mut super::Camera) -> &mut f64);

/// The lens settings that have their own field in the protocol. They are older than the protocol's map of lens
/// settings.
const OF_LENS: [Field; 8] = [
    ("motion", |camera| camera.motion, |camera| &mut camera.motion),
    ("motion_angle", |camera| camera.motion_angle_degrees, |camera| &mut camera.motion_angle_degrees),
    ("defocus", |camera| camera.defocus, |camera| &mut camera.defocus),
    ("blur", |camera| camera.blur, |camera| &mut camera.blur),
    ("vignetting", |camera| camera.vignetting, |camera| &mut camera.vignetting),
    ("exposure", |camera| camera.exposure, |camera| &mut camera.exposure),
    ("full_well", |camera| camera.full_well, |camera| &mut camera.full_well),
    ("read_noise", |camera| camera.read_noise, |camera| &mut camera.read_noise),
];

fn mount(described: Option<&super::Mount>, usual: Mount) -> Mount {
    described.map_or(usual, |at| Mount { position: Vector3::new(at.x, at.y, at.z), heading: at.heading })
}

fn inaccuracy(described: Option<&super::Inaccuracy>, usual: Inaccuracy) -> Inaccuracy {
    described.map_or(usual, |off| Inaccuracy { noise: off.noise, bias: off.bias, walk: off.walk })
}

impl From<&super::Lidar> for LidarSettings {
    fn from(lidar: &super::Lidar) -> Self {
        let usual = Self::default();
        let count = |described: Option<u32>, usual| described.map_or(usual, |count| count as usize);
        Self {
            mount: mount(lidar.mount.as_ref(), usual.mount),
            period: lidar.period.unwrap_or(usual.period),
            channels: count(lidar.channels, usual.channels),
            lowest: lidar.lowest.unwrap_or(usual.lowest),
            highest: lidar.highest.unwrap_or(usual.highest),
            columns: count(lidar.columns, usual.columns),
            range: lidar.range.unwrap_or(usual.range),
            noise: lidar.noise.unwrap_or(usual.noise),
            attenuation: lidar.attenuation.unwrap_or(usual.attenuation),
            sure: lidar.sure.unwrap_or(usual.sure),
            loss: lidar.loss.unwrap_or(usual.loss),
        }
    }
}

impl From<&super::Gnss> for GnssSettings {
    fn from(gnss: &super::Gnss) -> Self {
        let usual = Self::default();
        Self {
            mount: mount(gnss.mount.as_ref(), usual.mount),
            period: gnss.period.unwrap_or(usual.period),
            position: inaccuracy(gnss.position.as_ref(), usual.position),
            velocity_noise: gnss.velocity_noise.unwrap_or(usual.velocity_noise),
            outages: gnss.outages.unwrap_or(usual.outages),
            outage_duration: gnss.outage_duration.unwrap_or(usual.outage_duration),
        }
    }
}

impl From<&super::Imu> for ImuSettings {
    fn from(imu: &super::Imu) -> Self {
        let usual = Self::default();
        Self {
            period: imu.period.unwrap_or(usual.period),
            acceleration: inaccuracy(imu.acceleration.as_ref(), usual.acceleration),
            yaw_rate: inaccuracy(imu.yaw_rate.as_ref(), usual.yaw_rate),
        }
    }
}
