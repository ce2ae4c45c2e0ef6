//! A Gaussian process through the tests so far: an estimate of the robustness elsewhere, with its uncertainty.
//!
//! The method is in Rasmussen and Williams, "Gaussian Processes for Machine Learning" (2006), chapter 2 and equation
//! 2.42 for the unknown constant mean. It uses a Matern 5/2 kernel with a separate length for each axis; the levels
//! of a word are all at distance 1. Mean and variance have their most likely values in closed form.
//!
//! The algebra is that of the crate faer, which uses the available vector units. Unlike all else in this crate, the
//! last bits of a posterior may therefore differ between kinds of processors.

use super::cube::Axis;
use faer::linalg::solvers::{Llt, Solve};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};

/// The least variance that is told from 0, as a share of the process's variance.
const LEAST_VARIANCE: f64 = 1e-12;

/// An addition to variances, as a share of the process's variance, so that draws at places that are almost equal have a
/// Cholesky factor.
const DRAW_NOISE: f64 = 1e-8;

/// The kernel of a Gaussian process, which gives the correlation of two places.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    /// The kind of each axis of the cube.
    pub axes: Vec<Axis>,
    /// The length scale of each axis, which is the distance along the axis over which the robustness stays similar.
    pub lengths: Vec<f64>,
    /// The variance of the noise, as a share of the process's variance.
    pub noise: f64,
}

impl Kernel {
    /// Returns the squared distance along an axis, in multiples of the length scale of the axis.
    pub(super) fn squared(&self, axis: usize, a: &[f64], b: &[f64]) -> f64 {
        let scaled = self.axes[axis].difference(a[axis], b[axis]) / self.lengths[axis];
        scaled * scaled
    }

    /// Returns the distance of two places times `sqrt(5)`, in length scales.
    pub(super) fn scaled_distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let squares = self.axes.iter().zip(&self.lengths).zip(a.iter().zip(b));
        let squares = squares.map(|((axis, length), (a, b))| {
            let scaled = axis.difference(*a, *b) / length;
            scaled * scaled
        });
        (5.0 * squares.sum::<f64>()).sqrt()
    }

    /// Returns the correlation of two places.
    pub(super) fn correlation(&self, a: &[f64], b: &[f64]) -> f64 {
        Pair::of(self, a, b).correlation()
    }

    /// Returns the pairs of different places: for each place, the pairs with all places before this place.
    fn pairs(&self, places: &[Vec<f64>]) -> Vec<Pair> {
        let before = |i: usize| (0..i).map(move |j| Pair::of(self, &places[i], &places[j]));
        (0..places.len()).flat_map(before).collect()
    }
}

/// A pair of places.
#[derive(Debug, Clone, Copy)]
struct Pair {
    /// `sqrt(5)` times the distance of the two places.
    distance: f64,
    /// The number `exp(-distance)`, which takes longer to compute than everything else.
    decay: f64,
}

impl Pair {
    fn of(kernel: &Kernel, a: &[f64], b: &[f64]) -> Self {
        let distance = kernel.scaled_distance(a, b);
        Self { distance, decay: libm::exp(-distance) }
    }

    fn correlation(self) -> f64 {
        let s = self.distance;
        (1.0 + s + s * s / 3.0) * self.decay
    }
}

/// Returns the position of the pair of places `i` and `j`, where `j` is before `i`.
fn pair(i: usize, j: usize) -> usize {
    i * i.saturating_sub(1) / 2 + j
}

/// The mean of a Gaussian process far from all tests.
#[derive(Debug, Clone, Copy)]
pub(super) enum Mean {
    /// The mean of the process is unknown and is estimated.
    Unknown,
    /// The mean of the process is known and has the given value.
    Known(f64),
}

/// A Gaussian process that is conditioned on the results of tests.
pub(super) struct Process {
    kernel: Kernel,
    places: Vec<Vec<f64>>,
    pairs: Vec<Pair>,
    factor: Llt<f64>,
    /// The inverse of the correlations times the differences between the values and the mean.
    pull: Vec<f64>,
    /// The inverse of the correlations times a vector of ones.
    ones: Vec<f64>,
    mean: f64,
    /// The variance of the mean, as a share of the process's variance.
    mean_share: f64,
    variance: f64,
}

/// The random numbers for one draw from a Gaussian process.
pub(super) struct Draw {
    /// A standard normal random number for each place of the draw.
    pub values: Vec<f64>,
    /// A standard normal random number for the mean of the process.
    pub mean: f64,
    /// The ratio of the drawn standard deviation to the most likely standard deviation of the process.
    pub spread: f64,
}

