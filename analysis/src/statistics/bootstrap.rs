//! Computes confidence intervals by resampling (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter
//! 13).

use super::quantile;
use super::random::SplitMix64;

/// The number of resamples for a bootstrap interval. A thousand are enough for the ends of a 95 % interval.
pub const RESAMPLES: usize = 2_000;

/// Returns the 95 % percentile bootstrap interval of a statistic of `n` values.
///
/// `statistic` receives [`RESAMPLES`] lists of `n` indices below `n`, drawn with replacement. Pairs stay pairs if
/// `statistic` takes both sides at the same index. The interval lies between the 2.5 % and the 97.5 % quantile of the
/// results. The indices are drawn with a fixed seed, so that the same values always have the same interval.
///
/// # Panics
/// `n` is 0.
pub fn bootstrap_interval(n: usize, mut statistic: impl FnMut(&[usize]) -> f64) -> [f64; 2] {
    let mut random = SplitMix64(0);
    let mut indices = vec![0; n];
    let mut found: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            indices.fill_with(|| random.below(n));
            statistic(&indices)
        })
        .collect();
    found.sort_by(f64::total_cmp);
    [quantile(&found, 0.025), quantile(&found, 0.975)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_of(values: &[f64]) -> impl Fn(&[usize]) -> f64 {
        move |indices| indices.iter().map(|&i| values[i]).sum::<f64>() / indices.len() as f64
    }

    #[test]
    fn the_interval_of_a_mean_is_the_one_of_the_normal_distribution() {
        // 1 to 50 have the mean 25.5; a mean of 50 of them has the deviation sqrt((50^2 - 1) / 12 / 50) = 2.041.
        let values: Vec<f64> = (1..=50).map(f64::from).collect();
        let [low, high] = bootstrap_interval(50, mean_of(&values));
        assert!((low - (25.5 - 1.96 * 2.041)).abs() < 0.4, "{low}");
        assert!((high - (25.5 + 1.96 * 2.041)).abs() < 0.4, "{high}");
    }

    #[test]
    fn the_interval_of_a_coin_agrees_with_all_its_resamples() {
        // Of two values every resample is one of four: half the means are 0.5, a quarter are 0 and a quarter are 1.
        let mut means = [0; 3];
        let interval = bootstrap_interval(2, |indices| {
            let sum = indices.iter().sum::<usize>();
            means[sum] += 1;
            sum as f64 / 2.0
        });
        assert_eq!(interval, [0.0, 1.0]);
        let share = means.map(|count| count as f64 / RESAMPLES as f64);
        assert!((share[0] - 0.25).abs() < 0.04 && (share[1] - 0.5).abs() < 0.04, "{share:?}");
    }

    #[test]
    fn intervals_are_the_same_every_time_and_a_point_for_equal_values() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0];
        assert_eq!(bootstrap_interval(5, mean_of(&values)), bootstrap_interval(5, mean_of(&values)));
        assert_eq!(bootstrap_interval(3, mean_of(&[2.0; 3])), [2.0, 2.0]);
    }
}
