//! Computes rank correlations.

/// Returns Spearman's rank correlation, which is Pearson's correlation of the ranks, where equal values share the
/// mean of their ranks (The proof and measurement of association between two things, Am. J. Psychol. 15, 1904).
/// `None` if a side does not vary.
///
/// # Panics
/// `x` and `y` have different lengths.
pub fn spearman(x: &[f64], y: &[f64]) -> Option<f64> {
    assert_eq!(x.len(), y.len(), "pairs have two sides");
    let (x, y) = (ranks(x), ranks(y));
    // Shared ranks do not change the mean rank.
    let middle = (x.len() + 1) as f64 / 2.0;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum::<f64>();
    let spread = product(&x, &x) * product(&y, &y);
    (spread > 0.0).then(|| (product(&x, &y) / spread.sqrt()).clamp(-1.0, 1.0))
}

/// Returns the rank of each value, from 1.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut before = 0;
    for equal in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let shared = before as f64 + (equal.len() + 1) as f64 / 2.0;
        equal.iter().for_each(|&index| ranks[index] = shared);
        before += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ranks_without_ties_give_the_textbook_formula() {
        // 1 - 6 sum d^2 / (n (n^2 - 1)).
        let rho = spearman(&[10.0, 20.0, 30.0, 40.0, 50.0], &[2.0, 2.5, 9.0, 3.0, 2.2]).unwrap();
        // Ranks of y: 1 3 5 4 2, so d = 0 1 2 0 3 and the sum of squares is 14.
        assert!((rho - (1.0 - 6.0 * 14.0 / 120.0)).abs() < 1e-12, "{rho}");
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[5.0, 4.0, -1.0]), Some(-1.0));
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[7.0, 7.0, 7.0]), None);
        assert_eq!(spearman(&[], &[]), None);
    }

    /// Pearson's correlation of ranks that are counted one by one.
    fn naive(x: &[f64], y: &[f64]) -> f64 {
        let rank = |values: &[f64], v: f64| {
            let below = values.iter().filter(|w| **w < v).count() as f64;
            below + (values.iter().filter(|w| **w == v).count() as f64 + 1.0) / 2.0
        };
        let of = |values: &[f64]| -> Vec<f64> { values.iter().map(|&v| rank(values, v)).collect() };
        let (a, b) = (of(x), of(y));
        let n = a.len() as f64;
        let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
        let cov = |v: &[f64], w: &[f64]| v.iter().zip(w).map(|(s, t)| s * t).sum::<f64>() / n - mean(v) * mean(w);
        cov(&a, &b) / (cov(&a, &a) * cov(&b, &b)).sqrt()
    }

    proptest! {
        #[test]
        fn it_is_the_correlation_of_ranks_that_are_counted(pairs in prop::collection::vec((0_i8..8, -3_i8..9), 2..40)) {
            let (x, y): (Vec<f64>, Vec<f64>) = pairs.iter().map(|&(a, b)| (f64::from(a), f64::from(b))).unzip();
            let expected = naive(&x, &y);
            match spearman(&x, &y) {
                Some(rho) => prop_assert!((rho - expected).abs() < 1e-9, "{} {}", rho, expected),
                None => prop_assert!(x.iter().all(|v| *v == x[0]) || y.iter().all(|v| *v == y[0])),
            }
        }
    }
}
