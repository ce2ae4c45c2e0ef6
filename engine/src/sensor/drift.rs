//! How measured quantities are off: by noise of each reading, and by a bias that walks at random.

use super::Chance;
use super::error::{Checks, SensorError};
use nalgebra::SVector;

/// How far off a measured quantity is: standard deviations in its unit, of each of its coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inaccuracy {
    /// Of every reading by itself.
    pub noise: f64,
    /// Of the bias with which a run begins.
    pub bias: f64,
    /// Of how the bias changes within one second; within t seconds it is √t times that.
    pub walk: f64,
}

impl Inaccuracy {
    /// As it truly is.
    pub const NONE: Inaccuracy = Inaccuracy { noise: 0.0, bias: 0.0, walk: 0.0 };

    pub(super) fn check(&self, checks: &Checks, what: &str, unit: &'static str) -> Result<(), SensorError> {
        for (part, value) in [("noise", self.noise), ("bias", self.bias), ("walk", self.walk)] {
            checks.within(&format!("{what}.{part}"), value, (0.0, 1000.0), unit)?;
        }
        Ok(())
    }
}

/// The bias of N coordinates as it walks.
#[derive(Debug, Clone)]
pub(super) struct Drift<const N: usize> {
    inaccuracy: Inaccuracy,
    /// The bias, and since when; none before the first reading.
    now: Option<(SVector<f64, N>, f64)>,
}

impl<const N: usize> Drift<N> {
    pub fn new(inaccuracy: Inaccuracy) -> Self {
        Self { inaccuracy, now: None }
    }

    /// What is measured at a time, in seconds, of something that truly is so.
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

    /// Begins anew.
    pub fn reset(&mut self) {
        self.now = None;
    }
}

/// Independent standard normal numbers.
fn normal<const N: usize>(chance: &mut Chance) -> SVector<f64, N> {
    SVector::from_fn(|_, _| chance.normal())
}
