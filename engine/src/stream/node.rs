//! The nodes of streams, with the computation of each node and the nodes that it reads.

use super::datum::DatumSample;
use crate::line::Line;
use nalgebra::Vector2;
use paracosm_oracles::Comparison;
use paracosm_space::Shape;
use std::cell::RefCell;
use std::fmt;
use std::rc::Rc;

/// An output of an object, as the index of its first sample among the samples of all outputs at the start of a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Source(pub usize);

/// A function of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unary {
    Negative,
    Absolute,
    SquareRoot,
    Not,
    Norm,
    X,
    Y,
}

/// A function of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Binary {
    Sum,
    Difference,
    /// The product of numbers, or of a vector and a number.
    Product,
    Quotient,
    Least,
    Greatest,
    Dot,
    /// The vector with two numbers as its coordinates.
    Vector,
    And,
    Or,
}

/// A function that reads a value and writes another value.
pub(crate) type Map = Rc<dyn Fn(&[DatumSample], &mut [DatumSample])>;
/// A function that reads a value and returns `true` if the value is to be kept.
pub(crate) type Filter = Rc<dyn Fn(&[DatumSample]) -> bool>;
/// A function that changes its first value with the help of its second value.
pub(crate) type Scan = Rc<dyn Fn(&mut [DatumSample], &[DatumSample])>;
/// A function that has an effect with a value.
pub(crate) type Effect = Rc<RefCell<dyn FnMut(&[DatumSample])>>;

/// The operation of a node on its inputs. The table in [the module](super) shows each operation, tick by tick.
#[derive(Clone)]
pub(crate) enum NodeKind {
    /// A constant value, and the parameter that the value comes from, if any.
    Constant {
        value: Vec<DatumSample>,
        parameter: Option<String>,
    },
    /// The values of a parameter that varies over time, one after the other.
    Signal {
        parameter: String,
        shape: Shape,
        values: Vec<DatumSample>,
    },
    /// The seconds since the run began.
    Time,
    Output {
        source: Source,
        name: String,
    },
    /// The stream that the equation with this index defines.
    Forward {
        equation: usize,
        name: String,
    },
    Named(String),
    Unary(Unary),
    Binary(Binary),
    Compare(Comparison),
    Equal,
    /// The distance along a line's direction from a position to the line's point.
    Towards(Line),
    Map(Map),
    Filter(Filter),
    When,
    Zip,
    Take(usize),
    Concat,
    /// The sum so far, which begins with this value.
    Sum(DatumSample),
    Scan {
        initial: Vec<DatumSample>,
        step: Scan,
    },
    Merge,
    TakeUntil,
    SkipUntil,
    Pre,
    Hold {
        initial: Vec<DatumSample>,
    },
    ForEach(Effect),
}

/// A node of the graph of streams.
pub(crate) struct Node {
    pub kind: NodeKind,
    /// The nodes that this node reads (none, one or two).
    pub inputs: Vec<Rc<Node>>,
    /// The number of samples of the node's value.
    pub width: usize,
}

/// The equation `name = definition` of a forward stream, with a definition once it is known.
#[derive(Debug, Clone)]
pub(crate) struct Equation {
    pub name: String,
    pub definition: Option<Rc<Node>>,
    pub is_defined_twice: bool,
}

impl Node {
    /// Returns the name of the parameter whose value the node has; `None` for all other nodes.
    pub fn parameter(&self) -> Option<&str> {
        match &self.kind {
            NodeKind::Constant { parameter, .. } => parameter.as_deref(),
            NodeKind::Signal { parameter, .. } => Some(parameter),
            _ => None,
        }
    }

    /// Returns the label of the node in pictures that also show the inputs of the node.
    pub fn label(&self) -> String {
        match &self.kind {
            NodeKind::Constant { value, parameter: None } => value.iter().map(text).collect::<Vec<_>>().join(", "),
            NodeKind::Constant { parameter: Some(name), .. }
            | NodeKind::Output { name, .. }
            | NodeKind::Forward { name, .. }
            | NodeKind::Named(name) => name.clone(),
            NodeKind::Signal { parameter, shape, .. } => format!("{parameter}: {shape}"),
            NodeKind::Unary(function) => function.word().to_owned(),
            NodeKind::Binary(function) => function.word().to_owned(),
            NodeKind::Compare(comparison) => comparison.symbol().to_owned(),
            NodeKind::Equal => "==".to_owned(),
            NodeKind::Towards(line) => format!("distance to {}", line.name),
            NodeKind::Take(count) => format!("take {count}"),
            NodeKind::Hold { initial } => {
                format!("hold, first {}", initial.iter().map(text).collect::<Vec<_>>().join(", "))
            }
            kind => kind.word().to_owned(),
        }
    }

