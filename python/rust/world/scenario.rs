//! `Scenario`: what a function of Python builds a world in.

use super::actors::{Fixture, Mover, Pedestrian, Roadside};
use super::building::Building;
use super::called::Kind;
use super::effect::Effect;
use super::ego::AutonomousVehicle;
use super::environment::Environment;
use super::forward::announced;
use super::monitor::Monitor;
use super::network::{RoadSegment, placed};
use super::operand::Operand;
use super::parameter::{Said, declared};
use super::stream::{Origin, Stream};
use super::temporal::statement;
use super::traffic::EnvironmentCars;
use crate::error::raised;
use crate::value::value_of;
use paracosm::engine::{Declared, RequirementDraft};
use paracosm::space::constraint::Expression;
use paracosm::space::{Domain, Value};
use pyo3::prelude::*;

/// A world under construction, which the function of a scenario gets. It declares parameters, places objects, and states requirements.
#[pyclass(frozen, module = "paracosm")]
pub struct Scenario {
    building: Building,
}

impl Scenario {
    /// Makes the scenario that a function of Python gets.
    pub fn of(building: &Building) -> Self {
        Self { building: building.clone() }
    }

    /// Declares a parameter, which is a stream.
    fn parameter(&self, parameter: Declared, said: Said) -> PyResult<Stream> {
        let parameter = declared(&self.building, parameter, said)?;
        Ok(Stream::from_origin(Some(self.building.clone()), Origin::Parameter(parameter)))
    }

    fn stated(&self, draft: RequirementDraft, said: (Option<String>, Option<String>, Option<f64>)) {
        let (text, unit, scale) = said;
        let draft = text.iter().fold(draft, |draft, text| draft.text(text));
        let draft = unit.iter().fold(draft, |draft, unit| draft.unit(unit));
        let _ = scale.into_iter().fold(draft, RequirementDraft::scale);
    }
}

/// Reads a value of a parameter if there is one.
fn given(found: Option<&Bound<PyAny>>, name: &str) -> PyResult<Option<Value>> {
    found.map(|found| value_of(found, &format!("parameter `{name}`"))).transpose()
}

