//! Functions that are drawn at random: a narrow failure, and basins beside it that lead nowhere.
//!
//! A search that was made for ten functions is good at ten functions. The functions of this family differ in all that
//! makes failures hard to find: the number of parameters, the shape and rotation of the failure, the number, depth and
//! width of the decoys, plateaus, noise, errors and words. The number of a function decides its kind, and the seed
//! decides where everything lies. The functions 0 to 199 have served to choose searches; report results on others.

use super::distance_between;
use crate::seeded::mix;
use nalgebra::{DMatrix, DVector};
use paracosm_space::Point;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::fmt;

/// The properties of a random function that its number decides.
#[derive(Debug, Clone)]
pub(super) struct Kind {
    pub(super) dims: usize,
    pub(super) words: Vec<usize>,
    decoys: usize,
    /// The volume of the failure. Part of it may lie outside the cube.
    share: f64,
    /// The slope around the failure, compared with the slope around the decoys.
    slope: f64,
    /// Basins are cones if `false` and paraboloids if `true`.
    smooth: bool,
    /// The height of a step of a function with plateaus.
    step: Option<f64>,
    /// The greatest relative error of a function with noise.
    noise: f64,
    /// The distance of the failure from the tests in error, if there are any.
    errors: Option<f64>,
    scale: f64,
}

impl Kind {
    pub(super) fn new(number: u64) -> Self {
        let mut rng = random(number, 0);
        let mut quarter = || rng.random_range(0..4) == 0;
        let [steps, noisy, errors, worded] = [quarter(), quarter(), quarter(), quarter()];
        let words = if worded { rng.random_range(1..=2) } else { 0 };
        Self {
            dims: rng.random_range(3..=8),
            words: (0..words).map(|_| rng.random_range(2..=4)).collect(),
            decoys: rng.random_range(1..=4),
            share: libm::pow(10.0, rng.random_range(-3.3..-2.3)),
            slope: rng.random_range(0.75..2.0),
            smooth: rng.random(),
            step: steps.then(|| rng.random_range(0.03..0.12)),
            noise: if noisy { rng.random_range(0.02..0.1) } else { 0.0 },
            errors: errors.then(|| rng.random_range(0.25..0.5)),
            scale: libm::pow(10.0, rng.random_range(-1.0..2.0)),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { dims, decoys, .. } = self;
        let shape = if self.smooth { "paraboloids" } else { "cones" };
        let decoy = if *decoys == 1 { "a decoy" } else { "decoys" };
        write!(f, "{shape} in {dims} dimensions, {decoys} of them {decoy}")?;
        let also = [
            (self.step.is_some(), "plateaus"),
            (self.noise > 0.0, "noise"),
            (self.errors.is_some(), "errors"),
            (!self.words.is_empty(), "words"),
        ];
        also.into_iter().filter(|also| also.0).try_for_each(|also| write!(f, ", with {}", also.1))
    }
}

/// A random function whose failure and decoys lie at fixed places.
#[derive(Debug, Clone)]
pub(super) struct Landscape {
    kind: Kind,
    failure: Basin,
    decoys: Vec<Basin>,
    /// The direction of the tests in error from the failure.
    errors: DVector<f64>,
    seed: u64,
}

/// A place towards which the robustness falls.
#[derive(Debug, Clone)]
struct Basin {
    at: Vec<f64>,
    words: Vec<usize>,
    /// Maps differences from the place to a space in which the basin is round.
    shape: DMatrix<f64>,
    /// The robustness at the place of a decoy.
    floor: f64,
    slope: f64,
    /// The increase of the robustness for each wrong word.
    penalty: f64,
}

impl Landscape {
    pub(super) fn new(number: u64, seed: u64) -> Self {
        let kind = Kind::new(number);
        let mut rng = random(number, seed.wrapping_add(1));
        let basin = |rng: &mut Pcg64, floor, slope| Basin {
            at: (0..kind.dims).map(|_| rng.random_range(0.1..0.9)).collect(),
            words: kind.words.iter().map(|&levels| rng.random_range(0..levels)).collect(),
            shape: shape(kind.dims, rng),
            floor,
            slope,
            penalty: rng.random_range(0.1..0.3),
        };
        let failure = basin(&mut rng, -radius(kind.dims, kind.share) * kind.slope, kind.slope);
        let mut decoys = Vec::new();
        while decoys.len() < kind.decoys {
            let (floor, slope) = (rng.random_range(0.02..0.15), rng.random_range(0.5..1.0));
            let decoy = basin(&mut rng, floor, slope);
            if distance_between(&decoy.at, &failure.at) > 0.3 {
                decoys.push(decoy);
            }
        }
        let errors = DVector::from_fn(kind.dims, |_, _| crate::adaptive::normal(&mut rng)).normalize();
        Self { kind, failure, decoys, errors, seed }
    }

