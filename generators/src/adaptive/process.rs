//! A Gaussian process through the tests so far: what the robustness elsewhere may be, and how sure that is.
//!
//! Rasmussen and Williams, "Gaussian Processes for Machine Learning" (2006), chapter 2 and equation 2.42 for the unknown
//! constant mean: a Matern 5/2 kernel with a length of its own for each axis; the levels of a word are all at distance
//! 1. Mean and variance have their most likely values in closed form.
//!
//! The algebra is faer's. It uses the vector units that it finds, so the last bits of a posterior, unlike all else in this
//! crate, may differ from one kind of processor to another.

use super::cube::Axis;
use faer::linalg::solvers::{Llt, Solve};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};

/// The smallest variance, in shares of the process's, that is told from 0.
const LEAST_VARIANCE: f64 = 1e-12;

/// What is added to variances, in the same shares, so that draws at places that are almost one have a factor.
const DRAW_NOISE: f64 = 1e-8;

/// How alike two places are.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    /// The kinds of the axes.
    pub axes: Vec<Axis>,
    /// Along each axis how far places are alike.
    pub lengths: Vec<f64>,
    /// The variance of what no place explains, in shares of the process's.
    pub noise: f64,
}

impl Kernel {
    /// The squared distance along one axis, in multiples of its length.
    pub(super) fn squared(&self, axis: usize, a: &[f64], b: &[f64]) -> f64 {
        let difference = match self.axes[axis] {
            Axis::Nominal(_) => f64::from(a[axis] != b[axis]),
            Axis::Continuous | Axis::Ordered(_) => a[axis] - b[axis],
        };
        let scaled = difference / self.lengths[axis];
        scaled * scaled
    }

    /// `sqrt(5) r`, r being the distance.
    pub(super) fn scaled_distance(&self, a: &[f64], b: &[f64]) -> f64 {
        (5.0 * (0..a.len()).map(|axis| self.squared(axis, a, b)).sum::<f64>()).sqrt()
    }

    /// The correlation of two places.
    pub(super) fn correlation(&self, a: &[f64], b: &[f64]) -> f64 {
        let s = self.scaled_distance(a, b);
        (1.0 + s + s * s / 3.0) * libm::exp(-s)
    }

    /// The correlations of the places with each other, noise included, as far as they are needed: from the diagonal down.
    fn matrix(&self, places: &[Vec<f64>]) -> Mat<f64> {
        let entry = |i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => 1.0 + self.noise,
            std::cmp::Ordering::Greater => self.correlation(&places[i], &places[j]),
        };
        Mat::from_fn(places.len(), places.len(), entry)
    }
}

/// What is known of the mean far from all tests.
#[derive(Debug, Clone, Copy)]
pub(super) enum Mean {
    /// Nothing: it is estimated.
    Unknown,
    /// It is this.
    Known(f64),
}

/// The process, given the tests.
pub(super) struct Process {
    kernel: Kernel,
    places: Vec<Vec<f64>>,
    factor: Llt<f64>,
    /// The inverse of the correlations times what the mean leaves.
    pull: Vec<f64>,
    mean: f64,
    variance: f64,
}

impl Process {
    /// The process through values at places; `None` where the correlations have no Cholesky factor, or there is no place.
    pub(super) fn new(kernel: Kernel, places: Vec<Vec<f64>>, values: &[f64], mean: Mean) -> Option<Self> {
        let n = places.len();
        if n == 0 {
            return None;
        }
        let factor = kernel.matrix(&places).llt(Side::Lower).ok()?;
        let both = factor.solve(Mat::from_fn(n, 2, |i, j| if j == 0 { values[i] } else { 1.0 }));
        let sum = |column: usize| (0..n).map(|i| both[(i, column)]).sum::<f64>();
        let mean = match mean {
            Mean::Unknown => sum(0) / sum(1),
            Mean::Known(mean) => mean,
        };
        let pull: Vec<f64> = (0..n).map(|i| both[(i, 0)] - mean * both[(i, 1)]).collect();
        let variance = values.iter().zip(&pull).map(|(value, pull)| (value - mean) * pull).sum::<f64>() / n as f64;
        let variance = variance.max(LEAST_VARIANCE);
        (mean.is_finite() && variance.is_finite()).then_some(Self { kernel, places, factor, pull, mean, variance })
    }

    /// The process through values at places, with as much noise as it takes: without any, places that are almost one have
    /// no factor.
    pub(super) fn with_noise(kernel: &Kernel, places: &[Vec<f64>], values: &[f64]) -> Option<Self> {
        [1.0, 1e2, 1e4].into_iter().find_map(|more| {
            let kernel = Kernel { noise: kernel.noise * more, ..kernel.clone() };
            Self::new(kernel, places.to_vec(), values, Mean::Unknown)
        })
    }

