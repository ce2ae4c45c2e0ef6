//! A driver of Python in this process. It gets the same observations as over gRPC, so it drives the same.

use crate::busy;
use crate::error::raised;
use crate::sensors::welcome;
use crate::system::in_words;
use numpy::{PyArray1, PyArrayMethods};
use paracosm::Log;
use paracosm::campaign::StudyBuilder;
use paracosm::engine::driver::{Driver, Fault, FaultKind};
use paracosm::engine::{Briefing, Control, Observation};
use paracosm::rpc::message::{self, Outline};
use paracosm::rpc::{Answers, Partner};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict, PyList};
use std::collections::HashMap;
use std::sync::Arc;

/// Reads a driver that a study was given: an object, a class or a function. Returns the driver and its name; `None` if it is anything else, such
/// as the name of a driver.
///
/// # Errors
/// The class of the driver cannot make one.
pub fn of_python<'py>(given: &Bound<'py, PyAny>) -> PyResult<Option<(Bound<'py, PyAny>, String)>> {
    given.py().import("paracosm._drivers")?.call_method1("as_driver", (given,))?.extract()
}

/// Gives a driver of Python to a study. Every session gets a copy.
///
/// # Errors
/// The driver cannot be copied, has no such setting, or describes impossible sensors.
pub fn given_to(
    study: StudyBuilder,
    (driver, name): (Bound<PyAny>, String),
    settings: Vec<(String, f64)>,
) -> PyResult<StudyBuilder> {
    let make = maker(driver, &settings)?;
    Ok(settings.iter().fold(study.own_driver(&name, make), |study, (name, value)| study.set_driver(name, *value)))
}

/// Gives a driver of Python to the campaign of a folder in which a driver of this name drove.
///
/// # Errors
/// The driver has another name, cannot be copied, has no such setting, or describes impossible sensors.
pub fn given_again(log: &Log, (driver, name): (Bound<PyAny>, String)) -> PyResult<Log> {
    let settings = log.study().subject().scenario().map_err(raised)?.driver().changes();
    log.with_own_driver(&name, maker(driver, &settings)?).map_err(raised)
}

/// Returns the function that makes a copy of a driver for each session.
fn maker(
    driver: Bound<PyAny>,
    settings: &[(String, f64)],
) -> PyResult<impl Fn() -> Box<dyn Driver> + Send + Sync + 'static> {
    let seed = settings.iter().find(|(name, _)| name == "seed").map_or(0, |(_, seed)| *seed as u64);
    // The campaign itself deals with the latency.
    let own: Vec<_> = settings.iter().filter(|(name, _)| name != "seed" && name != "latency").cloned().collect();
    // A driver that cannot begin is a mistake of the study, and not of its tests.
    session(&driver, &own, seed)?;
    let driver = Arc::new(driver.unbind());
    Ok(move || -> Box<dyn Driver> {
        let begun = Python::attach(|py| session(driver.bind(py), &own, seed).map_err(|error| in_words(py, &error)));
        begun.unwrap_or_else(|why| Box::new(Unable(why)))
    })
}

/// Begins a session with a copy of a driver.
fn session(driver: &Bound<PyAny>, settings: &[(String, f64)], seed: u64) -> PyResult<Box<dyn Driver>> {
    let drivers = driver.py().import("paracosm._drivers")?;
    let settings: HashMap<_, _> = settings.iter().cloned().collect();
    let own = drivers.call_method1("of_session", (driver, settings, seed))?;
    let described = drivers.call_method1("described", (&own,))?;
    let welcome = welcome(described.cast::<PyDict>()?)?;
    let step = own.getattr("step")?.unbind();
    let inside = Inside { driver: own.unbind(), step, images: PyDict::new(driver.py()).unbind() };
    Ok(Box::new(Partner::new(welcome, seed, inside).map_err(raised)?))
}

/// A driver that could not begin a session.
struct Unable(String);

impl Driver for Unable {
    fn period(&self) -> f64 {
        1.0
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Err(Fault::new(self.0.clone()))
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        Err(Fault::new(self.0.clone()))
    }
}

/// A driver of Python, which answers the messages of the protocol.
struct Inside {
    driver: Py<PyAny>,
    step: Py<PyAny>,
    /// The last image of each camera in this test.
    images: Py<PyDict>,
}