impl Process {
    /// Makes the process that is conditioned on values at places; `None` if the correlations have no Cholesky factor or
    /// there is no place.
    pub(super) fn new(kernel: Kernel, places: Vec<Vec<f64>>, values: &[f64], mean: Mean) -> Option<Self> {
        let n = places.len();
        if n == 0 {
            return None;
        }
        let pairs = kernel.pairs(&places);
        // The correlations with noise. Only the lower triangle is needed.
        let entry = |i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => 1.0 + kernel.noise,
            std::cmp::Ordering::Greater => pairs[pair(i, j)].correlation(),
        };
        let factor = Mat::from_fn(n, n, entry).llt(Side::Lower).ok()?;
        let both = factor.solve(Mat::from_fn(n, 2, |i, j| if j == 0 { values[i] } else { 1.0 }));
        let sum = |column: usize| (0..n).map(|i| both[(i, column)]).sum::<f64>();
        let (mean, mean_share) = match mean {
            Mean::Unknown => (sum(0) / sum(1), 1.0 / sum(1)),
            Mean::Known(mean) => (mean, 0.0),
        };
        let ones: Vec<f64> = (0..n).map(|i| both[(i, 1)]).collect();
        let pull: Vec<f64> = (0..n).map(|i| both[(i, 0)] - mean * ones[i]).collect();
        let variance = values.iter().zip(&pull).map(|(value, pull)| (value - mean) * pull).sum::<f64>() / n as f64;
        let variance = variance.max(LEAST_VARIANCE);
        (mean.is_finite() && variance.is_finite()).then_some(Self {
            kernel,
            places,
            pairs,
            factor,
            pull,
            ones,
            mean,
            mean_share,
            variance,
        })
    }

    /// Makes the process that is conditioned on values at places, with as much noise as necessary. Without noise,
    /// places that are almost equal have no Cholesky factor.
    pub(super) fn with_noise(kernel: &Kernel, places: &[Vec<f64>], values: &[f64]) -> Option<Self> {
        [1.0, 1e2, 1e4].into_iter().find_map(|more| {
            let kernel = Kernel { noise: kernel.noise * more, ..kernel.clone() };
            Self::new(kernel, places.to_vec(), values, Mean::Unknown)
        })
    }

    /// Returns the kernel of the process, which gives the correlation of two places.
    pub(super) fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// Predicts the mean and the deviation at each place from the values at all other places. The mean, the variance
    /// and the kernel of the process count as known (Rasmussen and Williams, equation 5.12).
    pub(super) fn leave_one_out(&self, values: &[f64]) -> Vec<(f64, f64)> {
        let n = self.places.len();
        // Only the diagonal of the inverse is needed: the squares in the columns of the inverse of the factor.
        let mut inverse = Mat::<f64>::zeros(n, n);
        invert_lower_triangular(inverse.as_mut(), self.factor.L(), Par::Seq);
        let one = |i: usize| {
            let share = 1.0 / inverse.col_as_slice(i)[i..].iter().map(|entry| entry * entry).sum::<f64>();
            (values[i] - self.pull[i] * share, (share * self.variance).sqrt())
        };
        (0..n).map(one).collect()
    }

    /// Returns the logarithm of the likelihood of the values for the most likely mean and variance, up to a constant.
    pub(super) fn log_likelihood(&self) -> f64 {
        let n = self.places.len();
        let factor = self.factor.L();
        let half_log_determinant: f64 = (0..n).map(|i| libm::log(factor[(i, i)])).sum();
        -0.5 * n as f64 * libm::log(self.variance) - half_log_determinant
    }

    /// Returns the derivatives of the log-likelihood by the logarithms of the length scales, and last by the logarithm
    /// of the noise.
    pub(super) fn log_likelihood_gradient(&self) -> Vec<f64> {
        let (n, axes) = (self.places.len(), self.kernel.lengths.len());
        let inverse = self.factor.solve(Mat::<f64>::identity(n, n));
        let mut gradient = vec![0.0; axes + 1];
        for i in 0..n {
            for j in 0..=i {
                let push = self.pull[i] * self.pull[j] / self.variance - inverse[(i, j)];
                if i == j {
                    gradient[axes] += 0.5 * self.kernel.noise * push;
                    continue;
                }
                let (a, b) = (&self.places[i], &self.places[j]);
                let Pair { distance, decay } = self.pairs[pair(i, j)];
                // Twice a half, for both entries.
                let slope = push * 5.0 / 3.0 * (1.0 + distance) * decay;
                for (axis, partial) in gradient[..axes].iter_mut().enumerate() {
                    *partial += slope * self.kernel.squared(axis, a, b);
                }
            }
        }
        gradient
    }

    /// Returns the mean and the variance of the process at the given places.
    pub(super) fn posterior(&self, places: Vec<Vec<f64>>) -> Posterior<'_> {
        let n = self.places.len();
        let mut whitened = Mat::from_fn(n, places.len(), |i, j| self.kernel.correlation(&self.places[i], &places[j]));
        let along = |j: usize, of: &[f64]| (0..n).map(|i| whitened[(i, j)] * of[i]).sum::<f64>();
        let mean = (0..places.len()).map(|j| self.mean + along(j, &self.pull)).collect();
        let unexplained = (0..places.len()).map(|j| 1.0 - along(j, &self.ones)).collect();
        solve_lower_triangular_in_place(self.factor.L(), whitened.as_mut(), Par::Seq);
        let explained = |j: usize| (0..n).map(|i| whitened[(i, j)] * whitened[(i, j)]).sum::<f64>();
        let share = (0..places.len()).map(|j| (1.0 - explained(j)).max(LEAST_VARIANCE)).collect();
        Posterior { process: self, places, mean, unexplained, share, whitened, believed: Vec::new() }
    }
}

