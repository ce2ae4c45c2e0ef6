//! The period and the sensors of a Python driver, as a message of the protocol.

use crate::error::raised;
use paracosm::rpc::message;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Reads what a driver says of itself.
///
/// # Errors
/// An entry has another type.
pub fn welcome(described: &Bound<PyDict>) -> PyResult<message::Welcome> {
    let entry = |name: &str| described.get_item(name)?.ok_or_else(|| raised(format!("the driver says no `{name}`")));
    let all = |name: &str| -> PyResult<Vec<Entries>> {
        entry(name)?.try_iter()?.map(|one| Ok(Entries(one?.cast_into::<PyDict>()?))).collect()
    };
    Ok(message::Welcome {
        protocol: 1,
        name: String::new(),
        period: entry("period")?.extract()?,
        others: entry("others")?.extract()?,
        cameras: all("cameras")?.iter().map(Entries::camera).collect::<PyResult<_>>()?,
        lidars: all("lidars")?.iter().map(Entries::lidar).collect::<PyResult<_>>()?,
        gnss: all("gnss")?.iter().map(Entries::gnss).collect::<PyResult<_>>()?,
        imus: all("imus")?.iter().map(Entries::imu).collect::<PyResult<_>>()?,
        look: entry("look")?.extract()?,
    })
}

/// The entries of a sensor by their names. A missing entry has the default of the protocol.
struct Entries<'py>(Bound<'py, PyDict>);

impl<'py> Entries<'py> {
    fn of<T>(&self, name: &str) -> PyResult<Option<T>>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        let Some(value) = self.0.get_item(name)? else { return Ok(None) };
        let read = value.extract::<T>().map(Some);
        read.map_err(|error| {
            let why: PyErr = error.into();
            let sensor = self.0.get_item("name").ok().flatten().map(|name| name.to_string()).unwrap_or_default();
            raised(format!("the sensor `{sensor}`: {name}: {}", why.value(value.py())))
        })
    }

    fn part(&self, name: &str) -> PyResult<Option<Self>> {
        Ok(self.of::<Bound<PyDict>>(name)?.map(Self))
    }

    fn camera(&self) -> PyResult<message::Camera> {
        Ok(message::Camera {
            name: self.of("name")?.unwrap_or_default(),
            width: self.of("width")?.unwrap_or_default(),
            height: self.of("height")?.unwrap_or_default(),
            focal_mm: self.of("focal_mm")?.unwrap_or_default(),
            sensor_mm: self.of("sensor_mm")?.unwrap_or_default(),
            x: self.of("x")?.unwrap_or_default(),
            y: self.of("y")?.unwrap_or_default(),
            z: self.of("z")?.unwrap_or_default(),
            yaw_degrees: self.of("yaw_degrees")?.unwrap_or_default(),
            pitch_degrees: self.of("pitch_degrees")?.unwrap_or_default(),
            roll_degrees: self.of("roll_degrees")?.unwrap_or_default(),
            rate: self.of("rate")?.unwrap_or_default(),
            latency: self.of("latency")?.unwrap_or_default(),
            dropped: self.of("dropped")?.unwrap_or_default(),
            motion: self.of("motion")?.unwrap_or_default(),
            motion_angle_degrees: self.of("motion_angle_degrees")?.unwrap_or_default(),
            defocus: self.of("defocus")?.unwrap_or_default(),
            blur: self.of("blur")?.unwrap_or_default(),
            vignetting: self.of("vignetting")?.unwrap_or_default(),
            exposure: self.of("exposure")?.unwrap_or_default(),
            full_well: self.of("full_well")?.unwrap_or_default(),
            read_noise: self.of("read_noise")?.unwrap_or_default(),
            lens: self.of("lens")?.unwrap_or_default(),
        })
    }

    fn lidar(&self) -> PyResult<message::Lidar> {
        Ok(message::Lidar {
            name: self.of("name")?.unwrap_or_default(),
            delivery: self.part("delivery")?.map(|part| part.delivery()).transpose()?,
            mount: self.part("mount")?.map(|part| part.mount()).transpose()?,
            period: self.of("period")?,
            channels: self.of("channels")?,
            lowest: self.of("lowest")?,
            highest: self.of("highest")?,
            columns: self.of("columns")?,
            range: self.of("range")?,
            noise: self.of("noise")?,
            attenuation: self.of("attenuation")?,
            sure: self.of("sure")?,
            loss: self.of("loss")?,
        })
    }

    fn gnss(&self) -> PyResult<message::Gnss> {
        Ok(message::Gnss {
            name: self.of("name")?.unwrap_or_default(),
            delivery: self.part("delivery")?.map(|part| part.delivery()).transpose()?,
            mount: self.part("mount")?.map(|part| part.mount()).transpose()?,
            period: self.of("period")?,
            position: self.part("position")?.map(|part| part.inaccuracy()).transpose()?,
            velocity_noise: self.of("velocity_noise")?,
            outages: self.of("outages")?,
            outage_duration: self.of("outage_duration")?,
        })
    }

    fn imu(&self) -> PyResult<message::Imu> {
        Ok(message::Imu {
            name: self.of("name")?.unwrap_or_default(),
            delivery: self.part("delivery")?.map(|part| part.delivery()).transpose()?,
            period: self.of("period")?,
            acceleration: self.part("acceleration")?.map(|part| part.inaccuracy()).transpose()?,
            yaw_rate: self.part("yaw_rate")?.map(|part| part.inaccuracy()).transpose()?,
        })
    }

    fn mount(&self) -> PyResult<message::Mount> {
        Ok(message::Mount {
            x: self.of("x")?.unwrap_or_default(),
            y: self.of("y")?.unwrap_or_default(),
            z: self.of("z")?.unwrap_or_default(),
            heading: self.of("heading")?.unwrap_or_default(),
        })
    }

    fn delivery(&self) -> PyResult<message::Delivery> {
        Ok(message::Delivery {
            latency: self.of("latency")?.unwrap_or_default(),
            loss: self.of("loss")?.unwrap_or_default(),
        })
    }

    fn inaccuracy(&self) -> PyResult<message::Inaccuracy> {
        Ok(message::Inaccuracy {
            noise: self.of("noise")?.unwrap_or_default(),
            bias: self.of("bias")?.unwrap_or_default(),
            walk: self.of("walk")?.unwrap_or_default(),
        })
    }
}
