//! The wiring of objects: inputs that are bound to streams, and outputs that become streams.

use super::InputError;
use super::body::BodyState;
use crate::stream::{Datum, DatumSample, Graph, Node, Reader, Slot, Source, Stream};
use std::cell::{Cell, RefCell};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;
use std::rc::Rc;

/// All inputs and outputs of a world under construction. The handles that bind them share this value.
#[derive(Debug, Clone, Default)]
pub(crate) struct Wiring {
    inputs: Rc<RefCell<Vec<Bound>>>,
    samples: Rc<Cell<usize>>,
}

/// An input and the node that it reads.
#[derive(Debug, Clone)]
struct Bound {
    name: Rc<str>,
    node: Rc<Node>,
}

/// An input of an object, which reads the stream that it was bound to last. An input is a handle and cheap to clone.
pub struct Input<T> {
    index: usize,
    name: Rc<str>,
    wiring: Wiring,
    carries: PhantomData<T>,
}

/// An output of an object, whose values form a stream.
pub struct Output<T> {
    at: usize,
    name: Rc<str>,
    carries: PhantomData<T>,
}

impl Wiring {
    pub fn input<T: Datum>(&self, name: &str, stream: &Stream<T>) -> Input<T> {
        let name: Rc<str> = name.into();
        let mut inputs = self.inputs.borrow_mut();
        inputs.push(Bound { name: name.clone(), node: stream.node.clone() });
        Input { index: inputs.len() - 1, name, wiring: self.clone(), carries: PhantomData }
    }

    pub fn output<T: Datum>(&self, name: &str) -> Output<T> {
        let at = self.samples.get();
        self.samples.set(at + T::WIDTH);
        Output { at, name: name.into(), carries: PhantomData }
    }

    /// Returns the name of every input and the node that the input reads, in the order of declaration.
    pub fn readers(&self) -> Vec<(String, Rc<Node>)> {
        self.inputs.borrow().iter().map(|bound| (bound.name.to_string(), bound.node.clone())).collect()
    }

    /// Returns the slots that the inputs read in a graph that has been laid out.
    pub fn slots(&self, graph: &Graph) -> Vec<Slot> {
        self.inputs.borrow().iter().map(|bound| graph.slot(&bound.node)).collect()
    }

    /// Returns the number of samples of all outputs together.
    pub fn samples(&self) -> usize {
        self.samples.get()
    }
}

impl<T: Datum> Input<T> {
    /// Binds the input to a stream, which replaces the present stream.
    pub fn bind(&self, stream: impl Into<Stream<T>>) {
        self.rebind(|_| stream.into());
    }

    /// Binds the input to the stream that `change` makes of the present stream.
    pub fn rebind(&self, change: impl FnOnce(Stream<T>) -> Stream<T>) {
        let present = Stream::of(self.wiring.inputs.borrow()[self.index].node.clone());
        let changed = change(present);
        self.wiring.inputs.borrow_mut()[self.index].node = changed.node;
    }

    /// Returns the input as a drawing of the world knows it.
    pub fn reader(&self) -> Reader {
        Reader(self.index)
    }
}

impl<T: Datum> Output<T> {
    /// Returns the stream of the output's values.
    pub fn stream(&self) -> Stream<T> {
        Stream::output(self.source(), self.name.to_string())
    }

    pub(crate) fn source(&self) -> Source {
        Source(self.at)
    }
}

impl<T> Clone for Input<T> {
    fn clone(&self) -> Self {
        Self { index: self.index, name: self.name.clone(), wiring: self.wiring.clone(), carries: PhantomData }
    }
}

impl<T> Clone for Output<T> {
    fn clone(&self) -> Self {
        Self { at: self.at, name: self.name.clone(), carries: PhantomData }
    }
}

impl<T> fmt::Debug for Input<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "input {}", self.name)
    }
}

impl<T> fmt::Debug for Output<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "output {}", self.name)
    }
}

/// The storage to which objects write the values of their outputs at a tick.
#[derive(Debug)]
pub struct Outputs<'a> {
    pub(crate) samples: &'a mut [DatumSample],
}

impl Outputs<'_> {
    /// Sets the value of an output for this tick.
    #[inline]
    pub fn set<T: Datum>(&mut self, output: &Output<T>, value: T) {
        value.put(&mut self.samples[output.at..]);
    }
}

/// The inputs and the surroundings of an object during a tick.
#[derive(Debug, Clone, Copy)]
pub struct Tick<'a> {
    pub(crate) dt: f64,
    pub(crate) friction: f64,
    pub(crate) graph: &'a Graph,
    pub(crate) inputs: &'a [Slot],
    pub(crate) bodies: &'a [BodyState],
    /// The range of the object's own bodies in `bodies`.
    pub(crate) own: (usize, usize),
}

impl Tick<'_> {
    /// Returns the duration of the tick, in seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Returns the friction coefficient between tyre and road during the tick, which is at least 0. At the beginning of
    /// the run it is not known yet and NaN.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Returns the value of an input; `None` if the input's stream is absent.
    pub fn get<T: Datum>(&self, input: &Input<T>) -> Option<T> {
        self.graph.value(self.inputs[input.index])
    }

    /// Returns the number that an input reads.
    ///
    /// # Errors
    /// The input is absent or NaN; the error names it.
    pub fn number(&self, input: &Input<f64>) -> Result<f64, InputError> {
        let name = || input.name.to_string();
        let number = self.get(input).ok_or_else(|| InputError::Absent { input: name() })?;
        if number.is_nan() { Err(InputError::NotANumber { input: name() }) } else { Ok(number) }
    }

    /// Returns the speed that an input reads; 0 if the input's stream is absent.
    ///
    /// # Errors
    /// The speed is not a finite number from 0 on; the error names the input.
    pub fn speed(&self, input: &Input<f64>) -> Result<f64, InputError> {
        let speed = self.get(input).unwrap_or(0.0);
        if (0.0..f64::INFINITY).contains(&speed) {
            Ok(speed)
        } else {
            Err(InputError::OutOfRange { input: input.name.to_string(), value: speed, expected: "a number from 0 on" })
        }
    }

    /// Returns all bodies in the world except the object's own bodies, as they stand at the beginning of the tick. The
    /// ego vehicle is first. The other bodies follow in the order in which they were placed.
    pub fn others(&self) -> impl Iterator<Item = &BodyState> {
        let Range { start, end } = self.own.0..self.own.1;
        self.bodies[..start].iter().chain(&self.bodies[end..]).filter(|body| body.present)
    }
}
