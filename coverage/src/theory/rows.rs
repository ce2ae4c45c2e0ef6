//! How many random rows cover the discrete parameters k-wise.
//!
//! The proof of the paper's Proposition 3.2 is a union bound over the combinations that could be missed, rounded to a
//! formula one can remember; here are both, the formula as it is printed and the bound behind it, which also serves
//! parameters with more than two levels.

use std::collections::BTreeMap;

/// The number of uniformly random rows of `{0,1}^parameters` that Proposition 3.2 of the paper asks for, to be a
/// k-wise covering family with probability at least `1 - delta`: `2^k (k ln N - ln delta)`, not rounded.
///
/// The formula comes from `ln(1 - 2^-k) <= -2^-k` and `C(N,k) 2^k <= N^k`. The second does not hold for small
/// `N`: at `N = k = 1`, `delta = 0.9` it asks for 0.21, that is for one row, which cannot hold both values.
/// [`random_family_size`] is the number that can be relied on.
pub fn proposition_3_2(parameters: usize, k: usize, delta: f64) -> f64 {
    let k = k as f64;
    libm::exp2(k) * (k * libm::log(parameters as f64) - libm::log(delta))
}

/// The least number of uniformly random rows for which the union bound promises a k-wise covering family with
/// probability at least `1 - delta`: the smallest `n` with
///
/// ```text
/// sum over sets S of k parameters of  P_S (1 - 1/P_S)^n  <=  delta,      P_S = prod of the levels in S,
/// ```
///
/// since each of the `P_S` combinations of `S` is in a row with probability `1/P_S`. `u64::MAX` where the number
/// does not fit. Where sets have more than 16,384 different products (a hundred parameters, each with another
/// number of levels), products are rounded up by less than 1 % for each parameter of a set, and the number is
/// as much above the least.
///
/// # Panics
/// `k` is not in `1..=levels.len()`, a parameter has no level, or `delta` is not in `(0, 1)`.
pub fn union_bound(levels: &[usize], k: usize, delta: f64) -> u64 {
    assert!((1..=levels.len()).contains(&k), "k is {k}, expected 1 to {}", levels.len());
    assert!(levels.iter().all(|&v| v > 0), "every parameter needs a level");
    assert!(delta > 0.0 && delta < 1.0, "delta is {delta}, expected a number between 0 and 1");
    let sets = sets_by_product(levels, k);
    let enough = |n: u64| {
        let missed = |(&product, &sets): (&u128, &f64)| {
            let product = product as f64;
            // log1p(-1) is -inf: a set with one combination is covered by the first row.
            sets * product * libm::exp(n as f64 * libm::log1p(-1.0 / product))
        };
        sets.iter().map(missed).sum::<f64>() <= delta
    };
    // No row covers nothing, so 0 never is enough.
    let (mut short, mut long) = (0, 1);
    while !enough(long) {
        if long == u64::MAX {
            return u64::MAX;
        }
        (short, long) = (long, long.saturating_mul(2));
    }
    while long - short > 1 {
        let middle = short + (long - short) / 2;
        if enough(middle) {
            long = middle;
        } else {
            short = middle;
        }
    }
    long
}

/// How many uniformly random rows make a k-wise covering family with probability at least `1 - delta`.
///
/// For parameters with two levels each this is the paper's [`proposition_3_2`], which users of the paper
/// expect, though it asks for more than is needed; where it asks for too little it is raised to the
/// [`union_bound`]. For any other levels, of which the paper says nothing, it is the union bound.
///
/// # Panics
/// As [`union_bound`].
pub fn random_family_size(levels: &[usize], k: usize, delta: f64) -> u64 {
    let needed = union_bound(levels, k, delta);
    if levels.iter().all(|&v| v == 2) {
        needed.max(proposition_3_2(levels.len(), k, delta).ceil() as u64)
    } else {
        needed
    }
}

/// The number of sets of k parameters by the number of combinations of their levels.
///
/// There may be far more sets than can be listed, but few different products: parameter by parameter, sets are
/// counted by size and product. Products saturate; as many rows could not be counted either.
fn sets_by_product(levels: &[usize], k: usize) -> BTreeMap<u128, f64> {
    let mut by_size = vec![BTreeMap::new(); k + 1];
    by_size[0].insert(1u128, 1.0);
    for &v in levels {
        for size in (1..=k).rev() {
            let (smaller, larger) = by_size.split_at_mut(size);
            for (product, sets) in &smaller[size - 1] {
                *larger[0].entry(product.saturating_mul(v as u128)).or_insert(0.0) += sets;
            }
            if larger[0].len() > MOST_PRODUCTS {
                larger[0] = rounded_up(&larger[0]);
            }
        }
    }
    by_size.swap_remove(k)
}

/// How many different products are told apart.
const MOST_PRODUCTS: usize = 1 << 14;

/// The same sets with products rounded up to eight binary digits, of which there are fewer than
/// [`MOST_PRODUCTS`]. What the union bound sums grows with the product: the bound stays one.
fn rounded_up(sets_by_product: &BTreeMap<u128, f64>) -> BTreeMap<u128, f64> {
    let mut rounded = BTreeMap::new();
    for (&product, sets) in sets_by_product {
        let dropped = (u128::BITS - product.leading_zeros()).saturating_sub(8);
        let up = product.div_ceil(1 << dropped).saturating_mul(1 << dropped);
        *rounded.entry(up).or_insert(0.0) += sets;
    }
    rounded
}
