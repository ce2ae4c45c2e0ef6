//! The drawing of what objects do with their inputs.
//!
//! A graph of streams ends at the inputs of objects. An object that plays a program of its own, such as the storyboard of a file,
//! draws here which of its steps an input starts, and whom its actions move.

use super::combinators::Stream;
use super::node::{Node, NodeKind};
use std::rc::Rc;

/// The parts of objects and the lines between them, which [`Program::dot`](crate::Program::dot) draws behind the streams.
#[derive(Debug, Clone, Default)]
pub struct Sketch {
    pub(super) parts: Vec<(String, Form)>,
    pub(super) lines: Vec<Line>,
}

/// The input of an object in a [`Sketch`]: [`Input::reader`](crate::object::Input::reader).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reader(pub(crate) usize);

/// A part of an object in a [`Sketch`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part(pub(super) usize);

/// The form of a part in the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A step of the object's program, with round corners.
    Step,
    /// An action, as an arrow.
    Action,
    /// The actor that actions move, as an octagon.
    Actor,
}

/// A line to or from a part.
#[derive(Debug, Clone)]
pub(super) enum Line {
    /// From an input to a part, with words.
    Starts(Reader, Part, String),
    Leads(Part, Part),
    /// From a part to the node of a stream.
    Shows(Part, Rc<Node>),
}

impl Sketch {
    /// Adds a part. Line breaks of the label are kept.
    pub fn part(&mut self, label: impl Into<String>, form: Form) -> Part {
        self.parts.push((label.into(), form));
        Part(self.parts.len() - 1)
    }

    /// Draws a line from an input to the part that the input affects, with words such as `start`.
    pub fn starts(&mut self, input: Reader, part: Part, words: impl Into<String>) {
        self.lines.push(Line::Starts(input, part, words.into()));
    }

    /// Draws a line from a part to a part that it starts or moves.
    pub fn leads(&mut self, from: Part, to: Part) {
        self.lines.push(Line::Leads(from, to));
    }

    /// Draws a line from a part to the stream of an output whose values the part determines. The line is left out if nobody reads
    /// the output.
    pub fn shows<T>(&mut self, part: Part, output: &Stream<T>) {
        self.lines.push(Line::Shows(part, output.node.clone()));
    }
}

impl Line {
    /// Returns `true` if the line leads to the output that a node reads.
    pub fn shows(&self, node: &Node) -> bool {
        match (self, &node.kind) {
            (Self::Shows(_, shown), NodeKind::Output { source, .. }) => {
                matches!(&shown.kind, NodeKind::Output { source: of, .. } if of == source)
            }
            _ => false,
        }
    }
}

impl Form {
    pub(super) fn style(self) -> &'static str {
        match self {
            Self::Step => "shape=box, style=rounded",
            Self::Action => "shape=cds",
            Self::Actor => "shape=octagon",
        }
    }
}
