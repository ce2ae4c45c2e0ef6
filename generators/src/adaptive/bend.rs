//! How a robustness enters a model: bent, so that a Gaussian process fits.

/// A robustness bent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bend {
    /// In multiples of the spread below the median; above it only its logarithm counts: what is worst need not be known well.
    Low { median: f64, scale: f64 },
    /// Bent alike on both sides of 0, which stays 0.
    Signed { scale: f64 },
    /// Flat beyond what is usual on its side of 0: from -1 to 1, whatever the two sides measure.
    Sides { below: f64, above: f64 },
    /// Nothing but the verdict: -1 or 1.
    Verdict,
}

impl Bend {
    /// For what looks for low values.
    pub(super) fn low(values: &[f64]) -> Self {
        let median = median(values.to_vec());
        Self::Low { median, scale: scale(values.iter().map(|value| (value - median).abs()).collect()) }
    }

    /// For what looks for the sides of 0, from the one that keeps most to the one that keeps least.
    pub(super) fn of_sides(values: &[f64]) -> [Self; 3] {
        let side = |failed: bool| {
            let side = values.iter().filter(|value| is_failure(**value) == failed);
            scale(side.map(|value| value.abs()).collect())
        };
        let signed = Self::Signed { scale: scale(values.iter().map(|value| value.abs()).collect()) };
        [signed, Self::Sides { below: side(true), above: side(false) }, Self::Verdict]
    }

    pub(super) fn apply(self, value: f64) -> f64 {
        match self {
            Self::Low { median, scale } => {
                let z = (value - median) / scale;
                if z > 0.0 { libm::log1p(z) } else { z }
            }
            Self::Signed { scale } => libm::asinh(value / scale),
            Self::Sides { below, above } => libm::tanh(value / if is_failure(value) { below } else { above }),
            Self::Verdict => 1.0_f64.copysign(value),
        }
    }
}

/// Whether a robustness is that of a test that failed: -0 is violated, +0 is not.
pub(super) fn is_failure(robustness: f64) -> bool {
    robustness.is_sign_negative()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median of these, or their mean where that is 0, or 1.
fn scale(values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 1.0;
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    [median(values), mean].into_iter().find(|&scale| scale > 1e-12).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_for_sides_keeps_them_and_their_order() {
        let values = [-7.0, -3.0, -1e-3, -0.0, 0.0, 0.01, 0.3, 0.3, 0.9, 40.0];
        for bend in Bend::of_sides(&values) {
            let bent: Vec<f64> = values.iter().map(|&value| bend.apply(value)).collect();
            assert!(bent.is_sorted(), "{bend:?}: {bent:?}");
            let keeps = |(value, bent): (&f64, &f64)| is_failure(*value) == is_failure(*bent);
            assert!(values.iter().zip(&bent).all(keeps), "{bend:?}: {bent:?}");
        }
    }

    #[test]
    fn without_values_on_a_side_there_are_bends_still() {
        for values in [&[][..], &[1.0, 2.0], &[-0.0], &[0.0, 0.0]] {
            for bend in Bend::of_sides(values) {
                assert!([-1.0, -0.0, 0.0, 1.0].iter().all(|&value| bend.apply(value).is_finite()), "{bend:?}");
            }
        }
    }
}
