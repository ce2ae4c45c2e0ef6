//! The expressions of a run laid out for evaluation: operands first, one slot each, no allocation per tick.

use super::Stream;
use super::expression::{Datum, Node, Sample, Source};
use crate::scenario::Line;
use paracosm_oracles::Comparison;
use std::collections::HashMap;
use std::rc::Rc;

/// Where a node's value stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Slot(usize);

#[derive(Debug)]
enum Operation {
    Constant(Sample),
    Output(Source),
    Difference(Slot, Slot),
    Towards { position: Slot, line: Line },
    Compare { left: Slot, comparison: Comparison, right: Slot },
    SkipUntil { stream: Slot, event: Slot, begun: bool },
    TakeUntil { stream: Slot, event: Slot, ended: bool },
}

/// All streams that a run reads.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    operations: Vec<Operation>,
    values: Vec<Sample>,
    /// Which slot an expression has got. Only looked up, never iterated over: addresses differ between runs.
    slots: HashMap<*const Node, Slot>,
    /// Keeps the expressions alive, so that no address is used twice.
    expressions: Vec<Rc<Node>>,
}

impl Graph {
    /// Adds a stream, with all that it is made of; the slot where its value will stand.
    pub fn add<T: Datum>(&mut self, stream: &Stream<T>) -> Slot {
        self.add_node(&stream.node)
    }

    pub fn add_node(&mut self, node: &Rc<Node>) -> Slot {
        if let Some(slot) = self.slots.get(&Rc::as_ptr(node)) {
            return *slot;
        }
        let operation = match &**node {
            Node::Constant(sample) => Operation::Constant(*sample),
            Node::Output { source, .. } => Operation::Output(*source),
            Node::Difference(left, right) => Operation::Difference(self.add_node(left), self.add_node(right)),
            Node::Towards { position, line } => {
                Operation::Towards { position: self.add_node(position), line: line.clone() }
            }
            Node::Compare { left, comparison, right } => {
                Operation::Compare { left: self.add_node(left), comparison: *comparison, right: self.add_node(right) }
            }
            Node::SkipUntil { stream, event } => {
                Operation::SkipUntil { stream: self.add_node(stream), event: self.add_node(event), begun: false }
            }
            Node::TakeUntil { stream, event } => {
                Operation::TakeUntil { stream: self.add_node(stream), event: self.add_node(event), ended: false }
            }
        };
        let slot = Slot(self.operations.len());
        self.operations.push(operation);
        self.values.push(Sample::Absent);
        self.slots.insert(Rc::as_ptr(node), slot);
        self.expressions.push(node.clone());
        slot
    }

    /// Evaluates every stream for the tick whose world `outputs` shows.
    pub fn tick(&mut self, outputs: impl Fn(Source) -> Sample) {
        for (index, operation) in self.operations.iter_mut().enumerate() {
            let values = &self.values;
            let at = |slot: &Slot| values[slot.0];
            let value = match operation {
                Operation::Constant(sample) => *sample,
                Operation::Output(source) => outputs(*source),
                Operation::Difference(left, right) => match (at(left), at(right)) {
                    (Sample::Number(left), Sample::Number(right)) => Sample::Number(left - right),
                    _ => Sample::Absent,
                },
                Operation::Towards { position, line } => match at(position) {
                    Sample::Vector(position) => Sample::Number(line.ahead_of(position)),
                    _ => Sample::Absent,
                },
                Operation::Compare { left, comparison, right } => match (at(left), at(right)) {
                    (Sample::Number(left), Sample::Number(right)) => Sample::Truth(comparison.holds(left, right)),
                    _ => Sample::Absent,
                },
                Operation::SkipUntil { stream, event, begun } => {
                    *begun |= at(event) == Sample::Truth(true);
                    if *begun { at(stream) } else { Sample::Absent }
                }
                Operation::TakeUntil { stream, event, ended } => {
                    *ended |= at(event) == Sample::Truth(true);
                    if *ended { Sample::Absent } else { at(stream) }
                }
            };
            self.values[index] = value;
        }
    }

    /// The value in a slot at the last tick; `None` where it was absent.
    pub fn value<T: Datum>(&self, slot: Slot) -> Option<T> {
        T::unwrap(self.sample(slot))
    }

    pub fn sample(&self, slot: Slot) -> Sample {
        self.values[slot.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs `stream` over ticks at which the car's speed takes these values.
    fn over<T: Datum>(stream: &Stream<T>, speeds: &[f64]) -> Vec<Option<T>> {
        let mut graph = Graph::default();
        let slot = graph.add(stream);
        let tick = |speed: &f64| {
            graph.tick(|_| Sample::Number(*speed));
            graph.value(slot)
        };
        speeds.iter().map(tick).collect()
    }

    fn x() -> Stream<f64> {
        Stream::output(Source::CarSpeed, "x".into())
    }

    const TICKS: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];

    #[test]
    fn skip_until_begins_at_the_tick_of_the_event() {
        let stream = x().skip_until(&x().above(2.5));
        assert_eq!(over(&stream, &TICKS), [None, None, Some(3.0), Some(4.0), Some(5.0)]);
    }

    #[test]
    fn take_until_ends_before_the_tick_of_the_event() {
        let stream = x().take_until(&x().above(3.5));
        assert_eq!(over(&stream, &TICKS), [Some(1.0), Some(2.0), Some(3.0), None, None]);
    }

    #[test]
    fn what_has_begun_or_ended_stays_so_when_the_event_is_over() {
        let ticks = [1.0, 9.0, 1.0];
        assert_eq!(over(&x().skip_until(&x().above(5.0)), &ticks), [None, Some(9.0), Some(1.0)]);
        assert_eq!(over(&x().take_until(&x().above(5.0)), &ticks), [Some(1.0), None, None]);
    }

    #[test]
    fn an_operation_on_an_absent_value_is_absent() {
        let late = x().skip_until(&x().above(4.5));
        assert_eq!(over(&(x() - late.clone()), &TICKS), [None, None, None, None, Some(0.0)]);
        assert_eq!(over(&late.below(9.0), &TICKS), [None, None, None, None, Some(true)]);
    }

    #[test]
    fn a_shared_expression_is_evaluated_once() {
        let mut graph = Graph::default();
        let gap = x() - 1.0;
        let first = graph.add(&gap.below(2.0));
        let second = graph.add(&gap.above(2.0));
        assert_ne!(first, second);
        // x, 1, x - 1, 2, below, 2, above
        assert_eq!(graph.operations.len(), 7);
    }

    #[test]
    fn an_expression_prints_as_it_is_written() {
        assert_eq!((x() - 2.0).below(30.0).node.to_string(), "((x - 2) < 30)");
    }
}
