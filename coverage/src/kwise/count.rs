//! Counts the different combinations that tests contain.

use rayon::prelude::*;

/// The levels of tests as bits, one bit for each level of each parameter. Only the non-zero words are stored.
struct Bits {
    /// The first bit of each parameter, and the end of the last.
    first: Vec<usize>,
    /// The position of each test's first word, and the end of the last test.
    begin: Vec<usize>,
    words: Vec<(u32, u64)>,
}

impl Bits {
    fn new(levels: &[usize], tests: &[&[usize]]) -> Self {
        let mut first = vec![0];
        first.extend(levels.iter().scan(0, |bits, levels| {
            *bits += levels;
            Some(*bits)
        }));
        let mut words: Vec<(u32, u64)> = Vec::new();
        let mut begin = vec![0];
        for test in tests {
            for (first, level) in first.iter().zip(*test) {
                let (word, bit) = (((first + level) / 64) as u32, 1 << ((first + level) % 64));
                match words[begin[begin.len() - 1]..].last_mut() {
                    Some(last) if last.0 == word => last.1 |= bit,
                    _ => words.push((word, bit)),
                }
            }
            begin.push(words.len());
        }
        Self { first, begin, words }
    }

    /// The number of different levels of the parameters from `next` on that the tests have.
    fn levels_from(&self, next: usize, tests: &[usize], seen: &mut [u64]) -> u64 {
        let start = self.first[next] / 64;
        let first_mask = u64::MAX << (self.first[next] % 64);
        seen[start..].fill(0);
        for &test in tests {
            let words = &self.words[self.begin[test]..self.begin[test + 1]];
            let from = words.partition_point(|&(word, _)| (word as usize) < start);
            words[from..].iter().for_each(|&(word, bits)| seen[word as usize] |= bits);
        }
        seen[start] &= first_mask;
        seen[start..].iter().map(|word| u64::from(word.count_ones())).sum()
    }
}

/// Returns the number of combinations of levels of `k` parameters that the tests contain. The tests must be distinct.
/// For `k = 0` any test contains the empty combination.
pub(super) fn covered(levels: &[usize], k: usize, tests: &[&[usize]]) -> u64 {
    if k == 0 {
        return u64::from(!tests.is_empty());
    }
    let counting = Counting { parameters: levels.len(), tests, bits: Bits::new(levels, tests) };
    let all: Vec<usize> = (0..tests.len()).collect();
    if k == 1 {
        return counting.covered(0, 1, &mut all.clone(), &mut counting.buffer());
    }
    let with_first = |parameter| counting.covered_with(parameter, k, &mut all.clone(), &mut counting.buffer());
    (0..=levels.len() - k).into_par_iter().map(with_first).sum()
}

struct Counting<'a> {
    parameters: usize,
    tests: &'a [&'a [usize]],
    bits: Bits,
}

impl Counting<'_> {
    fn buffer(&self) -> Vec<u64> {
        vec![0; self.bits.first[self.parameters].div_ceil(64)]
    }

    /// The number of combinations of `k` of the parameters from `next` on that the tests contain.
    fn covered(&self, next: usize, k: usize, tests: &mut [usize], seen: &mut [u64]) -> u64 {
        match (tests.len(), k) {
            (0, _) => 0,
            (1, _) => choices((self.parameters - next) as u64, k as u64),
            (_, 1) => self.bits.levels_from(next, tests, seen),
            _ => (next..=self.parameters - k).map(|parameter| self.covered_with(parameter, k, tests, seen)).sum(),
        }
    }

    /// The number of combinations of `k` parameters whose first parameter is `parameter`.
    fn covered_with(&self, parameter: usize, k: usize, tests: &mut [usize], seen: &mut [u64]) -> u64 {
        let level = |test: usize| self.tests[test][parameter];
        tests.sort_unstable_by_key(|&test| level(test));
        let alike = tests.chunk_by_mut(|&a, &b| level(a) == level(b));
        alike.map(|alike| self.covered(parameter + 1, k - 1, alike, seen)).sum()
    }
}

/// n choose k; the numbers that callers need fit in `u64`.
fn choices(n: u64, k: u64) -> u64 {
    (0..k).fold(1, |choices, i| choices * (n - i) / (i + 1))
}
