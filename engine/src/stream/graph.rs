//! The streams of a run laid out for evaluation: operands first, all values in one place, no allocation per tick.

use super::datum::{Datum, DatumSample};
use super::node::{Binary, Equation, Node, NodeKind, Source};
use super::order::{GraphFlaw, order};
use crate::line::Line;
use nalgebra::Vector2;
use paracosm_oracles::Comparison;
use paracosm_space::Shape;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The place of a node's value in the memory of a graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Slot(usize);

/// The time of an evaluation, as tick (from 0), number of ticks in the run and duration of a tick in seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    pub tick: usize,
    pub ticks: usize,
    pub dt: f64,
}

/// A node with its memory from tick to tick.
#[derive(Debug)]
struct Operation {
    node: Rc<Node>,
    /// The place of the operation's value, and the number of samples that it takes.
    at: usize,
    width: usize,
    /// The places of the inputs' values. If there are fewer than two inputs, the rest is the operation's own place.
    inputs: [usize; 2],
    memory: Memory,
}

/// The memory of an operation.
#[derive(Debug)]
enum Memory {
    Nothing,
    /// True if an event has occurred.
    Occurred(bool),
    /// The number of values that are still to come.
    Left(usize),
    /// A value, and true if the stream is over.
    Value {
        samples: Vec<DatumSample>,
        over: bool,
    },
    /// The values of a signal.
    Numbers(Vec<f64>),
}

/// All streams that a run reads.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    operations: Vec<Operation>,
    /// The values of all nodes. The samples of the objects' outputs come first, so that they need no operations.
    values: Vec<DatumSample>,
    /// The number of samples of all outputs of objects.
    outputs: usize,
    /// For each value, true if its stream is over.
    over: Vec<bool>,
    /// For each value, true if it is the same at every tick.
    constant: Vec<bool>,
    /// The operations that take in their operand when the tick is over.
    delays: Vec<usize>,
    /// The slot of each node. The map is only looked up and never iterated over, because addresses differ between runs.
    slots: FxHashMap<*const Node, Slot>,
    /// Keeps the nodes without an operation alive, so that no address is used twice.
    nodes: Vec<Rc<Node>>,
}

impl Graph {
    /// Makes the graph of the given roots and all nodes that the roots depend on. `outputs` is the number of samples of
    /// all outputs of objects.
    pub fn new<'a>(
        roots: impl IntoIterator<Item = &'a Rc<Node>>,
        equations: &'a [Equation],
        outputs: usize,
    ) -> Result<Self, GraphFlaw> {
        let mut graph = Self {
            values: vec![DatumSample::Absent; outputs],
            outputs,
            over: vec![false; outputs],
            constant: vec![false; outputs],
            ..Self::default()
        };
        for node in order(roots, equations)? {
            let slot = match &node.kind {
                NodeKind::Output { source: Source(at), .. } => Slot(*at),
                // Other names of a stream share its slot.
                NodeKind::Named(_) => graph.slot(&node.inputs[0]),
                NodeKind::Forward { equation, .. } => {
                    graph.slot(equations[*equation].definition.as_ref().expect("it has been ordered"))
                }
                _ => graph.add(node),
            };
            graph.slots.insert(Rc::as_ptr(node), slot);
            graph.nodes.push(node.clone());
        }
        for &delay in &graph.delays {
            // Only now every operand has its place.
            graph.operations[delay].inputs[0] = graph.slots[&Rc::as_ptr(&graph.operations[delay].node.inputs[0])].0;
        }
        Ok(graph)
    }

    fn add(&mut self, node: &Rc<Node>) -> Slot {
        let at = self.values.len();
        let initial = match &node.kind {
            NodeKind::Constant { value, .. } | NodeKind::Hold { initial: value } => value.clone(),
            _ => vec![DatumSample::Absent; node.width],
        };
        self.values.extend(initial);
        self.over.resize(self.values.len(), false);
        self.constant.resize(self.values.len(), false);
        if matches!(node.kind, NodeKind::Constant { .. }) {
            self.constant[at] = true;
            return Slot(at);
        }
        let memory = match &node.kind {
            NodeKind::SkipUntil | NodeKind::TakeUntil => Memory::Occurred(false),
            NodeKind::Take(count) => Memory::Left(*count),
            NodeKind::Pre => Memory::Value { samples: vec![DatumSample::Absent; node.width], over: false },
            NodeKind::Sum(initial) => Memory::Value { samples: vec![*initial], over: false },
            NodeKind::Scan { initial, .. } => Memory::Value { samples: initial.clone(), over: false },
            NodeKind::Signal { values, shape, .. } if !matches!(shape, Shape::PiecewiseConstant { .. }) => {
                Memory::Numbers(values.iter().filter_map(|value| f64::get(std::slice::from_ref(value))).collect())
            }
            _ => Memory::Nothing,
        };
        let mut inputs = [at; 2];
        if matches!(node.kind, NodeKind::Pre) {
            self.delays.push(self.operations.len());
        } else {
            for (place, input) in inputs.iter_mut().zip(&node.inputs) {
                *place = self.slot(input).0;
            }
        }
        let mut operation = Operation { node: node.clone(), at, width: node.width, inputs, memory };
        let constant = node.kind.is_pure() && node.inputs.iter().all(|input| self.is_constant(self.slot(input)));
        if constant {
            // Evaluated here once, and at no tick. No such operation reads the clock or an output of an object.
            let clock = Clock { tick: 0, ticks: 0, dt: 0.0 };
            operation.evaluate(clock, &mut self.values, &mut self.over);
            self.constant[at] = true;
        } else {
            self.operations.push(operation);
        }
        Slot(at)
    }

    /// Returns `true` if the value in a slot is the same at every tick.
    pub fn is_constant(&self, slot: Slot) -> bool {
        self.constant[slot.0]
    }

    /// Returns the place of a node's value in the memory of the graph.
    ///
    /// # Panics
    /// The node is not in the graph.
    pub fn slot(&self, node: &Rc<Node>) -> Slot {
        self.slots[&Rc::as_ptr(node)]
    }

    /// Returns the slot of an output.
    pub fn output(Source(at): Source) -> Slot {
        Slot(at)
    }

    /// Returns the outputs of all objects, which have to be written before each tick.
    pub fn outputs(&mut self) -> &mut [DatumSample] {
        &mut self.values[..self.outputs]
    }

    /// Evaluates every stream for a tick.
    pub fn tick(&mut self, clock: Clock) {
        for operation in &mut self.operations {
            operation.evaluate(clock, &mut self.values, &mut self.over);
        }
        for &delay in &self.delays {
            let Operation { inputs: [at, _], width, memory, .. } = &mut self.operations[delay];
            if let Memory::Value { samples, over } = memory {
                copy(&self.values[*at..*at + *width], samples);
                *over = self.over[*at];
            }
        }
    }

    /// Returns the value in a slot at the last tick; `None` if the value was absent.
    pub fn value<T: Datum>(&self, slot: Slot) -> Option<T> {
        T::get(&self.values[slot.0..])
    }

    /// Reads the values in some slots at the last tick as the numbers of a trace: truths as 1 and 0, and all other
    /// values that are no numbers as NaN.
    pub fn read(&self, slots: &[Slot], numbers: &mut [f64]) {
        for (number, slot) in numbers.iter_mut().zip(slots) {
            *number = match self.values[slot.0] {
                DatumSample::Number(number) => number,
                DatumSample::Truth(truth) => f64::from(u8::from(truth)),
                _ => f64::NAN,
            };
        }
    }
}

