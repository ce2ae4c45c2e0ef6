//! The builder that a program writes its world into.
//!
//! A scenario is a function from a test to a world: it asks for its parameters by name, places objects, binds
//! their inputs to streams, and states requirements. Mistakes in it (a lane that the road does not have, two
//! cars under test) are collected and reported when the function has returned, so that programs need no `?` on
//! every line.

mod car;
mod geometry;
mod param;
mod requirement;
mod road;
mod walker;

pub use car::{AutonomousVehicle, Car};
pub use geometry::{Line, Pose};
pub use param::Param;
pub use requirement::{Draft, eventually, never};
pub use road::{Paved, Road, Side};
pub use walker::{Pedestrian, Walk, Walker};

pub(crate) use car::CarSetup;
pub(crate) use road::RoadSetup;
pub(crate) use walker::WalkerSetup;

use crate::program::Declared;
use crate::stream::Stream;
use paracosm_coverage::{Domain, Parameter, Value, Values};
use std::cell::RefCell;
use std::ops::RangeInclusive;
use std::rc::Rc;

/// Mistakes found while the program ran, shared with the handles that it got.
pub(crate) type Problems = Rc<RefCell<Vec<String>>>;

/// The world under construction, for one test or for none.
pub struct Scenario {
    /// The values of this test; `None` while the program is only asked for its parameters.
    test: Option<Values>,
    pub(crate) parameters: Rc<RefCell<Vec<Declared>>>,
    pub(crate) problems: Problems,
    pub(crate) roads: Vec<RoadSetup>,
    pub(crate) cars: Vec<CarSetup>,
    pub(crate) walkers: Vec<WalkerSetup>,
    pub(crate) requirements: Rc<RefCell<Vec<requirement::Stated>>>,
    pub(crate) premise: Option<Stream<bool>>,
    pub(crate) duration: f64,
}

/// Something that can be placed in a world: a road, a car, a pedestrian.
pub trait Place {
    /// How the program speaks of it afterwards.
    type Handle;

    /// Adds it to the world.
    fn place(self, scenario: &mut Scenario) -> Self::Handle;
}

impl Scenario {
    pub(crate) fn new(test: Option<Values>) -> Self {
        Self {
            test,
            parameters: Rc::default(),
            problems: Rc::default(),
            roads: Vec::new(),
            cars: Vec::new(),
            walkers: Vec::new(),
            requirements: Rc::default(),
            premise: None,
            duration: 10.0,
        }
    }

    /// An open parameter with values in an interval.
    pub fn interval(&mut self, name: &str, range: RangeInclusive<f64>) -> Param<f64> {
        let (lo, hi) = range.into_inner();
        self.declare(name, Domain::Interval { lo, hi }, None)
    }

    /// A parameter with values in an interval that stays at its nominal value until a study opens it.
    pub fn nominal(&mut self, name: &str, range: RangeInclusive<f64>, nominal: f64) -> Param<f64> {
        let (lo, hi) = range.into_inner();
        self.declare(name, Domain::Interval { lo, hi }, Some(nominal.into()))
    }

    /// An open parameter with one of these values.
    pub fn choice<T: Into<Value> + param::Plain, const N: usize>(&mut self, name: &str, levels: [T; N]) -> Param<T> {
        self.declare(name, Domain::Choice(levels.map(Into::into).into()), None)
    }

    /// A parameter with one of these values that stays at its nominal value until a study opens it.
    pub fn nominal_choice<T: Into<Value> + param::Plain, const N: usize>(
        &mut self,
        name: &str,
        levels: [T; N],
        nominal: T,
    ) -> Param<T> {
        self.declare(name, Domain::Choice(levels.map(Into::into).into()), Some(nominal.into()))
    }

    fn declare<T: param::Plain>(&mut self, name: &str, domain: Domain, nominal: Option<Value>) -> Param<T> {
        let open = nominal.is_none();
        let mut parameter = Parameter::new(name, domain);
        parameter.default = nominal;
        let declared = Declared { parameter, open };
        // A name that the test does not know is reported once the program has returned, with all the others.
        let given = self.test.as_ref().and_then(|test| test.get(name).cloned());
        let value = given.unwrap_or_else(|| declared.nominal());
        let value = T::from_value(&value).unwrap_or_else(|| {
            self.problem(format!("parameter `{name}` has the value {value}, which is of another type"));
            T::placeholder()
        });
        self.parameters.borrow_mut().push(declared);
        Param::new(self.parameters.clone(), value)
    }

    /// Adds an object to the world; the handle by which the program speaks of it.
    pub fn place<P: Place>(&mut self, object: P) -> P::Handle {
        object.place(self)
    }

    /// States a requirement on every run. What it returns takes a text, a unit and a scale.
    pub fn require(&mut self, id: &str, asked: requirement::Temporal) -> Draft {
        Draft::new(self.requirements.clone(), id, asked)
    }

    /// Says what the test is about: where `event` never occurs and nothing is violated, its verdict is
    /// inconclusive rather than a pass.
    pub fn premise(&mut self, event: &Stream<bool>) {
        self.premise = Some(event.clone());
    }

    /// How long a run takes in simulated seconds, unless a contact ends it before; 10 where nothing is said.
    pub fn duration(&mut self, seconds: f64) {
        self.duration = seconds;
    }

    pub(crate) fn problem(&self, message: String) {
        self.problems.borrow_mut().push(message);
    }
}
