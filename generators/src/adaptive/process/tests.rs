//! The process against its formulas, solved naively.

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
    let entry = |i: usize, j: usize| matern(kernel, &places[i], &places[j]) + if i == j { kernel.noise } else { 0.0 };
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
    let place = || (0.0..1.0_f64, 0.0..1.0_f64, 0..3_usize).prop_map(|(a, b, c)| vec![a, b, (c as f64 + 0.5) / 3.0]);
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
        let unit = |one: usize| Draw {
            values: (0..at.len()).map(|i| f64::from(u8::from(i == one))).collect(),
            mean: 0.0,
            spread: 1.0,
        };
        let units: Vec<Draw> = all.iter().map(|&one| unit(one)).collect();
        let columns = posterior.draws(&all, &units);
        for &i in &all {
            let off = |column: &Vec<f64>| column[i] - posterior.mean(i);
            let variance: f64 = columns.iter().map(|column| off(column) * off(column)).sum();
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
