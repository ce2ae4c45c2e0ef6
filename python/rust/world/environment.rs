//! Light, fog, rain, the sun, and the friction of the roads.

use super::building::Building;
use super::handle::Handle;
use super::recipe::Quantity;
use super::stream::Stream;
use paracosm::engine::{self, Place};
use pyo3::prelude::*;

/// The conditions of a world: light (0 to 1), fog (0 to 1), rain (0 to 1), the elevation and the azimuth of the sun in radians, and the friction
/// coefficient of dry roads. Each is a number or a stream. Without any: broad daylight, no fog, no rain, dry asphalt.
#[pyclass(frozen, module = "paracosm")]
pub struct Environment {
    light: Option<Quantity>,
    fog: Option<Quantity>,
    rain: Option<Quantity>,
    sun: Option<(Quantity, Quantity)>,
    friction: Option<Quantity>,
}

#[pymethods]
impl Environment {
    #[new]
    #[pyo3(signature = (*, light = None, fog = None, rain = None, sun = None, friction = None))]
    fn new(
        light: Option<&Bound<PyAny>>,
        fog: Option<&Bound<PyAny>>,
        rain: Option<&Bound<PyAny>>,
        sun: Option<(Bound<PyAny>, Bound<PyAny>)>,
        friction: Option<&Bound<PyAny>>,
    ) -> PyResult<Self> {
        let read = |found: Option<&Bound<PyAny>>, place| found.map(|found| Quantity::of(found, place)).transpose();
        let sun = sun.map(|(elevation, azimuth)| {
            PyResult::Ok((Quantity::of(&elevation, "sun")?, Quantity::of(&azimuth, "sun")?))
        });
        Ok(Self {
            light: read(light, "light")?,
            fog: read(fog, "fog")?,
            rain: read(rain, "rain")?,
            sun: sun.transpose()?,
            friction: read(friction, "friction")?,
        })
    }
}

impl Environment {
    /// Places the conditions in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake, or a stream belongs to another scenario.
    pub fn place(&self, building: &Building) -> PyResult<Conditions> {
        let mut inner = engine::Environment::new();
        if let Some(light) = &self.light {
            inner = inner.light(light.stream()?);
        }
        if let Some(fog) = &self.fog {
            inner = inner.fog(fog.stream()?);
        }
        if let Some(rain) = &self.rain {
            inner = inner.rain(rain.stream()?);
        }
        if let Some((elevation, azimuth)) = &self.sun {
            inner = inner.sun(elevation.stream()?, azimuth.stream()?);
        }
        if let Some(friction) = &self.friction {
            inner = inner.friction(friction.stream()?);
        }
        Ok(Conditions(Handle::new(building, building.with(|scenario| inner.place(scenario))?)))
    }
}

/// The conditions in the world, as streams.
#[pyclass(frozen, module = "paracosm")]
pub struct Conditions(Handle<engine::Conditions>);

#[pymethods]
impl Conditions {
    /// The amount of daylight, from 0 to 1.
    #[getter]
    fn light(&self) -> PyResult<Stream> {
        self.0.stream(|conditions| conditions.light.clone())
    }

    /// The density of the fog, from 0 to 1.
    #[getter]
    fn fog(&self) -> PyResult<Stream> {
        self.0.stream(|conditions| conditions.fog.clone())
    }

    /// The strength of the rain, from 0 to 1.
    #[getter]
    fn rain(&self) -> PyResult<Stream> {
        self.0.stream(|conditions| conditions.rain.clone())
    }

    /// The friction coefficient between tyre and road, reduced by the rain.
    #[getter]
    fn friction(&self) -> PyResult<Stream> {
        self.0.stream(|conditions| conditions.friction.clone())
    }
}
