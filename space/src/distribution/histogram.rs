//! The distribution of a histogram: the density is constant in each bin.

/// The bins of a histogram, written as an edge, a weight, an edge, a weight and so on, up to the last edge.
pub(super) struct Bins<'a>(&'a [f64]);

impl<'a> Bins<'a> {
    /// Returns the bins; `None` if the numbers are not edges in ascending order with weights between them.
    pub fn new(numbers: &'a [f64]) -> Option<Self> {
        let bins = Self(numbers);
        let is_whole = numbers.len() >= 3 && numbers.len() % 2 == 1;
        (is_whole && bins.all().all(|(from, _, to)| from < to)).then_some(bins)
    }

    /// Returns `true` if no weight is below 0, and the sum of the weights is finite and above 0.
    pub fn has_weights(&self) -> bool {
        let sum: f64 = self.all().map(|(_, weight, _)| weight).sum();
        self.all().all(|(_, weight, _)| weight >= 0.0) && sum > 0.0 && sum.is_finite()
    }

    /// Returns the share of the distribution that lies in an interval.
    pub fn share(&self, lo: f64, hi: f64) -> f64 {
        let sum = |bins: &mut dyn Iterator<Item = (f64, f64, f64)>| bins.map(|(_, weight, _)| weight).sum::<f64>();
        sum(&mut self.within(lo, hi)) / sum(&mut self.all())
    }

    /// Returns the number below which a share `u` of the part of the distribution lies that is in an interval. The number
    /// is never within a bin of the weight 0.
    pub fn quantile(&self, lo: f64, hi: f64, u: f64) -> f64 {
        let mut left = u * self.within(lo, hi).map(|(_, weight, _)| weight).sum::<f64>();
        let mut found = lo;
        for (from, weight, to) in self.within(lo, hi).filter(|(_, weight, _)| *weight > 0.0) {
            found = from + (to - from) * (left / weight).clamp(0.0, 1.0);
            if left < weight {
                break;
            }
            left -= weight;
        }
        found
    }

    /// Returns the lower edge, the weight and the upper edge of each bin.
    fn all(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        self.0.windows(3).step_by(2).map(|bin| (bin[0], bin[1], bin[2]))
    }

    /// Returns the parts of the bins that lie in an interval, like [`Self::all`].
    fn within(&self, lo: f64, hi: f64) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let parts = self.all().map(move |(from, weight, to)| {
            let (start, end) = (from.max(lo), to.min(hi));
            (start, weight * ((end - start) / (to - from)), end)
        });
        parts.filter(|(start, _, end)| start < end)
    }
}
