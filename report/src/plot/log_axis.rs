//! A logarithmic axis: equal factors have equal lengths.

use super::map::round_step;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::{Range, RangeInclusive};

/// A logarithmic axis with the numbers written along it.
#[derive(Debug, Clone)]
pub(super) struct Log {
    pub lo: f64,
    pub hi: f64,
    numbers: Vec<f64>,
}

impl Log {
    /// Makes a logarithmic axis over the given values, which are also the numbers along it. `room` is the share of the
    /// axis left free at each end.
    pub fn over(sizes: &[f64], room: f64) -> Self {
        let (least, most) = (sizes[0], sizes[sizes.len() - 1]);
        let mut axis = Self::from_to(least, most, room);
        axis.numbers.clear();
        for size in sizes {
            // A number too close to the one before would be printed over it.
            if axis.numbers.last().is_none_or(|before| axis.share(*size) - axis.share(*before) > 0.075) {
                axis.numbers.push(*size);
            }
        }
        axis
    }

    /// Makes a logarithmic axis from the least to the greatest value, with round numbers between. `room` is the share
    /// of the axis left free at each end.
    pub fn from_to(least: f64, most: f64, room: f64) -> Self {
        // A single value stands in the middle.
        let widened = if most > least { (least, most) } else { (least / 2.0, most * 2.0) };
        let margin = libm::pow(widened.1 / widened.0, room / (1.0 - 2.0 * room));
        let (lo, hi) = (widened.0 / margin, widened.1 * margin);
        Self { lo, hi, numbers: round_numbers(lo, hi) }
    }

    /// Returns the position of a value along the axis, from 0 at the lower end to 1 at the upper end.
    fn share(&self, value: f64) -> f64 {
        libm::log(value / self.lo) / libm::log(self.hi / self.lo)
    }

    /// Returns the value whose position is a share of the axis above the position of the given value.
    pub fn moved(&self, value: f64, share: f64) -> f64 {
        value * libm::pow(self.hi / self.lo, share)
    }

    /// Returns the least distance between two neighbouring numbers along the axis, as a share of the axis.
    pub fn least_gap(&self) -> f64 {
        let gaps = self.numbers.windows(2).map(|pair| self.share(pair[1]) - self.share(pair[0]));
        gaps.fold(1.0, f64::min)
    }
}

/// Returns round numbers for an axis, at least four but not too many to be read. They are powers of ten if they are
/// enough, otherwise some numbers between them as well, or even steps if the ends are not far apart.
fn round_numbers(lo: f64, hi: f64) -> Vec<f64> {
    const ENOUGH: RangeInclusive<usize> = 4..=9;
    let powers = libm::floor(libm::log10(lo)) as i32..=libm::ceil(libm::log10(hi)) as i32;
    for digits in [[1.0].as_slice(), &[1.0, 2.0, 5.0], &[1.0, 2.0, 3.0, 5.0], &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]] {
        let all =
            powers.clone().flat_map(|power| digits.iter().map(move |digit| digit * libm::exp10(f64::from(power))));
        let inside: Vec<f64> = all.filter(|number| (lo..=hi).contains(number)).collect();
        if ENOUGH.contains(&inside.len()) {
            return inside;
        }
    }
    let step = round_step((hi - lo) / *ENOUGH.end() as f64);
    let (first, last) = ((lo / step).ceil() as i64, (hi / step).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

impl Ranged for Log {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        limit.0 + (self.share(*value) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        // Lines between the numbers would only be in the way.
        if hint.max_num_points() == 0 { Vec::new() } else { self.numbers.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.lo..self.hi
    }
}

impl ValueFormatter<f64> for Log {
    fn format(value: &f64) -> String {
        if *value < 1e-4 || *value >= 1e6 {
            return format!("{value:.1e}").replace(".0e", "e");
        }
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_on_a_logarithmic_axis_are_round_and_few() {
        let text = |lo, hi| round_numbers(lo, hi).iter().map(Log::format).collect::<Vec<_>>().join(" ");
        assert_eq!(text(0.009, 0.11), "0.01 0.02 0.05 0.1");
        assert_eq!(text(0.3, 4.0), "0.3 0.5 1 2 3");
        assert_eq!(text(0.00002, 30.0), "0.0001 0.001 0.01 0.1 1 10");
        assert_eq!(text(0.95, 1.25), "0.95 1 1.05 1.1 1.15 1.2 1.25");
    }

    #[test]
    fn equal_factors_are_equal_lengths() {
        let axis = Log::over(&[50.0, 100.0, 200.0], 0.1);
        let at = [50.0, 100.0, 200.0].map(|size| axis.map(&size, (0, 1000)));
        assert_eq!(at, [100, 500, 900]);
        assert_eq!(axis.map(&axis.moved(50.0, 0.4), (0, 1000)), 500);
        assert_eq!(Log::over(&[50.0], 0.1).map(&50.0, (0, 1000)), 500);
    }
}
