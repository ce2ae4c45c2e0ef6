//! Reactive objects: what stands and moves in a world, with input streams and output streams.
//!
//! There are two kinds, as in section 2 of the paper. The pose of a [`Geometric`] object is under the control of its
//! program: it says at every tick where its bodies are. A [`Physical`] one has a mass, and the physics moves it: its
//! program only pushes. Pedestrians, cars on a path and houses are geometric objects that come with the engine; users
//! write their own of either kind.
//!
//! An object becomes part of a world by [`Place`](crate::Place): it asks the scenario for a [`ObjectDraft`](crate::ObjectDraft), in which it
//! declares its inputs, outputs and bodies, and leaves its behaviour there. What the program gets is a handle, from
//! which it takes the outputs as streams, and whose inputs it binds: anything's output to anything's input of that
//! type. At each tick
//!
//! 1. every object shows its outputs as they stand,
//! 2. all streams are evaluated,
//! 3. every object reads its inputs and moves on by the tick, seeing the others where they stood at its beginning.
//!
//! A balloon that climbs as fast as it is told, and whose height can be read:
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
mod wiring;

pub use body::{Body, BodyState, Class, Colour, Outline};
pub use wiring::{Input, Output, Outputs, Tick};

pub(crate) use behaviour::{Behaviour, ObjectSetup};
pub(crate) use footprint::{crosses, gap};
pub(crate) use wiring::Wiring;

use crate::geometry::Pose;
use crate::road::Path;
use nalgebra::Vector2;
use thiserror::Error;

/// What an object cannot go on with.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InputError {
    /// The stream of an input is absent.
    #[error("`{input}` has no value")]
    Absent {
        /// The input, as `object.input`.
        input: String,
    },
    /// An input reads NaN.
    #[error("`{input}` is not a number")]
    NotANumber {
        /// The input, as `object.input`.
        input: String,
    },
    /// An input reads what makes no sense.
    #[error("`{input}` is {value}, expected {expected}")]
    OutOfRange {
        /// The input, as `object.input`.
        input: String,
        /// What it reads.
        value: f64,
        /// What would make sense, in words.
        expected: &'static str,
    },
}

/// The behaviour of an object whose poses are under its own control.
pub trait Geometric: 'static {
    /// Writes where its bodies are, in the order in which they were declared; `None` for one that has left the world.
    fn poses(&self, poses: &mut [Option<Pose>]);

    /// Says how its bodies move as the run begins, in m/s over the ground, in the order in which they were declared: at
    /// rest where it does not. Its inputs are those of the first tick.
    ///
    /// # Errors
    /// As of [`Geometric::step`].
    fn begin(&mut self, tick: &Tick<'_>, velocities: &mut [Vector2<f64>]) -> Result<(), InputError> {
        let _ = (tick, velocities);
        Ok(())
    }

    /// Shows its outputs as they stand at the beginning of a tick. An output that is not shown is absent.
    fn show(&self, outputs: &mut Outputs<'_>) {
        let _ = outputs;
    }

    /// The way that it means to go from where it is, if it has decided on one: for pictures.
    fn plan(&self) -> Option<Path> {
        None
    }

    /// Reads its inputs and moves on by a tick.
    ///
    /// # Errors
    /// An input makes no sense. The run ends with the verdict `error`, which names the input.
    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        let _ = tick;
        Ok(())
    }
}

/// The behaviour of an object that the physics moves: a body with a mass, gravity, and friction on the ground.
pub trait Physical: 'static {
    /// Shows its outputs, with its body as it stands at the beginning of a tick.
    fn show(&self, body: &BodyState, outputs: &mut Outputs<'_>) {
        let _ = (body, outputs);
    }

    /// Reads its inputs; the force on the middle of its body during the tick, in N and in the axes of the ground plane.
    ///
    /// # Errors
    /// As of [`Geometric::step`].
    fn push(&mut self, body: &BodyState, tick: &Tick<'_>) -> Result<Vector2<f64>, InputError> {
        let _ = (body, tick);
        Ok(Vector2::zeros())
    }
}