    /// Mean and deviation at each place if the value there were not known, but mean, variance and kernel were (Rasmussen
    /// and Williams, equation 5.12).
    pub(super) fn leave_one_out(&self, values: &[f64]) -> Vec<(f64, f64)> {
        let n = self.places.len();
        let inverse = self.factor.solve(Mat::<f64>::identity(n, n));
        let one = |i: usize| {
            let share = 1.0 / inverse[(i, i)];
            (values[i] - self.pull[i] * share, (share * self.variance).sqrt())
        };
        (0..n).map(one).collect()
    }

    /// The logarithm of the likelihood of the values, mean and variance being the most likely ones, up to a constant.
    pub(super) fn log_likelihood(&self) -> f64 {
        let n = self.places.len();
        let factor = self.factor.L();
        let half_log_determinant: f64 = (0..n).map(|i| libm::log(factor[(i, i)])).sum();
        -0.5 * n as f64 * libm::log(self.variance) - half_log_determinant
    }

    /// Its derivatives by the logarithms of the lengths, and last of the noise.
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
                let s = self.kernel.scaled_distance(a, b);
                // Twice a half, for both entries.
                let slope = push * 5.0 / 3.0 * (1.0 + s) * libm::exp(-s);
                for (axis, partial) in gradient[..axes].iter_mut().enumerate() {
                    *partial += slope * self.kernel.squared(axis, a, b);
                }
            }
        }
        gradient
    }

    /// What it says of places.
    pub(super) fn posterior(&self, places: Vec<Vec<f64>>) -> Posterior<'_> {
        let n = self.places.len();
        let mut whitened = Mat::from_fn(n, places.len(), |i, j| self.kernel.correlation(&self.places[i], &places[j]));
        let mean = (0..places.len())
            .map(|j| self.mean + (0..n).map(|i| whitened[(i, j)] * self.pull[i]).sum::<f64>())
            .collect();
        solve_lower_triangular_in_place(self.factor.L(), whitened.as_mut(), Par::Seq);
        let explained = |j: usize| (0..n).map(|i| whitened[(i, j)] * whitened[(i, j)]).sum::<f64>();
        let share = (0..places.len()).map(|j| (1.0 - explained(j)).max(LEAST_VARIANCE)).collect();
        Posterior { process: self, places, mean, share, whitened, believed: Vec::new() }
    }
}

/// Mean and variance at some places.
pub(super) struct Posterior<'a> {
    process: &'a Process,
    places: Vec<Vec<f64>>,
    mean: Vec<f64>,
    /// The variances, in shares of the process's.
    share: Vec<f64>,
    whitened: Mat<f64>,
    believed: Vec<Vec<f64>>,
}

