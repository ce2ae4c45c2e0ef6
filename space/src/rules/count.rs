//! Counts the valid combinations of levels without listing them.
//!
//! Groups do not restrict each other. So the numbers of valid combinations are the coefficients of a product of
//! polynomials, one for each group and each free parameter. If the sum is replaced by the maximum, the same product
//! gives the largest number of valid combinations of any k parameters.

use super::Rules;
use super::group::Group;

/// The numbers of valid combinations of levels of k parameters. Numbers beyond `u128` become `u128::MAX`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TupleCount {
    /// The number of valid combinations of levels, added up over all choices of k parameters.
    pub valid: u128,
    /// The greatest number of valid combinations of levels that any k parameters have. A test has only one of these
    /// combinations, so at least this many tests are needed to cover all.
    pub largest: u128,
}

/// Counts for each number of parameters, from 0.
type Counts = Vec<TupleCount>;

impl Rules {
    /// Counts the valid combinations of levels of any `k` of the given parameters.
    ///
    /// # Panics
    /// A parameter does not exist.
    pub fn count(&self, parameters: &[usize], k: usize) -> TupleCount {
        let nothing = TupleCount { valid: 0, largest: 0 };
        let mut counts: Counts = vec![nothing; k + 1];
        counts[0] = TupleCount { valid: 1, largest: 1 };
        for &parameter in parameters.iter().filter(|&&parameter| self.group_of(parameter).is_none()) {
            let levels = self.levels[parameter] as u128;
            multiply(&mut counts, &[counts_of(1), counts_of(levels)]);
        }
        for group in self.groups.iter() {
            let places: Vec<usize> = parameters.iter().filter_map(|&parameter| group.place(parameter)).collect();
            if !places.is_empty() {
                multiply(&mut counts, &group_counts(group, &places, k.min(places.len())));
            }
        }
        counts[k]
    }

    /// Counts the tests that keep all constraints. `None` if a group of parameters is too entangled to be counted.
    pub fn tests(&self) -> Option<f64> {
        let free = (0..self.levels.len()).filter(|&parameter| self.group_of(parameter).is_none());
        let free: f64 = free.map(|parameter| self.levels[parameter] as f64).product();
        self.groups.iter().try_fold(free, |tests, group| Some(tests * group.tests()?))
    }
}

fn counts_of(count: u128) -> TupleCount {
    TupleCount { valid: count, largest: count }
}

fn multiply(counts: &mut Counts, factor: &[TupleCount]) {
    for size in (0..counts.len()).rev() {
        let mut product = TupleCount { valid: 0, largest: 0 };
        for (inside, factor) in factor.iter().enumerate().take(size + 1) {
            let outside = counts[size - inside];
            product.valid = product.valid.saturating_add(outside.valid.saturating_mul(factor.valid));
            product.largest = product.largest.max(outside.largest.saturating_mul(factor.largest));
        }
        counts[size] = product;
    }
}

/// Counts the valid combinations of up to `k` of these members of a group.
fn group_counts(group: &Group, places: &[usize], k: usize) -> Counts {
    let mut places = places.to_vec();
    places.sort_unstable();
    let mut counts = vec![TupleCount { valid: 0, largest: 0 }; k + 1];
    counts[0] = counts_of(1);
    let mut fixed = vec![None; group.members().len()];
    let mut heads = Vec::new();
    count_heads(group, &places, k, &mut heads, &mut fixed, &mut counts);
    counts
}

/// Visits the sets of fewer than `k` places. For each set, counts the valid combinations with one more place.
fn count_heads(
    group: &Group,
    places: &[usize],
    k: usize,
    heads: &mut Vec<usize>,
    fixed: &mut [Option<usize>],
    counts: &mut Counts,
) {
    if heads.len() == k || places.is_empty() {
        return;
    }
    let mut with = vec![0u128; fixed.len()];
    count_classes(group, places, heads, fixed, 1, &mut with);
    for &place in places {
        let count = &mut counts[heads.len() + 1];
        count.valid = count.valid.saturating_add(with[place]);
        count.largest = count.largest.max(with[place]);
    }
    for (i, &place) in places.iter().enumerate() {
        heads.push(place);
        count_heads(group, &places[i + 1..], k, heads, fixed, counts);
        heads.pop();
    }
}

/// For every later place, counts the valid combinations of the heads with one of its levels.
fn count_classes(
    group: &Group,
    later: &[usize],
    heads: &[usize],
    fixed: &mut [Option<usize>],
    weight: u128,
    with: &mut [u128],
) {
    let supported = group.supported_classes(fixed);
    let weights = |place: usize| {
        let classes = supported[place].iter().zip(&group.sizes[place]).enumerate();
        classes.filter(|(_, (supported, _))| **supported).map(|(class, (_, &size))| (class, size as u128))
    };
    let Some((&head, heads)) = heads.split_first() else {
        for &place in later {
            let levels: u128 = weights(place).map(|(_, size)| size).sum();
            with[place] = with[place].saturating_add(weight.saturating_mul(levels));
        }
        return;
    };
    for (class, size) in weights(head) {
        fixed[head] = Some(class);
        count_classes(group, later, heads, fixed, weight.saturating_mul(size), with);
    }
    fixed[head] = None;
}
