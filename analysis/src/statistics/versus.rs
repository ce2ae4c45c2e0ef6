//! Compares values with the values of a baseline, in pairs. Lower values are better.

use super::{bootstrap_interval, holm, median_and_quartiles, quantile, signed_rank_p, vargha_delaney};
use serde::Serialize;

/// A comparison of values with the values of a baseline. Each value has a partner in the baseline that was made with
/// the same seed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Versus {
    /// The factor by which the values are larger than the values of the baseline.
    pub ratio: f64,
    /// The 95 % bootstrap interval of the factor by which the values are larger than the baseline's values.
    pub interval: [f64; 2],
    /// The probability that a value is better than a value of the baseline (Vargha and Delaney's A12).
    pub better: f64,
    /// The p-value of Wilcoxon's signed-rank test of the differences of the pairs, two-sided.
    pub p: f64,
    /// The p-value after Holm's correction for all comparisons of the same family.
    pub p_holm: f64,
}

impl Versus {
    /// Compares values with the values of a baseline by the median of the ratios of the pairs. The p-value is not
    /// corrected yet.
    pub fn of_medians(values: &[f64], base: &[f64]) -> Self {
        let ratios: Vec<f64> = values.iter().zip(base).map(|(value, base)| value / base).collect();
        let ratio = median_and_quartiles(&ratios).0;
        Self::of(values, base, ratio, bootstrap_interval(ratios.len(), |drawn| median_of(drawn, &ratios)))
    }

    /// Compares values with the values of a baseline by the ratio of the means. The p-value is not corrected yet.
    pub fn of_means(values: &[f64], base: &[f64]) -> Self {
        let all: Vec<usize> = (0..values.len()).collect();
        let sum = |drawn: &[usize], of: &[f64]| drawn.iter().map(|&index| of[index]).sum::<f64>();
        let ratio = |drawn: &[usize]| sum(drawn, values) / sum(drawn, base);
        Self::of(values, base, ratio(&all), bootstrap_interval(all.len(), ratio))
    }

    fn of(values: &[f64], base: &[f64], ratio: f64, interval: [f64; 2]) -> Self {
        let p = signed_rank_p(&values.iter().zip(base).map(|(value, base)| value - base).collect::<Vec<_>>());
        Self { ratio, interval, better: vargha_delaney(base, values), p, p_holm: p }
    }
}

/// Corrects the p-values of all comparisons of a family by [`holm`].
pub fn correct<'a>(compared: impl Iterator<Item = &'a mut Versus>) {
    let mut compared: Vec<&mut Versus> = compared.collect();
    let p: Vec<f64> = compared.iter().map(|versus| versus.p).collect();
    for (versus, p_holm) in compared.iter_mut().zip(holm(&p)) {
        versus.p_holm = p_holm;
    }
}

/// Returns the median of the values at the given indices.
pub fn median_of(indices: &[usize], values: &[f64]) -> f64 {
    let mut drawn: Vec<f64> = indices.iter().map(|&i| values[i]).collect();
    drawn.sort_unstable_by(f64::total_cmp);
    quantile(&drawn, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_are_of_the_ratios_and_means_are_divided() {
        let (values, base) = ([1.0, 9.0, 2.0], [2.0, 3.0, 2.0]);
        assert_eq!(Versus::of_medians(&values, &base).ratio, 1.0);
        let means = Versus::of_means(&values, &base);
        assert!((means.ratio - 12.0 / 7.0).abs() < 1e-15);
        // All resamples of one pair only are among the 27: the ratios 1/2, 3 and 1 bound every other.
        assert!(means.interval[0] >= 0.5 && means.interval[1] <= 3.0 && means.interval[0] < means.interval[1]);
        // Of the nine pairs 1 is below all three, 2 below 3 and equal to two, 9 below none.
        assert!((means.better - (3.0 + 1.0 + 1.0) / 9.0).abs() < 1e-15);
    }
}
