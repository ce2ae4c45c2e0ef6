//! The number of random rows that cover the discrete parameters k-wise.
//!
//! The proof of the paper's Proposition 3.2 is a union bound over the combinations that could be missed, rounded to a
//! simple formula. This module has both: the formula as it is printed, and the bound behind it. The bound also serves
//! parameters with more than two levels, and constraints. Rows are then drawn from the tests that satisfy the
//! constraints, and every combination counts with its own probability.

use paracosm_space::rules::{Rules, UniformTests};
use std::collections::BTreeMap;

/// Returns the number of random rows that contain all combinations of any `k` two-level parameters with probability at
/// least `1 - delta`, by the paper's Proposition 3.2. The rows are uniformly distributed in `{0,1}^parameters`. The
/// number is `2^k (k ln N - ln delta)`, not rounded.
///
/// The formula comes from `ln(1 - 2^-k) <= -2^-k` and `C(N,k) 2^k <= N^k`. The second inequality does not hold for
/// every `N` if `k` is below 4, and the slack of the first inequality often makes up for this. Not always: at
/// `N = k = 1`, `delta = 0.9` the formula asks for 0.21, and one row cannot hold both values. Use
/// [`RandomRows::family_size`] for a number that is always sufficient.
pub fn proposition_3_2(parameters: usize, k: usize, delta: f64) -> f64 {
    let k = k as f64;
    libm::exp2(k) * (k * libm::log(parameters as f64) - libm::log(delta))
}

/// The probabilities that uniformly random rows contain the valid combinations of levels of any k parameters. Rows are
/// drawn from all tests that satisfy the constraints.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomRows {
    parameters: usize,
    k: usize,
    /// `true` if the paper's Proposition 3.2 applies, because all parameters have two levels and there are no
    /// constraints.
    of_the_paper: bool,
    combinations: Combinations,
}

impl RandomRows {
    /// Prepares the probabilities that random rows contain the valid combinations of levels of `k` parameters. Returns
    /// `None` if constraints join too many parameters, so that the probabilities cannot be computed.
    ///
    /// # Panics
    /// `k` is not in 1 to the number of parameters, or a parameter has no level.
    pub fn new(rules: &Rules, k: usize) -> Option<Self> {
        let levels = rules.levels();
        assert!((1..=levels.len()).contains(&k), "k is {k}, expected 1 to {}", levels.len());
        assert!(levels.iter().all(|&v| v > 0), "every parameter needs a level");
        let combinations = combinations(rules, &rules.uniform()?, k);
        let of_the_paper = rules.groups() == 0 && levels.iter().all(|&v| v == 2);
        Some(Self { parameters: levels.len(), k, of_the_paper, combinations })
    }

    /// Returns an upper bound on the probability that `rows` random rows miss at least one valid combination. It is the
    /// union bound, or 1 if the union bound is larger:
    ///
    /// ```text
    /// sum over all valid combinations of  (1 - p)^rows,      p = the probability of the combination in one row.
    /// ```
    ///
    /// Without constraints p is 1/P_S for each of the P_S combinations of a set S of k parameters. The values of p
    /// are rounded down, by less than 1 % for each factor of a p, if there are more than 16,384 different values (a
    /// hundred parameters, each with another number of levels), or if the parameters that constraints join have more
    /// than 1,024 different values. A number that does not fit in a float is rounded up, and a number that fits is
    /// exact: a `delta` that equals the sum is met.
    pub fn missed(&self, rows: u64) -> f64 {
        if rows == 0 {
            return 1.0;
        }
        let missed = |(&odds, &combinations): (&u64, &f64)| {
            product_above(combinations, power_above(complement_above(f64::from_bits(odds)), rows))
        };
        self.combinations.iter().map(missed).fold(0.0, sum_above).min(1.0)
    }

    /// Returns the least number of rows for which [`RandomRows::missed`] is at most `delta`. By the union bound, the
    /// rows then contain all valid combinations with probability at least `1 - delta`. Returns `u64::MAX` if the number
    /// does not fit.
    ///
    /// # Panics
    /// `delta` is not in `(0, 1)`.
    pub fn union_bound(&self, delta: f64) -> u64 {
        assert!(delta > 0.0 && delta < 1.0, "delta is {delta}, expected a number between 0 and 1");
        // Without rows nothing is covered, so 0 is never enough.
        let (mut short, mut long) = (0, 1);
        while self.missed(long) > delta {
            if long == u64::MAX {
                return u64::MAX;
            }
            (short, long) = (long, long.saturating_mul(2));
        }
        while long - short > 1 {
            let middle = short + (long - short) / 2;
            if self.missed(middle) <= delta {
                long = middle;
            } else {
                short = middle;
            }
        }
        long
    }

