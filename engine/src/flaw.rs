//! Mistakes of a scenario program that are found while the program builds its world.

use crate::road::RoadError;
use crate::stream::GraphFlaw;
use crate::traffic::TrafficError;
use crate::vehicle::VehicleFlaw;
use paracosm_space::{ParameterError, Shape, Value};
use std::cell::RefCell;
use std::rc::Rc;
use thiserror::Error;

/// The mistakes that were found while the program ran. The handles that the program got share this list.
pub(crate) type Flaws = Rc<RefCell<Vec<WorldFlaw>>>;

/// The reason why a world cannot be built.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum WorldFlaw {
    /// The description of an object is not valid.
    #[error("{object} {flaw}")]
    Object {
        /// The name of the object in the world.
        object: String,
        /// The mistake in the description of the object.
        flaw: ObjectFlaw,
    },
    /// The description of the roads is not valid.
    #[error(transparent)]
    Road(#[from] RoadError),
    /// The streams of the world cannot be evaluated.
    #[error(transparent)]
    Streams(#[from] GraphFlaw),
    /// A stream has two definitions.
    #[error("the stream `{stream}` is defined twice")]
    DefinedTwice {
        /// The name of the stream with two definitions.
        stream: String,
    },
    /// A parameter has a value of a wrong type.
    #[error("parameter `{parameter}` has the value {value}, expected a value of the parameter's type")]
    OtherType {
        /// The name of the parameter whose value has a wrong type.
        parameter: String,
        /// The value that has a wrong type.
        value: Value,
    },
    /// A range of a parameter is no part of the values that the parameter takes.
    #[error("parameter `{parameter}`: {what} is {}..{}, expected a part of {}..{}", range[0], range[1], domain[0], domain[1])]
    Outside {
        /// The name of the parameter.
        parameter: String,
        /// The function of the program that has set the range: `plausible` or `opens`.
        what: &'static str,
        /// The least and the greatest value of the range.
        range: [f64; 2],
        /// The least and the greatest value that the parameter takes.
        domain: [f64; 2],
    },
    /// A parameter cannot vary over time with the given shape.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A parameter varies over time, but the world needs a single value of the parameter.
    #[error("parameter `{parameter}` varies over time, but the scenario needs a single value of it for the whole run")]
    Varies {
        /// The name of the parameter that varies over time.
        parameter: String,
    },
    /// A parameter that does not vary over time has several values.
    #[error("parameter `{parameter}` has several values, {value}, but does not vary over time: give it a single value")]
    DoesNotVary {
        /// The name of the parameter that has several values.
        parameter: String,
        /// The values of the parameter.
        value: Value,
    },
    /// A parameter that varies over time has too many or too few values.
    #[error("the number of values of parameter `{parameter}` is {found}, expected {expected} for a {shape}")]
    Coordinates {
        /// The name of the parameter with too many or too few values.
        parameter: String,
        /// The number of values that the parameter has.
        found: usize,
        /// The number of values that the shape needs.
        expected: usize,
        /// The shape of the parameter's signal over time.
        shape: Shape,
    },
    /// The share of the roadside that is filled with objects is not a number from 0 to 1.
    #[error("the share of the roadside that is filled is {fullness}, expected a number from 0 to 1")]
    Roadside {
        /// The share of the roadside that the program wants to fill.
        fullness: f64,
    },
    /// The program sets the friction of the roads twice.
    #[error("the scenario sets the friction of the roads twice: set it only once")]
    FrictionTwice,
    /// The program places two environments.
    #[error("the scenario places two environments, expected at most one")]
    EnvironmentTwice,
    /// The program refuses the test by [`Scenario::refuse`](crate::Scenario::refuse).
    #[error("{why}")]
    Refused {
        /// The reason why the program refuses the test.
        why: String,
    },
    /// The duration of a lane change of a traffic car is not a finite number above 0.
    #[error("{traffic}: the lane change of car {car} takes {seconds} s, expected a finite number above 0")]
    LaneChange {
        /// The name of the traffic object in the world.
        traffic: String,
        /// The index of the car that changes lanes.
        car: usize,
        /// The duration of the lane change, in seconds.
        seconds: f64,
    },
    /// The traffic has no car with the given index.
    #[error("{traffic}: car {car} does not exist: the number of cars is {count}, and they are counted from 0")]
    NoCar {
        /// The name of the traffic object in the world.
        traffic: String,
        /// The index of the car that does not exist.
        car: usize,
        /// The number of cars in the traffic.
        count: usize,
    },
    /// The world does not have exactly one ego vehicle and exactly one road network.
    #[error("the number of ego vehicles is {cars} and the number of road networks is {roads}, expected one of each")]
    Cars {
        /// The number of ego vehicles in the world.
        cars: usize,
        /// The number of road networks in the world.
        roads: usize,
    },
    /// The duration of a run is not a positive number.
    #[error("the duration of a run is {seconds} s, expected a positive number")]
    Duration {
        /// The duration of the run, in seconds.
        seconds: f64,
    },
    /// The duration of a tick is not a positive number, or a tick is longer than the run.
    #[error("the duration of a tick is {tick} s, expected a positive number up to the duration of the run, {run} s")]
    Tick {
        /// The duration of a tick, in seconds.
        tick: f64,
        /// The duration of a run, in seconds.
        run: f64,
    },
    /// A run has too many ticks.
    #[error("a run has {ticks:.0} ticks, expected at most {most:.0}: make the run shorter or its ticks longer")]
    Ticks {
        /// The number of ticks of the run.
        ticks: f64,
        /// The greatest number of ticks that a run may have.
        most: f64,
    },
    /// Two requirements have the same name.
    #[error("requirement `{id}` is stated twice: give each requirement an id of its own")]
    RequirementTwice {
        /// The name that both requirements have.
        id: String,
    },
    /// The scale of a requirement is not a number above 0.
    #[error("the scale of requirement `{id}` is {scale}, expected a number above 0")]
    Scale {
        /// The name of the requirement.
        id: String,
        /// The wrong scale.
        scale: f64,
    },
    /// Two streams that requirements refer to have the same name.
    #[error("two streams of requirements are called `{stream}`: give them different names by `named`")]
    SameName {
        /// The name that both streams have.
        stream: String,
    },
    /// A stream of a requirement has the name of an output of an object.
    #[error("a stream of a requirement is called `{stream}`, the name of an object's output: rename it by `named`")]
    NameOfOutput {
        /// The name that the stream and the output have.
        stream: String,
    },
}

/// The reason why an object cannot be built.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum ObjectFlaw {
    /// The length, width or height of a body is not a finite number above 0.
    #[error("is {length} m long, {width} m wide and {height} m tall, expected finite lengths above 0")]
    Measures {
        /// The length of the body, in metres.
        length: f64,
        /// The width of the body, in metres.
        width: f64,
        /// The height of the body, in metres.
        height: f64,
    },
    /// The pose at which a body starts is not finite.
    #[error("stands at ({x}, {y}) with the heading {heading}, expected finite numbers")]
    Pose {
        /// The x coordinate of the body, in metres.
        x: f64,
        /// The y coordinate of the body, in metres.
        y: f64,
        /// The heading of the body, in radians.
        heading: f64,
    },
    /// An object that the physics moves has no body or several bodies.
    #[error("is a physical object with {found} bodies, expected exactly 1 body")]
    Bodies {
        /// The number of bodies of the object.
        found: usize,
    },
    /// The mass of the object is not a finite number above 0.
    #[error("weighs {mass} kg, expected a finite number above 0")]
    Mass {
        /// The mass of the object, in kg.
        mass: f64,
    },
    /// A piece of the object's path has a length that is negative or not finite.
    #[error("has a {line} with a piece of {piece} m, expected a finite length from 0 on")]
    Piece {
        /// The word for the path in the message, `path` or `way`.
        line: &'static str,
        /// The length of the piece of the path, in metres.
        piece: f64,
    },
    /// The object starts before the beginning or beyond the end of its path.
    #[error("starts {start} m along a {line} of {length} m, expected a start from 0 to this length")]
    Start {
        /// The word for the path in the message, `path` or `way`.
        line: &'static str,
        /// The start of the object, in metres along the path.
        start: f64,
        /// The length of the path, in metres.
        length: f64,
    },
    /// The speed at which the object starts is out of range.
    #[error("has the speed {speed} m/s, expected 0 to {most} m/s")]
    Speed {
        /// The speed at which the object starts, in m/s.
        speed: f64,
        /// The greatest speed at which the object may start, in m/s.
        most: f64,
    },
    /// The acceleration of a pedestrian is not above 0.
    #[error("has the acceleration {acceleration} m/s², expected more than 0 m/s²")]
    Acceleration {
        /// The acceleration of the pedestrian, in m/s².
        acceleration: f64,
    },
    /// The description of the vehicle is not valid.
    #[error("cannot be built: {0}")]
    Vehicle(#[from] VehicleFlaw),
    /// The cars of the traffic cannot begin to drive.
    #[error("cannot begin: {0}")]
    Traffic(#[from] TrafficError),
    /// The object reports its own mistake by [`ObjectDraft::refuse`](crate::ObjectDraft::refuse).
    #[error("{why}")]
    Refused {
        /// The message of the object, which continues a sentence that begins with the object's name.
        why: String,
    },
}
