//! Computes one temporal operator from the values of its operand, in the order of their ticks.

use crate::core::Sight;
use crate::fold::{Fold, Window, suffixes};
use crate::ticks::FOREVER;
use std::collections::VecDeque;

/// The values in sight, in the form in which they are stored.
#[derive(Debug, Clone)]
enum Seen<T> {
    /// A single fold of the values in sight. The operator sees all values before it, or only its first tick is needed.
    All(T),
    /// A window over the last values.
    Last(Window<T>),
    /// All values so far, until the end of the trace is known.
    Kept(Vec<T>),
}

/// A fold over the ticks in sight, for each tick.
#[derive(Debug, Clone)]
pub(super) struct Scan<T> {
    past: bool,
    start: usize,
    /// The number of values in sight, less one.
    span: usize,
    /// The number of results that are needed.
    needed: usize,
    values: usize,
    results: usize,
    /// The values that an operator of the past does not see yet.
    delayed: VecDeque<T>,
    seen: Seen<T>,
}

impl<T: Fold> Scan<T> {
    pub fn new(start: usize, sight: Sight, needed: usize) -> Self {
        let span = sight.end - start;
        let unbounded = sight.end >= FOREVER;
        let seen = if (sight.past && unbounded) || (!sight.past && needed == 1) {
            Seen::All(T::NEUTRAL)
        } else if unbounded {
            Seen::Kept(Vec::new())
        } else {
            Seen::Last(Window::new(span + 1, T::NEUTRAL))
        };
        Self { past: sight.past, start, span, needed, values: 0, results: 0, delayed: VecDeque::new(), seen }
    }

    /// Takes the operand's value at the next tick, and returns the operator's next result if this result is complete.
    pub fn push(&mut self, value: T) -> Option<T> {
        if self.results == self.needed {
            return None;
        }
        let value = if self.past { self.delay(value) } else { value };
        self.values += 1;
        if !self.past && self.values <= self.start {
            return None;
        }
        let result = match &mut self.seen {
            Seen::All(fold) => {
                *fold = fold.join(value);
                *fold
            }
            Seen::Last(window) => window.push(value),
            Seen::Kept(values) => {
                values.push(value);
                return None;
            }
        };
        let complete = self.past || self.values - self.start > self.span;
        self.results += usize::from(complete);
        complete.then_some(result)
    }

    fn delay(&mut self, value: T) -> T {
        if self.start == 0 {
            return value;
        }
        self.delayed.push_back(value);
        if self.delayed.len() <= self.start { T::NEUTRAL } else { self.delayed.pop_front().expect("just pushed") }
    }

    /// Returns the operator's result at the first tick for the values so far, if no result at another tick is needed.
    pub fn first(&self) -> Option<T> {
        match self.seen {
            Seen::All(fold) if !self.past => Some(fold),
            _ => None,
        }
    }

    /// Returns the operator's results that are not complete yet, for a trace that ends after `ticks` ticks. All values
    /// beyond the end are `outside`.
    pub fn rest(&mut self, ticks: usize, outside: T) -> Vec<T> {
        let missing = ticks.min(self.needed).saturating_sub(self.results);
        match &mut self.seen {
            Seen::All(fold) => vec![fold.join(outside); missing],
            Seen::Kept(values) => folded(values, missing, outside),
            Seen::Last(window) => match window.unfilled() {
                Some(values) => folded(values, missing, outside),
                None => (0..missing).map(|_| window.push(outside)).collect(),
            },
        }
    }
}

/// Returns the first `count` folds, each from a value to the last value and `outside`.
fn folded<T: Fold>(values: &[T], count: usize, outside: T) -> Vec<T> {
    let mut values = values.to_vec();
    suffixes(&mut values, outside);
    values.resize(count, outside);
    values
}
