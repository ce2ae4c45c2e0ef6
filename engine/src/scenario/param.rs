//! Parameters as programs see them: a stream where a stream is read, a plain value where the structure of the
//! world depends on it.

use crate::program::Declared;
use crate::stream::{Datum, Stream};
use paracosm_coverage::Value;
use std::cell::RefCell;
use std::rc::Rc;

/// A parameter of type `T` (a number or a word) with the value that the test gives it.
#[derive(Debug, Clone)]
pub struct Param<T> {
    declared: Rc<RefCell<Vec<Declared>>>,
    index: usize,
    value: T,
}

/// The types that parameters have in programs.
pub trait Plain: Clone {
    /// The value of this type, if `value` is of it.
    fn from_value(value: &Value) -> Option<Self>;

    /// Any value of this type, to go on with after a mistake that is reported.
    fn placeholder() -> Self;
}

impl Plain for f64 {
    fn from_value(value: &Value) -> Option<Self> {
        value.number()
    }

    fn placeholder() -> Self {
        f64::NAN
    }
}

impl Plain for i32 {
    fn from_value(value: &Value) -> Option<Self> {
        value.number().filter(|number| number.trunc() == *number).map(|number| number as i32)
    }

    fn placeholder() -> Self {
        0
    }
}

impl Plain for String {
    fn from_value(value: &Value) -> Option<Self> {
        value.word().map(str::to_owned)
    }

    fn placeholder() -> Self {
        String::new()
    }
}

impl<T: Plain> Param<T> {
    /// Of the parameter that was declared last.
    pub(super) fn new(declared: Rc<RefCell<Vec<Declared>>>, value: T) -> Self {
        let index = declared.borrow().len() - 1;
        Self { declared, index, value }
    }

    /// Says in which unit its values are read.
    pub fn unit(self, unit: &str) -> Self {
        self.declared.borrow_mut()[self.index].parameter.unit = Some(unit.to_owned());
        self
    }

    /// Gives an open parameter its nominal value, where shrinking goes and what it has when a study closes it.
    pub fn default(self, value: impl Into<Value>) -> Self {
        self.declared.borrow_mut()[self.index].parameter.default = Some(value.into());
        self
    }

    /// The value that this test gives it.
    pub fn value(&self) -> T {
        self.value.clone()
    }
}

impl<T: Datum + Plain> From<Param<T>> for Stream<T> {
    fn from(parameter: Param<T>) -> Self {
        Stream::constant(parameter.value)
    }
}

impl<T: Datum + Plain> From<&Param<T>> for Stream<T> {
    fn from(parameter: &Param<T>) -> Self {
        Stream::constant(parameter.value)
    }
}
