//! The errors of measured quantities: noise of each reading, and a bias that walks at random.

use super::Chance;
use super::error::{Checks, SensorError};
use nalgebra::SVector;

/// The inaccuracy of a measured quantity, as standard deviations of each coordinate in the quantity's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inaccuracy {
    /// The standard deviation of the noise of each reading.
    pub noise: f64,
    /// The standard deviation of the bias at the start of a run.
    pub bias: f64,
    /// The standard deviation of the change of the bias within one second; within t seconds it is √t times as large.
    pub walk: f64,
}

impl Inaccuracy {
    /// The inaccuracy of a perfect measurement, whose readings are true.
    pub const NONE: Inaccuracy = Inaccuracy { noise: 0.0, bias: 0.0, walk: 0.0 };

    pub(super) fn check(&self, checks: &Checks, what: &str, unit: &'static str) -> Result<(), SensorError> {
        for (part, value) in [("noise", self.noise), ("bias", self.bias), ("walk", self.walk)] {
            checks.within(&format!("{what}.{part}"), value, (0.0, 1000.0), unit)?;
        }
        Ok(())
    }
}

/// The bias of a quantity with N coordinates, which walks at random.
#[derive(Debug, Clone)]
pub(super) struct Drift<const N: usize> {
    inaccuracy: Inaccuracy,
    /// The present bias and its time; `None` before the first reading.
    now: Option<(SVector<f64, N>, f64)>,
}

impl<const N: usize> Drift<N> {
    pub fn new(inaccuracy: Inaccuracy) -> Self {
        Self { inaccuracy, now: None }
    }

    /// Returns the measured value for a true value at a time in seconds.
    pub fn measured(&mut self, truth: SVector<f64, N>, time: f64, chance: &mut Chance) -> SVector<f64, N> {
        let Inaccuracy { noise, bias, walk } = self.inaccuracy;
        let step = normal(chance);
        let bias = match self.now {
            None => step * bias,
            Some((now, since)) => now + step * (walk * (time - since).max(0.0).sqrt()),
        };
        self.now = Some((bias, time));
        truth + bias + normal(chance) * noise
    }

    /// Forgets the bias, because a new run begins.
    pub fn reset(&mut self) {
        self.now = None;
    }
}

/// Returns independent standard normal numbers.
fn normal<const N: usize>(chance: &mut Chance) -> SVector<f64, N> {
    SVector::from_fn(|_, _| chance.normal())
}
