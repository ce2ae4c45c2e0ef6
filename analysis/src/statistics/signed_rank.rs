//! Implements Wilcoxon's signed-rank test for pairs (Individual comparisons by ranking methods, Biometrics Bulletin
//! 1, 1945).
//!
//! Differences of 0 are dropped, as Wilcoxon did; equal absolute differences share the mean of their ranks. If the
//! pairs do not differ, every choice of signs is equally likely, given the ranks. So the exact distribution of the
//! sum of the positive ranks can be counted, even if ranks are shared, because twice a shared rank is a whole number
//! (Lehmann, Nonparametrics, 1975, chapter 3).

/// The greatest number of differences for which the exact distribution of the rank sum is counted. For more
/// differences, it is approximated.
pub const MOST_EXACT: usize = 50;

/// Returns the two-sided p-value of Wilcoxon's test of the hypothesis that the differences are symmetric around 0. It
/// is exact up to [`MOST_EXACT`] differences that are not 0. Beyond, it uses the normal approximation with corrections
/// for ties and for continuity (Hollander, Wolfe and Chicken, Nonparametric Statistical Methods, 2014, section 3.1). It
/// is 1 if all differences are 0.
pub fn signed_rank_p(differences: &[f64]) -> f64 {
    let mut different: Vec<f64> = differences.iter().copied().filter(|difference| *difference != 0.0).collect();
    different.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let ranks = doubled_ranks(&different);
    let signed = different.iter().zip(&ranks);
    let positive: usize = signed.filter(|(difference, _)| **difference > 0.0).map(|(_, rank)| rank).sum();
    let total: usize = ranks.iter().sum();
    let smaller = positive.min(total - positive);
    let one_sided = if ranks.len() <= MOST_EXACT { exact_tail(&ranks, smaller) } else { normal_tail(&ranks, smaller) };
    (2.0 * one_sided).min(1.0)
}

/// Returns twice the rank of each difference, from differences sorted by absolute value; equal ones share the mean.
fn doubled_ranks(sorted: &[f64]) -> Vec<usize> {
    let mut ranks = Vec::with_capacity(sorted.len());
    for equal in sorted.chunk_by(|a, b| a.abs() == b.abs()) {
        // The first of the equal differences has the rank len + 1, the last has len + equal.
        let doubled = 2 * ranks.len() + equal.len() + 1;
        ranks.extend(std::iter::repeat_n(doubled, equal.len()));
    }
    ranks
}

/// Returns the probability that a sum of ranks with random signs is at most `sum`.
fn exact_tail(ranks: &[usize], sum: usize) -> f64 {
    // The number of choices of signs that give each sum: at most 2^50, which a double holds exactly.
    let mut choices = vec![0.0; sum + 1];
    choices[0] = 1.0;
    for rank in ranks {
        for at in (*rank..=sum).rev() {
            choices[at] += choices[at - rank];
        }
    }
    choices.iter().sum::<f64>() / libm::exp2(ranks.len() as f64)
}

