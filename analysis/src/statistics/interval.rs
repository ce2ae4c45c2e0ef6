//! Computes confidence intervals of proportions and of means.

use paracosm_space::distribution::{beta_quantile, normal_quantile};

/// Returns the interval of Clopper and Pearson for a proportion, from `successes` among `n` independent trials (The
/// use of confidence or fiducial limits illustrated in the case of the binomial, Biometrika 26, 1934). It contains
/// the true proportion with a probability of at least `confidence`, whatever the true proportion is.
///
/// # Panics
/// There are more successes than trials.
pub fn clopper_pearson(successes: usize, n: usize, confidence: f64) -> [f64; 2] {
    assert!(successes <= n, "no more successes than trials");
    let tail = (1.0 - confidence) / 2.0;
    let (k, rest) = (successes as f64, (n - successes) as f64);
    let lower = if successes == 0 { 0.0 } else { beta_quantile(k, rest + 1.0, tail) };
    // By symmetry: a quantile near 1 would lose digits.
    let upper = if successes == n { 1.0 } else { 1.0 - beta_quantile(rest, k + 1.0, tail) };
    [lower, upper]
}

/// Returns Wilson's interval for a proportion, from `successes` among `n` independent trials (Probable inference, the
/// law of succession, and statistical inference, JASA 22, 1927). It holds the proportions that the normal
/// distribution allows for the observed successes. It is shorter than that of [`clopper_pearson`], and on average
/// contains the true proportion with about the probability `confidence`.
///
/// # Panics
/// There are more successes than trials, or there are no trials.
pub fn wilson(successes: usize, n: usize, confidence: f64) -> [f64; 2] {
    assert!(successes <= n && n > 0, "no more successes than trials, of which there are some");
    let (share, n) = (successes as f64 / n as f64, n as f64);
    let z = normal_quantile(0.5 + confidence / 2.0);
    let shrunk = 1.0 / (1.0 + z * z / n);
    let middle = shrunk * (share + z * z / (2.0 * n));
    let half = shrunk * z * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    // If the event occurs never or always, one end of the interval is 0 or 1. Rounding must not move it.
    let lower = if successes == 0 { 0.0 } else { middle - half };
    [lower, if share == 1.0 { 1.0 } else { middle + half }]
}

/// Returns the quantile at `p` of Student's t distribution with `freedom` degrees of freedom, for `p` of at least 0.5
/// (the inverse of DLMF 8.17.26).
pub fn student_quantile(freedom: f64, p: f64) -> f64 {
    let x = beta_quantile(0.5, freedom / 2.0, 2.0 * p - 1.0);
    (freedom * x / (1.0 - x)).sqrt()
}

/// Returns the mean and the variance (with n - 1) of at least two values.
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (mean, squares / (n - 1.0))
}

/// Returns Student's interval for the mean of a normal distribution, from a sample of the distribution.
///
/// # Panics
/// There are fewer than two values.
pub fn mean_interval(values: &[f64], confidence: f64) -> [f64; 2] {
    assert!(values.len() > 1, "at least two values");
    let n = values.len() as f64;
    let (mean, variance) = moments(values);
    let half = student_quantile(n - 1.0, 0.5 + confidence / 2.0) * (variance / n).sqrt();
    [mean - half, mean + half]
}

