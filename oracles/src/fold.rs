//! Folds over sliding windows, in time that does not depend on the width of the window.
//!
//! The method is that of van Herk (Pattern Recognition Letters 13, 1992) and of Gil and Werman (PAMI 15, 1993). Time
//! is cut into blocks as long as the window. Every window is the end of one block and the beginning of the next, and
//! both parts are folded step by step. The method takes three operations per sample on any data, and the operation
//! only has to be associative. A monotone wedge (Lemire, 2006) takes as many comparisons, but the processor cannot
//! predict them, and the wedge needs an order. So one window serves both `eventually` and `until`: see [`Clamp`].

use crate::worth::Worth;

/// An associative operation that folds the values of a window. The earlier operand comes first.
pub(crate) trait Fold: Copy {
    const NEUTRAL: Self;

    fn join(self, later: Self) -> Self;
}

/// Folds to the greatest value.
impl Fold for Worth {
    const NEUTRAL: Self = Worth::WORST;

    fn join(self, later: Self) -> Self {
        self.max(later)
    }
}

/// A step of `until`: a function `x -> max(goal, min(hold, x))` from the worth at the next tick to the worth now. The
/// composition of two such functions has the same form. At the end of the window, `x` is the worst value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Clamp {
    pub goal: Worth,
    pub hold: Worth,
}

impl Fold for Clamp {
    const NEUTRAL: Self = Self { goal: Worth::WORST, hold: Worth::BEST };

    fn join(self, later: Self) -> Self {
        Self { goal: self.goal.max(self.hold.min(later.goal)), hold: self.hold.min(later.hold) }
    }
}

/// A fold in the opposite direction, for windows into the past.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reversed<T>(pub T);

impl<T: Fold> Fold for Reversed<T> {
    const NEUTRAL: Self = Self(T::NEUTRAL);

    fn join(self, later: Self) -> Self {
        Self(later.0.join(self.0))
    }
}

/// Replaces each value by the fold of the value and the `span` values behind it. All values beyond the last are
/// `outside`.
pub(crate) fn windows<T: Fold>(values: &mut [T], span: usize, outside: T) {
    if span >= values.len() {
        return suffixes(values, outside);
    }
    let size = span + 1;
    let mut beginning = vec![outside; span];
    for start in (0..values.len()).step_by(size) {
        let end = values.len().min(start + size);
        let (block, rest) = values[start..].split_at_mut(end - start);
        let mut fold = T::NEUTRAL;
        let mut behind = rest.iter();
        for place in &mut beginning {
            fold = fold.join(behind.next().copied().unwrap_or(outside));
            *place = fold;
        }
        // The last block may be short. Its windows then end with values from outside.
        let mut fold = if block.len() < size { outside } else { T::NEUTRAL };
        let (first, others) = block.split_first_mut().expect("no block is empty");
        for (value, behind) in others.iter_mut().zip(&beginning).rev() {
            fold = value.join(fold);
            *value = fold.join(*behind);
        }
        *first = first.join(fold);
    }
}

/// Replaces each value by the fold of the value, all values behind it, and `outside`.
pub(crate) fn suffixes<T: Fold>(values: &mut [T], outside: T) {
    let mut fold = outside;
    for value in values.iter_mut().rev() {
        fold = value.join(fold);
        *value = fold;
    }
}

/// The fold of the last `size` values. All values before the first are `blank`.
#[derive(Debug, Clone)]
pub(crate) struct Window<T> {
    size: usize,
    blank: T,
    /// Before `at`: the values of this block. From `at` on: the folds from each value of the previous block to its
    /// end.
    block: Vec<T>,
    at: usize,
    /// The fold of the values of this block before `at`.
    recent: T,
}

impl<T: Fold> Window<T> {
    /// Makes a window over the last `size` values of a sequence. `size` is at least 1. The memory grows up to this
    /// number of values.
    pub fn new(size: usize, blank: T) -> Self {
        Self { size, blank, block: Vec::with_capacity(size.min(1 << 16)), at: 0, recent: T::NEUTRAL }
    }

    /// Adds the next value of the sequence to the window, and returns the fold of the last `size` values.
    #[inline]
    pub fn push(&mut self, value: T) -> T {
        match self.block.get_mut(self.at) {
            Some(place) => *place = value,
            None => self.block.push(value),
        }
        self.recent = self.recent.join(value);
        self.at += 1;
        if self.at == self.size {
            return self.turn();
        }
        self.block.get(self.at).copied().unwrap_or(self.blank).join(self.recent)
    }

    /// Begins a new block, and returns the fold of the full block.
    fn turn(&mut self) -> T {
        let mut rest = T::NEUTRAL;
        for value in self.block.iter_mut().rev() {
            rest = value.join(rest);
            *value = rest;
        }
        self.at = 0;
        self.recent = T::NEUTRAL;
        rest
    }

    /// Returns the values that were added to the window, or `None` if the values fill the window.
    pub fn unfilled(&self) -> Option<&[T]> {
        (self.block.len() < self.size).then_some(&self.block)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn step((goal, hold): &(i8, i8)) -> Clamp {
        Clamp { goal: Worth::of(f64::from(*goal)), hold: Worth::of(f64::from(*hold)) }
    }

    proptest! {
        #[test]
        fn windows_fold_each_value_with_those_behind_it(
            values in prop::collection::vec((-9..9i8, -9..9i8), 0..60),
            span in 0..20usize,
            outside in prop::sample::select(vec![Worth::WORST, Worth::of(0.0), Worth::BEST]),
        ) {
            let mut steps: Vec<_> = values.iter().map(step).collect();
            let outside = Clamp { goal: outside, hold: outside };
            let expected: Vec<_> = (0..steps.len())
                .map(|at| {
                    let seen = (at..=at + span).map(|at| steps.get(at).copied().unwrap_or(outside));
                    seen.reduce(Clamp::join).unwrap()
                })
                .collect();
            windows(&mut steps, span, outside);
            prop_assert_eq!(steps, expected);
        }

        #[test]
        fn a_window_folds_its_last_values_in_their_order(
            values in prop::collection::vec((-9..9i8, -9..9i8), 1..60),
            size in 1..20usize,
        ) {
            let steps: Vec<_> = values.iter().map(step).collect();
            let mut window = Window::new(size, Clamp::NEUTRAL);
            let mut reversed = Window::new(size, Reversed(Clamp::NEUTRAL));
            for (at, step) in steps.iter().enumerate() {
                let last = &steps[(at + 1).saturating_sub(size)..=at];
                let worth = last.iter().rev().fold(Worth::WORST, |x, step| step.goal.max(step.hold.min(x)));
                prop_assert_eq!(window.push(*step).goal, worth);
                let worth = last.iter().fold(Worth::WORST, |x, step| step.goal.max(step.hold.min(x)));
                prop_assert_eq!(reversed.push(Reversed(*step)).0.goal, worth);
            }
        }
    }
}
