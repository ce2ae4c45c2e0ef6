//! The methods and operators of a `Stream`. They make nodes of the graph, so Python is not asked while a test runs.

use super::called::{Called, Datum, Kind};
use super::effect::Effect;
use super::operand::Operand;
use super::parameter::Parameter;
use super::place::Line;
use super::stream::{Origin, Stream};
use super::temporal::Temporal;
use super::wire::{Sign, Wire, both, each};
use crate::error::raised;
use crate::whole::whole;
use nalgebra::Vector2;
use paracosm::engine;
use pyo3::basic::CompareOp;
use pyo3::prelude::*;
use pyo3::types::PyNone;

/// The message for a stream in the place of a plain number.
const NO_NUMBER: &str =
    "found a stream, expected a number: write `parameter.value()` for the number that this test gives a parameter";

impl Stream {
    /// Makes a stream of this stream and another operand.
    fn joined(&self, other: Operand, join: impl FnOnce(Wire, Wire) -> PyResult<Wire>) -> PyResult<Self> {
        let wire = join(self.wire()?, other.wire)?;
        let (building, extent) = (self.building.clone().or(other.building), self.extent.with(other.extent));
        Ok(Self::sized(building, Origin::Wire(wire), extent))
    }

    /// Makes the stream of `&` or `|`. A statement on the right makes a statement, which is its own affair.
    fn stated<'py>(&self, other: &Bound<'py, PyAny>, sign: Sign) -> PyResult<Bound<'py, PyAny>> {
        let py = other.py();
        match Operand::is_one(other) {
            true => Ok(Bound::new(py, self.operated(other, sign, false)?)?.into_any()),
            false => Ok(py.NotImplemented().into_bound(py)),
        }
    }

    /// Makes the stream of an operator, with this stream on the left or on the right.
    fn operated(&self, other: &Bound<PyAny>, sign: Sign, is_swapped: bool) -> PyResult<Self> {
        let other = Operand::of(other, sign.word())?;
        self.joined(other, |own, other| if is_swapped { sign.of(other, own) } else { sign.of(own, other) })
    }
}

#[pymethods]
impl Stream {
    /// Numpy leaves operators with streams to the streams.
    #[classattr]
    #[pyo3(name = "__array_ufunc__")]
    fn array_ufunc(py: Python) -> Py<PyNone> {
        PyNone::get(py).to_owned().unbind()
    }

    /// Makes the stream that has one value at every tick: a number, a truth, or a pair of coordinates.
    #[staticmethod]
    fn constant(value: &Bound<PyAny>) -> PyResult<Self> {
        let Operand { building, wire, extent } = Operand::of(value, "constant")?;
        Ok(Self::sized(building, Origin::Wire(wire), extent))
    }

    /// Makes the stream of the time since the beginning of the run, in seconds.
    #[staticmethod]
    fn time() -> Self {
        Self::from_origin(None, Origin::Wire(engine::Stream::time().into()))
    }

    /// Makes the stream with an event at every tick.
    #[staticmethod]
    fn tick() -> Self {
        Self::from_origin(None, Origin::Wire(engine::Stream::tick().into()))
    }

    /// Makes a stream of vectors from the streams of their coordinates.
    #[staticmethod]
    fn vector(x: &Bound<PyAny>, y: &Bound<PyAny>) -> PyResult<Self> {
        let (x, y) = (Operand::of(x, "x")?, Operand::of(y, "y")?);
        let (building, extent) = (x.building.or(y.building), x.extent.with(y.extent));
        let wire = engine::Stream::vector(x.wire.numbers("x")?, y.wire.numbers("y")?).into();
        Ok(Self::sized(building, Origin::Wire(wire), extent))
    }

