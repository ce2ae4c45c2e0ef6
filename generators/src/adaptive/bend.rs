//! Transforms a robustness ("bends" it) so that a Gaussian process fits it.

/// A transformation of robustness values, so that a Gaussian process fits the values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bend {
    /// A linear scale below the median and a logarithmic scale above the median. The worst values need not be known
    /// well.
    Low { median: f64, scale: f64 },
    /// A scale that is logarithmic for large values on both sides of 0, and maps 0 to 0.
    Signed { scale: f64 },
    /// A scale from -1 to 1 that is flat beyond the usual values on each side of 0, with a separate unit for each side.
    Sides { below: f64, above: f64 },
    /// The verdict without the amount of the robustness, which is -1 for a failure and 1 for a pass.
    Verdict,
}

impl Bend {
    /// Makes the transformation of robustness values for a search for low values.
    pub(super) fn low(values: &[f64]) -> Self {
        let median = median(values.to_vec());
        Self::Low { median, scale: scale(values.iter().map(|value| (value - median).abs()).collect()) }
    }

    /// Makes three transformations of robustness values for a model of the sides of 0. The first transformation keeps
    /// most of the values, the last keeps least.
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

/// Returns `true` if a test with the given robustness failed. The robustness -0 is a failure, +0 is a pass.
pub(super) fn is_failure(robustness: f64) -> bool {
    robustness.is_sign_negative()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median of the values; if it is 0 their mean, and if that is 0 too, 1.
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
