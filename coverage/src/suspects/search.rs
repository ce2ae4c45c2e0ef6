//! Lists suspects without storing them, by a depth-first search over the values of ascending parameters.
//!
//! The tests with a value are a set of bits. The tests with a combination are the intersection of its values' sets. A
//! combination grows while passing tests contain it, and stops if no failing test contains it. So the search only
//! looks at combinations that failing tests contain.

use super::{JudgedTest, Suspect};

/// A receiver of the suspects that a search finds.
pub(super) trait Visitor {
    /// Returns `true` if the visitor needs suspects that have at least `size` values and are in at most `explained`
    /// failing tests.
    fn wants(&self, size: usize, explained: usize) -> bool;

    /// Receives a suspect and the number of failing tests that contain the suspect.
    fn see(&mut self, suspect: Suspect, explained: usize);
}

/// A value of a parameter, with the tests that have the value.
struct Item {
    parameter: usize,
    level: usize,
    failed: Vec<u64>,
    passed: Vec<u64>,
}

/// A search for suspects over the values of failing tests. Values are ordered by parameters, then by levels.
pub(super) struct SuspectSearch {
    size: usize,
    items: Vec<Item>,
    /// The position of the first item of each parameter, and the end of the last parameter's items.
    first: Vec<usize>,
    /// The items of each failing test.
    of_failure: Vec<Vec<usize>>,
    passing: usize,
}

fn zeros(bits: usize) -> Vec<u64> {
    vec![0; bits.div_ceil(64)]
}

fn set(bits: &mut [u64], bit: usize) {
    bits[bit / 64] |= 1 << (bit % 64);
}

pub(super) fn count(bits: &[u64]) -> usize {
    bits.iter().map(|word| word.count_ones() as usize).sum()
}

/// Returns the positions of the set bits in a bit set.
pub(super) fn ones(bits: &[u64]) -> impl Iterator<Item = usize> {
    bits.iter().enumerate().flat_map(|(word, &bits)| {
        let clear_lowest = |bits: &u64| Some(bits & (bits - 1)).filter(|&rest| rest != 0);
        let rest = std::iter::successors(Some(bits).filter(|&bits| bits != 0), clear_lowest);
        rest.map(move |bits| 64 * word + bits.trailing_zeros() as usize)
    })
}

/// Sets `target` to the intersection of `a` and `b`. Returns the number of bits that are set.
fn intersect(target: &mut [u64], a: &[u64], b: &[u64]) -> usize {
    let words = target.iter_mut().zip(a.iter().zip(b));
    words
        .map(|(word, (a, b))| {
            *word = a & b;
            word.count_ones() as usize
        })
        .sum()
}

