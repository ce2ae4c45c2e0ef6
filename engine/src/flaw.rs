//! Mistakes of a program, found while it builds its world.

use crate::road::RoadError;
use crate::stream::GraphFlaw;
use crate::traffic::TrafficError;
use crate::vehicle::VehicleFlaw;
use paracosm_space::{ParameterError, Shape, Value};
use std::cell::RefCell;
use std::rc::Rc;
use thiserror::Error;

/// Mistakes found while the program ran, shared with the handles that it got.
pub(crate) type Flaws = Rc<RefCell<Vec<WorldFlaw>>>;

/// Why a world cannot be built.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum WorldFlaw {
    /// An object cannot be as it is described.
    #[error("{object} {flaw}")]
    Object {
        /// The object, by its name in the world.
        object: String,
        /// What is wrong with it.
        flaw: ObjectFlaw,
    },
    /// The roads cannot be as they are described.
    #[error(transparent)]
    Road(#[from] RoadError),
    /// The streams have no meaning.
    #[error(transparent)]
    Streams(#[from] GraphFlaw),
    /// A stream has two definitions.
    #[error("the stream `{stream}` is defined twice")]
    DefinedTwice {
        /// The stream.
        stream: String,
    },
    /// A parameter has a value of another type.
    #[error("parameter `{parameter}` has the value {value}, which is of another type")]
    OtherType {
        /// The parameter.
        parameter: String,
        /// The value.
        value: Value,
    },
    /// A parameter cannot vary in this way.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A parameter varies over time, and the world needs one value of it.
    #[error("parameter `{parameter}` varies over time, but the world is built with one value of it")]
    Varies {
        /// The parameter.
        parameter: String,
    },
    /// A parameter that does not vary has several values.
    #[error("parameter `{parameter}` has the values {value}, but does not vary over time")]
    DoesNotVary {
        /// The parameter.
        parameter: String,
        /// The values.
        value: Value,
    },
    /// A parameter that varies has too many or too few values.
    #[error("parameter `{parameter}` has {found} values, expected {expected} of a {shape}")]
    Coordinates {
        /// The parameter.
        parameter: String,
        /// The number of values.
        found: usize,
        /// The number of values that the shape takes.
        expected: usize,
        /// The shape.
        shape: Shape,
    },
    /// The share of the roadside that is taken is no share.
    #[error("the roadside is {fullness} full, expected 0 to 1")]
    Roadside {
        /// The share.
        fullness: f64,
    },
    /// The friction of the roads is said twice.
    #[error("the friction of the roads is said twice")]
    FrictionTwice,
    /// There are two environments.
    #[error("there are two environments, expected one at most")]
    EnvironmentTwice,
    /// The program refuses the test by [`Scenario::refuse`](crate::Scenario::refuse).
    #[error("{why}")]
    Refused {
        /// The reason that the program gives.
        why: String,
    },
    /// A car of the traffic changes lanes in no time.
    #[error("{traffic}: car {car} changes lanes within {seconds} s, expected a finite number above 0")]
    LaneChange {
        /// The traffic, by its name in the world.
        traffic: String,
        /// The index of the car.
        car: usize,
        /// The time, in seconds.
        seconds: f64,
    },
    /// The traffic does not have this car.
    #[error("{traffic}: there is no car {car}, cars are counted from 0 and there are {count}")]
    NoCar {
        /// The traffic, by its name in the world.
        traffic: String,
        /// The index that was asked for.
        car: usize,
        /// The number of cars.
        count: usize,
    },
    /// There are several cars under test or none, or several road networks or none.
    #[error("{cars} cars under test on {roads} roads, expected one on one")]
    Cars {
        /// The number of cars under test.
        cars: usize,
        /// The number of road networks.
        roads: usize,
    },
    /// The duration of a run is no positive number.
    #[error("a run takes {seconds} s, expected a positive number")]
    Duration {
        /// The duration, in seconds.
        seconds: f64,
    },
    /// The duration of a tick is no positive number, or longer than the run.
    #[error("a tick takes {tick} s, expected a positive number up to the run's {run}")]
    Tick {
        /// The duration of a tick, in seconds.
        tick: f64,
        /// The duration of a run, in seconds.
        run: f64,
    },
    /// A run has too many ticks.
    #[error("a run has {ticks:.0} ticks, expected at most {most:.0}")]
    Ticks {
        /// The number of ticks.
        ticks: f64,
        /// The greatest number of ticks.
        most: f64,
    },
    /// Two requirements have one name.
    #[error("requirement `{id}` is stated twice")]
    RequirementTwice {
        /// The name.
        id: String,
    },
    /// Two streams of requirements have one name.
    #[error("two streams that requirements speak of are called `{stream}`: tell them apart by `named`")]
    SameName {
        /// The name.
        stream: String,
    },
    /// A stream of a requirement has the name of an output.
    #[error("a stream is called `{stream}`, which is the name of an object's output")]
    NameOfOutput {
        /// The name.
        stream: String,
    },
}

/// Why an object cannot be.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum ObjectFlaw {
    /// Its body has a measure that is no length.
    #[error("is {length} m long, {width} m wide and {height} m tall, expected finite lengths above 0")]
    Measures {
        /// In metres.
        length: f64,
        /// In metres.
        width: f64,
        /// In metres.
        height: f64,
    },
    /// Its body begins at a place that is none.
    #[error("stands at ({x}, {y}) and faces {heading}, expected numbers")]
    Pose {
        /// In metres.
        x: f64,
        /// In metres.
        y: f64,
        /// In radians.
        heading: f64,
    },
    /// The physics moves it, and it has no body or several.
    #[error("is physical and has {found} bodies, expected 1")]
    Bodies {
        /// The number of bodies.
        found: usize,
    },
    /// Its mass is none.
    #[error("weighs {mass} kg, expected a finite number above 0")]
    Mass {
        /// In kg.
        mass: f64,
    },
    /// Its path has a piece that is none.
    #[error("has a {line} that has a piece {piece} m long, expected a number from 0 on")]
    Piece {
        /// `path` or `way`.
        line: &'static str,
        /// The length of the piece, in metres.
        piece: f64,
    },
    /// It starts outside of its path.
    #[error("starts {start} m along a {line} of {length} m")]
    Start {
        /// `path` or `way`.
        line: &'static str,
        /// In metres along it.
        start: f64,
        /// The length of the path, in metres.
        length: f64,
    },
    /// It starts at a speed that it cannot have.
    #[error("has the speed {speed} m/s, expected 0 to {most}")]
    Speed {
        /// In m/s.
        speed: f64,
        /// The greatest speed, in m/s.
        most: f64,
    },
    /// The vehicle cannot be.
    #[error("cannot be built: {0}")]
    Vehicle(#[from] VehicleFlaw),
    /// The traffic cannot begin.
    #[error("cannot begin: {0}")]
    Traffic(#[from] TrafficError),
    /// The object reports a mistake of its own by [`ObjectDraft::refuse`](crate::ObjectDraft::refuse).
    #[error("{why}")]
    Refused {
        /// The words of the object, which go on from its name.
        why: String,
    },
}
