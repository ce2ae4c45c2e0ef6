//! How many random rows cover the discrete parameters k-wise.
//!
//! The proof of the paper's Proposition 3.2 is a union bound over the combinations that could be missed, rounded to a
//! formula one can remember; here are both, the formula as it is printed and the bound behind it, which also serves
//! parameters with more than two levels, and constraints: rows are then drawn from those tests that keep them, and
//! every combination counts with its own probability.

use paracosm_space::rules::{Rules, UniformTests};
use std::collections::BTreeMap;

/// The number of uniformly random rows of `{0,1}^parameters` that Proposition 3.2 of the paper asks for, to be a
/// k-wise covering family with probability at least `1 - delta`: `2^k (k ln N - ln delta)`, not rounded.
///
/// The formula comes from `ln(1 - 2^-k) <= -2^-k` and `C(N,k) 2^k <= N^k`. The second does not hold for small
/// `N`: at `N = k = 1`, `delta = 0.9` it asks for 0.21, that is for one row, which cannot hold both values.
/// [`RandomRows::family_size`] is the number that can be relied on.
pub fn proposition_3_2(parameters: usize, k: usize, delta: f64) -> f64 {
    let k = k as f64;
    libm::exp2(k) * (k * libm::log(parameters as f64) - libm::log(delta))
}

/// Uniformly random rows, each one of all tests that keep the constraints, and what can be promised of them.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomRows {
    parameters: usize,
    k: usize,
    /// Whether they are rows of the paper's Proposition 3.2: two levels each, and no constraints.
    of_the_paper: bool,
    combinations: Combinations,
}

impl RandomRows {
    /// Random rows that are to have all valid combinations of levels of `k` parameters; none where constraints
    /// entangle too many parameters for probabilities to be known.
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

    /// A probability that is not exceeded: that one of the valid combinations is in none of `rows` rows. It is the
    /// union bound, or 1 where that says nothing:
    ///
    /// ```text
    /// sum over all valid combinations of  (1 - p)^rows,      p = the probability of the combination in one row.
    /// ```
    ///
    /// Without constraints p is 1/P_S for each of the P_S combinations of a set S of k parameters. Where there are
    /// more than 16,384 different p (a hundred parameters, each with another number of levels), or constraints make
    /// more than 1,024 among parameters that they join, these are rounded down, by less than 1 % for each factor of a p.
    /// What does not fit in a float is rounded up, and what fits is exact: a `delta` that is the very sum is kept.
    pub fn missed(&self, rows: u64) -> f64 {
        if rows == 0 {
            return 1.0;
        }
        let missed = |(&odds, &combinations): (&u64, &f64)| {
            product_above(combinations, power_above(complement_above(f64::from_bits(odds)), rows))
        };
        self.combinations.iter().map(missed).fold(0.0, sum_above).min(1.0)
    }

    /// The least number of rows for which the union bound promises all valid combinations with probability at least
    /// `1 - delta`: for which [`RandomRows::missed`] is at most `delta`. `u64::MAX` where the number does not fit.
    ///
    /// # Panics
    /// `delta` is not in `(0, 1)`.
    pub fn union_bound(&self, delta: f64) -> u64 {
        assert!(delta > 0.0 && delta < 1.0, "delta is {delta}, expected a number between 0 and 1");
        // No row covers nothing, so 0 never is enough.
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

    /// How many rows make a k-wise covering family with probability at least `1 - delta`.
    ///
    /// For parameters with two levels each and no constraints this is the paper's [`proposition_3_2`], which users of
    /// the paper expect, though it asks for more than is needed; where it asks for too little it is raised to the
    /// union bound. For anything else, of which the paper says nothing, it is the union bound.
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

/// `1 - 1/odds`, of odds that are at least 1, or the next float above it.
fn complement_above(odds: f64) -> f64 {
    let complement = (odds - 1.0) / odds;
    // What is left of a division that was not exact, and odds too large to take 1 from, are exact in one operation.
    let is_exact = odds - 1.0 + 1.0 == odds && libm::fma(complement, odds, 1.0 - odds) >= 0.0;
    if is_exact { complement } else { complement.next_up().min(1.0) }
}

/// `base` to the power of `exponent`, of numbers from 0 to 1, and not below it: the exact power where it fits.
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

/// The product of numbers that are not negative, or the next float above it.
fn product_above(a: f64, b: f64) -> f64 {
    let product = a * b;
    // Where the product is too small for its remainder to be a float, nobody knows whether it is exact.
    let is_tiny = product < 1e-250 && a > 0.0 && b > 0.0;
    if is_tiny || libm::fma(a, b, -product) > 0.0 { product.next_up() } else { product }
}

/// The sum of two numbers, or the next float above it.
fn sum_above(a: f64, b: f64) -> f64 {
    let sum = a + b;
    // What rounding took away (Knuth's sum of two floats with its remainder).
    let rest = sum - a;
    if (a - (sum - rest)) + (b - rest) > 0.0 { sum.next_up() } else { sum }
}

/// How many combinations there are by their odds, 1 to how many: the bits of floats, which sort as the floats do.
type Combinations = BTreeMap<u64, f64>;

/// The valid combinations of k parameters.
///
/// There may be far more than can be listed, but few different odds: parameter by parameter, and group by group,
/// combinations are counted by size and odds.
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

/// Joins combinations with those of further parameters, of 1, 2, .. of them.
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

/// How many different odds are told apart.
const MOST_ODDS: usize = 1 << 14;

/// The same among parameters that constraints join.
const MOST_ODDS_OF_A_GROUP: usize = 1 << 10;

/// The same combinations with odds rounded up to eight binary digits. What the union bound sums grows with the odds:
/// the bound stays one.
fn rounded_up(combinations: &Combinations) -> Combinations {
    const DROPPED: u64 = (1 << (f64::MANTISSA_DIGITS - 8)) - 1;
    let mut rounded = Combinations::new();
    for (&odds, &combinations) in combinations {
        // A carry out of the digits goes into the exponent, as it should.
        *rounded.entry((odds + DROPPED) & !DROPPED).or_insert(0.0) += combinations;
    }
    rounded
}