    /// Returns a number of random rows that contain all valid combinations with probability at least `1 - delta`.
    ///
    /// For parameters with two levels each and no constraints it is the number of the paper's [`proposition_3_2`],
    /// which users of the paper expect, although that is more than needed. If the formula asks for too few rows, the
    /// number is raised to the union bound. In all other cases, which the paper does not treat, it is the union
    /// bound.
    ///
    /// # Panics
    /// As [`RandomRows::union_bound`].
    pub fn family_size(&self, delta: f64) -> u64 {
        let needed = self.union_bound(delta);
        if self.of_the_paper {
            needed.max(proposition_3_2(self.parameters, self.k, delta).ceil() as u64)
        } else {
            needed
        }
    }
}

/// `1 - 1/odds`, or the next float above it; `odds` is at least 1.
fn complement_above(odds: f64) -> f64 {
    let complement = (odds - 1.0) / odds;
    // The remainder of an inexact division is exact in one operation, and so are odds too large to take 1 from.
    let is_exact = odds - 1.0 + 1.0 == odds && libm::fma(complement, odds, 1.0 - odds) >= 0.0;
    if is_exact { complement } else { complement.next_up().min(1.0) }
}

/// An upper bound on `base` to the power of `exponent`, for `base` from 0 to 1: the exact power if it fits.
fn power_above(mut base: f64, mut exponent: u64) -> f64 {
    let mut power = 1.0;
    while exponent > 0 {
        if exponent % 2 == 1 {
            power = product_above(power, base);
        }
        base = product_above(base, base);
        exponent /= 2;
    }
    power
}

/// The product of two non-negative numbers, or the next float above it.
fn product_above(a: f64, b: f64) -> f64 {
    let product = a * b;
    // If the product is so small that its remainder is not a float, it may be inexact.
    let is_tiny = product < 1e-250 && a > 0.0 && b > 0.0;
    if is_tiny || libm::fma(a, b, -product) > 0.0 { product.next_up() } else { product }
}

/// The sum of two numbers, or the next float above it.
fn sum_above(a: f64, b: f64) -> f64 {
    let sum = a + b;
    // The part that rounding took away (Knuth's sum of two floats with its remainder).
    let rest = sum - a;
    if (a - (sum - rest)) + (b - rest) > 0.0 { sum.next_up() } else { sum }
}

/// The number of combinations for each value of the odds `1/p`. The key holds the bits of the odds, which sort as the
/// floats do.
type Combinations = BTreeMap<u64, f64>;

/// Counts the valid combinations of k parameters by their odds.
///
/// There may be far too many to list, but there are few different odds. So combinations are counted by size and odds,
/// parameter by parameter and group by group.
fn combinations(rules: &Rules, tests: &UniformTests, k: usize) -> Combinations {
    let mut by_size = vec![Combinations::new(); k + 1];
    by_size[0].insert(1.0_f64.to_bits(), 1.0);
    let free = rules.levels().iter().enumerate().filter(|&(parameter, _)| rules.group_of(parameter).is_none());
    for (_, &v) in free {
        multiply(&mut by_size, &[Combinations::from([((v as f64).to_bits(), v as f64)])]);
    }
    let mut of_groups = vec![vec![Combinations::new(); k]; rules.groups()];
    tests.combinations(k, &mut |group, alike| {
        let of_size = &mut of_groups[group][alike.parameters - 1];
        *of_size.entry((1.0 / alike.probability).to_bits()).or_insert(0.0) += alike.combinations;
        if of_size.len() > MOST_ODDS {
            *of_size = rounded_up(of_size);
        }
    });
    for of_size in of_groups.iter_mut().flatten().filter(|of_size| of_size.len() > MOST_ODDS_OF_A_GROUP) {
        *of_size = rounded_up(of_size);
    }
    of_groups.iter().for_each(|of_group| multiply(&mut by_size, of_group));
    by_size.swap_remove(k)
}

/// Joins combinations with the combinations of further parameters, which have 1, 2, .. of them.
fn multiply(by_size: &mut [Combinations], further: &[Combinations]) {
    for size in (1..by_size.len()).rev() {
        let (smaller, larger) = by_size.split_at_mut(size);
        for (with, further) in further.iter().enumerate().take(size) {
            for (odds, combinations) in &smaller[size - 1 - with] {
                for (others, many) in further {
                    let odds = f64::from_bits(*odds) * f64::from_bits(*others);
                    *larger[0].entry(odds.to_bits()).or_insert(0.0) += combinations * many;
                }
            }
        }
        if larger[0].len() > MOST_ODDS {
            larger[0] = rounded_up(&larger[0]);
        }
    }
}

/// The largest number of different odds that are told apart.
const MOST_ODDS: usize = 1 << 14;

/// The largest number of different odds that are told apart among the parameters that constraints join.
const MOST_ODDS_OF_A_GROUP: usize = 1 << 10;

/// The same combinations with odds rounded up to eight binary digits. The union bound grows with the odds, so that it
/// stays an upper bound.
fn rounded_up(combinations: &Combinations) -> Combinations {
    const DROPPED: u64 = (1 << (f64::MANTISSA_DIGITS - 8)) - 1;
    let mut rounded = Combinations::new();
    for (&odds, &combinations) in combinations {
        // A carry out of the digits goes into the exponent, as it should.
        *rounded.entry((odds + DROPPED) & !DROPPED).or_insert(0.0) += combinations;
    }
    rounded
}
