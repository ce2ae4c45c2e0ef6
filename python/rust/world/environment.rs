//! Light, fog, rain, the sun, and the friction of the roads.

use super::building::Building;
use super::operand::Operand;
use super::stream::Stream;
use paracosm::engine::{self, Place};
use pyo3::prelude::*;

/// The conditions of a world: light (0 to 1), fog (0 to 1), rain (0 to 1), the elevation and the azimuth of the sun in radians, and the friction
/// coefficient of dry roads. Each is a number or a stream. Without any: broad daylight, no fog, no rain, dry asphalt.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Environment {
    inner: engine::Environment,
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
        let mut inner = engine::Environment::new();
        if let Some(light) = light {
            inner = inner.light(Operand::numbers(light, "light")?);
        }
        if let Some(fog) = fog {
            inner = inner.fog(Operand::numbers(fog, "fog")?);
        }
        if let Some(rain) = rain {
            inner = inner.rain(Operand::numbers(rain, "rain")?);
        }
        if let Some((elevation, azimuth)) = sun {
            inner = inner.sun(Operand::numbers(&elevation, "sun")?, Operand::numbers(&azimuth, "sun")?);
        }
        if let Some(friction) = friction {
            inner = inner.friction(Operand::numbers(friction, "friction")?);
        }
        Ok(Self { inner })
    }
}

impl Environment {
    /// Places the conditions in a scenario.
    ///
    /// # Errors
    /// The scenario has noted a mistake.
    pub fn place(&self, building: &Building) -> PyResult<Conditions> {
        let inner = building.with(|scenario| self.inner.clone().place(scenario))?;
        Ok(Conditions { building: building.clone(), inner })
    }
}

/// The conditions in the world, as streams.
#[pyclass(frozen, unsendable, module = "paracosm")]
pub struct Conditions {
    building: Building,
    inner: engine::Conditions,
}

#[pymethods]
impl Conditions {
    /// The amount of daylight, from 0 to 1.
    #[getter]
    fn light(&self) -> Stream {
        Stream::of(&self.building, self.inner.light.clone())
    }

    /// The density of the fog, from 0 to 1.
    #[getter]
    fn fog(&self) -> Stream {
        Stream::of(&self.building, self.inner.fog.clone())
    }

    /// The strength of the rain, from 0 to 1.
    #[getter]
    fn rain(&self) -> Stream {
        Stream::of(&self.building, self.inner.rain.clone())
    }

    /// The friction coefficient between tyre and road, reduced by the rain.
    #[getter]
    fn friction(&self) -> Stream {
        Stream::of(&self.building, self.inner.friction.clone())
    }
}
