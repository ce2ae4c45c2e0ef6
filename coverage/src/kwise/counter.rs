//! Keeps k-wise coverage up to date while tests arrive.

use super::{KwiseError, advance, check, valid};
use paracosm_space::rules::Rules;

/// The largest number of words that the bits of a counter may take: 64 mebibytes.
const MOST_WORDS: u128 = 1 << 23;

/// A counter of the valid combinations of levels of k parameters that the added tests contain.
///
/// Each combination of levels of k - 1 parameters has a bit for every level of every later parameter.
#[derive(Debug, Clone)]
pub struct KwiseCounter {
    rules: Rules,
    /// The parameters that are counted, in ascending order. `levels` has their numbers of levels.
    members: Vec<usize>,
    levels: Vec<usize>,
    k: usize,
    valid: u64,
    covered: u64,
    tests: usize,
    /// The position of the first bit of each member's levels, and the end of the last member's bits.
    first: Vec<usize>,
    seen: Vec<u64>,
}

impl KwiseCounter {
    /// Makes a counter of the valid combinations of levels of `k` parameters, without any test.
    ///
    /// # Errors
    /// `k` is 0 or more than the number of parameters, a parameter has no level, or there are too many combinations:
    /// their bits would take more than 64 MiB.
    pub fn new(rules: &Rules, k: usize) -> Result<Self, KwiseError> {
        let all: Vec<usize> = (0..rules.levels().len()).collect();
        Self::among(rules, &all, k)
    }

    /// Makes a counter of the valid combinations of levels of `k` parameters out of the given parameters, without any
    /// test. The given parameters are in ascending order.
    ///
    /// # Errors
    /// The same errors as [`KwiseCounter::new`].
    ///
    /// # Panics
    /// A given parameter does not exist.
    pub fn among(rules: &Rules, parameters: &[usize], k: usize) -> Result<Self, KwiseError> {
        if k == 0 {
            return Err(KwiseError::Strength { k, parameters: parameters.len() });
        }
        let valid = valid(rules, parameters, k)?;
        let members = parameters.to_vec();
        let levels: Vec<usize> = members.iter().map(|&member| rules.levels()[member]).collect();
        let mut first = vec![0];
        first.extend(levels.iter().scan(0, |bits, levels| {
            *bits += levels;
            Some(*bits)
        }));
        let (rules, seen) = (rules.clone(), Vec::new());
        let mut counter = Self { rules, members, levels, k, valid, covered: 0, tests: 0, first, seen };
        let mut words = 0u128;
        counter.each_head(|set, (begin, end)| {
            let heads = set.iter().fold(1u128, |heads, &place| heads.saturating_mul(counter.levels[place] as u128));
            words = words.saturating_add(heads.saturating_mul((end - begin) as u128));
        });
        if words > MOST_WORDS {
            return Err(KwiseError::Memory { k, mebibytes: words.div_ceil(1 << 17) });
        }
        counter.seen = vec![0; words as usize];
        Ok(counter)
    }

    /// Calls `call` for each choice of k - 1 members that have a later member, with the places of the chosen members
    /// and the range of words of the later members' bits.
    fn each_head(&self, mut call: impl FnMut(&[usize], (usize, usize))) {
        let parameters = self.members.len();
        let mut set: Vec<usize> = (0..self.k - 1).collect();
        loop {
            let next = set.last().map_or(0, |last| last + 1);
            if next < parameters {
                call(&set, (self.first[next] / 64, self.first[parameters].div_ceil(64)));
            }
            if !advance(&mut set, parameters) {
                return;
            }
        }
    }

    /// Calls `call` for each word of `seen` that holds combinations of the test, with the position of the word and the
    /// test's bits in the word.
    fn each_word(&self, test: &[usize], mut call: impl FnMut(usize, u64)) {
        let test: Vec<usize> = self.members.iter().map(|&member| test[member]).collect();
        let mut bits = vec![0u64; self.first[test.len()].div_ceil(64)];
        for (first, level) in self.first.iter().zip(&test) {
            bits[(first + level) / 64] |= 1 << ((first + level) % 64);
        }
        let levels = &self.levels;
        let mut start = 0;
        self.each_head(|set, (begin, end)| {
            let words = end - begin;
            let (head, heads) =
                set.iter().fold((0, 1), |(head, heads), &p| (head * levels[p] + test[p], heads * levels[p]));
            let next = set.last().map_or(0, |last| last + 1);
            let at = start + head * words;
            call(at, bits[begin] & u64::MAX << (self.first[next] % 64));
            (1..words).for_each(|i| call(at + i, bits[begin + i]));
            start += heads * words;
        });
    }

    /// Returns the number of valid combinations that a test contains and no added test contains; 0 for a test that
    /// violates a constraint.
    ///
    /// # Errors
    /// The test does not belong to this space.
    pub fn gain(&self, test: &[usize]) -> Result<u64, KwiseError> {
        check(self.rules.levels(), self.tests, test)?;
        let mut gain = 0;
        if self.rules.allows(test) {
            self.each_word(test, |word, bits| gain += u64::from((bits & !self.seen[word]).count_ones()));
        }
        Ok(gain)
    }

    /// Adds a test, and returns the number of valid combinations that no earlier test contains. A test that violates a
    /// constraint covers no combination.
    ///
    /// # Errors
    /// The test does not belong to this space.
    pub fn add(&mut self, test: &[usize]) -> Result<u64, KwiseError> {
        check(self.rules.levels(), self.tests, test)?;
        self.tests += 1;
        let before = self.covered;
        if self.rules.allows(test) {
            let mut seen = std::mem::take(&mut self.seen);
            let mut new = 0;
            self.each_word(test, |word, bits| {
                new += u64::from((bits & !seen[word]).count_ones());
                seen[word] |= bits;
            });
            self.seen = seen;
            self.covered += new;
        }
        Ok(self.covered - before)
    }

    /// Returns the number of all valid combinations, covered or not.
    pub fn valid(&self) -> u64 {
        self.valid
    }

    /// Returns the number of valid combinations that at least one added test contains.
    pub fn covered(&self) -> u64 {
        self.covered
    }
}