    /// Returns `true` if two nodes stand for the same operations on the same inputs. Two closures are the same
    /// operation only if they are the same closure.
    pub fn means(self: &Rc<Self>, other: &Rc<Self>) -> bool {
        let (left, right) = (self.unnamed(), other.unnamed());
        if Rc::ptr_eq(left, right) {
            return true;
        }
        let kinds = match (&left.kind, &right.kind) {
            (NodeKind::Map(left), NodeKind::Map(right)) => Rc::ptr_eq(left, right),
            (NodeKind::Filter(left), NodeKind::Filter(right)) => Rc::ptr_eq(left, right),
            (NodeKind::Scan { step: left, .. }, NodeKind::Scan { step: right, .. }) => Rc::ptr_eq(left, right),
            (NodeKind::ForEach(left), NodeKind::ForEach(right)) => Rc::ptr_eq(left, right),
            (NodeKind::Forward { equation: left, .. }, NodeKind::Forward { equation: right, .. }) => left == right,
            (NodeKind::Constant { value: left, .. }, NodeKind::Constant { value: right, .. }) => left == right,
            (NodeKind::Towards(left), NodeKind::Towards(right)) => left == right,
            (one, another) => {
                std::mem::discriminant(one) == std::mem::discriminant(another) && left.label() == right.label()
            }
        };
        kinds
            && left.inputs.len() == right.inputs.len()
            && left.inputs.iter().zip(&right.inputs).all(|(left, right)| left.means(right))
    }

    /// Returns `true` if the node is an output of an object that the program has not renamed.
    pub fn is_output(&self) -> bool {
        matches!(self.kind, NodeKind::Output { .. })
    }

    /// Returns the node without the names that the program has given to the node.
    pub fn unnamed(self: &Rc<Self>) -> &Rc<Self> {
        match self.kind {
            NodeKind::Named(_) => self.inputs[0].unnamed(),
            _ => self,
        }
    }
}

impl NodeKind {
    /// Returns `true` if the operation depends on nothing but the present values of its inputs. Closures of a program
    /// do not count, because they may have effects.
    pub fn is_pure(&self) -> bool {
        match self {
            NodeKind::Unary(_)
            | NodeKind::Binary(_)
            | NodeKind::Compare(_)
            | NodeKind::Equal
            | NodeKind::Towards(_)
            | NodeKind::When
            | NodeKind::Zip
            | NodeKind::Concat
            | NodeKind::Merge => true,
            NodeKind::Constant { .. }
            | NodeKind::Signal { .. }
            | NodeKind::Time
            | NodeKind::Output { .. }
            | NodeKind::Forward { .. }
            | NodeKind::Named(_)
            | NodeKind::Map(_)
            | NodeKind::Filter(_)
            | NodeKind::Take(_)
            | NodeKind::Sum(_)
            | NodeKind::Scan { .. }
            | NodeKind::TakeUntil
            | NodeKind::SkipUntil
            | NodeKind::Pre
            | NodeKind::Hold { .. }
            | NodeKind::ForEach(_) => false,
        }
    }

    /// Returns the method by which programs make a node of this kind.
    fn word(&self) -> &'static str {
        match self {
            NodeKind::Map(_) => "map",
            NodeKind::Filter(_) => "filter",
            NodeKind::When => "when",
            NodeKind::Zip => "zip",
            NodeKind::Take(_) => "take",
            NodeKind::Concat => "concat",
            NodeKind::Sum(_) => "sum",
            NodeKind::Scan { .. } => "scan",
            NodeKind::Merge => "merge",
            NodeKind::TakeUntil => "take_until",
            NodeKind::SkipUntil => "skip_until",
            NodeKind::Pre => "pre",
            NodeKind::Hold { .. } => "hold",
            NodeKind::ForEach(_) => "for_each",
            NodeKind::Equal => "equals",
            NodeKind::Towards(_) => "distance",
            NodeKind::Constant { .. } | NodeKind::Signal { .. } | NodeKind::Output { .. } => "input",
            NodeKind::Time => "time",
            NodeKind::Forward { .. } | NodeKind::Named(_) => "name",
            NodeKind::Unary(function) => function.word(),
            NodeKind::Binary(function) => function.word(),
            NodeKind::Compare(comparison) => comparison.symbol(),
        }
    }
}

impl Unary {
    fn word(self) -> &'static str {
        match self {
            Unary::Negative => "-",
            Unary::Absolute => "abs",
            Unary::SquareRoot => "sqrt",
            Unary::Not => "not",
            Unary::Norm => "norm",
            Unary::X => "x",
            Unary::Y => "y",
        }
    }

    /// Writes the value of the function; absent if its argument is absent.
    #[inline(always)]
    pub fn of(self, value: &DatumSample, output: &mut DatumSample) {
        use DatumSample::{Absent, Number, Truth, Vector};
        match (self, value) {
            (Unary::Negative, Number(x)) => *output = Number(-x),
            (Unary::Negative, Vector(x, y)) => *output = Vector(-x, -y),
            (Unary::Absolute, Number(x)) => *output = Number(x.abs()),
            (Unary::SquareRoot, Number(x)) => *output = Number(x.sqrt()),
            (Unary::Not, Truth(x)) => *output = Truth(!x),
            (Unary::Norm, Vector(x, y)) => *output = Number(Vector2::new(*x, *y).norm()),
            (Unary::X, Vector(x, _)) => *output = Number(*x),
            (Unary::Y, Vector(_, y)) => *output = Number(*y),
            _ => *output = Absent,
        }
    }
}