/// Returns `true` if an event occurs, which is a truth that holds, or any other value that is present.
fn occurs(value: &DatumSample) -> bool {
    !matches!(value, DatumSample::Absent | DatumSample::Truth(false))
}

impl Memory {
    /// Returns `true` if the event with the given value at this tick has occurred, now or before.
    fn occurred(&mut self, value: &DatumSample) -> bool {
        let Self::Occurred(occurred) = self else { unreachable!("every memory fits its node") };
        *occurred = *occurred || occurs(value);
        *occurred
    }
}

impl Operation {
    /// Writes the value of a tick, and whether the stream is over, to the operation's place.
    #[inline(always)]
    fn evaluate(&mut self, clock: Clock, values: &mut [DatumSample], over: &mut [bool]) {
        if !self.evaluate_simple(values, over) {
            let (before, rest) = values.split_at_mut(self.at);
            over[self.at] = self.evaluate_wide(clock, before, &mut rest[..self.width], over);
        }
    }

    /// Evaluates one of the most common operations in place. Returns `false` if the operation is of another kind.
    ///
    /// Samples are read and written part by part. A processor waits when it loads a whole sample at once whose parts
    /// it has just stored one by one.
    #[inline(always)]
    fn evaluate_simple(&mut self, values: &mut [DatumSample], over: &mut [bool]) -> bool {
        let [left, right] = self.inputs;
        let width = self.width;
        let (values, rest) = values.split_at_mut(self.at);
        let output = &mut rest[0];
        over[self.at] = match &self.node.kind {
            NodeKind::Unary(function) => {
                function.of(&values[left], output);
                over[left]
            }
            NodeKind::Binary(function) => {
                function.of(&values[left], &values[right], output);
                over[left] || over[right]
            }
            NodeKind::Compare(comparison) => {
                compare(*comparison, &values[left], &values[right], output);
                over[left] || over[right]
            }
            NodeKind::Towards(line) => {
                measure(line, &values[left], output);
                over[left]
            }
            NodeKind::SkipUntil => {
                let begun = self.memory.occurred(&values[right]);
                put(&mut rest[..width], begun, &values[left..left + width]);
                over[left]
            }
            NodeKind::TakeUntil => {
                let ended = self.memory.occurred(&values[right]);
                put(&mut rest[..width], !ended, &values[left..left + width]);
                ended || over[left]
            }
            _ => return false,
        };
        true
    }