impl Answers for Inside {
    fn reset(&mut self, reset: &message::Reset) -> Result<(), Fault> {
        Python::attach(|py| {
            self.images.bind(py).clear();
            let told = || -> PyResult<()> {
                let briefing = briefing(py, reset)?;
                busy::calling(py, || self.driver.bind(py).call_method1("reset", (briefing,)).map(drop))
            };
            told().map_err(|error| fault(py, &error))
        })
    }

    fn step(&mut self, step: message::Step) -> Result<Control, Fault> {
        Python::attach(|py| {
            let asked = || -> PyResult<Control> {
                let observation = observation(py, step, self.images.bind(py))?;
                let control = busy::calling(py, || self.step.bind(py).call1((observation,)))?;
                control_of(py, &control)
            };
            asked().map_err(|error| fault(py, &error))
        })
    }
}

/// Reads the control that a driver of Python returns.
///
/// # Errors
/// The object is no `Control`.
pub fn control_of(py: Python, control: &Bound<PyAny>) -> PyResult<Control> {
    if !control.is_instance(Class::Control.get(py)?)? {
        let found = control.repr().map(|text| text.to_string()).unwrap_or_default();
        return Err(raised(format!("step returned {found}, expected a Control")));
    }
    Ok(Control {
        throttle: control.getattr(intern!(py, "throttle"))?.extract()?,
        steering: control.getattr(intern!(py, "steering"))?.extract()?,
    })
}

fn fault(py: Python, error: &PyErr) -> Fault {
    match error.is_instance_of::<PyKeyboardInterrupt>(py) {
        true => Fault::of(FaultKind::Interrupted, "interrupted"),
        false => Fault::new(in_words(py, error)),
    }
}

/// The classes of the messages to and from a driver.
#[derive(Clone, Copy)]
enum Class {
    Control,
    Observation,
    Way,
    Briefing,
    Vehicle,
    Body,
    Picture,
    Scan,
    Fix,
    Inertia,
}

/// The classes in the order of [`Class`], once they were needed.
static CLASSES: PyOnceLock<Vec<Py<PyAny>>> = PyOnceLock::new();

impl Class {
    fn get<'py>(self, py: Python<'py>) -> PyResult<&'py Bound<'py, PyAny>> {
        const NAMES: [&str; 10] =
            ["Control", "Observation", "Way", "Briefing", "Vehicle", "Body", "Picture", "Scan", "Fix", "Inertia"];
        let classes = CLASSES.get_or_try_init(py, || {
            let module = py.import("paracosm.observation")?;
            NAMES.iter().map(|name| Ok(module.getattr(*name)?.unbind())).collect::<PyResult<Vec<_>>>()
        })?;
        Ok(classes[self as usize].bind(py))
    }
}

fn briefing<'py>(py: Python<'py>, reset: &message::Reset) -> PyResult<Bound<'py, PyAny>> {
    let car = reset.vehicle.unwrap_or_default();
    // In the order of the fields of the class.
    let fields = [
        car.length,
        car.width,
        car.height,
        car.wheelbase,
        car.track,
        car.front_axle,
        car.centre_of_gravity,
        car.mass,
        car.yaw_inertia,
        car.wheel_radius,
        car.wheel_mass,
        car.wheel_inertia,
        car.ride_frequency,
        car.damping_ratio,
        car.cornering_stiffness,
        car.max_steering_angle,
        car.max_steering_rate,
        car.max_acceleration,
        car.switch_speed,
        car.max_speed,
    ];
    let vehicle = Class::Vehicle.get(py)?.call1(pyo3::types::PyTuple::new(py, fields)?)?;
    Class::Briefing.get(py)?.call1((reset.cruise_speed, vehicle))
}