/// The mean and the variance of a Gaussian process at given places.
pub(super) struct Posterior<'a> {
    process: &'a Process,
    places: Vec<Vec<f64>>,
    mean: Vec<f64>,
    /// The part of the process's mean at the places that the tests do not determine.
    unexplained: Vec<f64>,
    /// The variances, as shares of the process's variance.
    share: Vec<f64>,
    whitened: Mat<f64>,
    believed: Vec<Vec<f64>>,
}

impl Posterior<'_> {
    /// Returns the number of places of the estimate.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    pub(super) fn place(&self, index: usize) -> &[f64] {
        &self.places[index]
    }

    pub(super) fn mean(&self, index: usize) -> f64 {
        self.mean[index]
    }

    pub(super) fn deviation(&self, index: usize) -> f64 {
        (self.share[index] * self.process.variance).sqrt()
    }

    /// Draws values at several places together, and returns a list of values for each draw.
    ///
    /// The mean is as uncertain as the tests leave it (Rasmussen and Williams, equation 2.42), and so is the
    /// deviation.
    pub(super) fn draws(&self, at: &[usize], draws: &[Draw]) -> Vec<Vec<f64>> {
        let kernel = &self.process.kernel;
        let share = |i: usize, j: usize| {
            if i == j {
                return self.share[at[i]] + DRAW_NOISE;
            }
            let (a, b) = (self.whitened.col(at[i]), self.whitened.col(at[j]));
            let explained: f64 = a.iter().zip(b.iter()).map(|(a, b)| a * b).sum();
            kernel.correlation(&self.places[at[i]], &self.places[at[j]]) - explained
        };
        let shares = Mat::from_fn(at.len(), at.len(), |i, j| if j <= i { share(i, j) } else { 0.0 });
        let factor = shares.llt(Side::Lower).ok();
        let deviation = self.process.variance.sqrt();
        let value = |draw: &Draw, i: usize| {
            let step: f64 = match &factor {
                Some(factor) => (0..=i).map(|j| factor.L()[(i, j)] * draw.values[j]).sum(),
                // Rounding errors have spoilt the covariance: the values then vary together.
                None => self.share[at[i]].sqrt() * draw.values[0],
            };
            let of_mean = self.unexplained[at[i]] * self.process.mean_share.sqrt() * draw.mean;
            self.mean[at[i]] + draw.spread * deviation * (step + of_mean)
        };
        draws.iter().map(|draw| (0..at.len()).map(|i| value(draw, i)).collect()).collect()
    }

    /// Assumes that a test at the place with the given index has the expected value (kriging believer; Ginsbourger et
    /// al. 2010). No mean changes, but all variances do.
    pub(super) fn believe(&mut self, index: usize) {
        let kernel = &self.process.kernel;
        let length = (self.share[index] + kernel.noise).sqrt();
        let at = &self.places[index];
        let explained = products(&self.whitened, index);
        let row: Vec<f64> = (0..self.places.len())
            .map(|other| {
                let alike = kernel.correlation(at, &self.places[other]);
                let believed: f64 = self.believed.iter().map(|row| row[index] * row[other]).sum();
                (alike - explained[other] - believed) / length
            })
            .collect();
        for (share, covariance) in self.share.iter_mut().zip(&row) {
            *share = (*share - covariance * covariance).max(LEAST_VARIANCE);
        }
        self.believed.push(row);
    }
}

/// Returns the scalar products of a column with every column. Four sums run at a time, each in the order of its terms:
/// the additions of a single sum would have to wait for each other.
fn products(columns: &Mat<f64>, column: usize) -> Vec<f64> {
    let known = columns.col_as_slice(column);
    let mut all = Vec::with_capacity(columns.ncols());
    for first in (0..columns.ncols()).step_by(4) {
        // At the end the last column replaces missing ones.
        let four = [0, 1, 2, 3].map(|i| columns.col_as_slice((first + i).min(columns.ncols() - 1)));
        let mut sums = [0.0; 4];
        for (row, value) in known.iter().enumerate() {
            for (sum, other) in sums.iter_mut().zip(four) {
                *sum += value * other[row];
            }
        }
        all.extend(&sums[..4.min(columns.ncols() - first)]);
    }
    all
}

#[cfg(test)]
mod tests;