impl SuspectSearch {
    /// Makes a search for suspects of at most `size` values in the given tests.
    pub fn new<'a>(parameters: usize, size: usize, tests: impl Iterator<Item = &'a JudgedTest>) -> Self {
        let (failing, passing): (Vec<&JudgedTest>, Vec<&JudgedTest>) = tests.partition(|test| test.failed);
        let mut items = Vec::new();
        let mut first = vec![0];
        let mut of_failure = vec![Vec::new(); failing.len()];
        for parameter in 0..parameters {
            let mut levels: Vec<usize> = failing.iter().map(|test| test.levels[parameter]).collect();
            levels.sort_unstable();
            levels.dedup();
            let begin = items.len();
            let item = |&level: &usize| {
                let (failed, passed) = (zeros(failing.len()), zeros(passing.len()));
                Item { parameter, level, failed, passed }
            };
            items.extend(levels.iter().map(item));
            for (failure, test) in failing.iter().enumerate() {
                let place = levels.binary_search(&test.levels[parameter]).expect("the levels are theirs");
                set(&mut items[begin + place].failed, failure);
                of_failure[failure].push(begin + place);
            }
            for (pass, test) in passing.iter().enumerate() {
                if let Ok(place) = levels.binary_search(&test.levels[parameter]) {
                    set(&mut items[begin + place].passed, pass);
                }
            }
            first.push(items.len());
        }
        Self { size, items, first, of_failure, passing: passing.len() }
    }

    /// Returns the set of all failing tests, as bits.
    pub fn failing(&self) -> Vec<u64> {
        let mut all = zeros(self.of_failure.len());
        (0..self.of_failure.len()).for_each(|failure| set(&mut all, failure));
        all
    }

    /// Returns the tests among the given failing tests that contain all given (parameter, level) pairs.
    pub fn containing(&self, failures: &[u64], values: &[(usize, usize)]) -> Vec<u64> {
        let mut containing = failures.to_vec();
        for item in values.iter().map(|&(parameter, level)| self.item(parameter, level)) {
            containing.iter_mut().zip(&item.failed).for_each(|(word, failed)| *word &= failed);
        }
        containing
    }

    fn item(&self, parameter: usize, level: usize) -> &Item {
        let items = &self.items[self.first[parameter]..self.first[parameter + 1]];
        &items[items.binary_search_by_key(&level, |item| item.level).expect("a value of a failing test")]
    }

    /// Returns the suspect that consists of these items.
    fn suspect(&self, items: &[usize]) -> Suspect {
        let items = || items.iter().map(|&item| &self.items[item]);
        let values: Vec<(usize, usize)> = items().map(|item| (item.parameter, item.level)).collect();
        let failures = count(&self.containing(&self.failing(), &values));
        let share = |item: &Item| {
            let (failed, passed) = (count(&item.failed), count(&item.passed));
            (failed + 1) as f64 / (failed + passed + 2) as f64
        };
        let suspicion = items().map(share).sum::<f64>() / values.len() as f64;
        Suspect { values, failures, suspicion }
    }

    /// Calls the visitor with each suspect that at least one of the given failing tests contains.
    pub fn visit(&self, failures: &[u64], visitor: &mut impl Visitor) {
        let mut passing = zeros(self.passing);
        (0..self.passing).for_each(|pass| set(&mut passing, pass));
        let mut sets = vec![(failures.to_vec(), passing)];
        sets.resize_with(self.size + 1, || (zeros(self.of_failure.len()), zeros(self.passing)));
        self.grow(0, &mut Vec::new(), &mut sets, visitor);
    }

    /// Adds an item of a parameter from `from` on. `sets` holds the tests with the chosen items, and room for more.
    fn grow(
        &self,
        from: usize,
        chosen: &mut Vec<usize>,
        sets: &mut [(Vec<u64>, Vec<u64>)],
        visitor: &mut impl Visitor,
    ) {
        for parameter in from..self.first.len() - 1 {
            for item in self.present(parameter, &sets[0].0) {
                let ([before, after, ..], next) = (&mut *sets, &self.items[item]) else { return };
                let explained = intersect(&mut after.0, &before.0, &next.failed);
                if explained == 0 || !visitor.wants(chosen.len() + 1, explained) {
                    continue;
                }
                let passed = intersect(&mut after.1, &before.1, &next.passed);
                chosen.push(item);
                if passed == 0 {
                    if self.is_minimal(chosen) {
                        visitor.see(self.suspect(chosen), explained);
                    }
                } else if chosen.len() < self.size {
                    self.grow(parameter + 1, chosen, &mut sets[1..], visitor);
                }
                chosen.pop();
            }
        }
    }

    /// Returns the items of a parameter that at least one of the failures has; all items of the parameter if this is
    /// faster.
    fn present(&self, parameter: usize, failures: &[u64]) -> Vec<usize> {
        let all = self.first[parameter]..self.first[parameter + 1];
        if all.len() <= count(failures) {
            return all.collect();
        }
        let mut items: Vec<usize> = ones(failures).map(|failure| self.of_failure[failure][parameter]).collect();
        items.sort_unstable();
        items.dedup();
        items
    }

    /// Checks that a passing test contains the items without the first, a passing test contains them without the
    /// second, and so on. It is already known that a passing test contains them without the last.
    fn is_minimal(&self, items: &[usize]) -> bool {
        let together = |without: usize, word: usize| {
            let others = items.iter().enumerate().filter(|(place, _)| *place != without);
            others.fold(u64::MAX, |bits, (_, &item)| bits & self.items[item].passed[word])
        };
        let words = self.passing.div_ceil(64);
        (0..items.len() - 1).all(|without| (0..words).any(|word| together(without, word) != 0))
    }
}
