//! The expressions that streams are made of, and the typed handles by which programs write them.

use crate::scenario::Line;
use nalgebra::Vector2;
use paracosm_oracles::Comparison;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Sub;
use std::rc::Rc;

/// A value at one tick. Public only because [`Datum`] speaks of it; nobody outside can name it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sample {
    Absent,
    Truth(bool),
    Number(f64),
    Vector(Vector2<f64>),
}

/// The types that streams carry: numbers, truths and vectors in the ground plane.
pub trait Datum: Copy + 'static {
    #[doc(hidden)]
    fn wrap(self) -> Sample;
    #[doc(hidden)]
    fn unwrap(sample: Sample) -> Option<Self>;
}

macro_rules! datum {
    ($type:ty, $variant:ident) => {
        impl Datum for $type {
            fn wrap(self) -> Sample {
                Sample::$variant(self)
            }

            fn unwrap(sample: Sample) -> Option<Self> {
                match sample {
                    Sample::$variant(value) => Some(value),
                    _ => None,
                }
            }
        }
    };
}

datum!(bool, Truth);
datum!(f64, Number);
datum!(Vector2<f64>, Vector);

/// An output of an object in the world, as it stands at the beginning of a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Source {
    CarPosition,
    CarX,
    CarY,
    CarSpeed,
    CarAcceleration,
    CarTravelled,
    CarClearance,
    CarThrottle,
    WalkerPosition(usize),
    WalkerX(usize),
    WalkerY(usize),
    WalkerSpeed(usize),
    WalkerRemaining(usize),
}

/// What a stream is made of.
#[derive(Debug)]
pub(crate) enum Node {
    Constant(Sample),
    Output {
        source: Source,
        name: String,
    },
    Difference(Rc<Node>, Rc<Node>),
    /// The distance along a line's direction from a position to the line's point.
    Towards {
        position: Rc<Node>,
        line: Line,
    },
    Compare {
        left: Rc<Node>,
        comparison: Comparison,
        right: Rc<Node>,
    },
    SkipUntil {
        stream: Rc<Node>,
        event: Rc<Node>,
    },
    TakeUntil {
        stream: Rc<Node>,
        event: Rc<Node>,
    },
}

/// The expression as one would write it, which is also the name of the signal that records it.
impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Node::Constant(Sample::Number(number)) => write!(f, "{number}"),
            Node::Constant(sample) => write!(f, "{sample:?}"),
            Node::Output { name, .. } => f.write_str(name),
            Node::Difference(left, right) => write!(f, "({left} - {right})"),
            Node::Towards { position, line } => write!(f, "distance({position}, {})", line.name),
            Node::Compare { left, comparison, right } => write!(f, "({left} {} {right})", comparison.symbol()),
            Node::SkipUntil { stream, event } => write!(f, "skip_until({stream}, {event})"),
            Node::TakeUntil { stream, event } => write!(f, "take_until({stream}, {event})"),
        }
    }
}

/// A stream of values of type `T`; a cheap handle, see the [module](crate::stream).
#[derive(Debug, Clone)]
pub struct Stream<T> {
    pub(crate) node: Rc<Node>,
    carries: PhantomData<T>,
}

impl<T: Datum> Stream<T> {
    pub(crate) fn new(node: Node) -> Self {
        Self { node: Rc::new(node), carries: PhantomData }
    }

    /// The stream that has this value at every tick.
    pub fn constant(value: T) -> Self {
        Self::new(Node::Constant(value.wrap()))
    }

    pub(crate) fn output(source: Source, name: String) -> Self {
        Self::new(Node::Output { source, name })
    }

    /// Absent until the first tick at which `event` is true; the stream itself from that tick on.
    pub fn skip_until(&self, event: &Stream<bool>) -> Self {
        Self::new(Node::SkipUntil { stream: self.node.clone(), event: event.node.clone() })
    }

    /// The stream itself until the first tick at which `event` is true; absent from that tick on.
    pub fn take_until(&self, event: &Stream<bool>) -> Self {
        Self::new(Node::TakeUntil { stream: self.node.clone(), event: event.node.clone() })
    }
}

impl Stream<f64> {
    /// True at the ticks at which this is below the other.
    pub fn below(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.compare(Comparison::Below, other.into())
    }

    /// True at the ticks at which this is at most the other.
    pub fn at_most(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.compare(Comparison::AtMost, other.into())
    }

    /// True at the ticks at which this is above the other.
    pub fn above(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.compare(Comparison::Above, other.into())
    }

    /// True at the ticks at which this is at least the other.
    pub fn at_least(&self, other: impl Into<Stream<f64>>) -> Stream<bool> {
        self.compare(Comparison::AtLeast, other.into())
    }

    fn compare(&self, comparison: Comparison, right: Stream<f64>) -> Stream<bool> {
        Stream::new(Node::Compare { left: self.node.clone(), comparison, right: right.node })
    }
}

impl Stream<Vector2<f64>> {
    /// How far the line still lies ahead of this position, along the line's direction, in metres; negative
    /// behind it.
    pub fn distance_to(&self, line: &Line) -> Stream<f64> {
        Stream::new(Node::Towards { position: self.node.clone(), line: line.clone() })
    }
}

impl<T: Datum> From<T> for Stream<T> {
    fn from(value: T) -> Self {
        Stream::constant(value)
    }
}

impl<S: Into<Stream<f64>>> Sub<S> for Stream<f64> {
    type Output = Stream<f64>;

    fn sub(self, other: S) -> Stream<f64> {
        Stream::new(Node::Difference(self.node, other.into().node))
    }
}
