//! Sets of ticks that are stored as runs of consecutive ticks.

use std::collections::VecDeque;

/// A run of consecutive ticks: the first and the last.
pub(super) type Run = (usize, usize);

/// A set of ticks, stored as its runs in order. No two runs touch each other.
#[derive(Debug, Clone, Default)]
pub(super) struct Runs(VecDeque<Run>);

impl Runs {
    /// Adds the ticks of a run to the set, and returns the run of the set that then contains these ticks.
    pub fn insert(&mut self, (from, to): Run) -> Run {
        // The usual case: the new run follows the last one.
        if let Some(last) = self.0.back_mut()
            && last.0 <= from
            && last.1 + 1 >= from
        {
            last.1 = last.1.max(to);
            return *last;
        }
        let first = self.0.partition_point(|run| run.1 + 1 < from);
        let mut joined = (from, to);
        while let Some(run) = self.0.get(first).copied().filter(|run| run.0 <= to + 1) {
            joined = (joined.0.min(run.0), joined.1.max(run.1));
            self.0.remove(first);
        }
        self.0.insert(first, joined);
        joined
    }

    /// Returns the run of the set that contains the given tick, or `None` if the set does not have the tick.
    pub fn containing(&self, tick: usize) -> Option<Run> {
        let run = *self.0.get(self.0.partition_point(|run| run.1 < tick))?;
        (run.0 <= tick).then_some(run)
    }

    /// Returns the first run of ticks that the set and the given run have in common.
    pub fn first_within(&self, (from, to): Run) -> Option<Run> {
        let run = *self.0.get(self.0.partition_point(|run| run.1 < from))?;
        (run.0 <= to).then_some((run.0.max(from), run.1.min(to)))
    }

    /// Returns the last tick that the set and the given run have in common.
    pub fn last_within(&self, (from, to): Run) -> Option<usize> {
        let run = *self.0.get(self.0.partition_point(|run| run.0 <= to).checked_sub(1)?)?;
        (run.1 >= from).then_some(run.1.min(to))
    }

    /// Returns the ticks that the set and the given run have in common, as runs in ascending order.
    pub fn within(&self, (from, to): Run) -> impl Iterator<Item = Run> {
        let first = self.0.partition_point(|run| run.1 < from);
        let overlapping = self.0.range(first..).take_while(move |run| run.0 <= to);
        overlapping.map(move |run| (run.0.max(from), run.1.min(to)))
    }

    /// Adds the ticks of a run to the set, and calls `new` for each run of ticks that the set did not have.
    pub fn complete(&mut self, (from, to): Run, mut new: impl FnMut(Run)) {
        // Again the usual case: the new run does not begin before the last one.
        let mut next = match self.0.back() {
            Some(last) if last.0 <= from => from.max(last.1 + 1),
            _ => from,
        };
        if self.0.back().is_none_or(|last| last.1 < next) {
            if next <= to {
                new((next, to));
                self.insert((next, to));
            }
            return;
        }
        while let Some(known) = self.first_within((next, to)) {
            if next < known.0 {
                new((next, known.0 - 1));
            }
            next = known.1 + 1;
            if next > to {
                break;
            }
        }
        if next <= to {
            new((next, to));
        }
        self.insert((from, to));
    }

    /// Returns the first tick that is not in the set.
    pub fn first_absent(&self) -> usize {
        self.0.front().filter(|run| run.0 == 0).map_or(0, |run| run.1 + 1)
    }

    /// Removes all runs that end before the tick `before` from the set.
    pub fn forget(&mut self, before: usize) {
        while self.0.front().is_some_and(|run| run.1 < before) {
            self.0.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn runs_are_a_set_of_ticks(inserted in prop::collection::vec((0..40usize, 0..5usize), 0..20), asked in (0..40usize, 0..9usize)) {
            let mut runs = Runs::default();
            let mut set = BTreeSet::new();
            for (from, length) in inserted {
                let mut new = Vec::new();
                runs.complete((from, from + length), |(from, to)| new.extend(from..=to));
                let added: Vec<_> = (from..=from + length).filter(|tick| set.insert(*tick)).collect();
                prop_assert_eq!(new, added);
            }
            let asked = (asked.0, asked.0 + asked.1);
            let common: Vec<_> = set.range(asked.0..=asked.1).copied().collect();
            prop_assert_eq!(runs.within(asked).flat_map(|(from, to)| from..=to).collect::<Vec<_>>(), common.clone());
            prop_assert_eq!(runs.first_within(asked).map(|run| run.0), common.first().copied());
            prop_assert_eq!(runs.last_within(asked), common.last().copied());
            prop_assert_eq!(runs.containing(asked.0).is_some(), set.contains(&asked.0));
            prop_assert_eq!(runs.first_absent(), (0..).find(|tick| !set.contains(tick)).unwrap());
            let (first, last) = runs.insert(asked);
            set.extend(asked.0..=asked.1);
            prop_assert!((first..=last).all(|tick| set.contains(&tick)));
            prop_assert!(!set.contains(&(last + 1)) && first.checked_sub(1).is_none_or(|tick| !set.contains(&tick)));
        }
    }
}