/// Returns Cox's interval for the mean of a log-normal distribution, from a sample, with Student's quantile (Olsson,
/// Confidence intervals for the mean of a log-normal distribution, J. Statistics Education 13, 2005).
///
/// # Panics
/// There are fewer than two values, or a value is not above 0.
pub fn log_normal_mean_interval(values: &[f64], confidence: f64) -> [f64; 2] {
    assert!(values.len() > 1 && values.iter().all(|value| *value > 0.0), "at least two values above 0");
    let n = values.len() as f64;
    let logs: Vec<f64> = values.iter().map(|value| libm::log(*value)).collect();
    let (mean, variance) = moments(&logs);
    let error = (variance / n + variance * variance / (2.0 * (n - 1.0))).sqrt();
    let half = student_quantile(n - 1.0, 0.5 + confidence / 2.0) * error;
    [-half, half].map(|half| libm::exp(mean + variance / 2.0 + half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    fn close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected}");
    }

    #[test]
    fn the_exact_interval_cuts_tails_of_the_binomial_distribution() {
        // The ends are where the tail that was seen has exactly the probability that is left out, summed term by term.
        let (k, n) = (7, 40);
        let [lower, upper] = clopper_pearson(k, n, 0.9);
        let term = |i: usize, p: f64| {
            let choose = (0..i).fold(1.0, |product, j| product * (n - j) as f64 / (j + 1) as f64);
            choose * libm::pow(p, i as f64) * libm::pow(1.0 - p, (n - i) as f64)
        };
        close((k..=n).map(|i| term(i, lower)).sum(), 0.05, 1e-12);
        close((0..=k).map(|i| term(i, upper)).sum(), 0.05, 1e-12);
    }

    #[test]
    fn nothing_seen_leaves_the_other_end_open() {
        // (1 - p)^n = 0.025.
        let [lower, upper] = clopper_pearson(0, 1000, 0.95);
        assert_eq!(lower, 0.0);
        close(upper, 1.0 - libm::pow(0.025, 1e-3), 1e-15);
        let [lower, upper] = clopper_pearson(1000, 1000, 0.95);
        close(lower, libm::pow(0.025, 1e-3), 1e-15);
        assert_eq!(upper, 1.0);
    }

    #[test]
    fn the_ends_of_wilsons_interval_are_where_what_was_seen_is_just_allowed() {
        // By the definition: |share - p| = z sqrt(p (1 - p) / n) at both ends.
        let z = 1.959_963_984_540_054;
        for (successes, n) in [(0, 30), (1, 30), (17, 30), (29, 30), (30, 30), (3, 7)] {
            let [lower, upper] = wilson(successes, n, 0.95);
            let share = successes as f64 / n as f64;
            for end in [lower, upper] {
                close((share - end).abs(), z * (end * (1.0 - end) / n as f64).sqrt(), 1e-9);
            }
            assert!(lower <= share && share <= upper);
        }
        // Newcombe, Two-sided confidence intervals for the single proportion, Stat. Med. 17 (1998), table I, 81 of 263.
        let [lower, upper] = wilson(81, 263, 0.95);
        close(lower, 0.2553, 5e-5);
        close(upper, 0.3662, 5e-5);
    }

    #[test]
    fn quantiles_of_student_are_those_of_the_tables() {
        close(student_quantile(1.0, 0.975), 12.706_204_736, 1e-8);
        close(student_quantile(9.0, 0.975), 2.262_157_163, 1e-8);
        close(student_quantile(19.0, 0.95), 1.729_132_812, 1e-8);
        // With two degrees t is (2p - 1) / sqrt(2 p (1 - p)).
        close(student_quantile(2.0, 0.995), 0.99 / (2.0_f64 * 0.995 * 0.005).sqrt(), 1e-12);
        close(student_quantile(9.0, 0.5), 0.0, 1e-12);
    }

    #[test]
    fn intervals_of_means_cover_the_truth_as_often_as_they_say() {
        let mut random = SplitMix64(1);
        let mut covered = [0; 2];
        for _ in 0..2000 {
            let normal: Vec<f64> = (0..10).map(|_| 3.0 + 0.4 * random.normal()).collect();
            let log_normal: Vec<f64> = normal.iter().map(|value| libm::exp(*value)).collect();
            let [low, high] = mean_interval(&normal, 0.95);
            covered[0] += usize::from(low <= 3.0 && 3.0 <= high);
            let [low, high] = log_normal_mean_interval(&log_normal, 0.95);
            let truth = libm::exp(3.0 + 0.5 * 0.4 * 0.4);
            covered[1] += usize::from(low <= truth && truth <= high);
        }
        // 1900 expected, with a deviation of 10.
        assert!(covered.iter().all(|covered| (1860..=1940).contains(covered)), "{covered:?}");
    }
}