/// Makes the observation of a moment, and keeps the last image of each camera in `images`.
///
/// # Errors
/// Python raises an error.
pub fn observation<'py>(
    py: Python<'py>,
    step: message::Step,
    images: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyAny>> {
    let pictures = step.images.iter().map(|image| picture(py, image)).collect::<PyResult<Vec<_>>>()?;
    for picture in &pictures {
        images.set_item(picture.getattr("camera")?, picture.getattr("pixels")?)?;
    }
    let way = step.way.unwrap_or_default();
    let ahead = PyArray1::from_vec(py, way.ahead);
    let points = ahead.len()? / 3;
    let ahead = ahead.reshape([points, 3])?;
    let (told, fields) = blank(Class::Way, py)?;
    fields.set_item(intern!(py, "offset"), way.offset)?;
    fields.set_item(intern!(py, "heading"), way.heading)?;
    fields.set_item(intern!(py, "spacing"), way.spacing)?;
    fields.set_item(intern!(py, "ahead"), ahead)?;
    let odometry = step.odometry.unwrap_or_default();
    let array = |values: [f64; 2]| PyArray1::from_slice(py, &values);
    let scans = step.scans.iter().map(|scan| {
        let points = from_buffer(py, &scan.points, "<f4")?.call_method1("reshape", (-1, 4))?;
        Class::Scan.get(py)?.call1((&scan.sensor, scan.number, scan.time, points))
    });
    let fixes = step.fixes.iter().map(|fix| {
        let known = fix.valid.then(|| (array([fix.x, fix.y]), array([fix.velocity_x, fix.velocity_y])));
        let (position, velocity) = known.unzip();
        Class::Fix.get(py)?.call1((&fix.sensor, fix.number, fix.time, position, velocity))
    });
    let inertia = step.inertia.iter().map(|one| {
        let acceleration = array([one.acceleration_x, one.acceleration_y]);
        Class::Inertia.get(py)?.call1((&one.sensor, one.number, one.time, acceleration, one.yaw_rate))
    });
    let others = step.others.iter().map(|other| {
        let (length, width) = match other.outline {
            Some(Outline::Rectangle(rectangle)) => (rectangle.length, rectangle.width),
            Some(Outline::Radius(radius)) => (2.0 * radius, 2.0 * radius),
            None => (0.0, 0.0),
        };
        let (position, velocity) = (array([other.x, other.y]), array([other.velocity_x, other.velocity_y]));
        Class::Body.get(py)?.call1((other.id, &other.class, position, velocity, other.heading, length, width))
    });
    let (observation, fields) = blank(Class::Observation, py)?;
    fields.set_item(intern!(py, "time"), step.time)?;
    fields.set_item(intern!(py, "speed"), step.speed)?;
    fields.set_item(intern!(py, "travelled"), step.travelled)?;
    fields.set_item(intern!(py, "odometry"), (odometry.x, odometry.y, odometry.heading))?;
    fields.set_item(intern!(py, "way"), told)?;
    fields.set_item(intern!(py, "images"), images.copy()?)?;
    fields.set_item(intern!(py, "pictures"), pictures)?;
    fields.set_item(intern!(py, "scans"), listed(py, scans)?)?;
    fields.set_item(intern!(py, "fixes"), listed(py, fixes)?)?;
    fields.set_item(intern!(py, "inertia"), listed(py, inertia)?)?;
    fields.set_item(intern!(py, "others"), listed(py, others)?)?;
    Ok(observation)
}

/// Makes an object of a class without a call of its `__init__`, and returns the object with the dictionary of its fields. The `__init__` of a
/// frozen dataclass takes as long as everything else of a step.
fn blank(class: Class, py: Python<'_>) -> PyResult<(Bound<'_, PyAny>, Bound<'_, PyDict>)> {
    let class = class.get(py)?;
    let object = class.call_method1(intern!(py, "__new__"), (class,))?;
    let fields = object.getattr(intern!(py, "__dict__"))?.cast_into::<PyDict>()?;
    Ok((object, fields))
}

fn listed<'py>(
    py: Python<'py>,
    all: impl Iterator<Item = PyResult<Bound<'py, PyAny>>>,
) -> PyResult<Bound<'py, PyList>> {
    PyList::new(py, all.collect::<PyResult<Vec<_>>>()?)
}

fn picture<'py>(py: Python<'py>, image: &message::Image) -> PyResult<Bound<'py, PyAny>> {
    let pixels = from_buffer(py, &image.rgb, "u1")?.call_method1("reshape", (image.height, image.width, 3))?;
    Class::Picture.get(py)?.call1((&image.camera, image.number, image.time, pixels))
}

/// Makes an array of bytes that nobody can write.
fn from_buffer<'py>(py: Python<'py>, bytes: &[u8], kind: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("numpy")?.call_method1("frombuffer", (PyBytes::new(py, bytes), kind))
}
