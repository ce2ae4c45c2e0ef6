//! Parameters in programs: a parameter can be read as a stream, or as a plain value if the structure of the world
//! depends on it.
//!
//! The test alone decides whether a parameter is constant or a signal that varies over a run. The object that reads it
//! gets a [`Stream`] in both cases.

use super::Scenario;
use super::reach::Use;
use crate::flaw::{Flaws, WorldFlaw};
use crate::stream::{Datum, DatumSample, NodeKind, Stream, samples};
use crate::test::{Declared, entry};
use paracosm_space::{Domain, Shape, Value};
use std::cell::{Cell, OnceCell, RefCell};
use std::fmt;
use std::ops::{Deref, RangeInclusive};
use std::rc::Rc;

/// A parameter with the value that the test gives the parameter. `T` is the type of its values: a number, a word, or
/// any type that stands for the levels of a choice.
#[derive(Clone)]
pub struct Param<T> {
    declared: Rc<RefCell<Vec<Declared>>>,
    uses: Rc<RefCell<Vec<Use>>>,
    index: usize,
    flaws: Flaws,
    keys: Rc<Keys>,
    atmospheric: bool,
    given: Given,
    read: Read<T>,
    /// The parameter as a stream, once a method or an operator of streams was used on it.
    as_stream: OnceCell<Stream<T>>,
}

/// Hashes of the test, as far as the program asks for its parameters: [`Test::key`](crate::Test::key). 0 without a test.
#[derive(Debug, Default)]
pub(crate) struct Keys {
    /// The key of the test.
    pub test: Cell<u64>,
    /// The key of the same test with the nominal air.
    pub scenery: Cell<u64>,
}

/// The value and the shape that a test gives a parameter.
#[derive(Debug, Clone, Default)]
pub(super) struct Given {
    /// The value of the parameter; `None` if there is no test.
    pub value: Option<Value>,
    /// The shape of the signal, or no shape for a constant; `None` if the test leaves it to the program's declaration.
    pub signal: Option<Option<Shape>>,
}

/// A function that converts a value to type `T`, if possible.
type With<T> = Rc<dyn Fn(&Value) -> Option<T>>;

/// The conversion of values to type `T`.
#[derive(Clone)]
pub(super) struct Read<T> {
    with: With<T>,
    /// Some value with which the program goes on after a mistake, which is reported.
    placeholder: T,
}

impl Read<f64> {
    pub fn number() -> Self {
        Self { with: Rc::new(Value::number), placeholder: f64::NAN }
    }
}

impl Read<Value> {
    pub fn value() -> Self {
        Self { with: Rc::new(|value: &Value| Some(value.clone())), placeholder: Value::Number(f64::NAN) }
    }
}

impl Read<String> {
    pub fn text() -> Self {
        let with = |value: &Value| (!matches!(value, Value::List(_))).then(|| value.to_string());
        Self { with: Rc::new(with), placeholder: String::new() }
    }
}

impl<T: Into<Value> + Clone + 'static> Read<T> {
    /// Makes the conversion of values to the given levels.
    pub fn level<const N: usize>(levels: [T; N]) -> Self {
        let placeholder = levels[0].clone();
        let levels = levels.map(|level| (level.clone().into(), level));
        let with = move |value: &Value| levels.iter().find(|(known, _)| known == value).map(|(_, level)| level.clone());
        Self { with: Rc::new(with), placeholder }
    }
}

impl<T: Clone> Param<T> {
    /// Makes the parameter that was declared last.
    pub(super) fn new(scenario: &Scenario, given: Given, read: Read<T>) -> Self {
        let Scenario { parameters, uses, flaws, keys, .. } = scenario;
        let (declared, uses, flaws, keys) = (parameters.clone(), uses.clone(), flaws.clone(), keys.clone());
        let index = declared.borrow().len() - 1;
        let parameter =
            Self { declared, uses, index, flaws, keys, atmospheric: false, given, read, as_stream: OnceCell::new() };
        for value in parameter.given.value.iter().flat_map(Value::scalars) {
            if (parameter.read.with)(value).is_none() {
                parameter.flaw(WorldFlaw::OtherType { parameter: parameter.name(), value: value.clone() });
            }
        }
        parameter
    }