#[pymethods]
impl Scenario {
    /// Declares an open parameter with the numbers from `low` to `high`. Tests vary it.
    ///
    /// `default` is its nominal value, `plausible` the range that occurs in the world, and `signal` the shape of a parameter that varies while a
    /// test runs: "piecewise-constant(4)", "polynomial(2)" or "piecewise-linear(3)".
    /// `incidental=True` says that a test with the nominal value has the same camera noise as a test without the parameter. `atmospheric=True` says
    /// that the parameter changes only light, fog, rain or the sun.
    #[pyo3(signature = (name, low, high, *, unit = None, default = None, plausible = None, signal = None, incidental = false, atmospheric = false))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn interval(
        &self,
        name: &str,
        low: f64,
        high: f64,
        unit: Option<String>,
        default: Option<&Bound<PyAny>>,
        plausible: Option<[f64; 2]>,
        signal: Option<String>,
        incidental: bool,
        atmospheric: bool,
    ) -> PyResult<Stream> {
        let parameter = Declared::open(paracosm::space::Parameter::new(name, Domain::Interval { lo: low, hi: high }));
        let default = given(default, name)?;
        let said = Said { unit, default, opens: None, plausible, signal, incidental, atmospheric };
        self.parameter(parameter, said)
    }

    /// Declares a closed parameter with the numbers from `low` to `high`. It stays at `nominal` until a study opens it; then tests vary it in
    /// `opens`, or in the whole interval.
    #[pyo3(signature = (name, low, high, nominal, *, unit = None, opens = None, plausible = None, signal = None, incidental = false, atmospheric = false))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn nominal(
        &self,
        name: &str,
        low: f64,
        high: f64,
        nominal: f64,
        unit: Option<String>,
        opens: Option<[f64; 2]>,
        plausible: Option<[f64; 2]>,
        signal: Option<String>,
        incidental: bool,
        atmospheric: bool,
    ) -> PyResult<Stream> {
        let parameter = paracosm::space::Parameter::new(name, Domain::Interval { lo: low, hi: high });
        let parameter = Declared { open: false, ..Declared::open(parameter) };
        let default = Some(Value::Number(nominal));
        let said = Said { unit, default, opens, plausible, signal, incidental, atmospheric };
        self.parameter(parameter, said)
    }

    /// Declares an open parameter that takes one of some values: numbers or words.
    #[pyo3(signature = (name, values, *, unit = None, default = None, signal = None, incidental = false, atmospheric = false))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn choice(
        &self,
        name: &str,
        values: &Bound<PyAny>,
        unit: Option<String>,
        default: Option<&Bound<PyAny>>,
        signal: Option<String>,
        incidental: bool,
        atmospheric: bool,
    ) -> PyResult<Stream> {
        let parameter = Declared::open(paracosm::space::Parameter::new(name, levels(name, values)?));
        let default = given(default, name)?;
        let said = Said { unit, default, signal, incidental, atmospheric, ..Said::default() };
        self.parameter(parameter, said)
    }

    /// Declares a closed parameter that takes one of some values, and stays at `nominal` until a study opens it.
    #[pyo3(signature = (name, values, nominal, *, unit = None, signal = None, incidental = false, atmospheric = false))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn nominal_choice(
        &self,
        name: &str,
        values: &Bound<PyAny>,
        nominal: &Bound<PyAny>,
        unit: Option<String>,
        signal: Option<String>,
        incidental: bool,
        atmospheric: bool,
    ) -> PyResult<Stream> {
        let parameter = paracosm::space::Parameter::new(name, levels(name, values)?);
        let parameter = Declared { open: false, ..Declared::open(parameter) };
        let default = given(Some(nominal), name)?;
        let said = Said { unit, default, signal, incidental, atmospheric, ..Said::default() };
        self.parameter(parameter, said)
    }

    /// Places an object in the world, and returns its handle.
    fn place<'py>(&self, py: Python<'py>, object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let building = &self.building;
        if let Ok(road) = object.cast::<RoadSegment>() {
            return Ok(Bound::new(py, road.get().place(building)?)?.into_any());
        }
        if let Ok(car) = object.cast::<AutonomousVehicle>() {
            return Ok(Bound::new(py, car.get().place(building)?)?.into_any());
        }
        if let Ok(pedestrian) = object.cast::<Pedestrian>() {
            return Ok(Bound::new(py, pedestrian.get().place(building)?)?.into_any());
        }
        if let Ok(mover) = object.cast::<Mover>() {
            return Ok(Bound::new(py, mover.get().place(building)?)?.into_any());
        }
        if let Ok(cars) = object.cast::<EnvironmentCars>() {
            return Ok(Bound::new(py, cars.get().place(building)?)?.into_any());
        }
        if let Ok(environment) = object.cast::<Environment>() {
            return Ok(Bound::new(py, environment.get().place(building)?)?.into_any());
        }
        if let Ok(fixture) = object.cast::<Fixture>() {
            fixture.get().place(building)?;
            return Ok(py.None().into_bound(py));
        }
        if let Ok(roadside) = object.cast::<Roadside>() {
            roadside.get().place(building)?;
            return Ok(py.None().into_bound(py));
        }
        if let Ok(effect) = object.cast::<Effect>() {
            effect.get().place(building)?;
            return Ok(py.None().into_bound(py));
        }
        match placed(object, building)? {
            Some(streets) => Ok(Bound::new(py, streets)?.into_any()),
            None => {
                let kind = object.get_type().name()?;
                Err(raised(format!(
                    "place: found a value of the type {kind}, expected an object such as a RoadSegment or a Pedestrian"
                )))
            }
        }
    }

    /// States a requirement on every run. `asked` is a statement, such as `never(car.collides())`. `text` is a sentence for people, `unit` the unit
    /// of the robustness, and `scale` the robustness that counts as large.
    #[pyo3(signature = (id, asked, *, text = None, unit = None, scale = None))]
    fn require(
        &self,
        id: &str,
        asked: &Bound<PyAny>,
        text: Option<String>,
        unit: Option<String>,
        scale: Option<f64>,
    ) -> PyResult<()> {
        if asked.cast::<Stream>().is_ok() {
            return Err(raised(
                "a requirement is a statement about the whole run, and found a stream: write `pc.always(..)`, `pc.never(..)` or \
                 `pc.eventually(..)`",
            ));
        }
        let asked = statement(asked, "require")?.inner.get()?.clone();
        let draft = self.building.with(|scenario| scenario.require(id, asked))?;
        self.stated(draft, (text, unit, scale));
        Ok(())
    }

    /// States a predefined requirement. `text`, `unit` and `scale` replace its defaults.
    #[pyo3(signature = (monitor, *, text = None, unit = None, scale = None))]
    fn monitor(
        &self,
        monitor: &Bound<PyAny>,
        text: Option<String>,
        unit: Option<String>,
        scale: Option<f64>,
    ) -> PyResult<()> {
        let monitor = monitor.cast::<Monitor>().map_err(|_| {
            raised("monitor: expected a `pc.Monitor`, such as `pc.Monitor.no_collision(car)`; `s.require(\"id\", ..)` takes other statements")
        })?;
        let monitor = monitor.get().inner()?;
        let draft = self.building.with(|scenario| scenario.monitor(monitor))?;
        self.stated(draft, (text, unit, scale));
        Ok(())
    }

    /// Sets the event that the test is about. If it never occurs and nothing is violated, the verdict is "inconclusive".
    fn premise(&self, event: &Bound<PyAny>) -> PyResult<()> {
        let event = Operand::of(event, "premise")?.wire.truths("premise")?;
        self.building.with(|scenario| scenario.premise(&event))
    }

    /// Ends every run at the first tick at which `event` occurs.
    fn end(&self, event: &Bound<PyAny>) -> PyResult<()> {
        let event = Operand::of(event, "end")?.wire.truths("end")?;
        self.building.with(|scenario| scenario.end(&event))
    }

    /// States a constraint between parameters, such as "gap >= 0.5 * speed". All tests satisfy the constraint.
    fn constrain(&self, constraint: &str) -> PyResult<()> {
        let expression: Expression = constraint.parse().map_err(raised)?;
        self.building.with(|scenario| scenario.constrain(expression))
    }

    /// Makes the test invalid, because its world is impossible. Return from the function afterwards.
    fn refuse(&self, why: &str) -> PyResult<()> {
        self.building.refuse(why)
    }

    /// Sets the duration of a run in simulated seconds; without it, 10.
    fn duration(&self, seconds: f64) -> PyResult<()> {
        self.building.with(|scenario| scenario.duration(seconds))
    }

    /// Sets the duration of a tick in seconds; without it, 0.01.
    fn tick(&self, seconds: f64) -> PyResult<()> {
        self.building.with(|scenario| scenario.tick(seconds))
    }

    /// Announces a stream that is used before it is defined. `type` is the type of its values: `float`, `bool` or `tuple`.
    #[pyo3(signature = (name, r#type = None))]
    fn forward(&self, name: &str, r#type: Option<&Bound<PyAny>>) -> PyResult<Stream> {
        let forward = announced(&self.building, name, Kind::of(r#type)?)?;
        Ok(Stream::from_origin(Some(self.building.clone()), Origin::Forward(forward)))
    }
}

/// Makes the domain of a choice.
fn levels(name: &str, values: &Bound<PyAny>) -> PyResult<Domain> {
    let Ok(values) = values.extract::<Vec<Bound<PyAny>>>() else {
        let found = values.repr()?;
        return Err(raised(format!("the values of parameter `{name}` are {found}, expected a list, such as [2, 4]")));
    };
    if values.is_empty() {
        return Err(raised(format!("parameter `{name}` has no values, expected at least one")));
    }
    let values = values.iter().map(|value| value_of(value, &format!("parameter `{name}`")));
    Ok(Domain::Choice(values.collect::<PyResult<_>>()?))
}
