//! Reactive objects: the things that stand and move in a world, with input streams and output streams.
//!
//! There are two kinds of objects, as in section 2 of the paper. The program of a [`Geometric`] object controls its
//! pose: at every tick, it says where the bodies are. A [`Physical`] object has a mass, and the physics moves it: its
//! program only pushes. Pedestrians, cars on a path and houses are geometric objects that come with the engine. Users
//! can write their own objects of either kind.
//!
//! An object becomes part of a world by [`Place`](crate::Place): it asks the scenario for an
//! [`ObjectDraft`](crate::ObjectDraft), declares its inputs, outputs and bodies in the draft, and leaves its behaviour
//! there. The program gets a handle. The handle gives the outputs as streams, and binds the inputs: any output can be
//! bound to any input of the same type. At each tick
//!
//! 1. every object shows its outputs in their present state,
//! 2. all streams are evaluated,
//! 3. every object reads its inputs and moves on. It sees the others where they stood at the beginning of the tick.
//!
//! An example is a balloon that climbs at a given speed, and whose height can be read:
//!
//! ```
//! use paracosm_engine::object::{Body, Class, Geometric, Input, InputError, Output, Outputs, Tick};
//! use paracosm_engine::{AutonomousVehicle, Place, Pose, Program, RoadSegment, Scenario, Stream, never};
//!
//! struct Balloon { start: Pose, climb: Stream<f64> }
//!
//! struct Flight { pose: Pose, height: f64, climb: Input<f64>, shown: Output<f64> }
//!
//! impl Geometric for Flight {
//!     fn poses(&self, poses: &mut [Option<Pose>]) {
//!         poses[0] = Some(self.pose);
//!     }
//!     fn show(&self, outputs: &mut Outputs<'_>) {
//!         outputs.set(&self.shown, self.height);
//!     }
//!     fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
//!         self.height += tick.number(&self.climb)? * tick.dt();
//!         Ok(())
//!     }
//! }
//!
//! impl Place for Balloon {
//!     type Handle = Stream<f64>;
//!     fn place(self, s: &mut Scenario) -> Stream<f64> {
//!         let mut draft = s.object("balloon");
//!         draft.body(Body::disc(Class::Prop, 0.4, 0.5), self.start);
//!         let climb = draft.input("climb", self.climb);
//!         let shown = draft.output("height");
//!         let height = shown.stream();
//!         draft.geometric(Flight { pose: self.start, height: 0.0, climb, shown });
//!         height
//!     }
//! }
//!
//! fn fair(s: &mut Scenario) {
//!     let road = s.place(RoadSegment::new(200.0));
//!     let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
//!     let height = s.place(Balloon { start: road.on_lane(-1, 100.0), climb: car.speed() * 0.1 });
//!     s.require("low", never(height.above(50.0)));
//! }
//! # Program::new("fair", "a fair", fair).declare().unwrap();
//! ```

mod behaviour;
mod body;
mod footprint;
mod vehicle_kind;
mod wiring;

pub use body::{Body, BodyState, Class, Colour, Outline};
pub use vehicle_kind::VehicleKind;
pub use wiring::{Input, Output, Outputs, Tick};

pub(crate) use behaviour::{Behaviour, ObjectSetup};
pub(crate) use footprint::{crosses, gap};
pub(crate) use wiring::Wiring;

use crate::road::Path;
use nalgebra::Vector2;
use paracosm_road::Pose;
use thiserror::Error;

/// The reason why an object cannot use the value of an input.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InputError {
    /// The stream of an input is absent.
    #[error("the input `{input}` has no value, because its stream is absent")]
    Absent {
        /// The name of the input, as `object.input`.
        input: String,
    },
    /// The value of an input is NaN.
    #[error("the value of the input `{input}` is not a number")]
    NotANumber {
        /// The name of the input, as `object.input`.
        input: String,
    },
    /// The object cannot do what it is told.
    #[error("{object}: `{action}` is impossible: {reason}")]
    Impossible {
        /// The name of the object, or the place of the action in a file.
        object: String,
        /// The name of the action.
        action: String,
        /// The reason.
        reason: String,
    },
    /// The value of an input is out of range.
    #[error("the value of the input `{input}` is {value}, expected {expected}")]
    OutOfRange {
        /// The name of the input, as `object.input`.
        input: String,
        /// The value that is out of range.
        value: f64,
        /// The values that the input allows, in words.
        expected: &'static str,
    },
}

/// The behaviour of an object that controls its own poses.
pub trait Geometric: 'static {
    /// Writes the poses of the object's bodies, in the order of declaration; `None` for a body that is not in the world: it has
    /// left, or it enters later. Before the first tick, bodies stand where they were declared, unless [`Geometric::begin`] changes a pose.
    fn poses(&self, poses: &mut [Option<Pose>]);

    /// Writes the velocities of the object's bodies at the beginning of the run, in m/s over the ground, in the order
    /// of declaration. By default they are at rest. The inputs are those of the first tick. If this call changes a pose of
    /// [`Geometric::poses`], the body starts there.
    ///
    /// # Errors
    /// The same as of [`Geometric::step`].
    fn begin(&mut self, tick: &Tick<'_>, velocities: &mut [Vector2<f64>]) -> Result<(), InputError> {
        let _ = (tick, velocities);
        Ok(())
    }

    /// Writes the values of the object's outputs at the beginning of a tick. An output without a value is absent.
    fn show(&self, outputs: &mut Outputs<'_>) {
        let _ = outputs;
    }

    /// Returns the intended path of the object from its present place; `None` without a plan. Pictures show the path.
    fn plan(&self) -> Option<Path> {
        None
    }

    /// Returns `true` if the object never moves and may overlap other such objects, as the walls of a house do.
    fn is_joined(&self) -> bool {
        false
    }

    /// Reads the object's inputs and moves the object on by a tick.
    ///
    /// # Errors
    /// An input has no value or a wrong value. The run ends with the verdict `error`, which names the input.
    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        let _ = tick;
        Ok(())
    }
}

/// The behaviour of an object that the physics moves as a body with a mass, gravity, and friction on the ground.
pub trait Physical: 'static {
    /// Writes the values of the object's outputs at the beginning of a tick. `body` is the state of its body then.
    fn show(&self, body: &BodyState, outputs: &mut Outputs<'_>) {
        let _ = (body, outputs);
    }

    /// Reads the object's inputs and returns the force on the body's middle during the tick, in N and in ground axes.
    ///
    /// # Errors
    /// The same as of [`Geometric::step`].
    fn push(&mut self, body: &BodyState, tick: &Tick<'_>) -> Result<Vector2<f64>, InputError> {
        let _ = (body, tick);
        Ok(Vector2::zeros())
    }
}