impl Binary {
    fn word(self) -> &'static str {
        match self {
            Binary::Sum => "+",
            Binary::Difference => "-",
            Binary::Product => "*",
            Binary::Quotient => "/",
            Binary::Least => "min",
            Binary::Greatest => "max",
            Binary::Dot => "dot",
            Binary::Vector => "vector",
            Binary::And => "and",
            Binary::Or => "or",
        }
    }

    /// Writes the value of the function; absent if an argument is absent.
    #[inline(always)]
    pub fn of(self, left: &DatumSample, right: &DatumSample, output: &mut DatumSample) {
        use DatumSample::{Absent, Number, Truth, Vector};
        match (self, left, right) {
            (Binary::Sum, Number(a), Number(b)) => *output = Number(a + b),
            (Binary::Difference, Number(a), Number(b)) => *output = Number(a - b),
            (Binary::Product, Number(a), Number(b)) => *output = Number(a * b),
            (Binary::Quotient, Number(a), Number(b)) => *output = Number(a / b),
            (Binary::Least, Number(a), Number(b)) => *output = Number(if a <= b || a.is_nan() { *a } else { *b }),
            (Binary::Greatest, Number(a), Number(b)) => *output = Number(if a >= b || a.is_nan() { *a } else { *b }),
            (Binary::Vector, Number(a), Number(b)) => *output = Vector(*a, *b),
            (Binary::Sum, Vector(ax, ay), Vector(bx, by)) => *output = Vector(ax + bx, ay + by),
            (Binary::Difference, Vector(ax, ay), Vector(bx, by)) => *output = Vector(ax - bx, ay - by),
            (Binary::Product, Vector(x, y), Number(b)) => *output = Vector(x * b, y * b),
            (Binary::Quotient, Vector(x, y), Number(b)) => *output = Vector(x / b, y / b),
            (Binary::Dot, Vector(ax, ay), Vector(bx, by)) => *output = Number(ax * bx + ay * by),
            (Binary::And, Truth(a), Truth(b)) => *output = Truth(*a && *b),
            (Binary::Or, Truth(a), Truth(b)) => *output = Truth(*a || *b),
            _ => *output = Absent,
        }
    }
}

fn text(sample: &DatumSample) -> String {
    match sample {
        DatumSample::Absent => "absent".to_owned(),
        DatumSample::Event => "tick".to_owned(),
        DatumSample::Truth(truth) => truth.to_string(),
        DatumSample::Number(number) => number.to_string(),
        DatumSample::Vector(x, y) => format!("({x}, {y})"),
        DatumSample::Word(word) => (*word).to_owned(),
    }
}

/// Writes the expression as a person would write it, which is also the name of the signal that records it.
impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.kind, self.inputs.as_slice()) {
            (NodeKind::Constant { value, .. }, _) => {
                f.write_str(&value.iter().map(text).collect::<Vec<_>>().join(", "))
            }
            (NodeKind::Signal { parameter, .. }, _) => f.write_str(parameter),
            (NodeKind::Time, _) => f.write_str("time"),
            (NodeKind::Output { name, .. } | NodeKind::Forward { name, .. } | NodeKind::Named(name), _) => {
                f.write_str(name)
            }
            (NodeKind::Unary(Unary::Negative), [input]) => write!(f, "-{input}"),
            (NodeKind::Towards(line), [position]) => write!(f, "distance({position}, {})", line.name),
            (NodeKind::Take(count), [input]) => write!(f, "take({input}, {count})"),
            (NodeKind::Hold { initial }, [input]) => {
                write!(f, "hold({input}, {})", initial.iter().map(text).collect::<Vec<_>>().join(", "))
            }
            (
                NodeKind::Binary(
                    Binary::Sum | Binary::Difference | Binary::Product | Binary::Quotient | Binary::And | Binary::Or,
                )
                | NodeKind::Compare(_)
                | NodeKind::Equal,
                [left, right],
            ) => write!(f, "({left} {} {right})", self.label()),
            (kind, inputs) => {
                write!(f, "{}(", kind.word())?;
                for (i, input) in inputs.iter().enumerate() {
                    write!(f, "{}{input}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str(")")
            }
        }
    }
}

impl fmt::Debug for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Drops one node after the other: a chain of many thousands of nodes would otherwise need as many stack frames.
impl Drop for Node {
    fn drop(&mut self) {
        let mut waiting = std::mem::take(&mut self.inputs);
        while let Some(node) = waiting.pop() {
            if let Some(mut node) = Rc::into_inner(node) {
                waiting.append(&mut node.inputs);
            }
        }
    }
}