    /// Writes a tick's value and returns `true` if the stream is over. `values` are those of earlier operations.
    #[inline(never)]
    fn evaluate_wide(
        &mut self,
        clock: Clock,
        values: &[DatumSample],
        output: &mut [DatumSample],
        over: &[bool],
    ) -> bool {
        let Self { node, width, inputs: [left, right], memory, .. } = self;
        let width = *width;
        let ([left, right], [left_over, right_over]) = ([*left, *right], [over[*left], over[*right]]);
        let from = |at: usize| &values[at..at + width];
        match (&node.kind, memory) {
            (NodeKind::Time, _) => {
                output[0] = (clock.tick as f64 * clock.dt).into();
                false
            }
            (NodeKind::Signal { shape, .. }, Memory::Numbers(numbers)) => {
                output[0] = shape.number_at(numbers, clock.tick, clock.ticks).into();
                false
            }
            (NodeKind::Signal { values, .. }, _) => {
                let pieces = values.len() / width;
                let piece = Shape::piece(pieces, clock.tick, clock.ticks);
                copy(&values[piece * width..][..width], output);
                false
            }
            (NodeKind::Equal, _) => {
                let width = node.inputs[0].width;
                let absent = values[left].is_absent() || values[right].is_absent();
                let equal = values[left..left + width] == values[right..right + width];
                output[0] = if absent { DatumSample::Absent } else { equal.into() };
                left_over || right_over
            }
            (NodeKind::Map(map), _) => {
                output[0] = DatumSample::Absent;
                map(&values[left..], output);
                left_over
            }
            (NodeKind::Filter(keep), _) => {
                put(output, keep(&values[left..]), from(left));
                left_over
            }
            (NodeKind::When, _) => {
                put(output, occurs(&values[right]), from(left));
                left_over || right_over
            }
            (NodeKind::Zip, _) => {
                let middle = node.inputs[0].width;
                let present = !values[left].is_absent() && !values[right].is_absent();
                output[..middle].copy_from_slice(&values[left..left + middle]);
                output[middle..].copy_from_slice(&values[right..right + width - middle]);
                if !present {
                    output[0] = DatumSample::Absent;
                }
                left_over || right_over
            }
            (NodeKind::Take(_), Memory::Left(count)) => {
                let over = *count == 0 || left_over;
                put(output, *count > 0, from(left));
                *count -= usize::from(!output[0].is_absent());
                over
            }
            (NodeKind::Concat, _) => {
                copy(from(if left_over { right } else { left }), output);
                left_over && right_over
            }
            (NodeKind::Sum(_), Memory::Value { samples, .. }) => {
                if !values[left].is_absent() {
                    let before = samples[0];
                    Binary::Sum.of(&before, &values[left], &mut samples[0]);
                }
                put(output, !values[left].is_absent(), samples);
                left_over
            }
            (NodeKind::Scan { step, .. }, Memory::Value { samples, .. }) => {
                let present = !values[left].is_absent();
                if present {
                    step(samples, &values[left..]);
                }
                put(output, present, samples);
                left_over
            }
            (NodeKind::Merge, _) => {
                copy(from(if values[left].is_absent() { right } else { left }), output);
                left_over && right_over
            }
            (NodeKind::Pre, Memory::Value { samples, over }) => {
                copy(samples, output);
                *over
            }
            (NodeKind::Hold { .. }, _) => {
                if !values[left].is_absent() {
                    copy(from(left), output);
                }
                false
            }
            (NodeKind::ForEach(effect), _) => {
                (effect.borrow_mut())(&values[left..]);
                left_over
            }
            _ => unreachable!("simple operations are done elsewhere, others have none, and every memory fits its node"),
        }
    }
}

/// Writes the result of comparing two numbers; absent if a number is absent.
fn compare(comparison: Comparison, left: &DatumSample, right: &DatumSample, output: &mut DatumSample) {
    match (left, right) {
        (DatumSample::Number(left), DatumSample::Number(right)) => {
            *output = DatumSample::Truth(comparison.holds(*left, *right));
        }
        _ => *output = DatumSample::Absent,
    }
}

/// Writes the distance from a position to a line; absent if the position is absent.
fn measure(line: &Line, position: &DatumSample, output: &mut DatumSample) {
    match position {
        DatumSample::Vector(x, y) => *output = DatumSample::Number(line.ahead_of(Vector2::new(*x, *y))),
        _ => *output = DatumSample::Absent,
    }
}

/// Writes the value, or an absent sample if `present` is false.
fn put(output: &mut [DatumSample], present: bool, value: &[DatumSample]) {
    if present {
        copy(value, output);
    } else {
        output[0] = DatumSample::Absent;
    }
}

/// Copies a value. Nearly all are one sample, for which a call to copy memory would take longer than the rest.
fn copy(value: &[DatumSample], output: &mut [DatumSample]) {
    match (value, output) {
        ([DatumSample::Number(number)], [output]) => *output = DatumSample::Number(*number),
        ([value], [output]) => *output = *value,
        (value, output) => output.copy_from_slice(value),
    }
}