/// Returns the same probability as [`exact_tail`] by the normal approximation. The ranks and the sum are doubled.
fn normal_tail(ranks: &[usize], sum: usize) -> f64 {
    // With shared ranks, the sum of their squares is n (n + 1) (2n + 1) / 6 with the correction for ties.
    let (total, squares) = ranks.iter().map(|&r| r as f64).fold((0.0, 0.0), |(t, s), r| (t + r, s + r * r));
    let (mean, deviation) = (total / 2.0, (squares / 4.0).sqrt());
    let z = (sum as f64 + 1.0 - mean) / deviation;
    0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected}");
    }

    #[test]
    fn the_heights_of_darwins_maize_differ_as_published() {
        // Darwin's pairs of crossed and self-fertilised plants (Fisher, The Design of Experiments, 1935), in eighths of
        // an inch. The ranks 10 and 14 are negative: 2 x 676 of 2^15 choices of signs have sums of at most 24.
        let eighths = [49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48];
        close(signed_rank_p(&eighths.map(f64::from)), 0.041_259_765_625, 1e-15);
    }

    #[test]
    fn the_depression_scale_of_hollander_and_wolfe_has_its_published_p() {
        // Hollander and Wolfe, Nonparametric Statistical Methods, table 3.1; one-sided 0.0195 in the book.
        // Thousandths of the scale before and after a tranquilliser.
        let first = [1830, 500, 1620, 2480, 1680, 1880, 1550, 3060, 1300];
        let second = [878, 647, 598, 2050, 1060, 1290, 1060, 3140, 1290];
        let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| f64::from(a - b)).collect();
        close(signed_rank_p(&differences) / 2.0, 10.0 / 512.0, 1e-15);
    }

    #[test]
    fn small_cases_are_as_worked_out_by_hand() {
        assert_eq!(signed_rank_p(&[]), 1.0);
        assert_eq!(signed_rank_p(&[0.0, 0.0]), 1.0);
        assert_eq!(signed_rank_p(&[3.0]), 1.0);
        // All five positive: one of 2^5 choices on either side, whatever zeros there are.
        assert_eq!(signed_rank_p(&[1.0, 2.0, 0.0, 3.0, 4.0, 5.0]), 2.0 / 32.0);
        // -1 2 3: sums of at most 1 are two of 8 choices.
        assert_eq!(signed_rank_p(&[-1.0, 2.0, 3.0]), 0.5);
    }

    /// The distribution by listing all choices of signs, with mean ranks by counting.
    fn by_enumeration(differences: &[f64]) -> f64 {
        let d: Vec<f64> = differences.iter().copied().filter(|d| *d != 0.0).collect();
        let rank = |x: &f64| {
            let below = d.iter().filter(|y| y.abs() < x.abs()).count() as f64;
            let equal = d.iter().filter(|y| y.abs() == x.abs()).count() as f64;
            below + (equal + 1.0) / 2.0
        };
        let ranks: Vec<f64> = d.iter().map(rank).collect();
        let middle = ranks.iter().sum::<f64>() / 2.0;
        let sum =
            |positive: &dyn Fn(usize) -> bool| (0..d.len()).filter(|i| positive(*i)).map(|i| ranks[i]).sum::<f64>();
        let found = (sum(&|i| d[i] > 0.0) - middle).abs();
        let choices = 1_u32 << d.len();
        let as_far = (0..choices).filter(|signs| (sum(&|i| signs >> i & 1 == 1) - middle).abs() >= found).count();
        as_far as f64 / f64::from(choices)
    }

    proptest! {
        #[test]
        fn the_exact_p_is_the_share_of_all_choices_of_signs(whole in prop::collection::vec(-6_i32..=6, 0..12)) {
            let differences: Vec<f64> = whole.iter().map(|&d| f64::from(d)).collect();
            prop_assert!((signed_rank_p(&differences) - by_enumeration(&differences)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_approximation_agrees_with_the_exact_distribution_where_they_meet() {
        for shift in [0.0, 4.0, 8.0, 14.0] {
            // 50 differences in an irregular order, some of them equal.
            let differences: Vec<f64> = (0..50).map(|i| f64::from(i * 17 % 41 - 20) + shift).collect();
            let different: Vec<f64> = differences.iter().copied().filter(|d| *d != 0.0).collect();
            let mut sorted = different.clone();
            sorted.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
            let ranks = doubled_ranks(&sorted);
            let positive: usize = sorted.iter().zip(&ranks).filter(|(d, _)| **d > 0.0).map(|(_, r)| r).sum();
            let smaller = positive.min(ranks.iter().sum::<usize>() - positive);
            close(normal_tail(&ranks, smaller), exact_tail(&ranks, smaller), 2e-3);
        }
        // 60 differences 1 to 60, every third negative: W- = 3 + 6 + ... + 60 = 630, of mean 915 and variance
        // 60 x 61 x 121 / 24 = 18452.5; z = (630.5 - 915) / 135.84 = -2.0944, twice the tail 0.03623.
        let differences: Vec<f64> = (1..=60).map(|i| if i % 3 == 0 { -f64::from(i) } else { f64::from(i) }).collect();
        close(signed_rank_p(&differences), 0.036_23, 2e-5);
    }
}