    /// Lets the parameter take any text.
    pub(super) fn taking_texts(self) -> Self {
        self.declared.borrow_mut()[self.index].takes_texts = true;
        self
    }

    /// Sets the unit of the parameter's values.
    pub fn unit(self, unit: &str) -> Self {
        self.declared.borrow_mut()[self.index].parameter.unit = Some(unit.to_owned());
        self
    }

    /// Sets the nominal value of an open parameter. Shrinking moves towards it, and the parameter has it when a study
    /// closes it. For a signal, it is a list with a value for each coordinate, or one value for all.
    pub fn default(self, value: impl Into<Value>) -> Self {
        self.declared.borrow_mut()[self.index].parameter.default = Some(value.into());
        self
    }

    /// Sets the interval that tests vary a closed parameter over if a study opens it and names no range. It is a part of
    /// the parameter's domain, for example the realistic values.
    pub fn opens(self, range: RangeInclusive<f64>) -> Self {
        let (lo, hi) = range.into_inner();
        self.declared.borrow_mut()[self.index].opens = Some(Domain::Interval { lo, hi });
        self
    }

    /// Sets the least and the greatest value that occur in the world, as a part of the parameter's domain. Tests with other values run as
    /// all others, and a summary also names the worst of the plausible tests.
    pub fn plausible(self, range: RangeInclusive<f64>) -> Self {
        self.declared.borrow_mut()[self.index].plausible = Some([*range.start(), *range.end()]);
        self
    }

    /// Lets the parameter vary over time, with a value for each coordinate of the given shape. A study may ask for
    /// another shape, or for a constant. A choice varies in pieces.
    pub fn signal(self, shape: Shape) -> Self {
        self.declared.borrow_mut()[self.index].parameter.signal = Some(shape);
        self
    }

    /// Declares that a test with the nominal value is the same as a test without the parameter. Both have the same key,
    /// and so the same camera noise, which otherwise differs. It is for parameters added later.
    pub fn incidental(self) -> Self {
        let (value, nominal) = (self.given_or_nominal(), self.declared.borrow()[self.index].nominal());
        let seen = if self.atmospheric { &nominal } else { &value };
        for (key, value) in [(&self.keys.test, &value), (&self.keys.scenery, seen)] {
            if self.given.value.is_some() && *value == nominal {
                key.set(key.get().wrapping_sub(entry(&self.name(), value)));
            }
        }
        self
    }

    /// Declares that the parameter changes the air alone: light, fog, rain or the sun. The scenery of pictures is the same
    /// at all its values. Call it once, after `default` and before `incidental`.
    pub fn atmospheric(self) -> Self {
        if let Some(value) = &self.given.value {
            let nominal = self.declared.borrow()[self.index].nominal();
            let [value, nominal] = [value, &nominal].map(|value| entry(&self.name(), value));
            let scenery = &self.keys.scenery;
            scenery.set(scenery.get().wrapping_sub(value).wrapping_add(nominal));
        }
        self.uses.borrow_mut()[self.index].atmospheric = true;
        Self { atmospheric: true, ..self }
    }

    /// Returns the value that this test gives the parameter. If the test lets the parameter vary over time, the world
    /// cannot be built, because a single value has to hold for the whole run.
    pub fn value(&self) -> T {
        if self.shape().is_some() {
            self.flaw(WorldFlaw::Varies { parameter: self.name() });
        }
        self.uses.borrow_mut()[self.index].value = true;
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

/// A parameter has the methods of its stream, and stands where a reference to a stream is expected.
impl<T: Datum> Deref for Param<T> {
    type Target = Stream<T>;

    fn deref(&self) -> &Stream<T> {
        self.as_stream.get_or_init(|| self.stream())
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
