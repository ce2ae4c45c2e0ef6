//! Provides the statistics by which repeated measurements are compared.
//!
//! The choice follows Arcuri and Briand, A hitchhiker's guide to statistical tests for assessing randomized
//! algorithms in software engineering (STVR 24, 2014): no assumption of normality, effect sizes beside p-values,
//! intervals beside point estimates, and a correction for many tests.

mod bootstrap;
mod interval;
mod log_rank;
mod mcnemar;
pub mod random;
mod rank;
mod signed_rank;
mod survival;
mod versus;

pub use bootstrap::{RESAMPLES, bootstrap_interval};
pub use interval::{clopper_pearson, log_normal_mean_interval, mean_interval, student_quantile, wilson};
pub use log_rank::log_rank_p;
pub use mcnemar::mcnemar_p;
pub use rank::spearman;
pub use signed_rank::{MOST_EXACT, signed_rank_p};
pub use survival::{Lifetime, Survival};
pub use versus::{Versus, correct, median_of};

/// Returns the quantile at `q` of sorted values, interpolated linearly between two values (type 7 of Hyndman and Fan,
/// Sample quantiles in statistical packages, The American Statistician 50, 1996).
///
/// # Panics
/// `sorted` is empty.
pub fn quantile(sorted: &[f64], q: f64) -> f64 {
    let at = q * (sorted.len() - 1) as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (at - below as f64) * (sorted[above] - sorted[below])
}

/// Returns the median, the lower quartile and the upper quartile of values, as [`quantile`] defines quantiles.
///
/// # Panics
/// `values` is empty.
pub fn median_and_quartiles(values: &[f64]) -> (f64, [f64; 2]) {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    (quantile(&sorted, 0.5), [quantile(&sorted, 0.25), quantile(&sorted, 0.75)])
}

/// Returns the effect size A12 of Vargha and Delaney for two groups of values. It is the probability that a value of
/// `a` is larger than a value of `b`, where equal values count half (Vargha and Delaney, A critique and improvement of
/// the CL common language effect size statistics of McGraw and Wong, J. Educ. Behav. Stat. 25, 2000). 0.5 means no
/// difference; the authors call 0.56 small, 0.64 medium and 0.71 large, and likewise below 0.5.
///
/// # Panics
/// `a` or `b` is empty.
pub fn vargha_delaney(a: &[f64], b: &[f64]) -> f64 {
    assert!(!a.is_empty() && !b.is_empty(), "there is nothing to compare");
    let halves = |x: f64| b.iter().map(|y| if x > *y { 2 } else { usize::from(x == *y) }).sum::<usize>();
    a.iter().map(|x| halves(*x)).sum::<usize>() as f64 / (2 * a.len() * b.len()) as f64
}

/// Returns the p-values of a family of tests, adjusted by the step-down procedure of Holm (A simple sequentially
/// rejective multiple test procedure, Scand. J. Statist. 6, 1979). The probability of any false finding among the
/// tests then stays below the significance level.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![0.0; p.len()];
    let mut largest: f64 = 0.0;
    for (rank, i) in order.into_iter().enumerate() {
        largest = largest.max((p.len() - rank) as f64 * p[i]).min(1.0);
        adjusted[i] = largest;
    }
    adjusted
}

/// Returns the exponent of the power law `y = c x^slope` through points with values above 0. It is the slope of the
/// least-squares line of log y over log x. `None` if there are fewer than two different `x`.
pub fn power_law_slope(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (libm::log(*x), libm::log(*y))).collect();
    let n = logs.len() as f64;
    let (x_mean, y_mean) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    let spread: f64 = logs.iter().map(|(x, _)| (x - x_mean) * (x - x_mean)).sum();
    let together: f64 = logs.iter().map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let different = points.iter().any(|(x, _)| *x != points[0].0);
    different.then(|| together / spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_lie_between_values_in_proportion() {
        // By hand: of 1 2 4 8 the quartiles are at the places 0.75, 1.5 and 2.25.
        assert_eq!(median_and_quartiles(&[8.0, 1.0, 4.0, 2.0]), (3.0, [1.75, 5.0]));
        assert_eq!(median_and_quartiles(&[5.0, 3.0, 1.0]), (3.0, [2.0, 4.0]));
        assert_eq!(median_and_quartiles(&[7.0]), (7.0, [7.0, 7.0]));
    }

    #[test]
    fn the_effect_size_counts_pairs_and_half_the_equal_ones() {
        // By hand: of the 9 pairs 4 has won 3, 3 has won 2 and shared 1, 1 has shared 1.
        assert_eq!(vargha_delaney(&[4.0, 3.0, 1.0], &[1.0, 2.0, 3.0]), (3.0 + 2.5 + 0.5) / 9.0);
        assert_eq!(vargha_delaney(&[1.0, 2.0], &[1.0, 2.0]), 0.5);
        assert_eq!(vargha_delaney(&[5.0], &[1.0, 2.0]), 1.0);
        assert_eq!(vargha_delaney(&[0.0], &[1.0, 2.0]), 0.0);
    }

    #[test]
    fn holm_multiplies_the_smallest_most_and_keeps_the_order() {
        // By hand: 4 x 0.005, 3 x 0.01, 2 x 0.03, and 1 x 0.04 raised to the one before it.
        let adjusted = holm(&[0.01, 0.04, 0.03, 0.005]);
        let expected = [0.03, 0.06, 0.06, 0.02];
        assert!(adjusted.iter().zip(expected).all(|(a, e)| (a - e).abs() < 1e-15), "{adjusted:?}");
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }

    #[test]
    fn holm_rejects_what_the_procedure_as_it_is_told_rejects() {
        // The procedure: while the smallest p of the m that are left is at most alpha / m, reject it and go on.
        let p: [f64; 8] = [0.013, 0.0004, 0.21, 0.0131, 0.009, 0.05, 0.0004, 0.024];
        for alpha in [0.001, 0.01, 0.05, 0.06, 0.1, 0.25] {
            let mut left: Vec<usize> = (0..p.len()).collect();
            while let Some(at) = (0..left.len()).min_by(|&a, &b| p[left[a]].total_cmp(&p[left[b]]))
                && p[left[at]] <= alpha / left.len() as f64
            {
                left.remove(at);
            }
            let adjusted = holm(&p);
            let kept: Vec<usize> = (0..p.len()).filter(|&i| adjusted[i] > alpha).collect();
            assert_eq!(kept, left, "alpha {alpha}");
        }
    }

    #[test]
    fn the_slope_of_a_power_law_is_its_exponent() {
        let points: Vec<(f64, f64)> = [1.0, 2.0, 5.0, 30.0].map(|x| (x, 3.0 / (x * x * x))).to_vec();
        assert!((power_law_slope(&points).unwrap() + 3.0).abs() < 1e-12);
        // By hand, over ln x = 0, 1, 2: ln y = 0, 0, 3 has the slope (2 - 0) * 3 / 2 / 2.
        let e = std::f64::consts::E;
        let slope = power_law_slope(&[(1.0, 1.0), (e, 1.0), (e * e, e * e * e)]).unwrap();
        assert!((slope - 1.5).abs() < 1e-12);
        assert_eq!(power_law_slope(&[(50.0, 0.1), (50.0, 0.2)]), None);
        assert_eq!(power_law_slope(&[]), None);
    }
}
