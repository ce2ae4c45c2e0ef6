//! Implements McNemar's exact test for pairs of yes and no (McNemar, Note on the sampling error of the difference between
//! correlated proportions or percentages, Psychometrika 12, 1947).

/// Returns the two-sided p-value of McNemar's exact test: of all pairs that differ, `first` differ in one direction and `second` in the
/// other. If both directions are equally likely, the count of one direction has a binomial distribution with the probability 1/2. The
/// p-value is twice its tail, and at most 1.
pub fn mcnemar_p(first: usize, second: usize) -> f64 {
    let (n, least) = (first + second, first.min(second));
    // The logarithm of each binomial coefficient follows from the one before, so that large counts do not overflow.
    let (mut log, mut tail) = (-(n as f64) * std::f64::consts::LN_2, 0.0);
    for i in 0..=least {
        tail += libm::exp(log);
        log += libm::log((n - i) as f64 / (i + 1) as f64);
    }
    (2.0 * tail).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_pairs_are_counted_out() {
        // By hand: of 2^n equally likely outcomes, these are as far from the middle.
        for (first, second, p) in [(0, 0, 1.0), (0, 1, 1.0), (0, 5, 2.0 / 32.0), (1, 5, 14.0 / 64.0), (3, 3, 1.0)] {
            assert!((mcnemar_p(first, second) - p).abs() < 1e-12, "{first} {second}");
            assert_eq!(mcnemar_p(first, second), mcnemar_p(second, first));
        }
    }

    #[test]
    fn many_pairs_do_not_overflow() {
        // Summed up in whole numbers: 2 sum C(10000, i) / 2^10000 for i up to 4900.
        assert!((mcnemar_p(4900, 5100) - 0.046_585_527_704_947).abs() < 1e-9, "{}", mcnemar_p(4900, 5100));
        assert!(mcnemar_p(1, 1999) < 1e-150);
    }
}
