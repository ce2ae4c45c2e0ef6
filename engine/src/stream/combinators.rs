//! The typed handles with which programs write streams of any type.

use super::datum::{Datum, DatumSample, samples};
use super::node::{Node, NodeKind, Source};
use std::cell::RefCell;
use std::fmt;
use std::marker::PhantomData;
use std::rc::Rc;

/// A sequence of values of type `T`, at most one at each tick; cheap to clone ([module](crate::stream)).
pub struct Stream<T> {
    pub(crate) node: Rc<Node>,
    carries: PhantomData<T>,
}

impl<T> Clone for Stream<T> {
    fn clone(&self) -> Self {
        Self { node: self.node.clone(), carries: PhantomData }
    }
}

impl<T> fmt::Debug for Stream<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.node, f)
    }
}

/// A side effect at every tick at which a stream has a value. [`Stream::for_each`] makes the effect, and
/// [`Scenario::place`](crate::Scenario::place) makes it part of the world.
#[must_use = "an effect only happens if you place it in the scenario"]
#[derive(Debug)]
pub struct Effect(pub(crate) Rc<Node>);

impl Stream<()> {
    /// Returns the clock, which is a stream with an event at every tick.
    pub fn tick() -> Self {
        Self::constant(())
    }
}

impl Stream<f64> {
    /// Returns the stream of the time since the run began, in seconds.
    pub fn time() -> Self {
        Self::new(NodeKind::Time, [])
    }
}

impl<T: Datum> Stream<T> {
    pub(crate) fn new(kind: NodeKind, inputs: impl Into<Vec<Rc<Node>>>) -> Self {
        let node = Node { kind, inputs: inputs.into(), width: T::WIDTH };
        Self { node: Rc::new(node), carries: PhantomData }
    }

    /// Returns the stream that has the given value at every tick.
    pub fn constant(value: T) -> Self {
        Self::new(NodeKind::Constant { value: samples(value), parameter: None }, [])
    }

    /// Returns the stream of a node, whose values must have the type `T`.
    pub(crate) fn of(node: Rc<Node>) -> Self {
        Self { node, carries: PhantomData }
    }

    /// Returns the stream that has no value at any tick. An unbound input reads this stream.
    pub fn absent() -> Self {
        Self::new(NodeKind::Constant { value: vec![DatumSample::Absent; T::WIDTH], parameter: None }, [])
    }

    pub(crate) fn output(source: Source, name: String) -> Self {
        Self::new(NodeKind::Output { source, name }, [])
    }

    /// Returns the same stream with a name, which the printed graph and the traces use.
    pub fn named(&self, name: &str) -> Self {
        self.then(NodeKind::Named(name.to_owned()))
    }

    /// Applies `f` to each value of the stream. `f` should be pure: the number of calls is not defined.
    pub fn map<U: Datum>(&self, f: impl Fn(T) -> U + 'static) -> Stream<U> {
        let map = move |input: &[_], output: &mut [_]| {
            if let Some(value) = T::get(input) {
                f(value).put(output);
            }
        };
        self.then(NodeKind::Map(Rc::new(map)))
    }

    /// Returns the stream at the ticks at which `keep` is true for the value; absent at all other ticks.
    pub fn filter(&self, keep: impl Fn(T) -> bool + 'static) -> Self {
        self.then(NodeKind::Filter(Rc::new(move |input: &[_]| T::get(input).is_some_and(&keep))))
    }

    /// Returns the stream at the ticks at which `event` occurs; absent at all other ticks.
    pub fn when<E: Datum>(&self, event: &Stream<E>) -> Self {
        self.with(NodeKind::When, event)
    }

    /// Returns the pair of the values of two streams, at the ticks at which both streams have a value.
    pub fn zip<U: Datum>(&self, other: &Stream<U>) -> Stream<(T, U)> {
        Stream::new(NodeKind::Zip, [self.node.clone(), other.node.clone()])
    }

    /// Returns the first `count` values of the stream; the result is over after the last of these values.
    pub fn take(&self, count: usize) -> Self {
        self.then(NodeKind::Take(count))
    }

    /// Returns a stream that is this stream until it is over, and then `next`, whose earlier values are lost.
    pub fn concat(&self, next: &Stream<T>) -> Self {
        self.with(NodeKind::Concat, next)
    }

    /// Returns `value` at the first tick, and this stream from then on, like Lustre's `->`. With [`Stream::pre`], it
    /// gives a feedback its first value: `x.pre().initially(0.0)`.
    pub fn initially(&self, value: impl Into<Stream<T>>) -> Self {
        value.into().take(1).concat(self)
    }

    /// Returns the fold of the stream's values so far, at the ticks at which the stream has a value. Each result is
    /// `f` of the previous result (`initial` at first) and the value. `f` should be a pure function.
    pub fn scan<A: Datum>(&self, initial: A, f: impl Fn(A, T) -> A + 'static) -> Stream<A> {
        let step = move |sum: &mut [_], input: &[_]| {
            if let (Some(before), Some(value)) = (A::get(sum), T::get(input)) {
                f(before, value).put(sum);
            }
        };
        self.then(NodeKind::Scan { initial: samples(initial), step: Rc::new(step) })
    }

    /// Returns the value of this stream, and the value of `other` at the ticks at which only `other` has a value.
    pub fn merge(&self, other: &Stream<T>) -> Self {
        self.with(NodeKind::Merge, other)
    }

    /// Returns the stream before the first tick at which `event` occurs; the result is over from that tick on.
    pub fn take_until<E: Datum>(&self, event: &Stream<E>) -> Self {
        self.with(NodeKind::TakeUntil, event)
    }

    /// Returns the stream from the first tick on at which `event` occurs; absent before that tick.
    pub fn skip_until<E: Datum>(&self, event: &Stream<E>) -> Self {
        self.with(NodeKind::SkipUntil, event)
    }

    /// Returns the stream's value at the previous tick; absent at the first tick and if the previous value is absent.
    pub fn pre(&self) -> Self {
        self.then(NodeKind::Pre)
    }

    /// Returns the latest value of the stream at every tick, or `initial` before the first value.
    pub fn hold(&self, initial: T) -> Self {
        self.then(NodeKind::Hold { initial: samples(initial) })
    }

    /// Returns a stream that is true at the ticks at which both streams have the same value.
    pub fn equals(&self, other: impl Into<Stream<T>>) -> Stream<bool> {
        Stream::new(NodeKind::Equal, [self.node.clone(), other.into().node])
    }

    /// Returns an effect that calls `f` with each value of the stream. The effect has to be placed in the scenario.
    pub fn for_each(&self, mut f: impl FnMut(T) + 'static) -> Effect {
        let effect = move |input: &[_]| T::get(input).map_or((), &mut f);
        let effect: Stream<()> = self.then(NodeKind::ForEach(Rc::new(RefCell::new(effect))));
        Effect(effect.node)
    }

    pub(super) fn then<U: Datum>(&self, kind: NodeKind) -> Stream<U> {
        Stream::new(kind, [self.node.clone()])
    }

    pub(super) fn with<U: Datum, V: Datum>(&self, kind: NodeKind, other: &Stream<U>) -> Stream<V> {
        Stream::new(kind, [self.node.clone(), other.node.clone()])
    }
}

impl<T: Datum> From<T> for Stream<T> {
    fn from(value: T) -> Self {
        Stream::constant(value)
    }
}

impl<T: Datum> From<&Stream<T>> for Stream<T> {
    fn from(stream: &Stream<T>) -> Self {
        stream.clone()
    }
}