impl Posterior<'_> {
    /// How many places there are.
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

    /// Values at some of the places together, by the process: one for each list of standard normal numbers.
    pub(super) fn draws(&self, at: &[usize], normals: &[Vec<f64>]) -> Vec<Vec<f64>> {
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
        let value = |normals: &[f64], i: usize| {
            let step: f64 = match &factor {
                Some(factor) => (0..=i).map(|j| factor.L()[(i, j)] * normals[j]).sum(),
                // Rounding errors have made it no covariance: then they vary as one.
                None => self.share[at[i]].sqrt() * normals[0],
            };
            self.mean[at[i]] + deviation * step
        };
        normals.iter().map(|normals| (0..at.len()).map(|i| value(normals, i)).collect()).collect()
    }

    /// Believes that a test at one of the places comes out as expected (kriging believer; Ginsbourger et al. 2010): no mean
    /// changes, but all variances do.
    pub(super) fn believe(&mut self, index: usize) {
        let kernel = &self.process.kernel;
        let length = (self.share[index] + kernel.noise).sqrt();
        let (known, at) = (self.whitened.col(index), &self.places[index]);
        let row: Vec<f64> = (0..self.places.len())
            .map(|other| {
                let alike = kernel.correlation(at, &self.places[other]);
                let explained: f64 = known.iter().zip(self.whitened.col(other).iter()).map(|(a, b)| a * b).sum();
                let believed: f64 = self.believed.iter().map(|row| row[index] * row[other]).sum();
                (alike - explained - believed) / length
            })
            .collect();
        for (share, covariance) in self.share.iter_mut().zip(&row) {
            *share = (*share - covariance * covariance).max(LEAST_VARIANCE);
        }
        self.believed.push(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Solves by Gauss and Jordan.
    fn inverse(mut a: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let n = a.len();
        for (i, row) in a.iter_mut().enumerate() {
            row.extend((0..n).map(|j| f64::from(i == j)));
        }
        for pivot in 0..n {
            let best = (pivot..n).max_by(|&i, &j| a[i][pivot].abs().total_cmp(&a[j][pivot].abs())).unwrap();
            a.swap(pivot, best);
            let by = a[pivot][pivot];
            a[pivot].iter_mut().for_each(|x| *x /= by);
            let row = a[pivot].clone();
            for i in (0..n).filter(|&i| i != pivot) {
                let times = a[i][pivot];
                a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= times * y);
            }
        }
        a.into_iter().map(|row| row[n..].to_vec()).collect()
    }

    fn matern(kernel: &Kernel, a: &[f64], b: &[f64]) -> f64 {
        let part = |i: usize| match kernel.axes[i] {
            Axis::Nominal(_) if a[i] == b[i] => 0.0,
            Axis::Nominal(_) => 1.0 / (kernel.lengths[i] * kernel.lengths[i]),
            _ => (a[i] - b[i]) * (a[i] - b[i]) / (kernel.lengths[i] * kernel.lengths[i]),
        };
        let r = (0..a.len()).map(part).sum::<f64>().sqrt();
        (1.0 + 5.0_f64.sqrt() * r + 5.0 / 3.0 * r * r) * libm::exp(-5.0_f64.sqrt() * r)
    }

    /// Mean and variance at a place, straight from the formulas.
    fn naive(kernel: &Kernel, places: &[Vec<f64>], values: &[f64], at: &[f64]) -> (f64, f64) {
        let n = places.len();
        let entry =
            |i: usize, j: usize| matern(kernel, &places[i], &places[j]) + if i == j { kernel.noise } else { 0.0 };
        let inverse = inverse((0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect());
        let form = |a: &[f64], b: &[f64]| -> f64 {
            (0..n).map(|i| (0..n).map(|j| a[i] * inverse[i][j] * b[j]).sum::<f64>()).sum()
        };
        let ones = vec![1.0; n];
        let mean = form(&ones, values) / form(&ones, &ones);
        let left: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let variance = form(&left, &left) / n as f64;
        let near: Vec<f64> = places.iter().map(|place| matern(kernel, place, at)).collect();
        (mean + form(&near, &left), variance * (1.0 - form(&near, &near)))
    }

    /// A kernel, places, their values, and other places.
    type Case = (Kernel, Vec<Vec<f64>>, Vec<f64>, Vec<Vec<f64>>);

    fn cases() -> impl Strategy<Value = Case> {
        let place =
            || (0.0..1.0_f64, 0.0..1.0_f64, 0..3_usize).prop_map(|(a, b, c)| vec![a, b, (c as f64 + 0.5) / 3.0]);
        let lengths = prop::collection::vec(0.1..2.0_f64, 3);
        let tests = prop::collection::vec((place(), -3.0..3.0_f64), 2..20);
        (lengths, 1e-3..0.1_f64, tests, prop::collection::vec(place(), 3..6)).prop_map(|(lengths, noise, tests, at)| {
            let axes = vec![Axis::Continuous, Axis::Continuous, Axis::Nominal(3)];
            let (places, values) = tests.into_iter().unzip();
            (Kernel { axes, lengths, noise }, places, values, at)
        })
    }

    proptest! {
        #[test]
        fn the_posterior_is_that_of_the_formulas((kernel, places, values, at) in cases()) {
            let process = Process::new(kernel.clone(), places.clone(), &values, Mean::Unknown).unwrap();
            let posterior = process.posterior(at.clone());
            for (index, at) in at.iter().enumerate() {
                let (mean, variance) = naive(&kernel, &places, &values, at);
                prop_assert!((posterior.mean(index) - mean).abs() < 1e-7);
                let found = posterior.deviation(index) * posterior.deviation(index);
                prop_assert!((found - variance).abs() < 1e-7, "{found} {variance}");
            }
        }

        #[test]
        fn believing_is_conditioning_on_what_was_expected((kernel, places, values, at) in cases()) {
            let process = Process::new(kernel.clone(), places.clone(), &values, Mean::Unknown).unwrap();
            let mut posterior = process.posterior(at.clone());
            posterior.believe(0);
            posterior.believe(1);
            // The share of variance left, which the values do not enter.
            let all: Vec<Vec<f64>> = places.iter().chain(&at[..2]).cloned().collect();
            let share = |places: &[Vec<f64>], values: &[f64], at: &[f64]| {
                let far = [1e9, 1e9, 7.0];
                naive(&kernel, places, values, at).1 / naive(&kernel, places, values, &far).1
            };
            let any: Vec<f64> = (0..all.len()).map(|i| (i * i % 7) as f64).collect();
            for (index, place) in at.iter().enumerate() {
                let found = posterior.deviation(index) * posterior.deviation(index) / process.variance;
                prop_assert!((found - share(&all, &any, place)).abs() < 1e-6);
            }
        }

        #[test]
        fn leaving_one_out_is_a_process_without_it((kernel, places, values, _) in cases()) {
            let process = Process::new(kernel.clone(), places.clone(), &values, Mean::Unknown).unwrap();
            let left_out = process.leave_one_out(&values);
            for index in (0..places.len()).filter(|_| places.len() > 2) {
                let without = |i: &usize| *i != index;
                let others: Vec<Vec<f64>> = (0..places.len()).filter(without).map(|i| places[i].clone()).collect();
                let rest: Vec<f64> = (0..places.len()).filter(without).map(|i| values[i]).collect();
                let smaller = Process::new(kernel.clone(), others, &rest, Mean::Known(process.mean)).unwrap();
                let posterior = smaller.posterior(vec![places[index].clone()]);
                let (mean, deviation) = left_out[index];
                prop_assert!((posterior.mean(0) - mean).abs() < 1e-6);
                // The noise of the value itself counts, and the variance is that of all.
                let share = posterior.share[0] + kernel.noise;
                prop_assert!((share * process.variance - deviation * deviation).abs() < 1e-6);
            }
        }

        #[test]
        fn draws_vary_together_as_the_process_says((kernel, places, values, at) in cases()) {
            let process = Process::new(kernel, places, &values, Mean::Unknown).unwrap();
            let posterior = process.posterior(at.clone());
            let all: Vec<usize> = (0..at.len()).collect();
            // With one normal number at a time a draw is a column of the covariance's factor.
            let unit = |one: usize| (0..at.len()).map(|i| f64::from(u8::from(i == one))).collect();
            let units: Vec<Vec<f64>> = all.iter().map(|&one| unit(one)).collect();
            let columns = posterior.draws(&all, &units);
            for &i in &all {
                let variance: f64 = columns.iter().map(|column| (column[i] - posterior.mean(i)).powi(2)).sum();
                let found = posterior.deviation(i) * posterior.deviation(i);
                prop_assert!((variance - found).abs() < 1e-6 * process.variance, "{variance} {found}");
            }
            // What is believed of the first takes away as much of the others as its covariance with them.
            let mut believing = process.posterior(at.clone());
            believing.believe(0);
            let noisy = posterior.share[0] + process.kernel.noise;
            for &i in &all {
                let covariance: f64 = columns
                    .iter()
                    .map(|column| (column[0] - posterior.mean(0)) * (column[i] - posterior.mean(i)))
                    .sum::<f64>() / process.variance;
                let left = posterior.share[i] - covariance * covariance / noisy;
                prop_assert!((left - believing.share[i]).abs() < 1e-5, "{left} {}", believing.share[i]);
            }
        }

        #[test]
        fn the_gradient_is_the_difference_quotient((kernel, places, values, _) in cases()) {
            let of = |kernel: &Kernel| Process::new(kernel.clone(), places.clone(), &values, Mean::Unknown).unwrap();
            let gradient = of(&kernel).log_likelihood_gradient();
            let step = 1e-5_f64;
            for (index, partial) in gradient.iter().enumerate() {
                let moved = |by: f64| {
                    let mut kernel = kernel.clone();
                    let factor = libm::exp(by);
                    if index < 3 { kernel.lengths[index] *= factor } else { kernel.noise *= factor }
                    of(&kernel).log_likelihood()
                };
                let quotient = (moved(step) - moved(-step)) / (2.0 * step);
                prop_assert!((quotient - partial).abs() < 1e-4 * (1.0 + partial.abs()), "{index}: {quotient} {partial}");
            }
        }
    }

    #[test]
    fn without_a_place_or_with_places_that_are_one_there_is_no_process() {
        let kernel = |noise| Kernel { axes: vec![Axis::Continuous], lengths: vec![1.0], noise };
        assert!(Process::new(kernel(0.1), Vec::new(), &[], Mean::Unknown).is_none());
        assert!(Process::new(kernel(0.0), vec![vec![0.5]; 3], &[1.0, 2.0, 3.0], Mean::Unknown).is_none());
    }
}
