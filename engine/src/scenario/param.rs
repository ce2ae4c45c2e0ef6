//! Parameters as programs see them: a stream where a stream is read, a plain value where the structure of the
//! world depends on it.
//!
//! Whether a parameter is constant or a signal that varies over a run is nobody's business but the test's: the object
//! that reads it gets a [`Stream`] either way.

use super::Scenario;
use crate::flaw::{Flaws, WorldFlaw};
use crate::stream::{Datum, DatumSample, NodeKind, Stream, samples};
use crate::test::{Declared, entry};
use paracosm_space::{Shape, Value};
use std::cell::{Cell, RefCell};
use std::fmt;
use std::rc::Rc;

/// A parameter of type `T` (a number, a word, or whatever else stands for the values of a choice) with the value that
/// the test gives it.
#[derive(Clone)]
pub struct Param<T> {
    declared: Rc<RefCell<Vec<Declared>>>,
    index: usize,
    flaws: Flaws,
    /// The key of the test: [`Test::key`](crate::Test::key).
    key: Rc<Cell<u64>>,
    given: Given,
    read: Read<T>,
}

/// What a test says of a parameter.
#[derive(Debug, Clone, Default)]
pub(super) struct Given {
    /// Its value; `None` where there is no test.
    pub value: Option<Value>,
    /// How it varies, where the test says so: not at all, or in a shape. `None`: as the program declares.
    pub signal: Option<Option<Shape>>,
}

/// The value as one of type `T`, if it is one.
type With<T> = Rc<dyn Fn(&Value) -> Option<T>>;

/// How values become values of type `T`.
#[derive(Clone)]
pub(super) struct Read<T> {
    with: With<T>,
    /// Any value, to go on with after a mistake that is reported.
    placeholder: T,
}

impl Read<f64> {
    pub fn number() -> Self {
        Self { with: Rc::new(Value::number), placeholder: f64::NAN }
    }
}

impl<T: Into<Value> + Clone + 'static> Read<T> {
    /// One of these levels.
    pub fn level<const N: usize>(levels: [T; N]) -> Self {
        let placeholder = levels[0].clone();
        let levels = levels.map(|level| (level.clone().into(), level));
        let with = move |value: &Value| levels.iter().find(|(known, _)| known == value).map(|(_, level)| level.clone());
        Self { with: Rc::new(with), placeholder }
    }
}

impl<T: Clone> Param<T> {
    /// Of the parameter that was declared last.
    pub(super) fn new(scenario: &Scenario, given: Given, read: Read<T>) -> Self {
        let Scenario { parameters, flaws, key, .. } = scenario;
        let (declared, flaws, key) = (parameters.clone(), flaws.clone(), key.clone());
        let index = declared.borrow().len() - 1;
        let parameter = Self { declared, index, flaws, key, given, read };
        for value in parameter.given.value.iter().flat_map(Value::scalars) {
            if (parameter.read.with)(value).is_none() {
                parameter.flaw(WorldFlaw::OtherType { parameter: parameter.name(), value: value.clone() });
            }
        }
        parameter
    }

    /// Says in which unit its values are read.
    pub fn unit(self, unit: &str) -> Self {
        self.declared.borrow_mut()[self.index].parameter.unit = Some(unit.to_owned());
        self
    }

    /// Gives an open parameter its nominal value, where shrinking goes and what it has when a study closes it. That of
    /// a signal is a list with a value for each coordinate, or one value for all.
    pub fn default(self, value: impl Into<Value>) -> Self {
        self.declared.borrow_mut()[self.index].parameter.default = Some(value.into());
        self
    }

    /// Lets it vary over time: the test gives it a value for each coordinate of this shape. A study may ask for another
    /// shape, or for none. A choice varies in pieces.
    pub fn signal(self, shape: Shape) -> Self {
        self.declared.borrow_mut()[self.index].parameter.signal = Some(shape);
        self
    }

    /// Says that a test in which it has its nominal value is the one that it would be without it, down to the noise of its
    /// cameras, which is another in every other test: for parameters that a program asks for later than for the rest.
    pub fn incidental(self) -> Self {
        let value = self.given_or_nominal();
        if self.given.value.is_some() && value == self.declared.borrow()[self.index].nominal() {
            self.key.set(self.key.get().wrapping_sub(entry(&self.name(), &value)));
        }
        self
    }

    /// The value that this test gives it. Where the test lets it vary over time, the world cannot be built: who asks
    /// for a value needs one for the whole run.
    pub fn value(&self) -> T {
        if self.shape().is_some() {
            self.flaw(WorldFlaw::Varies { parameter: self.name() });
        }
        self.read(self.given_or_nominal().scalars().first())
    }

    fn name(&self) -> String {
        self.declared.borrow()[self.index].parameter.name.clone()
    }

    fn flaw(&self, flaw: WorldFlaw) {
        self.flaws.borrow_mut().push(flaw);
    }

    fn shape(&self) -> Option<Shape> {
        self.given.signal.unwrap_or(self.declared.borrow()[self.index].parameter.signal)
    }

    fn given_or_nominal(&self) -> Value {
        self.given.value.clone().unwrap_or_else(|| self.declared.borrow()[self.index].nominal())
    }

    fn read(&self, value: Option<&Value>) -> T {
        value.and_then(|value| (self.read.with)(value)).unwrap_or_else(|| self.read.placeholder.clone())
    }
}

impl<T: Datum> Param<T> {
    fn stream(&self) -> Stream<T> {
        let parameter = self.name();
        let value = self.given_or_nominal();
        let shape = self.shape().filter(|shape| {
            let suits = self.declared.borrow()[self.index].parameter.check_signal(*shape);
            suits.map_err(|error| self.flaw(error.into())).is_ok()
        });
        let Some(shape) = shape else {
            if matches!(value, Value::List(_)) {
                self.flaw(WorldFlaw::DoesNotVary { parameter: parameter.clone(), value: value.clone() });
            }
            let value = samples(self.read(value.scalars().first()));
            return Stream::new(NodeKind::Constant { value, parameter: Some(parameter) }, []);
        };
        let expected = shape.coordinates();
        let values: Vec<DatumSample> = match &value {
            Value::List(values) if values.len() == expected => {
                values.iter().flat_map(|value| samples(self.read(Some(value)))).collect()
            }
            value => {
                let found = value.scalars().len();
                if found != 1 {
                    let parameter = parameter.clone();
                    self.flaw(WorldFlaw::Coordinates { parameter, found, expected, shape });
                }
                samples(self.read(value.scalars().first())).repeat(expected)
            }
        };
        Stream::new(NodeKind::Signal { parameter, shape, values }, [])
    }
}

impl<T> fmt::Debug for Param<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {:?}", self.declared.borrow()[self.index].parameter.name, self.given)
    }
}

impl<T: Datum> From<Param<T>> for Stream<T> {
    fn from(parameter: Param<T>) -> Self {
        parameter.stream()
    }
}

impl<T: Datum> From<&Param<T>> for Stream<T> {
    fn from(parameter: &Param<T>) -> Self {
        parameter.stream()
    }
}