    /// Returns the robustness of a test; `None` if the test ends in an error.
    pub(super) fn robustness(&self, test: &Point) -> Option<f64> {
        let ahead: f64 = (0..self.kind.dims).map(|i| (test.continuous[i] - self.failure.at[i]) * self.errors[i]).sum();
        if self.kind.errors.is_some_and(|distance| ahead > distance) {
            return None;
        }
        let basins = self.decoys.iter().map(|decoy| decoy.robustness(test, self.kind.smooth));
        let value = basins.fold(self.failure.robustness(test, self.kind.smooth), f64::min);
        if value < 0.0 {
            return Some(value * self.kind.scale);
        }
        let noisy = value * (1.0 + self.kind.noise * noise(test, self.seed));
        let stepped = self.kind.step.map_or(noisy, |step| ((noisy / step).floor() + 1.0) * step);
        Some(stepped * self.kind.scale)
    }

    /// Returns the place of the failure.
    #[cfg(test)]
    pub(super) fn hidden(&self) -> Point {
        Point { continuous: self.failure.at.clone(), discrete: self.failure.words.clone() }
    }
}

impl Basin {
    fn robustness(&self, test: &Point, smooth: bool) -> f64 {
        let difference =
            DVector::from_iterator(self.at.len(), test.continuous.iter().zip(&self.at).map(|(a, b)| a - b));
        let away = (&self.shape * difference).norm();
        // A paraboloid has the slope of the cone at the distance 1/4, and a failure is as wide as that of a cone.
        let radius = (-self.floor / self.slope).max(0.0);
        let (floor, risen) = match smooth {
            false => (self.floor, self.slope * away),
            true => (self.floor.max(-2.0 * self.slope * radius * radius), 2.0 * self.slope * away * away),
        };
        let wrong = test.discrete.iter().zip(&self.words).filter(|(a, b)| a != b).count();
        floor + risen + self.penalty * wrong as f64
    }
}

/// A random rotation after a random stretch along the axes that keeps the volume.
fn shape(dims: usize, rng: &mut Pcg64) -> DMatrix<f64> {
    let rotation = DMatrix::from_fn(dims, dims, |_, _| crate::adaptive::normal(rng)).qr().q();
    let mut logs: Vec<f64> = (0..dims).map(|_| rng.random_range(-0.7..0.7)).collect();
    let mean = logs.iter().sum::<f64>() / dims as f64;
    logs.iter_mut().for_each(|log| *log = libm::exp(*log - mean));
    DMatrix::from_diagonal(&DVector::from_vec(logs)) * rotation
}

/// The radius of a ball with a share of the volume of the unit cube.
fn radius(dims: usize, share: f64) -> f64 {
    // The volume of the unit ball, by its recurrence in steps of two dimensions.
    let ball = (2 - dims % 2..=dims).step_by(2).fold(1.0, |volume, d| match d {
        1 => 2.0,
        d => volume * std::f64::consts::TAU / d as f64,
    });
    libm::pow(share / ball, 1.0 / dims as f64)
}

/// A number from -1 to 1 that depends on every bit of a test.
fn noise(test: &Point, seed: u64) -> f64 {
    let bits = test.continuous.iter().map(|u| u.to_bits()).chain(test.discrete.iter().map(|&level| level as u64));
    let word = bits.fold(mix(seed), |word, bits| mix(word ^ bits));
    word as f64 / u64::MAX as f64 * 2.0 - 1.0
}

fn random(number: u64, seed: u64) -> Pcg64 {
    Pcg64::seed_from_u64(mix(number ^ mix(seed)))
}
