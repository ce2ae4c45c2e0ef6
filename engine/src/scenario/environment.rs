//! What holds for the whole world: light, fog, and how slippery the roads are (the paper's `World`).

use super::{Place, Scenario};
use crate::stream::Stream;

/// Friction coefficient of dry asphalt.
const DRY_ASPHALT: f64 = 0.8;

/// The conditions of a world, not placed yet: broad daylight, no fog, dry asphalt.
#[derive(Debug, Clone)]
pub struct Environment {
    light: Stream<f64>,
    fog: Stream<f64>,
    friction: Option<Stream<f64>>,
}

/// The conditions as streams that anything can read.
#[derive(Debug, Clone)]
pub struct Conditions {
    /// From 0, night, to 1, broad daylight.
    pub light: Stream<f64>,
    /// From 0, none, to 1, so thick that nothing is seen.
    pub fog: Stream<f64>,
    /// The friction coefficient between tyre and road.
    pub friction: Stream<f64>,
}

impl Environment {
    /// Broad daylight, no fog, dry asphalt.
    #[expect(clippy::new_without_default, reason = "as every other object it is made by its name")]
    pub fn new() -> Self {
        Self { light: Stream::constant(1.0), fog: Stream::constant(0.0), friction: None }
    }

    /// From 0, night, to 1, broad daylight.
    pub fn light(mut self, light: impl Into<Stream<f64>>) -> Self {
        self.light = light.into();
        self
    }

    /// From 0, none, to 1, so thick that nothing is seen.
    pub fn fog(mut self, fog: impl Into<Stream<f64>>) -> Self {
        self.fog = fog.into();
        self
    }

    /// The friction coefficient between tyre and road.
    pub fn friction(mut self, friction: impl Into<Stream<f64>>) -> Self {
        self.friction = Some(friction.into());
        self
    }
}

impl Default for Conditions {
    fn default() -> Self {
        let Environment { light, fog, .. } = Environment::new();
        Self { light, fog, friction: Stream::constant(DRY_ASPHALT) }
    }
}

impl Place for Environment {
    type Handle = Conditions;

    fn place(self, scenario: &mut Scenario) -> Conditions {
        if let Some(friction) = self.friction {
            scenario.say_friction(friction);
        }
        scenario.say_weather(self.light, self.fog);
        scenario.conditions.clone()
    }
}
