//! Streams that are read before they are defined, for feedback.

use super::Stream;
use super::node::Equation;
use std::cell::RefCell;
use std::ops::Deref;
use std::rc::Rc;

/// A stream that was announced by [`Scenario::forward`](crate::Scenario::forward) and is defined later. A program can
/// use it like any other stream, before and after its definition.
#[derive(Debug)]
pub struct Forward<T> {
    pub(crate) stream: Stream<T>,
    /// The index of the stream's equation among all equations.
    pub(crate) equation: usize,
    pub(crate) equations: Rc<RefCell<Vec<Equation>>>,
}

impl<T> Forward<T> {
    /// Sets the definition of the stream. A second definition is a mistake of the scenario.
    pub fn define(&self, definition: impl Into<Stream<T>>) {
        let equation = &mut self.equations.borrow_mut()[self.equation];
        equation.is_defined_twice |= equation.definition.replace(definition.into().node).is_some();
    }
}

impl<T> Deref for Forward<T> {
    type Target = Stream<T>;

    fn deref(&self) -> &Stream<T> {
        &self.stream
    }
}
