//! The edges and the delays of the conditions of a trigger.

use crate::openscenario::condition::{Condition, Edge, Trigger};
use crate::openscenario::measure::Measure;
use crate::openscenario::state::State;
use std::collections::VecDeque;

/// A change of a condition this many seconds too early counts as in time: ticks are sums of rounded numbers.
const TOLERANCE: f64 = 1e-6;

/// A trigger under watch: the history of each of its conditions.
#[derive(Debug, Clone, Default)]
pub(super) struct Watch(Vec<Vec<History>>);

/// A question for the state of an element of the storyboard. The storyboard answers it at once, and not from the world at the beginning
/// of the tick: an element that starts at a tick is running for all elements after it.
#[derive(Debug, Clone)]
pub(super) struct Question {
    /// The index of the element.
    pub element: usize,
    pub state: State,
    /// The moment of the last answer. A transition before it has been seen.
    pub since: u64,
}

/// The history of a condition.
#[derive(Debug, Clone)]
struct History {
    edge: Edge,
    delay: f64,
    /// The condition's input, by its index.
    input: usize,
    /// The question that replaces the input; `None` for a condition that is not on a state.
    question: Option<Question>,
    /// The value of the condition at the previous check; `None` before the first check.
    before: Option<bool>,
    /// The present value after edge and delay, and the changes to come with their times.
    value: bool,
    changes: VecDeque<(f64, bool)>,
}

impl Watch {
    /// Begins to watch a trigger. `inputs` gives the conditions their indices, in order.
    pub fn new(trigger: &Trigger, inputs: &mut impl Iterator<Item = usize>) -> Self {
        let mut history = |condition: &Condition| History {
            edge: condition.edge,
            delay: condition.delay,
            input: inputs.next().expect("each condition has an input"),
            question: Question::of(&condition.check.measures),
            before: None,
            value: false,
            changes: VecDeque::new(),
        };
        Self(trigger.iter().map(|group| group.iter().map(&mut history).collect()).collect())
    }

    /// Forgets the past of all conditions.
    pub fn reset(&mut self) {
        for history in self.0.iter_mut().flatten() {
            (history.before, history.value) = (None, false);
            history.changes.clear();
        }
    }

    /// Checks all conditions at a time in seconds. `answer` answers questions for states, and `moment` counts the changes of states.
    /// Returns `true` if the trigger is true.
    pub fn check(&mut self, time: f64, truths: &[bool], moment: u64, answer: &dyn Fn(&Question) -> bool) -> bool {
        let mut fires = false;
        for group in &mut self.0 {
            let mut all = true;
            for history in group.iter_mut() {
                let truth = match &mut history.question {
                    None => truths[history.input],
                    Some(question) => {
                        let truth = answer(question);
                        question.since = moment;
                        truth
                    }
                };
                all &= history.check(time, truth);
            }
            fires |= all && !group.is_empty();
        }
        fires
    }
}

impl Question {
    fn of(measures: &[Measure]) -> Option<Self> {
        let [Measure::State { element, state }] = *measures else { return None };
        Some(Self { element, state, since: 0 })
    }
}

impl History {
    fn check(&mut self, time: f64, truth: bool) -> bool {
        // No element has been within a transition before.
        let is_transition = self.question.as_ref().is_some_and(|question| question.state.is_transition());
        let now = match (self.edge, self.before.or(is_transition.then_some(false))) {
            (Edge::None, _) => truth,
            (_, None) => false,
            (Edge::Rising, Some(before)) => truth && !before,
            (Edge::Falling, Some(before)) => !truth && before,
            (Edge::Either, Some(before)) => truth != before,
        };
        self.before = Some(truth);
        if self.delay == 0.0 {
            return now;
        }
        let last = self.changes.back().map_or(self.value, |(_, value)| *value);
        if now != last {
            self.changes.push_back((time + self.delay, now));
        }
        while let Some((_, value)) = self.changes.pop_front_if(|(due, _)| *due <= time + TOLERANCE) {
            self.value = value;
        }
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::openscenario::condition::Check;
    use crate::openscenario::rule::Rule;

    /// Returns the ticks at which a condition with this edge and delay is true, for truths at ticks of 0.1 s.
    fn fires(edge: Edge, delay: f64, truths: &[bool]) -> Vec<usize> {
        let check = Check { measures: vec![Measure::Time], any: true, rule: Rule::Equal, value: 0.0 };
        let trigger = vec![vec![Condition { name: String::new(), origin: Default::default(), delay, edge, check }]];
        let mut watch = Watch::new(&trigger, &mut (0..));
        let at = |tick: usize| tick as f64 * 0.1;
        (0..truths.len()).filter(|tick| watch.check(at(*tick), &[truths[*tick]], 0, &|_| false)).collect()
    }

    #[test]
    fn an_edge_is_false_at_the_first_check() {
        assert_eq!(fires(Edge::None, 0.0, &[true, true, false]), [0, 1]);
        assert_eq!(fires(Edge::Rising, 0.0, &[true, true, false, true]), [3]);
        assert_eq!(fires(Edge::Falling, 0.0, &[true, false, false, true, false]), [1, 4]);
        assert_eq!(fires(Edge::Either, 0.0, &[true, false, true, true]), [1, 2]);
    }

    #[test]
    fn a_delay_shifts_the_condition_in_time() {
        assert_eq!(fires(Edge::None, 0.2, &[false, true, true, false, false, false]), [3, 4]);
        assert_eq!(fires(Edge::Rising, 0.3, &[false, true, true, true, true, true]), [4]);
        assert_eq!(fires(Edge::Rising, 0.1, &[false, true, false, true, false, false]), [2, 4]);
    }
}