    fn __add__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Add, false)
    }

    fn __radd__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Add, true)
    }

    fn __sub__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Sub, false)
    }

    fn __rsub__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Sub, true)
    }

    fn __mul__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Mul, false)
    }

    fn __rmul__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Mul, true)
    }

    fn __truediv__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Div, false)
    }

    fn __rtruediv__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Div, true)
    }

    fn __and__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.stated(other, Sign::And)
    }

    fn __rand__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::And, true)
    }

    fn __or__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.stated(other, Sign::Or)
    }

    fn __ror__(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        self.operated(other, Sign::Or, true)
    }

    fn __invert__(&self) -> PyResult<Self> {
        Ok(self.made(!self.wire()?.truths("`~`")?))
    }

    fn __neg__(&self) -> PyResult<Self> {
        Ok(match self.wire()? {
            Wire::Vector(stream) => self.made(-stream),
            other => self.made(-other.numbers("`-`")?),
        })
    }

    fn __abs__(&self) -> PyResult<Self> {
        Ok(self.made(self.wire()?.numbers("abs")?.abs()))
    }

    fn __richcmp__(&self, other: &Bound<PyAny>, comparison: CompareOp) -> PyResult<Self> {
        let word = match comparison {
            CompareOp::Lt => "`<`",
            CompareOp::Le => "`<=`",
            CompareOp::Gt => "`>`",
            CompareOp::Ge => "`>=`",
            CompareOp::Eq | CompareOp::Ne => {
                return Err(raised(
                    "streams have no `==` and `!=`: write `a.equals(b)` for a stream of truths, and `parameter.value() == 2` for a value that \
                     decides how the world is built",
                ));
            }
        };
        self.joined(Operand::of(other, word)?, |own, other| {
            let (own, other) = (own.numbers(word)?, other.numbers(word)?);
            Ok(Wire::Truth(match comparison {
                CompareOp::Lt => own.below(other),
                CompareOp::Le => own.at_most(other),
                CompareOp::Gt => own.above(other),
                _ => own.at_least(other),
            }))
        })
    }

    fn __pow__(&self, _other: &Bound<PyAny>, _modulo: Option<&Bound<PyAny>>) -> PyResult<Self> {
        Err(raised(
            "streams have no `**`: write `a * a` for a square and `a.sqrt()` for a root; `a.map(..)` calls a function of Python at every tick",
        ))
    }

    fn __mod__(&self, _other: &Bound<PyAny>) -> PyResult<Self> {
        Err(raised("streams have no `%`: `a.map(..)` calls a function of Python at every tick"))
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(raised(
            "a stream is neither true nor false while the world is built: write `&`, `|` and `~` for `and`, `or` and `not`, \
             `(a < b) & (b < c)` for `a < b < c`, `a.min(b)` and `a.max(b)` for `min(a, b)` and `max(a, b)`, and `parameter.value()` for a \
             value that decides how the world is built",
        ))
    }

    /// Returns the statement that `other` holds if this stream is true.
    fn implies(&self, other: &Bound<PyAny>) -> PyResult<Temporal> {
        Temporal::of_stream(self, "implies")?.implies(other)
    }

    fn __float__(&self) -> PyResult<f64> {
        Err(raised(NO_NUMBER))
    }

    fn __index__(&self) -> PyResult<usize> {
        Err(raised(NO_NUMBER))
    }

    /// Returns the stream that is true at the ticks at which both streams have the same value.
    fn equals(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        let other = Operand::of(other, "equals")?;
        self.joined(other, |own, other| match (own, other) {
            (Wire::Number(own), Wire::Number(other)) => Ok(own.equals(other).into()),
            (Wire::Truth(own), Wire::Truth(other)) => Ok(own.equals(other).into()),
            (Wire::Vector(own), Wire::Vector(other)) => Ok(own.equals(other).into()),
            (own, other) => Err(raised(format!(
                "equals: found {} and {}, expected two streams of the same type",
                own.words(),
                other.words()
            ))),
        })
    }

    /// Returns the smaller value of this stream and another.
    fn min(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        let other = Operand::of(other, "min")?;
        self.joined(other, |own, other| Ok(own.numbers("min")?.min(other.numbers("min")?).into()))
    }

    /// Returns the larger value of this stream and another.
    fn max(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        let other = Operand::of(other, "max")?;
        self.joined(other, |own, other| Ok(own.numbers("max")?.max(other.numbers("max")?).into()))
    }

    /// Returns the square root of the stream's number at each tick; NaN below 0.
    fn sqrt(&self) -> PyResult<Self> {
        Ok(self.made(self.wire()?.numbers("sqrt")?.sqrt()))
    }

    /// Returns the sum of all values so far.
    fn sum(&self) -> PyResult<Self> {
        Ok(match self.wire()? {
            Wire::Vector(stream) => self.made(stream.sum()),
            other => self.made(other.numbers("sum")?.sum()),
        })
    }

    /// Returns the length of the stream's vector at each tick.
    fn norm(&self) -> PyResult<Self> {
        Ok(self.made(self.wire()?.vectors("norm")?.norm()))
    }

    /// Returns the scalar product of this stream's vectors and another's.
    fn dot(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        let other = Operand::of(other, "dot")?;
        self.joined(other, |own, other| Ok(own.vectors("dot")?.dot(other.vectors("dot")?).into()))
    }

    /// Returns the first coordinate of the stream's vector at each tick.
    fn x(&self) -> PyResult<Self> {
        Ok(self.made(self.wire()?.vectors("x")?.x()))
    }

    /// Returns the second coordinate of the stream's vector at each tick.
    fn y(&self) -> PyResult<Self> {
        Ok(self.made(self.wire()?.vectors("y")?.y()))
    }

    /// Returns the distance in metres from the stream's position to a line; negative past the line.
    fn distance_to(&self, line: &Line) -> PyResult<Self> {
        Ok(self.made(self.wire()?.vectors("distance_to")?.distance_to(&line.inner)))
    }

    /// Returns the same stream with a name. The graph uses the name, and so do the traces if a requirement reads the stream.
    fn named(&self, name: &str) -> PyResult<Self> {
        let made = each!(self.wire()?, stream => self.made(stream.named(name)));
        Ok(Self { extent: made.extent.named(), ..made })
    }

    /// Returns the stream at the ticks at which `event` occurs.
    fn when(&self, event: &Self) -> PyResult<Self> {
        let (event, extent) = (event.wire()?, self.extent.with(event.extent));
        let made = each!(self.wire()?, stream => each!(&event, event => self.made(stream.when(event))));
        Ok(Self { extent, ..made })
    }

    /// Returns the stream from the first tick on at which `event` occurs.
    fn skip_until(&self, event: &Self) -> PyResult<Self> {
        let (event, extent) = (event.wire()?, self.extent.with(event.extent));
        let made = each!(self.wire()?, stream => each!(&event, event => self.made(stream.skip_until(event))));
        Ok(Self { extent, ..made })
    }

    /// Returns the stream before the first tick at which `event` occurs.
    fn take_until(&self, event: &Self) -> PyResult<Self> {
        let (event, extent) = (event.wire()?, self.extent.with(event.extent));
        let made = each!(self.wire()?, stream => each!(&event, event => self.made(stream.take_until(event))));
        Ok(Self { extent, ..made })
    }

    /// Returns the first `count` values of the stream.
    fn take(&self, #[pyo3(from_py_with = whole)] count: usize) -> PyResult<Self> {
        Ok(each!(self.wire()?, stream => self.made(stream.take(count))))
    }

    /// Returns the value at the tick before; there is none at the first tick.
    fn pre(&self) -> PyResult<Self> {
        Ok(each!(self.wire()?, stream => self.made(stream.pre())))
    }

    /// Returns this stream until it is over, and then `following`.
    fn concat(&self, following: &Bound<PyAny>) -> PyResult<Self> {
        let following = Operand::of(following, "concat")?;
        self.joined(following, |own, next| both!("concat", own, next, one, other => one.concat(&other)))
    }

    /// Returns `value` at the first tick, and this stream from then on.
    fn initially(&self, value: &Bound<PyAny>) -> PyResult<Self> {
        let value = Operand::of(value, "initially")?;
        self.joined(value, |own, value| both!("initially", own, value, one, other => one.initially(other)))
    }

    /// Returns the value of this stream, and the value of `other` at the ticks at which only `other` has one.
    fn merge(&self, other: &Bound<PyAny>) -> PyResult<Self> {
        let other = Operand::of(other, "merge")?;
        self.joined(other, |own, other| both!("merge", own, other, one, two => one.merge(&two)))
    }

    /// Returns the latest value at every tick, or `initial` before the first value.
    fn hold(&self, initial: &Bound<PyAny>) -> PyResult<Self> {
        Ok(match self.wire()? {
            Wire::Number(stream) => self.made(stream.hold(f64::read(initial)?)),
            Wire::Truth(stream) => self.made(stream.hold(bool::read(initial)?)),
            Wire::Vector(stream) => self.made(stream.hold(Vector2::read(initial)?)),
            Wire::Event(_) => return Err(raised("hold: found a stream of events, which has no values to hold")),
        })
    }

    /// Applies a function of Python to each value. It is called at every tick. `returns` is the type of its
    /// results: `float`, `bool`, or `tuple` for a pair of coordinates.
    #[pyo3(signature = (function, returns = None))]
    fn map(&self, function: Py<PyAny>, returns: Option<&Bound<PyAny>>) -> PyResult<Self> {
        let (called, kind) = (Called::new(function), Kind::of(returns)?);
        Ok(each!(self.wire()?, stream => self.made(match kind {
            Kind::Number => Wire::Number(stream.map(move |value| called.answer(value))),
            Kind::Truth => Wire::Truth(stream.map(move |value| called.answer(value))),
            Kind::Vector => Wire::Vector(stream.map(move |value| called.answer(value))),
        })))
    }

    /// Returns the stream at the ticks at which a function of Python returns true for the value. It is called at every tick.
    fn filter(&self, function: Py<PyAny>) -> PyResult<Self> {
        let called = Called::new(function);
        Ok(each!(self.wire()?, stream => self.made(stream.filter(move |value| called.answer(value)))))
    }

    /// Combines the values so far: at each tick with a value, the new result is `function(previous result, value)`. The first previous result is
    /// `initial`. The Python function is called at each of these ticks.
    fn scan(&self, initial: &Bound<PyAny>, function: Py<PyAny>) -> PyResult<Self> {
        let called = Called::new(function);
        let folded: Wire = match Operand::of(initial, "initial")?.wire {
            Wire::Number(_) => {
                let initial = f64::read(initial)?;
                each!(self.wire()?, stream => stream.scan(initial, move |sum, value| called.folded(sum, value)).into())
            }
            Wire::Truth(_) => {
                let initial = bool::read(initial)?;
                each!(self.wire()?, stream => stream.scan(initial, move |sum, value| called.folded(sum, value)).into())
            }
            Wire::Vector(_) | Wire::Event(_) => {
                let initial = Vector2::read(initial)?;
                each!(self.wire()?, stream => stream.scan(initial, move |sum, value| called.folded(sum, value)).into())
            }
        };
        Ok(self.made(folded))
    }

    /// Returns an effect that calls a function of Python with each value. Place the effect in the scenario: `s.place(stream.for_each(print))`.
    fn for_each(&self, function: Py<PyAny>) -> PyResult<Effect> {
        let called = Called::new(function);
        self.wire()?;
        Ok(Effect { stream: self.clone(), called })
    }

    /// Returns the value that the test gives a parameter: a number, or a word of a choice. It can decide how the world is built.
    ///
    /// Raises `Error` if the stream is no parameter, or if the parameter varies while the test runs.
    fn value<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match (self.origin()?, &self.building) {
            (Origin::Parameter(parameter), Some(building)) => parameter.value(py, building),
            _ => Err(raised(
                "value: a stream has no value before the run; only a parameter has one, such as that of `s.interval(..)`",
            )),
        }
    }

    /// Defines a stream that `s.forward(..)` has announced. The definition may contain the stream itself after `pre`.
    ///
    /// Raises `Error` if the stream was not announced, or if the definition has values of another type.
    fn define(&self, definition: &Bound<PyAny>) -> PyResult<()> {
        match self.origin()? {
            Origin::Forward(forward) => forward.define(Operand::of(definition, "define")?.wire),
            _ => Err(raised("define: the stream has a definition already; only a stream of `s.forward(..)` needs one")),
        }
    }

    fn __repr__(&self) -> PyResult<String> {
        if let Origin::Parameter(Parameter::Word { name, .. }) = self.origin()? {
            return Ok(format!("Stream({name}, a parameter of words)"));
        }
        Ok(each!(self.wire()?, stream => format!("Stream({stream:?})")))
    }
}
